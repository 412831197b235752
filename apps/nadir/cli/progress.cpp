// SPDX-License-Identifier: Apache-2.0
#include "cli/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace nadir::cli {
namespace {

constexpr int kBarWidth = 30;
constexpr int kLineStepPercent = 10;

}  // namespace

Progress::Progress(std::string label, int total, const CommonOptions& common)
    : label_(std::move(label)), total_(total) {
  const bool terminal = isatty(STDERR_FILENO) != 0;
  if (common.quiet || common.progress == "none" || total <= 0) return;
  const bool bar = common.progress == "bar" || (common.progress == "auto" && terminal);
  style_ = bar ? Style::kBar : Style::kLines;
}

Progress::~Progress() {
  // Other lines must not be written into the bar.
  if (style_ == Style::kBar && shown_percent_ >= 0) std::fputs("\n", stderr);
}

void Progress::update(int done) {
  const int percent = static_cast<int>(100LL * done / std::max(total_, 1));
  const int step = style_ == Style::kLines ? kLineStepPercent : 1;
  if (style_ == Style::kNone || percent / step == shown_percent_ / step) return;
  if (style_ == Style::kBar) {
    draw_bar(done, percent);
  } else if (percent >= step) {
    fmt::print(stderr, "nadir: {} {} % ({} of {}), about {:.0f} s left\n", label_,
               percent / step * step, done, total_, seconds_left(done));
  }
  shown_percent_ = percent;
}

double Progress::seconds_left(int done) const {
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start_;
  return done > 0 ? passed.count() * (total_ - done) / done : 0.0;
}

void Progress::draw_bar(int done, int percent) const {
  const int filled = kBarWidth * percent / 100;
  fmt::print(stderr, "\r{} [{:=<{}}{:<{}}] {:3} % {:.0f} s left \033[K", label_, "", filled, "",
             kBarWidth - filled, percent, seconds_left(done));
  std::fflush(stderr);
}

}  // namespace nadir::cli
