// SPDX-License-Identifier: Apache-2.0
#include "nadir/pipelines/context.hpp"

#include <gtest/gtest.h>

#include <string>

#include "nadir/core/error.hpp"
#include "nadir/pipelines/libraries.hpp"
#include "nadir/pipelines/manifest_of.hpp"
#include "nadir/pipelines/threads.hpp"
#include "nadir/version.hpp"

namespace nadir {
namespace {

TEST(PipelineContext, TellsWhoListensAndNobodyElse) {
  PipelineContext context;
  context.report_progress("mapping", 1, 2);
  context.say("nobody hears this");
  std::string heard;
  context.progress = [&](const std::string& stage, int done, int total) {
    heard += stage + " " + std::to_string(done) + "/" + std::to_string(total);
  };
  context.note = [&](const std::string& sentence) { heard += "; " + sentence; };
  context.report_progress("mapping", 1, 2);
  context.say("took up 3 features");
  EXPECT_EQ(heard, "mapping 1/2; took up 3 features");
}

TEST(ManifestOf, HoldsWhatTheContextSays) {
  PipelineContext context;
  context.seed = 11;
  context.arguments = {"localize", "site"};
  const Manifest manifest = manifest_of(context, 3, {"a", "b"});
  EXPECT_EQ(manifest.program_version, NADIR_VERSION);
  EXPECT_EQ(manifest.seed, 11U);
  EXPECT_EQ(manifest.threads, 3);
  EXPECT_EQ(manifest.arguments, context.arguments);
  EXPECT_EQ(manifest.inputs.size(), 2U);
}

TEST(Version, IsOneTextOfThreeNumbers) {
  EXPECT_EQ(std::string(NADIR_VERSION), std::to_string(NADIR_VERSION_MAJOR) + "." +
                                            std::to_string(NADIR_VERSION_MINOR) + "." +
                                            std::to_string(NADIR_VERSION_PATCH));
}

TEST(ThreadLimit, TakesWhatIsAllowedWhereNoNumberIsGiven) {
  EXPECT_EQ(ThreadLimit(3).threads(), 3);
  EXPECT_EQ(ThreadLimit(0).threads(), allowed_cores());
}

TEST(RequireDevice, RefusesNothingThatIsThere) {
  EXPECT_NO_THROW(require_device("cpu"));
  EXPECT_NO_THROW(require_device("auto"));
}

TEST(Libraries, AllHaveALicence) {
  ASSERT_GT(libraries().size(), 5U);
  for (const Library& library : libraries()) {
    EXPECT_FALSE(library.name.empty());
    EXPECT_FALSE(library.licence.empty()) << library.name;
  }
}

}  // namespace
}  // namespace nadir
