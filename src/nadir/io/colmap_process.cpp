// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/colmap_process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "nadir/core/error.hpp"
#include "nadir/io/atomic_file.hpp"
#include "nadir/io/input_file.hpp"

namespace nadir {
namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;

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

void run(Arguments arguments, const fs::path& log) {
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
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  throw Error(ErrorKind::kProcessing, "colmap " + arguments.at(1) + " failed", log.string(),
              "its log says why");
}

/// The model with the most photos, in text; COLMAP numbers its models from 0.
fs::path largest_model(const fs::path& sparse, const fs::path& log) {
  fs::path best;
  std::uintmax_t size = 0;
  for (int number = 0; is_folder(sparse / std::to_string(number)); ++number) {
    const fs::path model = sparse / std::to_string(number);
    run({"colmap", "model_converter", "--input_path", model.string(), "--output_path",
         model.string(), "--output_type", "TXT"},
        log);
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
                         const fs::path& work,
                         const std::function<void(const std::string&)>& step) {
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
    run(program, log);
  }
  const fs::path model = largest_model(work / "sparse", log);
  if (model.empty()) {
    throw Error(ErrorKind::kNoResult, "colmap found no model", log.string(),
                "the photos must overlap and show texture");
  }
  return read_photo_poses(model);
}

}  // namespace nadir
