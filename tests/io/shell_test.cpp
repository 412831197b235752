// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/shell.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>

namespace nadir {
namespace {

const std::vector<std::string> kWords{"plain-word_1.tif",
                                      "",
                                      "two words",
                                      "it's",
                                      "a\"b",
                                      "$HOME `id` $(id)",
                                      "a\nb\tc",
                                      "caf\xe9 1'",
                                      "stra\xc3\x9f"
                                      "e",
                                      "~",
                                      "=ls",
                                      "*",
                                      "back\\slash",
                                      "!",
                                      "-dash",
                                      "\xff\x7f",
                                      "a\\\n'"};

/// What bash hands to a program for this line, each word followed by a zero.
std::string words_of_bash(const std::string& line) {
  // The outer shell takes the line from the environment, untouched.
  setenv("NADIR_TEST_LINE", ("printf '%s\\0' " + line).c_str(), 1);
  std::FILE* pipe = popen("bash -c 'eval \"$NADIR_TEST_LINE\"'", "r");
  std::string text;
  std::array<char, 256> part{};
  for (std::size_t n = 0; (n = std::fread(part.data(), 1, part.size(), pipe)) > 0;) {
    text.append(part.data(), n);
  }
  EXPECT_EQ(pclose(pipe), 0) << line;
  return text;
}

TEST(Shell, EveryWordComesOutOfAShellAsItWas) {
  std::string expected;
  for (const std::string& word : kWords) expected += word + std::string(1, '\0');
  EXPECT_EQ(words_of_bash(shell_line(kWords)), expected) << shell_line(kWords);
}

TEST(Shell, WhatNeedsNoQuotesHasNone) {
  EXPECT_EQ(shell_line({"nadir", "map", "a/b.tif", "--set", "stage.name=1e-3"}),
            "nadir map a/b.tif --set stage.name=1e-3");
  EXPECT_EQ(shell_quoted("stra\xc3\x9f"
                         "e"),
            "'stra\xc3\x9f"
            "e'");
  EXPECT_EQ(shell_quoted("caf\xe9"), "$'caf\\351'");
}

TEST(Shell, APathIsNoOption) {
  EXPECT_EQ(shell_quoted_path("-a b.tif"), "'./-a b.tif'");
  EXPECT_EQ(shell_quoted_path("a.tif"), "a.tif");
}

}  // namespace
}  // namespace nadir
