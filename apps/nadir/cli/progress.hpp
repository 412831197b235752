// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

#include "cli/invocation.hpp"

namespace nadir::cli {

/// How far a stage has come, on standard error: a bar on a terminal, else one line per 10 %.
class Progress {
 public:
  Progress(std::string label, int total, const CommonOptions& common);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  Progress(Progress&&) = delete;
  Progress& operator=(Progress&&) = delete;

  void update(int done);
  /// The same work goes on under another name.
  void rename(const std::string& label) { label_ = label; }

 private:
  enum class Style { kNone, kBar, kLines };

  double seconds_left(int done) const;
  void draw_bar(int done, int percent) const;

  std::string label_;
  int total_;
  Style style_ = Style::kNone;
  int shown_percent_ = -1;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace nadir::cli
