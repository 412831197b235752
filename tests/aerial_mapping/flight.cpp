// SPDX-License-Identifier: Apache-2.0
#include "aerial_mapping/flight.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <complex>

#include "nadir/core/rolling_shutter.hpp"

namespace nadir::test {
namespace {

constexpr double kPaintM = 0.06;  // pixel of the painted ground
constexpr double kWest = -65.0;
constexpr double kNorth = 55.0;
constexpr int kPaintWidth = 2166;
constexpr int kPaintHeight = 1833;
constexpr int kPhotoEveryS = 3;
constexpr double kDegree = std::numbers::pi / 180.0;

/// Values on a lattice, blended linearly.
double value_noise(const RandomStream& stream, double x, double y) {
  const auto cell = [&](double column, double row) {
    const auto index =
        static_cast<std::uint64_t>(static_cast<std::int64_t>(row) + 100000) * 1000003ULL +
        static_cast<std::uint64_t>(static_cast<std::int64_t>(column) + 100000);
    return stream.uniform(index);
  };
  const double c = std::floor(x);
  const double r = std::floor(y);
  const double fx = x - c;
  const double fy = y - r;
  return (1 - fy) * ((1 - fx) * cell(c, r) + fx * cell(c + 1, r)) +
         fy * ((1 - fx) * cell(c, r + 1) + fx * cell(c + 1, r + 1));
}

}  // namespace

Terrain::Terrain(std::uint64_t seed, double relief_m)
    : paint_(kPaintWidth, kPaintHeight, 0, 3), relief_m_(relief_m) {
  const RandomStream coarse(seed, 1);
  const RandomStream middle(seed, 2);
  const RandomStream fine(seed, 3);
  for (int row = 0; row < kPaintHeight; ++row)
    for (int column = 0; column < kPaintWidth; ++column) {
      const double x = column * kPaintM;
      const double y = row * kPaintM;
      const double a = value_noise(coarse, x / 5.0, y / 5.0);
      const double b = value_noise(middle, x / 0.9, y / 0.9);
      const double c = value_noise(fine, x / 0.22, y / 0.22);
      const double grey = 40.0 + 60.0 * a + 60.0 * b + 50.0 * c;
      paint_.at(column, row, 0) = static_cast<std::uint8_t>(std::clamp(grey - 20 * a, 0.0, 255.0));
      paint_.at(column, row, 1) = static_cast<std::uint8_t>(std::clamp(grey, 0.0, 255.0));
      paint_.at(column, row, 2) = static_cast<std::uint8_t>(std::clamp(grey - 25 * b, 0.0, 255.0));
    }
}

void Terrain::add_pond(double x, double y, double radius) {
  for (int row = 0; row < kPaintHeight; ++row)
    for (int column = 0; column < kPaintWidth; ++column)
      if (std::hypot(kWest + column * kPaintM - x, kNorth - row * kPaintM - y) < radius)
        for (int channel = 0; channel < 3; ++channel)
          paint_.at(column, row, channel) = static_cast<std::uint8_t>(60 + 20 * channel);
}

double Terrain::height(double x, double y) const {
  return relief_m_ * (std::sin(x / 17.0) * std::cos(y / 13.0) + 0.3 * std::sin((x + y) / 7.0));
}

Eigen::Vector3d Terrain::colour(double x, double y) const {
  const double column = std::clamp((x - kWest) / kPaintM, 0.0, kPaintWidth - 1.001);
  const double row = std::clamp((kNorth - y) / kPaintM, 0.0, kPaintHeight - 1.001);
  const int c = static_cast<int>(column);
  const int r = static_cast<int>(row);
  const double fc = column - c;
  const double fr = row - r;
  Eigen::Vector3d rgb;
  for (int k = 0; k < 3; ++k)
    rgb[k] = (1 - fr) * ((1 - fc) * paint_.at(c, r, k) + fc * paint_.at(c + 1, r, k)) +
             fr * ((1 - fc) * paint_.at(c, r + 1, k) + fc * paint_.at(c + 1, r + 1, k));
  return rgb;
}

Eigen::Vector3d Terrain::meet(const Eigen::Vector3d& centre,
                              const Eigen::Vector3d& direction) const {
  Eigen::Vector3d p = centre;
  double z = 0.0;
  for (int pass = 0; pass < 12; ++pass) {
    p = centre + direction * ((z - centre.z()) / direction.z());
    z = height(p.x(), p.y());
  }
  return p;
}

namespace {

/// FNV-1a of the pixels: the same photo has the same digest in every flight.
std::string digest_of(const Raster<std::uint8_t>& pixels) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const std::uint8_t value : pixels.values()) hash = (hash ^ value) * 1099511628211ULL;
  return std::to_string(hash);
}

}  // namespace

Flight fly(const std::shared_ptr<const Terrain>& terrain, const FlightPlan& plan,
           const FlightErrors& errors) {
  Flight flight;
  flight.terrain = terrain;
  flight.camera = {480, 360, 400.0, 400.0, 239.5, 179.5, errors.k1, 0.0, 0.0, 0.0, 0.0};
  CameraPrior prior;
  prior.name = "test camera";
  prior.width = flight.camera.width;
  prior.height = flight.camera.height;
  prior.focal = {flight.camera.fx * errors.focal_factor, errors.focal_sigma, "told by the test"};
  flight.set.cameras.push_back(prior);
  const RandomStream noise(plan.seed, 11);
  std::uint64_t draw = 0;
  const auto normal = [&](double sigma) { return sigma * noise.normal(draw++); };
  for (int strip = 0; strip < plan.strips; ++strip)
    for (int k = 0; k < plan.photos; ++k) {
      const bool back = strip % 2 == 1;
      const double along = (k - 0.5 * (plan.photos - 1)) * plan.step_m * (back ? -1.0 : 1.0);
      const double across = (strip - 0.5 * (plan.strips - 1)) * plan.strip_step_m;
      const Eigen::Vector3d centre{plan.middle.x() + across + normal(0.5),
                                   plan.middle.y() + along + normal(0.5),
                                   plan.height_m + normal(0.4)};
      const PhotoAttitude attitude{
          (back ? -0.5 : 0.5) * std::numbers::pi + normal(3.0 * kDegree),
          -0.5 * std::numbers::pi + std::abs(normal(errors.tilt_deg * kDegree)),
          normal(errors.tilt_deg * kDegree)};
      Transform3<frames::Map, frames::Camera> pose;
      pose.rotation = Eigen::Quaterniond(map_from_camera_rotation(attitude));
      pose.translation = centre;
      flight.truth.push_back(pose);
      const double speed = (back ? -1.0 : 1.0) * plan.step_m / kPhotoEveryS;
      flight.flown.emplace_back(0.0, errors.readout_s * speed, 0.0);

      MappingPhoto photo;
      photo.name = plan.prefix + std::to_string(100 + strip * plan.photos + k) + ".jpg";
      photo.prior.position =
          Point3<frames::Map>{centre.x() + errors.gps_bias.x() + normal(errors.gps_sigma_m),
                              centre.y() + errors.gps_bias.y() + normal(errors.gps_sigma_m),
                              centre.z() + errors.gps_bias.z() + normal(2.0 * errors.gps_sigma_m)};
      PhotoAttitude told = attitude;
      told.yaw += normal(4.0 * kDegree);
      told.pitch += normal(errors.gimbal_sigma_deg * kDegree);
      told.roll += normal(errors.gimbal_sigma_deg * kDegree);
      photo.prior.attitude = told;
      photo.prior.relative_altitude_m = centre.z();
      photo.prior.taken_at = Stamp{(strip * 40 + k * kPhotoEveryS) * 1000000000LL};
      const double gain = std::exp(normal(errors.exposure_sigma));
      photo.prior.exposure = std::pow(gain, 2.2);
      auto pixels =
          std::make_shared<Raster<std::uint8_t>>(flight.camera.width, flight.camera.height, 0, 3);
      for (int v = 0; v < pixels->height(); ++v)
        for (int u = 0; u < pixels->width(); ++u) {
          const Eigen::Vector3d ray =
              pose.rotation * flight.camera.ray({static_cast<double>(u), static_cast<double>(v)});
          const Eigen::Vector3d row_centre =
              centre + readout_share(flight.camera, v) * flight.flown.back();
          const Eigen::Vector3d p = terrain->meet(row_centre, ray);
          const Eigen::Vector3d rgb = gain * terrain->colour(p.x(), p.y());
          for (int channel = 0; channel < 3; ++channel)
            pixels->at(u, v, channel) =
                static_cast<std::uint8_t>(std::clamp(rgb[channel], 0.0, 255.0));
        }
      photo.digest = digest_of(*pixels);
      photo.load = [pixels] { return *pixels; };
      flight.set.photos.push_back(photo);
    }
  return flight;
}

MapError compare(const Flight& flight, const AerialMap& map) {
  using Complex = std::complex<double>;
  std::vector<Complex> shown;
  std::vector<Complex> real;
  std::vector<Eigen::Vector3d> heights;
  for (int row = 2; row < map.ortho.height(); row += 5)
    for (int column = 2; column < map.ortho.width(); column += 5) {
      if (map.ortho.valid.at(column, row) == 0) continue;
      const double x = map.ortho.geo.x_at(column + 0.5);
      const double y = map.ortho.geo.y_at(row + 0.5);
      const PixelCoordinate cell = map.surface.geo.pixel_at(x, y);
      const int c = static_cast<int>(cell.column);
      const int r = static_cast<int>(cell.row);
      if (!map.surface.height_m.contains(c, r)) continue;
      const double z = map.surface.height_m.at(c, r);
      if (!std::isfinite(z)) continue;
      const PhotoPose& pose = map.poses[map.source.at(column, row)];
      const auto pixel = project_row_by_row(
          pose.camera, pose.map_from_camera.rotation.inverse().toRotationMatrix(),
          Eigen::Vector3d(x, y, z) - pose.map_from_camera.translation, pose.flown_in_readout);
      if (!pixel) continue;
      const auto photo = std::find_if(flight.set.photos.begin(), flight.set.photos.end(),
                                      [&](const auto& p) { return p.name == pose.name; });
      const auto n = static_cast<std::size_t>(photo - flight.set.photos.begin());
      const Eigen::Vector3d centre =
          flight.truth[n].translation + readout_share(flight.camera, pixel->y()) * flight.flown[n];
      const Eigen::Vector3d p =
          flight.terrain->meet(centre, flight.truth[n].rotation * flight.camera.ray(*pixel));
      shown.emplace_back(x, y);
      real.emplace_back(p.x(), p.y());
      heights.emplace_back(p.x(), p.y(), z - p.z());
    }
  MapError error;
  error.pixels = static_cast<int>(shown.size());
  if (shown.size() < 10) return error;
  const auto n = static_cast<double>(shown.size());
  Complex shown_mean{};
  Complex real_mean{};
  for (std::size_t k = 0; k < shown.size(); ++k) {
    shown_mean += shown[k] / n;
    real_mean += real[k] / n;
  }
  Complex cross{};
  double norm = 0.0;
  for (std::size_t k = 0; k < shown.size(); ++k) {
    cross += std::conj(real[k] - real_mean) * (shown[k] - shown_mean);
    norm += std::norm(real[k] - real_mean);
  }
  const Complex fit = cross / norm;
  error.scale_error = std::abs(fit) - 1.0;
  const Complex shift = shown_mean - real_mean;
  error.shift_m = {shift.real(), shift.imag()};
  for (std::size_t k = 0; k < shown.size(); ++k) {
    error.relative_rms_m += std::norm(shown[k] - shown_mean - fit * (real[k] - real_mean)) / n;
    error.absolute_rms_m += std::norm(shown[k] - real[k]) / n;
  }
  error.relative_rms_m = std::sqrt(error.relative_rms_m);
  error.absolute_rms_m = std::sqrt(error.absolute_rms_m);

  // dz = a + b x + c y + d r^2: d times the square of the block's half diagonal is the bowl.
  Eigen::Matrix4d a = 1e-9 * Eigen::Matrix4d::Identity();
  Eigen::Vector4d b = Eigen::Vector4d::Zero();
  double farthest = 0.0;
  for (const Eigen::Vector3d& h : heights) {
    const double x = h.x() - real_mean.real();
    const double y = h.y() - real_mean.imag();
    const Eigen::Vector4d rows{1.0, x, y, x * x + y * y};
    farthest = std::max(farthest, rows[3]);
    a += rows * rows.transpose();
    b += rows * h.z();
  }
  const Eigen::Vector4d bowl = a.ldlt().solve(b);
  error.bowl_m = bowl[3] * farthest;
  for (const Eigen::Vector3d& h : heights) {
    const double x = h.x() - real_mean.real();
    const double y = h.y() - real_mean.imag();
    const double rest = h.z() - bowl[0] - bowl[1] * x - bowl[2] * y;
    error.height_rms_m += rest * rest / n;
  }
  error.height_rms_m = std::sqrt(error.height_rms_m);
  return error;
}

}  // namespace nadir::test
