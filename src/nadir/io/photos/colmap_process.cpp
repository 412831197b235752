// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/photos/colmap_process.hpp"

#include <fcntl.h>
// POSIX's kill(), which <csignal> need not have: a child is sent a signal, none is handled here.
#include <signal.h>  // NOLINT(modernize-deprecated-headers)
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <system_error>
#include <thread>

#include "nadir/core/error.hpp"
#include "nadir/io/atomic_file.hpp"
#include "nadir/io/input_file.hpp"

namespace nadir {
namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;

constexpr std::chrono::milliseconds kLook{20};  // at whether a program has ended

/// Its window library must not look for a screen.
Arguments environment() {
  Arguments variables;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    if (!std::string(*entry).starts_with("QT_QPA_PLATFORM=")) variables.emplace_back(*entry);
  }
  variables.emplace_back("QT_QPA_PLATFORM=offscreen");
  return variables;
}

std::vector<char*> pointers(Arguments& words) {
  std::vector<char*> result;
  for (std::string& word : words) result.push_back(word.data());
  result.push_back(nullptr);
  return result;
}

/// Ends a program that is no longer wanted, and waits for its end.
void end(pid_t process) {
  constexpr auto kPatience = std::chrono::milliseconds(500);
  kill(process, SIGTERM);
  const auto due = std::chrono::steady_clock::now() + kPatience;
  while (waitpid(process, nullptr, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > due) kill(process, SIGKILL);
    std::this_thread::sleep_for(kLook);
  }
}

/// What waitpid says of a program when it has ended. Throws Stopped, with the program ended.
int status_of(pid_t process, const StopToken& stop) {
  int status = 0;
  while (true) {
    const pid_t ended = waitpid(process, &status, WNOHANG);
    if (ended == process || (ended < 0 && errno != EINTR)) return status;
    if (stop.stop_requested()) {
      end(process);
      throw Stopped{};
    }
    std::this_thread::sleep_for(kLook);
  }
}

void run(Arguments arguments, const fs::path& log, const StopToken& stop) {
  Arguments variables = environment();
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(),
                                   O_WRONLY | O_CREAT | O_APPEND, 0644);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t process = 0;
  const int failure = posix_spawnp(&process, arguments.front().c_str(), &actions, nullptr,
                                   pointers(arguments).data(), pointers(variables).data());
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) {
    throw Error(
        ErrorKind::kUsage, "colmap cannot be started: " + std::generic_category().message(failure),
        "--sfm colmap", "install COLMAP, or leave --sfm away: nadir finds the poses itself");
  }
  const int status = status_of(process, stop);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  throw Error(ErrorKind::kProcessing, "colmap " + arguments.at(1) + " failed", log.string(),
              "its log says why");
}

/// The model with the most photos, in text; COLMAP numbers its models from 0.
fs::path largest_model(const fs::path& sparse, const fs::path& log, const StopToken& stop) {
  fs::path best;
  std::uintmax_t size = 0;
  for (int number = 0; is_folder(sparse / std::to_string(number)); ++number) {
    const fs::path model = sparse / std::to_string(number);
    run({"colmap", "model_converter", "--input_path", model.string(), "--output_path",
         model.string(), "--output_type", "TXT"},
        log, stop);
    std::error_code missing;
    const std::uintmax_t own = fs::file_size(model / "images.txt", missing);
    if (!missing && own > size) {
      size = own;
      best = model;
    }
  }
  return best;
}

}  // namespace

ImportedPoses run_colmap(const fs::path& photos, const std::vector<std::string>& names,
                         const fs::path& work, const std::function<void(const std::string&)>& step,
                         const StopToken& stop) {
  const fs::path log = work / "colmap.log";
  const std::string database = (work / "database.db").string();
  const std::string images = fs::absolute(photos).string();
  std::string list;
  for (const std::string& name : names) {
    if (name.find('\n') != std::string::npos) {
      throw Error(ErrorKind::kUsage, "its name holds a line break, which COLMAP cannot take", name,
                  "rename the photo, or leave --sfm away");
    }
    list += name + "\n";
  }
  write_file(work / "photos.txt", list);
  create_folder(work / "sparse");
  const std::vector<Arguments> programs{
      {"colmap", "feature_extractor", "--database_path", database, "--image_path", images,
       "--image_list_path", (work / "photos.txt").string(), "--ImageReader.single_camera", "1",
       "--ImageReader.camera_model", "OPENCV", "--SiftExtraction.use_gpu", "0"},
      {"colmap", "exhaustive_matcher", "--database_path", database, "--SiftMatching.use_gpu", "0"},
      {"colmap", "mapper", "--database_path", database, "--image_path", images, "--output_path",
       (work / "sparse").string()}};
  for (const Arguments& program : programs) {
    if (step) step("colmap " + program.at(1));
    run(program, log, stop);
  }
  const fs::path model = largest_model(work / "sparse", log, stop);
  if (model.empty()) {
    throw Error(ErrorKind::kNoResult, "colmap found no model", log.string(),
                "the photos must overlap and show texture");
  }
  return read_photo_poses(model);
}

}  // namespace nadir
