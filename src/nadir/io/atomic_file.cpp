// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "nadir/core/error.hpp"

namespace nadir {
namespace {

Error system_write_error(const std::filesystem::path& target, int system_error) {
  return {ErrorKind::kProcessing,
          "cannot be written: " + std::generic_category().message(system_error), target.string(),
          "check the folder, its permissions and the free space"};
}

/// An open file that is closed on every way out.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor(Descriptor&&) = delete;
  Descriptor& operator=(Descriptor&&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path target)
    : target_(std::move(target)),
      folder_(target_),
      temporary_(folder_.path() / target_.filename()) {}

AtomicFile::~AtomicFile() = default;

void AtomicFile::write(std::string_view bytes) {
  constexpr int kReadableByUmask = 0666;
  const Descriptor file(
      ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kReadableByUmask));
  if (file.number() < 0) throw system_write_error(target_, errno);
  while (!bytes.empty()) {
    const ssize_t written = ::write(file.number(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw system_write_error(target_, errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void AtomicFile::commit() {
  const Descriptor file(::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.number() < 0 || ::fsync(file.number()) != 0) throw system_write_error(target_, errno);
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) throw system_write_error(target_, errno);
  folder_.remove();
}

void write_file(const std::filesystem::path& target, std::string_view bytes) {
  AtomicFile file(target);
  file.write(bytes);
  file.commit();
}

void remove_file(const std::filesystem::path& target) {
  std::error_code error;
  std::filesystem::remove(target, error);
  if (error) throw system_write_error(target, error.value());
}

void create_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw system_write_error(folder, error.value());
}

}  // namespace nadir
