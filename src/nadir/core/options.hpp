// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace nadir {

/// The values that a number may take; both ends are allowed.
struct Range {
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
};

/// One option, as declared: the only place that knows its name, default, range, meaning and
/// source. The check, the YAML reader, `--help`, `nadir config dump` and docs/options.md read it.
struct Option {
  std::string name;           ///< dotted, with its unit: "localization.temper", "…yaw_step_deg"
  std::string type;           ///< "number", "integer", "switch", "choice"
  std::string default_value;  ///< as text
  std::string allowed;        ///< human-readable: "0 .. 1", "on, off", "zncc, zwncc"
  std::string description;    ///< one sentence
  std::string source;         ///< where the default comes from; may be empty
  std::function<std::string()> get;
  /// Parses and checks; throws Error (usage) that names the option, the value and what is allowed.
  std::function<void(std::string_view)> set;
};

/// The options of a run: a flat list of declarations bound to the structs that hold the values.
/// The structs must outlive the table.
class OptionTable {
 public:
  void number(std::string name, double& value, Range range, std::string description,
              std::string source = {});
  void integer(std::string name, int& value, Range range, std::string description,
               std::string source = {});
  void flag(std::string name, bool& value, std::string description, std::string source = {});
  /// An enumeration; `names` lists each value with its name.
  template <class Enum>
  void choice(std::string name, Enum& value, std::span<const std::pair<Enum, const char*>> names,
              std::string description, std::string source = {}) {
    std::vector<std::string> allowed;
    for (const auto& entry : names) allowed.emplace_back(entry.second);
    add_choice(
        std::move(name), std::move(allowed),
        [&value, names]() -> std::string {
          for (const auto& entry : names)
            if (entry.first == value) return entry.second;
          return {};
        },
        [&value, names](std::size_t position) { value = names[position].first; },
        std::move(description), std::move(source));
  }

  /// Sets one option from text. Throws Error (usage); an unknown name is answered with the nearest
  /// known one. `where` (a file:line or a flag) leads the message.
  void set(std::string_view name, std::string_view value, const std::string& where = {});

  const Option* find(std::string_view name) const;
  const std::vector<Option>& options() const { return options_; }

 private:
  void add_choice(std::string name, std::vector<std::string> allowed,
                  std::function<std::string()> get, std::function<void(std::size_t)> set,
                  std::string description, std::string source);

  std::vector<Option> options_;
};

/// The candidate nearest to `name` by edit distance; empty where none is near.
std::string nearest_name(std::string_view name, std::span<const std::string> candidates);

/// The shortest decimal text that reads back as exactly this number.
std::string to_text(double value);

/// Parses a whole text as a finite number. Throws Error (usage) that names `what`.
double parse_number(std::string_view text, const std::string& what);

/// Numbers separated by commas. Throws Error (usage) that names `flag` and the `form` to write
/// where there are not `count` of them.
std::vector<double> parse_numbers(const std::string& text, std::size_t count,
                                  const std::string& flag, const std::string& form);

}  // namespace nadir
