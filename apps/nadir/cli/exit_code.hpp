// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "nadir/core/error.hpp"

namespace nadir::cli {

/// What the program ends with: this table is the only one, for every verb.
enum class ExitCode {
  kDone = 0,
  kFailed = static_cast<int>(ErrorKind::kProcessing),
  kUsage = static_cast<int>(ErrorKind::kUsage),
  kInput = static_cast<int>(ErrorKind::kInput),
  kNothingFound = static_cast<int>(ErrorKind::kNoResult),
  kDoubtful = 5,
  kInterrupted = 130,  ///< 128 and SIGINT, as shells have it
  kTerminated = 143,   ///< 128 and SIGTERM
};

struct ExitCodeMeaning {
  ExitCode code;
  const char* name;     ///< a few words, for `nadir --help`
  const char* meaning;  ///< sentences, for docs/exit-codes.md
};

inline constexpr std::array<ExitCodeMeaning, 8> kExitCodes{
    {{ExitCode::kDone, "done", "All was done as asked; the result is written and sound."},
     {ExitCode::kFailed, "processing failed",
      "The computation or the writing could not be completed; no half-written file is left."},
     {ExitCode::kUsage, "usage",
      "An option, a value or an output place is wrong; nothing was begun, nothing is written."},
     {ExitCode::kInput, "input refused",
      "A file is missing, unreadable, or contradicts itself or another; nothing is written."},
     {ExitCode::kNothingFound, "nothing found",
      "Everything was read, and there is no match, pose or map in it."},
     {ExitCode::kDoubtful, "result doubtful",
      "The result is written, but must not be relied on unseen: it is not metric, lacks a part, "
      "or failed a check. The last line on standard error says why."},
     {ExitCode::kInterrupted, "interrupted",
      "Stopped by SIGINT (Ctrl-C). What is whole by then is written, where the verb says so; "
      "else outputs are as before."},
     {ExitCode::kTerminated, "terminated", "The same, stopped by SIGTERM."}}};

/// The table in words, in lines of at most 92 characters.
std::string exit_codes_in_words();

/// The table for docs/exit-codes.md.
std::string exit_codes_in_markdown();

}  // namespace nadir::cli
