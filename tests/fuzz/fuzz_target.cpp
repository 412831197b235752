// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_target.hpp"

#include <unistd.h>

#include <ctime>
#include <fstream>
#include <stdexcept>

namespace nadir::fuzz {
namespace {

namespace fs = std::filesystem;

class ScratchFolder {
 public:
  ScratchFolder() {
    std::error_code unknown;
    const fs::path memory = "/dev/shm";
    const bool usable = fs::is_directory(memory, unknown) && ::access(memory.c_str(), W_OK) == 0;
    const fs::path parent = usable ? memory : fs::temp_directory_path();
    path_ = parent / ("nadir-fuzz-" + std::to_string(::getpid()));
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

}  // namespace

std::vector<Target>& targets() {
  static std::vector<Target> all;
  return all;
}

bool add_target(const char* name, Body body) {
  targets().push_back({name, body});
  return true;
}

bool run_target(Body body, std::string_view input) {
  const std::clock_t started = std::clock();
  const bool accepted = attempt([&] { body(input); });
  require(static_cast<double>(std::clock() - started) / CLOCKS_PER_SEC < kHangS,
          "a hang: more than 5 s of processor time");
  return accepted;
}

void require(bool holds, const char* what) {
  if (!holds) throw std::logic_error(what);
}

const fs::path& scratch_folder() {
  static const ScratchFolder folder;
  return folder.path();
}

fs::path as_file(const std::string& name, std::string_view bytes) {
  fs::path path = scratch_folder() / name;
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  if (!file) {
    fs::create_directories(path.parent_path());
    file.open(path, std::ios::binary | std::ios::trunc);
  }
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  require(static_cast<bool>(file), "the scratch folder cannot be written: is there space?");
  return path;
}

void discard(const std::string& name) {
  std::error_code ignored;
  fs::remove_all(scratch_folder() / name, ignored);
}

std::vector<std::string_view> parts_of(std::string_view input, std::size_t count) {
  constexpr std::string_view kCut = "%%\n";
  std::vector<std::string_view> parts;
  while (parts.size() + 1 < count) {
    const std::size_t cut = std::min(input.find(kCut), input.size());
    parts.push_back(input.substr(0, cut));
    input.remove_prefix(std::min(cut + kCut.size(), input.size()));
  }
  parts.push_back(input);
  return parts;
}

}  // namespace nadir::fuzz
