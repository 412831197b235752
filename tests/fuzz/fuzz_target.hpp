// SPDX-License-Identifier: Apache-2.0
#pragma once

// What every fuzz target shares. A target is one function of bytes; libFuzzer calls it (preset
// fuzz), and fuzz_replay_test calls it with the files of tests/fuzz/corpus/<target> in every build.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "nadir/core/error.hpp"
#include "nadir/core/frames3.hpp"

namespace nadir::fuzz {

/// Of processor time, so that a busy machine does not count.
inline constexpr double kHangS = 5.0;

using Body = void (*)(std::string_view input);

struct Target {
  const char* name;
  Body body;
};

/// The targets of this program: all of them in the replay, one in a fuzzer.
std::vector<Target>& targets();
bool add_target(const char* name, Body body);

/// Gives the input to a target; whether it was accepted. nadir::Error is the answer to bad input;
/// whatever else is thrown leaves, and is a finding.
bool run_target(Body body, std::string_view input);

/// Goes on after a reader that refused the input; whether it took it.
template <class Reader>
bool attempt(const Reader& reader) {
  try {
    reader();
    return true;
  } catch (const Error&) {
    return false;
  }
}

/// What must hold of everything that a reader returned; throws std::logic_error, a finding.
void require(bool holds, const char* what);

template <class To, class From>
void require_pose(const Transform3<To, From>& pose) {
  require(pose.is_finite(), "a pose that was read is not finite");
}

/// A folder in memory where there is one; it goes with the process.
const std::filesystem::path& scratch_folder();

/// The input as a file of this name in the scratch folder, since readers take paths and tell
/// formats by extensions. Overwrites what was there.
std::filesystem::path as_file(const std::string& name, std::string_view bytes);

/// Removes a file or folder of the scratch folder.
void discard(const std::string& name);

/// Several files in one input: cut at each of the first `count - 1` lines "%%"; what is missing is
/// empty.
std::vector<std::string_view> parts_of(std::string_view input, std::size_t count);

/// A number off the front of the input, as it lies; 0 where the input has ended.
template <class T>
T taken(std::string_view& input) {
  T value{};
  const std::size_t size = std::min(sizeof(T), input.size());
  std::copy_n(input.data(), size, reinterpret_cast<char*>(&value));
  input.remove_prefix(size);
  return value;
}

}  // namespace nadir::fuzz

#ifdef NADIR_FUZZER
#define NADIR_FUZZ_ENTRY(name)                                                         \
  extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {  \
    nadir::fuzz::run_target(fuzz_##name, {reinterpret_cast<const char*>(data), size}); \
    return 0;                                                                          \
  }
#else
#define NADIR_FUZZ_ENTRY(name) \
  [[maybe_unused]] static const bool added_##name = nadir::fuzz::add_target(#name, fuzz_##name);
#endif

/// Defines the target `name`: NADIR_FUZZ_TARGET(pcd) { ... input ... }
#define NADIR_FUZZ_TARGET(name)                    \
  static void fuzz_##name(std::string_view input); \
  NADIR_FUZZ_ENTRY(name)                           \
  static void fuzz_##name([[maybe_unused]] std::string_view input)
