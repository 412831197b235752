// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/mapping.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <map>
#include <mutex>

#include "aerial_mapping/flight.hpp"
#include "nadir/core/error.hpp"
#include "support/expect_error.hpp"

namespace nadir {
namespace {

using test::compare;
using test::Flight;
using test::FlightErrors;
using test::FlightPlan;
using test::fly;
using test::MapError;
using test::Terrain;

AerialMappingOptions quick_options() {
  AerialMappingOptions options;
  options.features_per_photo = 1500;
  options.gps_sigma_m = 0.5;
  return options;
}

const std::shared_ptr<const Terrain>& terrain() {
  static const std::shared_ptr<const Terrain> shared = std::make_shared<const Terrain>();
  return shared;
}

const Flight& usual_flight() {
  static const Flight flight = [] {
    FlightErrors errors;
    errors.gps_bias = {1.7, -2.3, 1.0};
    return fly(terrain(), {}, errors);
  }();
  return flight;
}

/// A store in memory, that counts.
class MemoryStore : public MappingStore {
 public:
  std::optional<std::string> find(const std::string& key) override {
    const std::scoped_lock lock(mutex_);
    const auto found = values_.find(key);
    if (found == values_.end()) return std::nullopt;
    ++hits;
    return found->second;
  }
  void keep(const std::string& key, const std::string& bytes) override {
    const std::scoped_lock lock(mutex_);
    values_[key] = bytes;
  }
  std::size_t size() const { return values_.size(); }
  void cut_all() {
    for (auto& [key, bytes] : values_) bytes.resize(bytes.size() / 2 + 1);
  }
  int hits = 0;

 private:
  std::mutex mutex_;
  std::map<std::string, std::string> values_;
};

/// The map of a flight. Most tests fly over the same ground and differ in what is said of the
/// photos: their features and matches, which take two thirds of the time and follow from the pixels
/// alone, are found once for all of them.
AerialMap mapped(const PhotoSet& photos, const AerialMappingOptions& options) {
  static MemoryStore store;
  return map_photos(photos, options, {}, &store);
}

bool same(const AerialMap& a, const AerialMap& b) {
  return a.ortho.image == b.ortho.image && a.ortho.valid == b.ortho.valid &&
         a.ortho.geo == b.ortho.geo && a.view_count == b.view_count && a.quality == b.quality;
}

class Mapping : public testing::Test {
 protected:
  void SetUp() override {
    if (!can_solve_poses()) GTEST_SKIP() << "built without NADIR_WITH_SFM";
  }
};

TEST_F(Mapping, FindsTheGroundToATenthOfAMetreAndKeepsTheBiasOfTheGps) {
  const Flight& flight = usual_flight();
  const AerialMap map = mapped(flight.set, quick_options());
  EXPECT_EQ(map.report.registered, 12);
  EXPECT_EQ(map.report.components.size(), 1U);
  EXPECT_EQ(map.report.scale_source, ScaleSource::kPositions);
  const MapError error = compare(flight, map);
  EXPECT_GT(error.pixels, 5000);
  testing::Test::RecordProperty("relative_rms_mm", static_cast<int>(error.relative_rms_m * 1e3));
  EXPECT_LT(error.relative_rms_m, 0.10);
  // GPS noise of 0.2 m over this block leaves 0.3 per cent (one sigma).
  EXPECT_LT(std::abs(error.scale_error), 0.01);
  // The tilt of the block, known to 0.3 degrees by gimbals and heights, moves the ground by 0.2 m.
  EXPECT_NEAR(error.shift_m.x(), 1.7, 0.5);
  EXPECT_NEAR(error.shift_m.y(), -2.3, 0.5);
  EXPECT_LT(error.height_rms_m, 0.3);
  EXPECT_NEAR(map.report.ground_below_camera_m, 40.0, 2.0);
}

TEST_F(Mapping, ReliefDoesNotShrinkTheBlock) {
  // Hills of 10 m from foot to top, positions that weigh little: any term that likes a flatter
  // block shows as a smaller one.
  const Flight flight = fly(std::make_shared<const Terrain>(2, 5.0), {.photos = 3}, {});
  AerialMappingOptions options = quick_options();
  options.gps_sigma_m = 1.5;
  const AerialMap map = mapped(flight.set, options);
  EXPECT_EQ(map.report.registered, 9);
  EXPECT_LT(std::abs(compare(flight, map).scale_error), 0.02);
}

TEST_F(Mapping, ControlPointsMakeItAbsolute) {
  Flight flight = usual_flight();
  const std::array<Eigen::Vector2d, 4> places{{{-22, -16}, {21, -15}, {20, 17}, {-21, 15}}};
  for (const Eigen::Vector2d& place : places) {
    GroundControlPoint point;
    point.name = "gcp" + std::to_string(flight.set.control_points.size());
    point.position = {place.x(), place.y(), terrain()->height(place.x(), place.y())};
    for (std::size_t i = 0; i < flight.truth.size(); ++i) {
      const auto pixel =
          flight.camera.project((flight.truth[i].inverse() * point.position).vector());
      if (pixel && pixel->x() > 3 && pixel->y() > 3 && pixel->x() < 476 && pixel->y() < 356)
        point.marks.push_back({flight.set.photos[i].name, pixel->x(), pixel->y()});
    }
    ASSERT_GE(point.marks.size(), 2U);
    flight.set.control_points.push_back(point);
  }
  const AerialMap map = mapped(flight.set, quick_options());
  EXPECT_EQ(map.report.scale_source, ScaleSource::kControlPoints);
  const MapError error = compare(flight, map);
  EXPECT_LT(error.absolute_rms_m, 0.10);
  EXPECT_LT(std::abs(error.scale_error), 0.003);
  for (const ControlPointReport& point : map.report.control_points) {
    EXPECT_FALSE(point.outlier) << point.name;
    EXPECT_LT(std::hypot(point.residual_m[0], point.residual_m[1]), 0.1) << point.name;
  }
}

TEST_F(Mapping, AWrongFocalLengthBendsNothing) {
  for (const double factor : {0.85, 1.15}) {
    FlightErrors errors;
    errors.focal_factor = factor;
    errors.focal_sigma = 0.15;
    const Flight flight = fly(terrain(), {}, errors);
    const AerialMap map = mapped(flight.set, quick_options());
    const MapError error = compare(flight, map);
    EXPECT_EQ(map.report.registered, 12) << factor;
    EXPECT_LT(error.relative_rms_m, 0.15) << factor;
    EXPECT_LT(std::abs(error.bowl_m), 0.6) << factor;
    EXPECT_LT(std::abs(error.scale_error), 0.012) << factor;
  }
}

TEST_F(Mapping, ARollingShutterIsMostlyFoundAndSpoilsLittle) {
  // 50 ms at 3.3 m/s: the first row is taken 0.17 m before the last, 1.7 pixels. Images take most
  // of it for a ground that is stretched and bent; a block of twelve tells it half.
  const FlightErrors errors{.gps_sigma_m = 0.02, .gimbal_sigma_deg = 0.1, .readout_s = 0.05};
  const Flight flight = fly(terrain(), {}, errors);
  AerialMappingOptions options = quick_options();
  options.gps_sigma_m = 0.03;
  const AerialMap map = mapped(flight.set, options);
  EXPECT_EQ(map.report.registered, 12);
  EXPECT_GT(map.report.cameras.at(0).readout_s, 0.02);
  EXPECT_LT(map.report.cameras.at(0).readout_s, 0.06);
  EXPECT_LT(compare(flight, map).relative_rms_m, 0.06);
}

TEST_F(Mapping, OrderOfPhotosAndNumberOfThreadsDoNotMatter) {
  FlightPlan plan;
  plan.strips = 2;
  plan.photos = 3;
  const Flight flight = fly(terrain(), plan, {});
  PhotoSet turned = flight.set;
  std::reverse(turned.photos.begin(), turned.photos.end());
  std::swap(turned.photos[1], turned.photos[4]);
  const AerialMap map = [&] {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    return map_photos(flight.set, quick_options());
  }();
  const tbb::global_control four(tbb::global_control::max_allowed_parallelism, 4);
  EXPECT_TRUE(same(map, map_photos(turned, quick_options())));
}

TEST_F(Mapping, WithoutPositionsTheGivenPixelSizeIsTheScale) {
  FlightErrors errors;
  errors.tilt_deg = 8.0;
  Flight flight = fly(terrain(), {}, errors);
  for (MappingPhoto& photo : flight.set.photos) {
    photo.prior.position.reset();
    photo.prior.attitude.reset();
    photo.prior.relative_altitude_m.reset();
  }
  AerialMap map = mapped(flight.set, quick_options());
  EXPECT_EQ(map.report.registered, 12);
  EXPECT_EQ(map.report.scale_source, ScaleSource::kNone);
  ASSERT_EQ(map.report.doubts.size(), 1U);
  EXPECT_NE(map.report.doubts.front().find("the scale is arbitrary"), std::string::npos);
  EXPECT_FALSE(map.report.warnings.empty());
  flight.set.metres_per_photo_pixel = 40.0 / 400.0;
  map = mapped(flight.set, quick_options());
  EXPECT_EQ(map.report.scale_source, ScaleSource::kPhotoPixelSize);
  const MapError error = compare(flight, map);
  EXPECT_LT(error.relative_rms_m, 0.3);
  EXPECT_LT(std::abs(error.scale_error), 0.03);
}

TEST_F(Mapping, HalvesThatDoNotMeetAreNamed) {
  FlightPlan plan;
  plan.strips = 2;
  plan.photos = 3;
  plan.middle = {-35.0, -20.0};
  Flight flight = fly(terrain(), plan, {});
  plan.middle = {38.0, 20.0};
  plan.photos = 2;
  plan.prefix = "q";
  const Flight other = fly(terrain(), plan, {});
  flight.set.photos.insert(flight.set.photos.end(), other.set.photos.begin(),
                           other.set.photos.end());
  const AerialMap map = mapped(flight.set, quick_options());
  ASSERT_EQ(map.report.components.size(), 2U);
  EXPECT_EQ(map.report.components[0].size(), 6U);
  EXPECT_EQ(map.report.components[0][0], "p100.jpg");
  EXPECT_EQ(map.report.components[1].size(), 4U);
  EXPECT_EQ(map.report.registered, 6);
  const auto& warnings = map.report.warnings;
  EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [](const std::string& text) {
    return text.find("4 of 10 photos do not join") != std::string::npos &&
           text.find("q100.jpg") != std::string::npos;
  }));
}

TEST_F(Mapping, WaterIsNoGroundAndPhotosOfItAloneDoNotJoin) {
  auto wet = std::make_shared<Terrain>(1, 0.5);
  wet->add_pond(0.0, 0.0, 14.0);
  const Flight flight = fly(wet, {}, {});
  const AerialMap map = mapped(flight.set, quick_options());
  EXPECT_GE(map.report.registered, 10);
  const PixelCoordinate middle = map.ortho.geo.pixel_at(0.0, 0.0);
  EXPECT_EQ(map.ortho.valid.at(static_cast<int>(middle.column), static_cast<int>(middle.row)), 0)
      << "a pixel 14 m from the nearest point must not be called valid";
  EXPECT_LT(compare(flight, map).relative_rms_m, 0.15);
}

bool warns(const AerialMap& map, const std::string& first, const std::string& second) {
  const auto& warnings = map.report.warnings;
  return std::any_of(warnings.begin(), warnings.end(), [&](const std::string& text) {
    return text.find(first) != std::string::npos && text.find(second) != std::string::npos;
  });
}

/// A block of six photos, to say something of its tags.
Flight small_flight() { return fly(terrain(), {.strips = 2, .photos = 3}, {}); }

TEST_F(Mapping, ABlurredPhotoIsNamedAndShownNowhereElse) {
  Flight flight = usual_flight();
  const std::size_t blurred = 5;  // amid the block
  const auto load = flight.set.photos[blurred].load;
  flight.set.photos[blurred].digest += " blurred";
  flight.set.photos[blurred].load = [load] {
    // Out of focus: the mean of 7 x 7 pixels.
    const Raster<std::uint8_t> sharp = load();
    Raster<std::uint8_t> soft = sharp;
    for (int row = 3; row < sharp.height() - 3; ++row)
      for (int column = 3; column < sharp.width() - 3; ++column)
        for (int channel = 0; channel < 3; ++channel) {
          int sum = 0;
          for (int dy = -3; dy <= 3; ++dy)
            for (int dx = -3; dx <= 3; ++dx) sum += sharp.at(column + dx, row + dy, channel);
          soft.at(column, row, channel) = static_cast<std::uint8_t>(sum / 49);
        }
    return soft;
  };
  const AerialMap map = mapped(flight.set, quick_options());
  const std::string& name = flight.set.photos[blurred].name;
  EXPECT_TRUE(warns(map, name, "blurred")) << map.report.warnings.size();
  EXPECT_FALSE(warns(map, flight.set.photos[0].name, "blurred"));
  for (int row = 0; row < map.ortho.height(); row += 3)
    for (int column = 0; column < map.ortho.width(); column += 3) {
      if (map.ortho.valid.at(column, row) == 0) continue;
      const bool from_blurred = map.poses[map.source.at(column, row)].name == name;
      ASSERT_FALSE(from_blurred && map.view_count.at(column, row) > 1) << column << " " << row;
    }
}

TEST_F(Mapping, AGroundThatIsNotWhereTheAltitudeSaysIsDoubtful) {
  Flight flight = small_flight();
  for (MappingPhoto& photo : flight.set.photos) *photo.prior.relative_altitude_m *= 1.4;
  const AerialMap map = mapped(flight.set, quick_options());
  EXPECT_TRUE(warns(map, "surface doubtful", "nearer"));
  EXPECT_TRUE(map.report.doubts.empty()) << "the positions hold the scale: a hill explains it";
  EXPECT_FALSE(warns(mapped(small_flight().set, quick_options()), "surface doubtful", ""));
}

TEST_F(Mapping, HeightsThatTrendAgainstThePositionsAreDoubtful) {
  Flight flight = usual_flight();
  // A barometer that drifts by 6 m over the flight, said to be worse than the gimbals are good.
  for (std::size_t i = 0; i < flight.set.photos.size(); ++i) {
    auto& prior = flight.set.photos[i].prior;
    prior.position->z += 0.15 * prior.position->x;
    prior.vertical_sigma_m = 20.0;
  }
  const AerialMap map = mapped(flight.set, quick_options());
  EXPECT_TRUE(warns(map, "surface doubtful", "against the positions"));
  EXPECT_EQ(map.report.doubts.size(), 1U);
}

TEST_F(Mapping, AFreeFocalLengthOverFlatGroundIsHeld) {
  AerialMappingOptions options = quick_options();
  options.free_focal = true;
  const Flight flight = small_flight();
  const AerialMap map = mapped(flight.set, options);
  EXPECT_TRUE(warns(map, "free focal length", "held by its prior"));
  EXPECT_NEAR(map.report.cameras[0].model.fx, 400.0, 24.0);
  EXPECT_GT(map.report.cameras[0].focal_sigma, 0.0);
}

TEST_F(Mapping, TakesUpWhatAStoreKept) {
  Flight flight = small_flight();
  const AerialMap without = map_photos(flight.set, quick_options());
  for (MappingPhoto& photo : flight.set.photos) photo.digest = "content of " + photo.name;
  MemoryStore store;
  EXPECT_TRUE(same(map_photos(flight.set, quick_options(), {}, &store), without));
  EXPECT_EQ(store.hits, 0);
  EXPECT_GT(store.size(), 6U);
  EXPECT_TRUE(same(map_photos(flight.set, quick_options(), {}, &store), without));
  EXPECT_EQ(static_cast<std::size_t>(store.hits), store.size());
  // Another content under the same name is another photo, and damage is found.
  store.hits = 0;
  flight.set.photos[0].digest = "something else";
  EXPECT_TRUE(same(map_photos(flight.set, quick_options(), {}, &store), without));
  EXPECT_LT(static_cast<std::size_t>(store.hits), store.size());
  store.cut_all();
  EXPECT_TRUE(same(map_photos(flight.set, quick_options(), {}, &store), without));
}

TEST_F(Mapping, StopsWhereItIsAskedToAndKeepsItsStore) {
  Flight flight = small_flight();
  for (MappingPhoto& photo : flight.set.photos) photo.digest = "content of " + photo.name;
  std::map<std::string, int> asked;  // until the end of each stage
  std::atomic<int> count{0};
  const AerialMap whole = map_photos(
      flight.set, quick_options(), [&](const std::string& stage, double) { asked[stage] = count; },
      nullptr, StopToken([&] {
        ++count;
        return false;
      }));
  int before = 0;
  for (const MappingStage& stage : kMappingStages) {
    EXPECT_GT(asked[stage.name], before) << stage.name;
    MemoryStore store;
    std::atomic<int> left{(before + asked[stage.name]) / 2};
    EXPECT_THROW(
        map_photos(flight.set, quick_options(), {}, &store, StopToken([&] { return left-- <= 0; })),
        Stopped)
        << stage.name;
    before = asked[stage.name];
    if (stage.name != std::string("seams")) continue;
    const std::size_t kept = store.size();
    EXPECT_GT(kept, 6U);
    EXPECT_TRUE(same(map_photos(flight.set, quick_options(), {}, &store), whole));
    EXPECT_EQ(static_cast<std::size_t>(store.hits), kept);
  }
}

TEST_F(Mapping, RefusesMorePhotosThanAMapCanName) {
  PhotoSet set = small_flight().set;
  const MappingPhoto photo = set.photos[0];
  for (int i = 0; set.photos.size() <= 65535; ++i) {
    set.photos.push_back(photo);
    set.photos.back().name = "more" + std::to_string(i);
  }
  test::expect_error(ErrorKind::kUsage, {"65536 photos", "65535", "in parts"},
                     [&] { map_photos(set, quick_options()); });
}

TEST_F(Mapping, OneStripIsHeldByItsGimbal) {
  FlightPlan plan;
  plan.strips = 1;
  plan.photos = 5;
  FlightErrors errors;
  errors.gimbal_sigma_deg = 0.2;
  const Flight flight = fly(terrain(), plan, errors);
  const AerialMap map = mapped(flight.set, quick_options());
  EXPECT_EQ(map.report.registered, 5);
  EXPECT_LT(compare(flight, map).relative_rms_m, 0.25);
  EXPECT_TRUE(warns(map, "one straight strip", "the gimbal angles alone, to 1.5 degrees"));
  PhotoSet without = flight.set;
  for (MappingPhoto& photo : without.photos) photo.prior.attitude.reset();
  EXPECT_TRUE(warns(mapped(without, quick_options()), "one straight strip",
                    "the assumption that the photos look straight down"));
}

TEST_F(Mapping, GivenPosesAreTakenAsTheyAre) {
  Flight flight = usual_flight();
  for (std::size_t i = 0; i < flight.set.photos.size(); ++i)
    flight.set.photos[i].pose =
        PhotoPose{flight.set.photos[i].name, flight.camera, flight.truth[i]};
  const AerialMap map = mapped(flight.set, quick_options());
  EXPECT_EQ(map.report.scale_source, ScaleSource::kGivenPoses);
  const MapError error = compare(flight, map);
  EXPECT_LT(error.absolute_rms_m, 0.05);
  // The colours too: what the map shows is what the ground is painted with.
  double sum = 0.0;
  int count = 0;
  for (int row = 0; row < map.ortho.height(); row += 3)
    for (int column = 0; column < map.ortho.width(); column += 3) {
      if (map.ortho.valid.at(column, row) == 0) continue;
      const double green = map.ortho.image.at(column, row, 1);
      sum += std::abs(green - terrain()->colour(map.ortho.geo.x_at(column + 0.5),
                                                map.ortho.geo.y_at(row + 0.5))[1]);
      ++count;
    }
  EXPECT_LT(sum / count, 12.0) << "grey levels, mean";
}

TEST_F(Mapping, ContradictionsAreRefused) {
  PhotoSet set = usual_flight().set;
  set.photos[1].name = set.photos[0].name;
  EXPECT_THROW(map_photos(set, quick_options()), Error);
  set = usual_flight().set;
  set.photos[0].camera = 3;
  EXPECT_THROW(map_photos(set, quick_options()), Error);
  set.photos.resize(1);
  EXPECT_THROW(map_photos(set, quick_options()), Error);
  set = usual_flight().set;
  set.cameras[0].width = 481;
  try {
    map_photos(set, quick_options());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    EXPECT_NE(std::string(error.what()).find("480 x 360"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace nadir
