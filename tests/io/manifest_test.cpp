// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/provenance/manifest.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "nadir/io/json.hpp"
#include "nadir/io/provenance/sha256.hpp"
#include "support/expect_error.hpp"
#include "support/temporary_folder.hpp"

namespace nadir {
namespace {

using test::TemporaryFolder;

// FIPS 180-4, examples of NIST.
TEST(Sha256, AgreesWithPublishedDigests) {
  const TemporaryFolder folder;
  test::write_text(folder / "abc", "abc");
  EXPECT_EQ(sha256_of_file(folder / "abc"),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  test::write_text(folder / "empty", "");
  EXPECT_EQ(sha256_of_file(folder / "empty"),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  test::write_text(folder / "million", std::string(1'000'000, 'a'));
  EXPECT_EQ(sha256_of_file(folder / "million"),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  test::expect_error(ErrorKind::kInput, {"none", "cannot be opened"},
                     [&] { sha256_of_file(folder / "none"); });
}

TEST(Manifest, RecordsTheRun) {
  const TemporaryFolder folder;
  test::write_text(folder / "site/b.txt", "abc");
  test::write_text(folder / "site/a/c.txt", "");
  double radius = 0.25;
  bool adaptive = true;
  OptionTable table;
  table.number("search.radius_m", radius, {}, "How far.");
  table.flag("filter.adaptive", adaptive, "Whether.");
  Manifest manifest;
  manifest.program_version = "1.2.3";
  manifest.arguments = {"nadir", "localize", "caf\xe9"};  // not UTF-8
  manifest.seed = 18446744073709551615U;
  manifest.threads = 2;
  manifest.inputs = {folder / "site"};
  manifest.sources = {{"site", folder / "site"}};
  manifest.stages = {{"match", 1.5}};
  manifest.started = std::chrono::system_clock::from_time_t(0);
  write_manifest(folder.path(), manifest, table, {{"search.radius_m", "--set"}});

  const auto json = nlohmann::json::parse(test::read_text(folder / "manifest.json"));
  EXPECT_EQ(json["version"], "1.2.3");
  EXPECT_EQ(json["arguments"].size(), 3U);
  EXPECT_EQ(json["started"], "1970-01-01T00:00:00Z");
  EXPECT_EQ(json["seed"], 18446744073709551615U);
  EXPECT_EQ(json["threads"], 2);
  EXPECT_EQ(json["device"], "cpu");
  EXPECT_EQ(json["sources"]["site"], (folder / "site").string());
  EXPECT_EQ(json["options"]["search.radius_m"]["value"], 0.25);
  EXPECT_EQ(json["options"]["search.radius_m"]["from"], "--set");
  EXPECT_EQ(json["options"]["filter.adaptive"]["value"], true);
  EXPECT_EQ(json["options"]["filter.adaptive"]["from"], "default");
  ASSERT_EQ(json["inputs"].size(), 2U);
  EXPECT_EQ(json["inputs"][0]["path"], (folder / "site/a/c.txt").string());
  EXPECT_EQ(json["inputs"][1]["bytes"], 3);
  EXPECT_EQ(json["inputs"][1]["sha256"], sha256_of_file(folder / "site/b.txt"));
  EXPECT_EQ(json["stages"][0]["seconds"], 1.5);
  EXPECT_GT(json["host"]["memory_bytes"], 0);
}

TEST(Manifest, ASourceOfAnyNameIsFoundAgain) {
  const TemporaryFolder folder;
  const std::filesystem::path site = folder / "caf\xe9";
  Manifest manifest;
  manifest.sources = {{"site", site}};
  write_manifest(folder.path(), manifest, OptionTable{});
  const auto json = Json::parse(test::read_text(folder / "manifest.json"));
  EXPECT_EQ(name_at(json["sources"], "site"), site.string());
}

TEST(Manifest, LeavesNothingWhereAnInputIsMissing) {
  const TemporaryFolder folder;
  Manifest manifest;
  manifest.inputs = {folder / "none.tif"};
  test::expect_error(ErrorKind::kInput, {"none.tif"},
                     [&] { write_manifest(folder.path(), manifest, OptionTable{}); });
  EXPECT_EQ(test::count_entries(folder.path()), 0);
}

}  // namespace
}  // namespace nadir
