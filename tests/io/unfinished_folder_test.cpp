// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/unfinished_folder.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include "nadir/io/atomic_file.hpp"
#include "support/data.hpp"
#include "support/expect_error.hpp"
#include "support/temporary_folder.hpp"

namespace nadir {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

TEST(UnfinishedFolder, BecomesItsTargetWhole) {
  const TemporaryFolder folder;
  UnfinishedFolder unfinished(folder / "run");
  test::write_text(unfinished.path() / "a", "1");
  EXPECT_FALSE(fs::exists(folder / "run"));
  unfinished.become_target();
  EXPECT_EQ(test::read_text(folder / "run/a"), "1");
  EXPECT_EQ(test::count_entries(folder.path()), 1);
}

TEST(UnfinishedFolder, ReplacesWhatWasThere) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "run");
  test::write_text(folder / "run/old", "0");
  UnfinishedFolder unfinished(folder / "run");
  test::write_text(unfinished.path() / "new", "1");
  unfinished.become_target();
  EXPECT_TRUE(fs::exists(folder / "run/new"));
  EXPECT_FALSE(fs::exists(folder / "run/old"));
  EXPECT_EQ(test::count_entries(folder.path()), 1);
}

TEST(UnfinishedFolder, LeavesNothingWithoutIt) {
  const TemporaryFolder folder;
  {
    const UnfinishedFolder unfinished(folder / "run");
    test::write_text(unfinished.path() / "a", "1");
  }
  EXPECT_EQ(test::count_entries(folder.path()), 0);
}

TEST(UnfinishedFolder, NeverTakesUpAnother) {
  const TemporaryFolder folder;
  // As a process of this number that was killed, in a container of its own, left it.
  const fs::path killed = folder / (".run.unfinished-" + std::to_string(getpid()));
  fs::create_directories(killed);
  test::write_text(killed / "stale", "0");
  UnfinishedFolder unfinished(folder / "run");
  unfinished.become_target();
  EXPECT_FALSE(fs::exists(folder / "run/stale"));
}

TEST(UnfinishedFolder, TwoOfOneTargetAreApart) {
  const TemporaryFolder folder;
  const UnfinishedFolder first(folder / "run");
  const UnfinishedFolder second(folder / "run");
  EXPECT_NE(first.path(), second.path());
}

TEST(RemoveAbandoned, RemovesWhatTheDeadLeftAndNothingElse) {
  const TemporaryFolder folder;
  const UnfinishedFolder living(folder / "run");
  fs::create_directories(folder / ".run.unfinished-0123456789abcdef/deep");
  fs::create_directories(folder / ".other.unfinished-0123456789abcdef");
  fs::create_directories(folder / ".run.work");
  remove_abandoned(folder / "run");
  EXPECT_FALSE(fs::exists(folder / ".run.unfinished-0123456789abcdef"));
  EXPECT_TRUE(fs::exists(living.path()));
  EXPECT_TRUE(fs::exists(folder / ".other.unfinished-0123456789abcdef"));
  remove_all_abandoned(folder.path());
  EXPECT_FALSE(fs::exists(folder / ".other.unfinished-0123456789abcdef"));
  EXPECT_TRUE(fs::exists(living.path()));
  EXPECT_TRUE(fs::exists(folder / ".run.work"));
}

TEST(RemoveAbandoned, GivesBackWhatWasOnItsWayToBeReplaced) {
  const TemporaryFolder folder;
  // Killed between two renames, on a file system that cannot exchange names.
  fs::create_directories(folder / ".run.unfinished-0123456789abcdef");
  fs::create_directories(folder / ".run.unfinished-0123456789abcdef-old");
  test::write_text(folder / ".run.unfinished-0123456789abcdef-old/kept", "1");
  remove_abandoned(folder / "run");
  remove_abandoned(folder / "run");
  EXPECT_EQ(test::read_text(folder / "run/kept"), "1");
  EXPECT_EQ(test::count_entries(folder.path()), 1);
}

TEST(RemoveAbandoned, TakesAFolderThatIsNotThereForEmpty) {
  remove_abandoned("/nowhere/at/all");
  remove_all_abandoned("/nowhere/at/all");
}

TEST(AtomicFile, AFileOfAKilledWriterIsNoObstacle) {
  const TemporaryFolder folder;
  // The names that it once gave: by process and count.
  for (int i = 0; i < 64; ++i) {
    test::write_text(
        folder / (".pose." + std::to_string(getpid()) + "-" + std::to_string(i) + ".tmp.txt"), "x");
  }
  write_file(folder / "pose.txt", "whole");
  EXPECT_EQ(test::read_text(folder / "pose.txt"), "whole");
}

}  // namespace
}  // namespace nadir
