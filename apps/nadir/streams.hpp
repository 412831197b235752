// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "nadir/io/json.hpp"

namespace nadir::cli {

/// The only way to standard output: results. A reader that has gone away is no error; throws Error
/// (processing) where the text could not be written for another reason, as on a full disk.
void print(const std::string& text);
/// One document, indented, with a newline; a number that is not finite becomes null.
void print(const Json& document);

/// "nadir: error: …" on standard error, in one line; red on a terminal unless NO_COLOR is set.
void print_error(const std::string& message);
/// "nadir: …" on standard error, unless `quiet`.
void print_note(const std::string& message, bool quiet);

}  // namespace nadir::cli
