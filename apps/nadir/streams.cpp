// SPDX-License-Identifier: Apache-2.0
#include "streams.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>

#include "captured_output.hpp"
#include "nadir/core/error.hpp"

namespace nadir::cli {
namespace {

std::string in_one_line(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

/// Where print() goes instead of standard output.
std::string* captured = nullptr;

bool colours_wanted() {
  const char* no_color = std::getenv("NO_COLOR");
  return isatty(STDERR_FILENO) != 0 && (no_color == nullptr || *no_color == '\0');
}

}  // namespace

CapturedOutput::CapturedOutput() { captured = &text_; }
CapturedOutput::~CapturedOutput() { captured = nullptr; }

void print(const std::string& text) {
  if (captured != nullptr) {
    *captured += text;
    return;
  }
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (written && std::fflush(stdout) == 0) return;
  if (errno == EPIPE) return;
  throw Error(ErrorKind::kProcessing, std::strerror(errno), "standard output");
}

void print(const Json& document) { print(json_text(document, 2) + "\n"); }

void print_error(const std::string& message) {
  const bool colours = colours_wanted();
  std::fprintf(stderr, "nadir: %serror:%s %s\n", colours ? "\033[31m" : "",
               colours ? "\033[0m" : "", in_one_line(message).c_str());
}

void print_note(const std::string& message, bool quiet) {
  if (!quiet) std::fprintf(stderr, "nadir: %s\n", in_one_line(message).c_str());
}

}  // namespace nadir::cli
