// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace nadir::testing {

/// A name that a file may have, and that programs trip over.
struct OddName {
  const char* label;  ///< of the test
  const char* name;
  std::size_t length;  ///< to be filled up to, in bytes; 0 = as it is

  /// The name between a first letter and an ending.
  std::string with(char letter, const std::string& ending = {}) const {
    std::string text = letter + std::string(name);
    if (length > text.size() + ending.size()) {
      text.append(length - text.size() - ending.size(), 'n');
    }
    return text + ending;
  }
};

inline constexpr std::array kOddNames{
    OddName{"ShellAndLines", " it's \"a\" $HOME `x` \\ * # %20 &<> .b\nc\r\td stra\xc3\x9f\x65", 0},
    OddName{"Latin1", "stra\xdf\x65 \xe9\xff", 0},
    OddName{"Longest", "", 255},
};

}  // namespace nadir::testing
