// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace nadir::cli {

/// While it lives, print() adds to its text and not to standard output. One at a time.
class CapturedOutput {
 public:
  CapturedOutput();
  ~CapturedOutput();
  CapturedOutput(const CapturedOutput&) = delete;
  CapturedOutput& operator=(const CapturedOutput&) = delete;
  CapturedOutput(CapturedOutput&&) = delete;
  CapturedOutput& operator=(CapturedOutput&&) = delete;

  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

}  // namespace nadir::cli
