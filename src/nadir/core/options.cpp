// SPDX-License-Identifier: Apache-2.0
#include "nadir/core/options.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>

#include "nadir/core/error.hpp"

namespace nadir {
namespace {

std::string joined(std::span<const std::string> words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string range_text(Range range) {
  const bool below = std::isfinite(range.lowest);
  const bool above = std::isfinite(range.highest);
  if (below && above) return to_text(range.lowest) + " .. " + to_text(range.highest);
  if (below) return ">= " + to_text(range.lowest);
  if (above) return "<= " + to_text(range.highest);
  return "any number";
}

double parse_in_range(std::string_view text, const std::string& name, Range range) {
  const double value = parse_number(text, "option " + name);
  if (value < range.lowest || value > range.highest) {
    throw Error(ErrorKind::kUsage, "option " + name + " is " + std::string(text) + ", allowed is " +
                                       range_text(range));
  }
  return value;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row.back();
}

constexpr std::array<std::pair<std::string_view, bool>, 8> kSwitchWords{{{"on", true},
                                                                         {"true", true},
                                                                         {"yes", true},
                                                                         {"1", true},
                                                                         {"off", false},
                                                                         {"false", false},
                                                                         {"no", false},
                                                                         {"0", false}}};

}  // namespace

std::string to_text(double value) {
  std::array<char, 32> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return error == std::errc{} ? std::string(buffer.data(), end) : std::string{};
}

double parse_number(std::string_view text, const std::string& what) {
  double value = 0.0;
  const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(value)) {
    throw Error(ErrorKind::kUsage,
                what + " is '" + std::string(text) + "', which is not a finite number");
  }
  return value;
}

std::vector<double> parse_numbers(const std::string& text, std::size_t count,
                                  const std::string& flag, const std::string& form) {
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    numbers.push_back(parse_number(text.substr(begin, comma - begin), flag));
    begin = comma + 1;
  }
  if (numbers.size() != count) {
    throw Error(ErrorKind::kUsage,
                "'" + text + "' does not have " + std::to_string(count) + " numbers", flag,
                "write " + form);
  }
  return numbers;
}

std::string nearest_name(std::string_view name, std::span<const std::string> candidates) {
  constexpr std::size_t kLongest = 256;  // of what was meant for a name
  std::string nearest;
  if (name.size() > kLongest) return nearest;
  std::size_t smallest = std::max<std::size_t>(3, name.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    // The last part alone may have been typed: "temper" for "localization.temper".
    const std::string_view full = candidate;
    const std::string_view last = full.substr(full.find_last_of('.') + 1);
    const std::size_t distance = std::min(edit_distance(name, full), edit_distance(name, last));
    if (distance < smallest) {
      smallest = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

void OptionTable::number(std::string name, double& value, Range range, std::string description,
                         std::string source) {
  Option option{std::move(name),
                "number",
                to_text(value),
                range_text(range),
                std::move(description),
                std::move(source),
                {},
                {}};
  option.get = [&value] { return to_text(value); };
  option.set = [&value, range, label = option.name](std::string_view text) {
    value = parse_in_range(text, label, range);
  };
  options_.push_back(std::move(option));
}

void OptionTable::integer(std::string name, int& value, Range range, std::string description,
                          std::string source) {
  range.lowest = std::max(range.lowest, static_cast<double>(std::numeric_limits<int>::min()));
  range.highest = std::min(range.highest, static_cast<double>(std::numeric_limits<int>::max()));
  Option option{std::move(name),
                "integer",
                std::to_string(value),
                range_text(range),
                std::move(description),
                std::move(source),
                {},
                {}};
  option.get = [&value] { return std::to_string(value); };
  option.set = [&value, range, label = option.name](std::string_view text) {
    const double parsed = parse_in_range(text, label, range);
    if (parsed != std::floor(parsed)) {
      throw Error(ErrorKind::kUsage,
                  "option " + label + " is " + std::string(text) + ", allowed are whole numbers");
    }
    value = static_cast<int>(parsed);
  };
  options_.push_back(std::move(option));
}

void OptionTable::flag(std::string name, bool& value, std::string description, std::string source) {
  Option option{std::move(name),
                "switch",
                value ? "on" : "off",
                "on, off",
                std::move(description),
                std::move(source),
                {},
                {}};
  option.get = [&value] { return std::string(value ? "on" : "off"); };
  option.set = [&value, label = option.name](std::string_view text) {
    const auto* const word =
        std::find_if(kSwitchWords.begin(), kSwitchWords.end(),
                     [text](const auto& entry) { return entry.first == text; });
    if (word == kSwitchWords.end()) {
      throw Error(ErrorKind::kUsage,
                  "option " + label + " is '" + std::string(text) + "', allowed are on and off");
    }
    value = word->second;
  };
  options_.push_back(std::move(option));
}

void OptionTable::add_choice(std::string name, std::vector<std::string> allowed,
                             std::function<std::string()> get, std::function<void(std::size_t)> set,
                             std::string description, std::string source) {
  Option option{std::move(name),        "choice",          get(),          joined(allowed),
                std::move(description), std::move(source), std::move(get), {}};
  option.set = [label = option.name, allowed = std::move(allowed),
                set = std::move(set)](std::string_view text) {
    const auto found = std::find(allowed.begin(), allowed.end(), text);
    if (found == allowed.end()) {
      const std::string nearest = nearest_name(text, allowed);
      throw Error(ErrorKind::kUsage, "option " + label + " is '" + std::string(text) +
                                         "', allowed are " + joined(allowed) +
                                         (nearest.empty() ? "" : " (nearest: " + nearest + ")"));
    }
    set(static_cast<std::size_t>(found - allowed.begin()));
  };
  options_.push_back(std::move(option));
}

void OptionTable::set(std::string_view name, std::string_view value, const std::string& where) {
  const Option* option = find(name);
  if (option == nullptr) {
    std::vector<std::string> names;
    for (const Option& known : options_) names.push_back(known.name);
    const std::string nearest = nearest_name(name, names);
    throw Error(ErrorKind::kUsage, "unknown option '" + std::string(name) + "'", where,
                nearest.empty() ? "`nadir config dump` lists all options"
                                : "did you mean '" + nearest + "'?");
  }
  try {
    option->set(value);
  } catch (const Error& error) {
    throw Error(error.kind(), error.what(), where);
  }
}

const Option* OptionTable::find(std::string_view name) const {
  const auto found = std::find_if(options_.begin(), options_.end(),
                                  [name](const Option& option) { return option.name == name; });
  return found == options_.end() ? nullptr : &*found;
}

}  // namespace nadir
