// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/atomic_file.hpp"

#include <gtest/gtest.h>

#include "nadir/io/file_names.hpp"
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
  EXPECT_EQ(file.temporary().parent_path().parent_path(), folder.path());
}

TEST(AtomicFile, WritesUnderTheLongestName) {
  const TemporaryFolder folder;
  const std::string name(kLongestName - 4, 'n');
  for (const std::string& longest : {name + ".tif", "n." + std::string(kLongestName - 2, 'x')}) {
    write_file(folder / longest, "new");
    EXPECT_EQ(test::read_text(folder / longest), "new");
  }
  EXPECT_EQ(test::count_entries(folder.path()), 2);
}

TEST(AtomicFile, AShortNameTearsNoCharacter) {
  EXPECT_EQ(short_name("map"), "map");
  EXPECT_EQ(short_name(std::string(70, 'n')), std::string(64, 'n'));
  const std::string euro = "\xe2\x82\xac";
  EXPECT_EQ(short_name(std::string(63, 'n') + euro + "nnn"), std::string(63, 'n'));
  EXPECT_EQ(short_name(std::string(61, 'n') + euro + "nnn"), std::string(61, 'n') + euro);
  EXPECT_EQ(short_name(std::string(300, '\x80')).size(), 64U) << "Latin-1, not UTF-8";
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
