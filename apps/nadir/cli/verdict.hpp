// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/exit_code.hpp"
#include "cli/invocation.hpp"
#include "cli/streams.hpp"

namespace nadir::cli {

/// How good a verb's result is. Every check of a result fills one; the end of the verb turns it
/// into exit code, JSON and text, alike in all verbs.
class Verdict {
 public:
  Verdict() = default;
  explicit Verdict(const std::vector<std::string>& doubts) { doubt(doubts); }

  /// The result is there, but must not be relied on unseen. `reason` reads as an error does: what
  /// is wrong; what to do about it.
  void doubt(std::string reason);
  void doubt(const std::vector<std::string>& reasons);
  /// Everything was read, but there is no result.
  void nothing_found(Error reason) { nothing_ = std::move(reason); }

  const std::vector<std::string>& doubts() const { return doubts_; }
  const std::optional<Error>& nothing() const { return nothing_; }
  ExitCode exit_code() const;

 private:
  std::vector<std::string> doubts_;  ///< each once
  std::optional<Error> nothing_;
};

/// Adds to a result's document its `doubtful`, the list of reasons, empty in a sound one; and
/// `error` where nothing was found.
void add_verdict(Json& document, const Verdict& verdict);

/// The document of a verb that ended without a result: {"error": {"message", "exit_code"}}.
Json error_document(const std::string& message, int exit_code);

/// Prints the result of a verb: with --json the document with its verdict, else the text.
void print_result(Json document, const std::string& text, const Verdict& verdict,
                  const CommonOptions& common);

/// The end of a verb that wrote a result: says on standard error what is wrong with it, also with
/// --quiet, and returns the exit code: that of an interrupt before that of the verdict.
int conclude(const Verdict& verdict);

/// Both.
int finish(Json document, const std::string& text, const Verdict& verdict,
           const CommonOptions& common);

}  // namespace nadir::cli
