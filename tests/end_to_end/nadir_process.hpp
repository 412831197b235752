// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace nadir::testing {

/// What one start of the program gave back.
struct Outcome {
  int exit_code = -1;  ///< 128 + signal where a signal ended it
  std::string output;  ///< standard output
  std::string errors;  ///< standard error
};

/// A running `nadir`; its streams go to files.
class NadirProcess {
 public:
  /// `environment` adds "NAME=value" entries; `folder` is the current one of the process.
  explicit NadirProcess(const std::vector<std::string>& arguments,
                        const std::vector<std::string>& environment = {},
                        const std::filesystem::path& folder = {});
  NadirProcess(const NadirProcess&) = delete;
  NadirProcess& operator=(const NadirProcess&) = delete;

  void send(int signal) const;
  void interrupt() const;
  /// Sends the signal once a stream holds the text, or after a minute.
  void send_when(int signal, const std::string& said) const;
  /// What the streams hold so far.
  std::string output_so_far() const;
  std::string errors_so_far() const;
  Outcome wait();

 private:
  std::filesystem::path output_;
  std::filesystem::path errors_;
  pid_t process_ = -1;
};

/// Runs `nadir` to its end.
Outcome nadir(const std::vector<std::string>& arguments,
              const std::vector<std::string>& environment = {});

/// The same in a folder, which relative paths start from.
Outcome nadir_in(const std::filesystem::path& folder, const std::vector<std::string>& arguments);

/// A folder of this process that goes when the process ends.
std::filesystem::path scratch_folder();

std::string read_file(const std::filesystem::path& path);
void write_file_as(const std::filesystem::path& path, const std::string& text);

}  // namespace nadir::testing
