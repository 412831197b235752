// SPDX-License-Identifier: Apache-2.0
#include "end_to_end/nadir_process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

namespace nadir::testing {
namespace {

namespace fs = std::filesystem;

class ScratchFolder {
 public:
  ScratchFolder()
      : path_(fs::temp_directory_path() / ("nadir_end_to_end_" + std::to_string(getpid()))) {
    fs::create_directories(path_);
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> list;
  for (std::string& text : texts) list.push_back(text.data());
  list.push_back(nullptr);
  return list;
}

}  // namespace

fs::path scratch_folder() {
  static const ScratchFolder folder;
  return folder.path();
}

NadirProcess::NadirProcess(const std::vector<std::string>& arguments,
                           const std::vector<std::string>& environment, const fs::path& folder) {
  static int started = 0;
  output_ = scratch_folder() / ("stdout_" + std::to_string(++started));
  errors_ = scratch_folder() / ("stderr_" + std::to_string(started));
  std::vector<std::string> words{NADIR_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<std::string> variables = environment;
  for (char** entry = environ; *entry != nullptr; ++entry) variables.emplace_back(*entry);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  constexpr int kFlags = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output_.c_str(), kFlags, 0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, errors_.c_str(), kFlags, 0600);
  if (!folder.empty()) posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  const int error = posix_spawn(&process_, NADIR_PROGRAM, &actions, nullptr, pointers(words).data(),
                                pointers(variables).data());
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw std::runtime_error("cannot start " NADIR_PROGRAM);
}

void NadirProcess::send(int signal) const { kill(process_, signal); }
void NadirProcess::interrupt() const { send(SIGINT); }

void NadirProcess::send_when(int signal, const std::string& said) const {
  const auto holds = [&](const std::string& text) { return text.find(said) != std::string::npos; };
  for (int i = 0; i < 600 && !holds(output_so_far()) && !holds(errors_so_far()); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  send(signal);
}

std::string NadirProcess::output_so_far() const { return read_file(output_); }
std::string NadirProcess::errors_so_far() const { return read_file(errors_); }

Outcome NadirProcess::wait() {
  int status = 0;
  waitpid(process_, &status, 0);
  const int exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return {exit_code, read_file(output_), read_file(errors_)};
}

Outcome nadir(const std::vector<std::string>& arguments,
              const std::vector<std::string>& environment) {
  return NadirProcess(arguments, environment).wait();
}

Outcome nadir_in(const fs::path& folder, const std::vector<std::string>& arguments) {
  return NadirProcess(arguments, {}, folder).wait();
}

std::string read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_file_as(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

}  // namespace nadir::testing
