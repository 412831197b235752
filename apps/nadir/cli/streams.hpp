// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "nadir/io/json.hpp"

namespace nadir::cli {

// What standard error gets is one line each time: control characters, as file names may hold them,
// become blanks.

/// The only way to standard output: results. A reader that has gone away is no error; throws Error
/// (processing) where the text could not be written for another reason, as on a full disk.
void print(const std::string& text);
/// One document, indented, with a newline; a number that is not finite becomes null.
void print(const Json& document);

/// Whether standard output has got a document since the last expect_document().
bool document_printed();
/// From now on standard output is to get one document, where `due` (--json).
void expect_document(bool due);
/// Whether it is to get one and has not; safe in a signal handler.
bool document_due();

/// "nadir: error: …" on standard error, in one line; red on a terminal unless NO_COLOR is set.
void print_error(const std::string& message);
/// "nadir: doubtful: …" on standard error, in the same way; nothing where the output is captured,
/// as the document holds it.
void print_doubt(const std::string& message);
/// "nadir: …" on standard error, unless `quiet`.
void print_note(const std::string& message, bool quiet);

}  // namespace nadir::cli
