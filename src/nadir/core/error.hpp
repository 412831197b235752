// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace nadir {

/// What went wrong, in the classes that a caller can act on. The values are the exit codes of the
/// command line.
enum class ErrorKind {
  kProcessing = 1,  ///< the computation could not be completed
  kUsage = 2,       ///< an option or a configuration value is wrong
  kInput = 3,       ///< a file is missing, unreadable or inconsistent
  kNoResult = 4,    ///< everything was read, but no match or pose was found
};

/// Bad input, said once at the boundary (io, options): one sentence each of what is wrong, where
/// (file:line, frame, pixel) and what to do about it.
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& problem, const std::string& where = {},
        const std::string& remedy = {})
      : std::runtime_error(join(problem, where, remedy)), kind_(kind) {}

  ErrorKind kind() const { return kind_; }

 private:
  static std::string join(const std::string& problem, const std::string& where,
                          const std::string& remedy) {
    std::string text = where.empty() ? problem : where + ": " + problem;
    return remedy.empty() ? text : text + "; " + remedy;
  }

  ErrorKind kind_;
};

}  // namespace nadir
