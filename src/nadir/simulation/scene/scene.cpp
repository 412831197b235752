// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/scene/scene.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "nadir/core/angle.hpp"
#include "nadir/core/random.hpp"
#include "nadir/simulation/scene/things.hpp"

namespace nadir::simulation {
namespace {

constexpr double kTile = 3.2;    ///< side of a tile of finest detail, metres
constexpr int kFinest = 2;       ///< its texels are this many times finer
constexpr int kMaximumTaps = 8;  ///< along the long axis of a slanted pixel
constexpr double kShadowReach = 80.0;

// Streams of random numbers; the seed of the traffic is added.
constexpr std::uint64_t kParked = 1'000'000;
constexpr std::uint64_t kUnderWay = 2'000'000;

/// A coordinate folded into low .. high, as between two mirrors.
double mirrored(double value, double low, double high) {
  return low + std::abs(std::remainder(value - low, 2.0 * (high - low)));
}

Light light_of(const Appearance& appearance) {
  const double elevation = radians(appearance.sun_elevation_deg);
  const double yaw = 0.5 * kPi - radians(appearance.sun_heading_deg);
  Light light;
  light.to_sun = {std::cos(elevation) * std::cos(yaw), std::cos(elevation) * std::sin(yaw),
                  std::sin(elevation)};
  // A low sun is weaker and warmer.
  const auto height = static_cast<float>(std::sin(elevation));
  const Eigen::Vector3f warmth(1.0F, 0.90F + 0.08F * height, 0.74F + 0.20F * height);
  const Eigen::Vector3f sky(0.215F, 0.245F, 0.30F);
  const float level = 0.78F * height + sky.mean();
  light.sun = 0.78F * warmth / level;
  light.sky = sky / level;
  return light;
}

}  // namespace

Scene::Scene(std::shared_ptr<const Terrain> terrain, const Appearance& appearance)
    : terrain_(std::move(terrain)),
      appearance_(appearance),
      dryness_(static_cast<float>(appearance.dryness)),
      light_(light_of(appearance)),
      noise_(terrain_->seed + 77U) {
  std::vector<Solid> solids = terrain_->solids;
  park_cars(solids);
  caster_ = std::make_unique<Caster>(terrain_->heights, std::move(solids), terrain_->seed);
  cast_shadows();
  light_ground();
  const Eigen::Vector2d size = terrain_->extent.high - terrain_->extent.low;
  tile_columns_ = static_cast<int>(std::ceil(size.x() / kTile));
  tile_rows_ = static_cast<int>(std::ceil(size.y() / kTile));
  tiles_.resize(static_cast<std::size_t>(tile_columns_) * static_cast<std::size_t>(tile_rows_));
}

void Scene::park_cars(std::vector<Solid>& solids) const {
  const RandomStream random(terrain_->seed, kParked + appearance_.traffic_seed);
  for (std::size_t i = 0; i < terrain_->layout.stalls.size(); ++i) {
    const Stall& stall = terrain_->layout.stalls[i];
    if (random.uniform(4 * i) >= appearance_.car_share) continue;
    Car car;
    const double turn = random.uniform(4 * i + 1) < 0.4 ? kPi : 0.0;
    car.yaw = stall.yaw + turn + random.uniform(4 * i + 2, -0.035, 0.035);
    const auto [u, v] = random.uniform_pair(4 * i + 3);
    car.at = stall.at + Eigen::Vector2d(0.36 * u - 0.18, 0.36 * v - 0.18);
    car.ground = terrain_->heights.at(car.at.x(), car.at.y());
    car.seed = terrain_->seed * 1000003U + appearance_.traffic_seed * 1009U + i;
    add_car(car, solids);
  }
}

Movers Scene::traffic(double seconds) const {
  const RandomStream random(terrain_->seed, kUnderWay + appearance_.traffic_seed);
  Movers movers;
  std::uint64_t draw = 0;
  for (const Road& road : terrain_->layout.roads) {
    if (road.kind != RoadKind::kStreet) continue;
    const double length = road.path.length();
    for (const double side : {-1.0, 1.0}) {
      const double speed = random.uniform(draw++, 5.0, 8.0);
      const double start = random.uniform(draw++, 0.0, length);
      const auto count = static_cast<int>(std::lround(length * appearance_.cars_per_km / 2000.0));
      for (int i = 0; i < count; ++i) {
        const double gap = length / count;
        const double uneven = random.uniform(draw++, -0.3, 0.3) * gap;
        const double gone = start + i * gap + uneven + speed * seconds;
        const double along = gone - length * std::floor(gone / length);
        const PathPose pose = road.path.at(side > 0.0 ? length - along : along);
        Car car;
        car.yaw = pose.yaw + (side > 0.0 ? kPi : 0.0);
        car.at = pose.point + 0.5 * side * road.half_width *
                                  Eigen::Vector2d(-std::sin(pose.yaw), std::cos(pose.yaw));
        car.seed = terrain_->seed * 1000003U + appearance_.traffic_seed * 1013U + draw;
        const Extent& extent = terrain_->extent;
        if ((car.at - extent.low).minCoeff() < 3.0 || (extent.high - car.at).minCoeff() < 3.0) {
          continue;
        }
        car.ground = terrain_->heights.at(car.at.x(), car.at.y());
        std::vector<Solid> solids;
        add_car(car, solids);
        movers.add(std::move(solids));
      }
    }
  }
  return movers;
}

/// Which places of the ground the sun reaches.
void Scene::cast_shadows() {
  sunlit_texel_m_ = 2.0 * terrain_->options.texel_m;
  const Eigen::Vector2d size = terrain_->extent.high - terrain_->extent.low;
  sunlit_ = Raster<std::uint8_t>(static_cast<int>(std::ceil(size.x() / sunlit_texel_m_)),
                                 static_cast<int>(std::ceil(size.y() / sunlit_texel_m_)), 255);
  tbb::parallel_for(0, sunlit_.height(), [&](int row) {
    for (int column = 0; column < sunlit_.width(); ++column) {
      const Eigen::Vector2d p =
          terrain_->extent.low + sunlit_texel_m_ * Eigen::Vector2d(column + 0.5, row + 0.5);
      const Eigen::Vector3d foot(p.x(), p.y(), terrain_->heights.at(p.x(), p.y()) + 0.01);
      const bool blocked = !caster_->is_free(foot, light_.to_sun, 0.02, kShadowReach) ||
                           !std::isnan(terrain_->heights.meet(foot, light_.to_sun, 0.03, 0.6));
      if (blocked) sunlit_.at(column, row) = 0;
    }
  });
}

Eigen::Vector3f Scene::tinted(const Eigen::Vector3f& colour, float plants) const {
  const float grey = colour.sum() / 3.0F;
  const Eigen::Vector3f straw = grey * Eigen::Vector3f(1.75F, 1.45F, 0.72F);
  return colour + dryness_ * plants * (straw - colour);
}

Eigen::Vector3f Scene::lit(const Eigen::Vector4f& albedo, double x, double y) const {
  const double u = std::clamp((x - terrain_->extent.low.x()) / sunlit_texel_m_ - 0.5, 0.0,
                              sunlit_.width() - 1.001);
  const double v = std::clamp((y - terrain_->extent.low.y()) / sunlit_texel_m_ - 0.5, 0.0,
                              sunlit_.height() - 1.001);
  const int column = static_cast<int>(u);
  const int row = static_cast<int>(v);
  const auto a = static_cast<float>(u - column);
  const auto b = static_cast<float>(v - row);
  const float below = static_cast<float>(sunlit_.at(column, row)) * (1.0F - a) +
                      static_cast<float>(sunlit_.at(column + 1, row)) * a;
  const float above = static_cast<float>(sunlit_.at(column, row + 1)) * (1.0F - a) +
                      static_cast<float>(sunlit_.at(column + 1, row + 1)) * a;
  const float sun = (below * (1.0F - b) + above * b) * (1.0F / 255.0F);
  const Eigen::Vector3d normal = terrain_->heights.normal(x, y);
  const auto facing = static_cast<float>(std::max(0.0, normal.dot(light_.to_sun)));
  const auto open = static_cast<float>(0.5 + 0.5 * normal.z());
  return tinted(albedo.head<3>(), albedo[3])
      .cwiseProduct(sun * facing * light_.sun + open * light_.sky);
}

void Scene::light_ground() {
  const Raster<std::uint8_t>& albedo = terrain_->albedo;
  const double texel = terrain_->options.texel_m;
  Raster<std::uint8_t> image(albedo.width(), albedo.height(), 0, 4);
  tbb::parallel_for(0, albedo.height(), [&](int row) {
    for (int column = 0; column < albedo.width(); ++column) {
      Eigen::Vector4f reflectance;
      for (int channel = 0; channel < 4; ++channel) {
        const float root = static_cast<float>(albedo.at(column, row, channel)) / 255.0F;
        reflectance[channel] = root * root;
      }
      const Eigen::Vector2d p =
          terrain_->extent.low + texel * Eigen::Vector2d(column + 0.5, row + 0.5);
      const Eigen::Vector3f colour = lit(reflectance, p.x(), p.y());
      for (int channel = 0; channel < 3; ++channel) {
        image.at(column, row, channel) = encoded(colour[channel]);
      }
    }
  });
  ground_ = Texture(std::move(image), terrain_->extent.low, texel, true);
}

void Scene::refine(std::span<const Pose2> places, double radius_m) {
  std::vector<int> wanted;
  for (int index = 0; index < tile_columns_ * tile_rows_; ++index) {
    const Eigen::Vector2d middle =
        terrain_->extent.low +
        kTile * (Eigen::Vector2d(index % tile_columns_, index / tile_columns_) +
                 Eigen::Vector2d(0.5, 0.5));
    const bool near = std::any_of(places.begin(), places.end(), [&](const Pose2& place) {
      return std::hypot(place.x - middle.x(), place.y - middle.y()) < radius_m + 0.5 * kTile;
    });
    if (near && tiles_[static_cast<std::size_t>(index)] == nullptr) wanted.push_back(index);
  }
  const double texel = terrain_->options.texel_m / kFinest;
  const int side = static_cast<int>(std::ceil(kTile / texel)) + 2;  // an apron for interpolation
  tbb::parallel_for(std::size_t{0}, wanted.size(), [&](std::size_t i) {
    const int index = wanted[i];
    const Eigen::Vector2d low =
        terrain_->extent.low +
        kTile * Eigen::Vector2d(index % tile_columns_, index / tile_columns_) -
        Eigen::Vector2d(texel, texel);
    const Nearby nearby =
        terrain_->model->near(low + Eigen::Vector2d(0.5 * kTile, 0.5 * kTile), 0.75 * kTile);
    Raster<std::uint8_t> image(side, side, 0, 4);
    for (int row = 0; row < side; ++row) {
      for (int column = 0; column < side; ++column) {
        const Eigen::Vector2d p = low + texel * Eigen::Vector2d(column + 0.5, row + 0.5);
        const GroundSample sample = terrain_->sample(p, static_cast<float>(texel), nearby);
        const Eigen::Vector3f colour = lit(
            {sample.albedo.x(), sample.albedo.y(), sample.albedo.z(), sample.plants}, p.x(), p.y());
        for (int channel = 0; channel < 3; ++channel) {
          image.at(column, row, channel) = encoded(colour[channel]);
        }
      }
    }
    tiles_[static_cast<std::size_t>(index)] =
        std::make_unique<Texture>(std::move(image), low, texel, false);
  });
}

Eigen::Vector3f Scene::ground_colour(double x, double y, float footprint) const {
  const Extent& extent = terrain_->extent;
  if (!extent.contains(x, y)) {
    if (terrain_->draped) {  // beyond the map nothing is known: it goes on as its mirror image
      return ground_.at(mirrored(x, extent.low.x(), extent.high.x()),
                        mirrored(y, extent.low.y(), extent.high.y()), footprint);
    }
    const Eigen::Vector2d point(x, y);
    const GroundSample sample =
        terrain_->sample(point, footprint, terrain_->model->near(point, 0.0));
    return tinted(sample.albedo, sample.plants)
        .cwiseProduct(static_cast<float>(light_.to_sun.z()) * light_.sun + light_.sky);
  }
  const auto texel = static_cast<float>(terrain_->options.texel_m);
  Eigen::Vector3f coarse = ground_.at(x, y, footprint);
  if (footprint >= texel) return coarse;
  const auto column = static_cast<int>((x - extent.low.x()) / kTile);
  const auto row = static_cast<int>((y - extent.low.y()) / kTile);
  const Texture* tile =
      tiles_[static_cast<std::size_t>(row) * static_cast<std::size_t>(tile_columns_) +
             static_cast<std::size_t>(column)]
          .get();
  if (tile == nullptr) return coarse;
  const Eigen::Vector3f fine = tile->finest(x, y).head<3>();
  const float share =
      std::clamp(std::log(texel / footprint) / std::log(static_cast<float>(kFinest)), 0.0F, 1.0F);
  // Grains of a centimetre and less, which no stored picture holds.
  const auto u = static_cast<float>(x);
  const auto v = static_cast<float>(y);
  const float grain = noise_.fractal(u, v, 0.016F, 2, 950, footprint, 0.9F);
  return (coarse + share * (fine - coarse)) * (1.0F + 0.3F * grain);
}

Eigen::Vector3f Scene::colour(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                              const RayHit& hit, double width, const Movers* movers) const {
  if (hit.solid == RayHit::kSky) return sky(direction);
  const Eigen::Vector3d p = origin + hit.t * direction;
  if (hit.solid >= 0) return solid_colour(p, hit, static_cast<float>(width));
  // A slanted pixel is long: several samples along it, each as wide as the pixel. Ground that rises
  // along the ray is seen less aslant; where it falls away, it is taken for level.
  const double run = std::hypot(direction.x(), direction.y());
  const double facing = std::max(rise_along(p, direction) - direction.z(), std::abs(direction.z()));
  const double length = std::min(width * direction.norm() / std::max(facing, 1e-6), 40.0);
  const int taps = std::clamp(static_cast<int>(std::lround(length / width)), 1, kMaximumTaps);
  const auto footprint = static_cast<float>(std::max(width, length / kMaximumTaps));
  const Eigen::Vector3f left = movers == nullptr ? Eigen::Vector3f::Ones() : shadow_of(*movers, p);
  if (taps == 1) return left.cwiseProduct(ground_colour(p.x(), p.y(), footprint));
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (int i = 0; i < taps; ++i) {
    const double offset = ((i + 0.5) / taps - 0.5) * length / run;
    sum += ground_colour(p.x() + offset * direction.x(), p.y() + offset * direction.y(), footprint);
  }
  return left.cwiseProduct(sum) / static_cast<float>(taps);
}

double Scene::rise_along(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const {
  const Eigen::Vector3d normal = terrain_->heights.normal(point.x(), point.y());
  return -normal.head<2>().dot(direction.head<2>()) / normal.z();
}

Eigen::Vector3f Scene::shadow_of(const Movers& movers, const Eigen::Vector3d& point) const {
  constexpr double kReach = 8.0;
  for (const Movers::Thing& thing : movers.things) {
    if ((thing.box.center() - point).head<2>().norm() > kReach) continue;
    const bool hidden =
        std::any_of(thing.solids.begin(), thing.solids.end(), [&](const Solid& solid) {
          return solid.meet(point, light_.to_sun, 0.01, kReach, noise_).has_value();
        });
    if (!hidden || !caster_->is_free(point, light_.to_sun, 0.05, kShadowReach)) continue;
    const Eigen::Vector3f all = static_cast<float>(light_.to_sun.z()) * light_.sun + light_.sky;
    return light_.sky.cwiseQuotient(all);
  }
  return Eigen::Vector3f::Ones();
}

Eigen::Vector3f Scene::sky(const Eigen::Vector3d& direction) const {
  const Eigen::Vector3d unit = direction.normalized();
  const auto up = static_cast<float>(std::max(unit.z(), 0.0));
  const auto yaw = static_cast<float>(std::atan2(unit.y(), unit.x()));
  // Woods on the horizon.
  const float crest = 0.035F + 0.018F * noise_.fractal(yaw * 20.0F, 0.0F, 4.0F, 5, 900, 0.001F);
  const float open = ease_between(crest - 0.002F, crest + 0.002F, up);
  const Eigen::Vector3f wood =
      Eigen::Vector3f(0.085F, 0.115F, 0.075F) *
      (1.0F + 0.35F * noise_.fractal(yaw * 60.0F, up * 60.0F, 1.0F, 4, 901, 0.001F));
  const Eigen::Vector3f horizon(0.72F, 0.78F, 0.82F);
  const Eigen::Vector3f zenith(0.25F, 0.40F, 0.66F);
  const Eigen::Vector3f blue = horizon + ease_between(0.0F, 0.7F, up) * (zenith - horizon);
  return wood + open * (blue - wood);
}

}  // namespace nadir::simulation
