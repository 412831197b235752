// SPDX-License-Identifier: Apache-2.0
#include "run_words.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace nadir::cli {
namespace {

/// Ten frames along x; the estimate is `offset` metres off, the covariance says `sigma` metres.
RunRecord run_of(double offset, double sigma) {
  RunRecord run;
  run.manifest = Json::object();
  std::vector<StampedCovariance> covariances;
  Trajectory estimated;
  for (int i = 0; i < 10; ++i) {
    ViewFrame frame;
    frame.number = 100 + i;
    frame.stamp = Stamp{i * 1'000'000'000LL};
    frame.status = "ok";
    frame.map_from_robot = {i + offset, 0.0, 0.0};
    frame.covariance = PoseCovariance::Identity() * sigma * sigma;
    frame.cluster_mass = 1.0;
    frame.clusters = 1;
    frame.truth = Pose2{static_cast<double>(i), 0.0, 0.0};
    run.truth.push_back({frame.stamp, *frame.truth});
    estimated.push_back({frame.stamp, frame.map_from_robot});
    covariances.push_back({frame.stamp, frame.covariance});
    run.frames.push_back(frame);
  }
  run.judgement = judged(estimated, covariances, run.truth);
  return run;
}

bool warns_of(const RunWords& words, const std::string& part) {
  return std::ranges::any_of(words.warnings, [&](const std::string& warning) {
    return warning.find(part) != std::string::npos;
  });
}

TEST(RunWords, AGoodRunIsSaidToBeGood) {
  const RunWords words = words_of(run_of(0.2, 0.2));
  EXPECT_TRUE(words.good);
  EXPECT_TRUE(words.warnings.empty());
  EXPECT_TRUE(words.headline.starts_with("Localized well: 10 of 10 frames")) << words.headline;
  EXPECT_NE(words.headline.find("0.20 m"), std::string::npos) << words.headline;
}

TEST(RunWords, ALostRunIsSaidToBeLost) {
  const RunWords words = words_of(run_of(5.0, 0.2));
  EXPECT_FALSE(words.good);
  EXPECT_TRUE(words.headline.starts_with("Lost")) << words.headline;
  EXPECT_TRUE(warns_of(words, "more than 2 m"));
  EXPECT_TRUE(warns_of(words, "covariance is too small"));
}

TEST(RunWords, FramesThatSayNothingAreNamedWithTheirReason) {
  RunRecord run = run_of(0.1, 0.2);
  for (const std::size_t i : {2U, 3U, 7U}) run.frames[i].status = "no_overlap";
  const RunWords words = words_of(run);
  EXPECT_TRUE(warns_of(words, "3 frames not compared")) << words.warnings.size();
  EXPECT_TRUE(warns_of(words, "102-103, 107"));
  EXPECT_TRUE(warns_of(words, "too little of the local map"));
  for (ViewFrame& frame : run.frames) frame.status = "no_overlap";
  EXPECT_TRUE(words_of(run).headline.starts_with("Not localized"));
}

TEST(RunWords, WithoutATruthTheFiltersOwnUncertaintyIsTold) {
  RunRecord run = run_of(0.1, 1.5);
  run.truth.clear();
  run.judgement.reset();
  const RunWords words = words_of(run);
  EXPECT_NE(words.headline.find("No true trajectory"), std::string::npos);
  EXPECT_TRUE(warns_of(words, "uncertain by 3.0 m"));
}

TEST(RunWords, AnInterruptedAndADividedRunAreToldApart) {
  RunRecord run = run_of(0.1, 0.2);
  run.manifest["stages"] = {{{"name", "localize (interrupted)"}, {"seconds", 1.0}}};
  run.frames.back().cluster_mass = 0.6;
  run.frames.back().clusters = 2;
  const RunWords words = words_of(run);
  EXPECT_TRUE(warns_of(words, "interrupted"));
  EXPECT_TRUE(warns_of(words, "2 places"));
  EXPECT_TRUE(warns_of(words, "60 %"));
}

TEST(RunWords, TwoSigmaIsThatOfTheMostUncertainDirection) {
  // A cloud of 3 m by 1 m, turned by 30 degrees.
  const double turn = std::numbers::pi / 6.0;
  PoseCovariance covariance = PoseCovariance::Zero();
  const double c = std::cos(turn);
  const double s = std::sin(turn);
  covariance(0, 0) = 9.0 * c * c + s * s;
  covariance(1, 1) = 9.0 * s * s + c * c;
  covariance(0, 1) = covariance(1, 0) = 8.0 * s * c;
  covariance(2, 2) = 0.25;
  EXPECT_NEAR(two_sigma_m(covariance), 6.0, 1e-12);
  EXPECT_NEAR(two_sigma_yaw_rad(covariance), 1.0, 1e-12);
}

TEST(RunWords, NumbersBecomeStretches) {
  EXPECT_EQ(stretches({}), "");
  EXPECT_EQ(stretches({5}), "5");
  EXPECT_EQ(stretches({3, 4, 5, 9}), "3-5, 9");
  EXPECT_EQ(stretches({1, 3, 5, 7, 9, 11, 13}), "1, 3, 5, 7, 9, 11, ...");
}

}  // namespace
}  // namespace nadir::cli
