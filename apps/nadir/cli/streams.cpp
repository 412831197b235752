// SPDX-License-Identifier: Apache-2.0
#include "cli/streams.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>

#include "cli/captured_output.hpp"
#include "nadir/core/error.hpp"

namespace nadir::cli {
namespace {

std::string in_one_line(std::string text) {
  constexpr unsigned char kDelete = 0x7f;
  const auto controls = [](unsigned char byte) { return byte < ' ' || byte == kDelete; };
  std::ranges::replace_if(text, controls, ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

/// Where print() goes instead of standard output.
std::string* captured = nullptr;

// Also read by a signal handler.
std::atomic<bool> printed_document{false};
std::atomic<bool> expected_document{false};
static_assert(std::atomic<bool>::is_always_lock_free);

bool colours_wanted() {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): nothing here sets the environment
  const char* no_color = std::getenv("NO_COLOR");
  return isatty(STDERR_FILENO) != 0 && (no_color == nullptr || *no_color == '\0');
}

void print_marked(const char* mark, const char* colour, const std::string& message) {
  const bool colours = colours_wanted();
  std::fprintf(stderr, "nadir: %s%s%s %s\n", colours ? colour : "", mark, colours ? "\033[0m" : "",
               in_one_line(message).c_str());
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
  throw Error(ErrorKind::kProcessing, std::generic_category().message(errno), "standard output");
}

void print(const Json& document) {
  if (captured == nullptr) printed_document = true;
  print(json_text(document, 2) + "\n");
}

bool document_printed() { return printed_document; }
void expect_document(bool due) {
  printed_document = false;
  expected_document = due;
}
bool document_due() { return expected_document && !printed_document; }

void print_error(const std::string& message) { print_marked("error:", "\033[31m", message); }

void print_doubt(const std::string& message) {
  if (captured == nullptr) print_marked("doubtful:", "\033[33m", message);
}

void print_note(const std::string& message, bool quiet) {
  if (!quiet) std::fprintf(stderr, "nadir: %s\n", in_one_line(message).c_str());
}

}  // namespace nadir::cli
