// SPDX-License-Identifier: Apache-2.0
#include "cli/interrupt.hpp"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "cli/exit_code.hpp"
#include "cli/streams.hpp"
#include "cli/verdict.hpp"

namespace nadir::cli {
namespace {

// Written by signal handlers and read by all threads.
std::atomic<int> noted_signal{0};
std::atomic<bool> is_the_end{false};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

/// From the signal on; less than the three seconds within which every verb ends.
constexpr unsigned kPatienceS = 2;

/// What a signal handler prints must be there beforehand.
std::string document_of_interrupt;
std::string document_of_termination;

/// A signal handler can do no more about a failure than go on.
void write_all(int stream, std::string_view text) {
  [[maybe_unused]] const auto n = write(stream, text.data(), text.size());
}

extern "C" void end_the_process(int /*signal_number*/) {
  constexpr std::string_view kSaid =
      "nadir: stopped within a step that cannot be interrupted; what was finished is kept\n";
  if (!is_the_end) write_all(STDERR_FILENO, kSaid);
  const bool term = noted_signal == SIGTERM;
  if (document_due())
    write_all(STDOUT_FILENO, term ? document_of_termination : document_of_interrupt);
  _exit(interrupted_exit_code());
}

extern "C" void note_interrupt(int signal_number) {
  int none = 0;
  if (noted_signal.compare_exchange_strong(none, signal_number)) alarm(kPatienceS);
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

}  // namespace

void catch_signals() {
  const auto document = [](ExitCode code) {
    return json_text(error_document(kStopped, static_cast<int>(code)), 2) + "\n";
  };
  document_of_interrupt = document(ExitCode::kInterrupted);
  document_of_termination = document(ExitCode::kTerminated);
  std::signal(SIGINT, note_interrupt);
  std::signal(SIGTERM, note_interrupt);
  std::signal(SIGALRM, end_the_process);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

bool interrupted() { return noted_signal != 0; }

void stop_if_interrupted() {
  if (interrupted()) throw Stopped{};
}

StopToken interrupt_token() { return StopToken(interrupted); }

int interrupted_exit_code() {
  constexpr int kOfShells = 128;
  return is_the_end ? 0 : kOfShells + noted_signal;
}

void interrupt_is_the_end(bool is) { is_the_end = is; }

}  // namespace nadir::cli
