// SPDX-License-Identifier: Apache-2.0
#include "interrupt.hpp"

#include <atomic>
#include <csignal>

namespace nadir::cli {
namespace {

std::atomic<int> noted_signal{0};
bool is_the_end = false;
static_assert(std::atomic<int>::is_always_lock_free);

extern "C" void note_interrupt(int signal_number) {
  noted_signal = signal_number;
  std::signal(signal_number, SIG_DFL);
}

}  // namespace

void catch_signals() {
  std::signal(SIGINT, note_interrupt);
  std::signal(SIGTERM, note_interrupt);
  std::signal(SIGPIPE, SIG_IGN);
}

bool interrupted() { return noted_signal != 0; }

void stop_if_interrupted() {
  if (interrupted()) throw Interrupted{};
}

int interrupted_exit_code() {
  constexpr int kOfShells = 128;
  return is_the_end ? 0 : kOfShells + noted_signal;
}

void interrupt_is_the_end() { is_the_end = true; }

}  // namespace nadir::cli
