// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/atomic_file.hpp"

#include <gtest/gtest.h>

#include "support/expect_error.hpp"
#include "support/full_disk.hpp"
#include "support/temporary_folder.hpp"

namespace nadir {
namespace {

using test::TemporaryFolder;

TEST(AtomicFile, AppearsWholeAndAlone) {
  const TemporaryFolder folder;
  AtomicFile file(folder / "pose.txt");
  file.write("new");
  EXPECT_FALSE(std::filesystem::exists(file.target()));
  file.commit();
  EXPECT_EQ(test::read_text(folder / "pose.txt"), "new");
  EXPECT_EQ(test::count_entries(folder.path()), 1);
}

TEST(AtomicFile, ReplacesWhatWasThere) {
  const TemporaryFolder folder;
  write_file(folder / "pose.txt", "old and longer");
  write_file(folder / "pose.txt", "new");
  EXPECT_EQ(test::read_text(folder / "pose.txt"), "new");
}

TEST(AtomicFile, LeavesTheOldFileWithoutCommit) {
  const TemporaryFolder folder;
  write_file(folder / "pose.txt", "old");
  {
    AtomicFile file(folder / "pose.txt");
    file.write("half of the n");
  }
  EXPECT_EQ(test::read_text(folder / "pose.txt"), "old");
  EXPECT_EQ(test::count_entries(folder.path()), 1);
}

TEST(AtomicFile, LeavesTheOldFileWhenTheDiskIsFull) {
  const TemporaryFolder folder;
  write_file(folder / "pose.txt", "old");
  {
    const test::FullDisk full;
    test::expect_error(ErrorKind::kProcessing, {"pose.txt", "cannot be written", "free space"},
                       [&] { write_file(folder / "pose.txt", std::string(1 << 20, 'x')); });
  }
  EXPECT_EQ(test::read_text(folder / "pose.txt"), "old");
  EXPECT_EQ(test::count_entries(folder.path()), 1);
}

TEST(AtomicFile, KeepsTheExtensionForLibrariesThatChooseTheFormatByIt) {
  const TemporaryFolder folder;
  const AtomicFile file(folder / "map.tif");
  EXPECT_EQ(file.temporary().extension(), ".tif");
  EXPECT_EQ(file.temporary().parent_path(), folder.path());
}

TEST(AtomicFile, RefusesAFolderThatIsNotThere) {
  const TemporaryFolder folder;
  test::expect_error(ErrorKind::kProcessing, {"missing/pose.txt", "cannot be written", "check"},
                     [&] { write_file(folder.path() / "missing" / "pose.txt", "x"); });
}

TEST(AtomicFile, RefusesATargetThatIsAFolder) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "taken/inside");
  test::expect_error(ErrorKind::kProcessing, {"taken", "cannot be written"},
                     [&] { write_file(folder / "taken", "x"); });
  EXPECT_EQ(test::count_entries(folder.path()), 1);
}

TEST(CreateFolder, RefusesAPathThroughAFile) {
  const TemporaryFolder folder;
  test::write_text(folder / "file", "x");
  test::expect_error(ErrorKind::kProcessing, {"file/below", "cannot be written"},
                     [&] { create_folder(folder.path() / "file" / "below"); });
}

}  // namespace
}  // namespace nadir
