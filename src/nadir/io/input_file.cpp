// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/input_file.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <iterator>
#include <system_error>

#include "nadir/core/options.hpp"

namespace nadir {
namespace {

constexpr std::string_view kLfsPointer = "version https://git-lfs.github.com/spec/";
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
constexpr std::string_view kBetweenWords = " \t\r\f\v";

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  line = line.substr(0, line.find('#'));
  while (true) {
    const std::size_t begin = line.find_first_not_of(kBetweenWords);
    if (begin == std::string_view::npos) return words;
    line.remove_prefix(begin);
    const std::size_t end = std::min(line.find_first_of(kBetweenWords), line.size());
    words.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
}

template <class Iterator>
std::vector<std::filesystem::path> sorted_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : Iterator(folder)) {
    if (is_file(entry.path())) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char letter) {
    return static_cast<char>(std::tolower(letter));
  });
  return extension;
}

bool is_file(const std::filesystem::path& path) {
  std::error_code unknown;
  return std::filesystem::is_regular_file(path, unknown);
}

bool is_folder(const std::filesystem::path& path) {
  std::error_code unknown;
  return std::filesystem::is_directory(path, unknown);
}

std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder, Depth depth) {
  try {
    return depth == Depth::kFolder
               ? sorted_files<std::filesystem::directory_iterator>(folder)
               : sorted_files<std::filesystem::recursive_directory_iterator>(folder);
  } catch (const std::filesystem::filesystem_error& error) {
    throw input_error(folder, "cannot be listed: " + error.code().message(),
                      "check the path and its permissions");
  }
}

std::string file_and_line(const std::filesystem::path& path, int line) {
  return path.string() + ":" + std::to_string(line);
}

void check_input_file(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw input_error(path, "no such file", "check the path");
  }
  if (std::filesystem::is_directory(status)) {
    throw input_error(path, "is a folder, a file is expected", "check the path");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) throw input_error(path, "cannot be opened", "check its permissions");
  std::string start(kLfsPointer.size(), '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  if (file.gcount() == 0) throw input_error(path, "is empty (0 bytes)", "copy or make it again");
  if (start == kLfsPointer) {
    throw input_error(path, "is a Git LFS pointer, not the file itself",
                      "run `git lfs pull` in its repository");
  }
}

std::string read_file(const std::filesystem::path& path) {
  check_input_file(path);
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file.good() && !file.eof()) throw input_error(path, "cannot be read", "check the disk");
  return bytes;
}

void for_each_line(
    const std::filesystem::path& path, std::string_view text,
    const std::function<void(const std::string&, const std::vector<std::string_view>&)>& visit) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::vector<std::string_view> words = words_of(text.substr(0, end));
    if (!words.empty()) visit(file_and_line(path, number), words);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

double number_in_file(std::string_view text, const std::string& what, const std::string& where) {
  try {
    return checked_number(parse_number(text, what), what, where);
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::kInput) throw;
    throw Error(ErrorKind::kInput, error.what(), where, "correct the line");
  }
}

double checked_number(double value, const std::string& what, const std::string& where) {
  if (std::abs(value) <= kLargestNumber) return value;
  throw Error(ErrorKind::kInput, what + " is " + to_text(value) + ", which cannot be", where,
              "correct it");
}

int checked_integer(double value, const std::string& what, const std::string& where, int lowest,
                    int highest) {
  if (value >= lowest && value <= highest && value == std::floor(value)) {
    return static_cast<int>(value);
  }
  throw Error(ErrorKind::kInput,
              what + " is " + to_text(value) + ", a whole number from " + std::to_string(lowest) +
                  " to " + std::to_string(highest) + " is expected",
              where, "correct it");
}

}  // namespace nadir
