// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/scene/solid.hpp"

#include <cmath>

#include "nadir/core/angle.hpp"

namespace nadir::simulation {
namespace {

enum FrayLayer : std::uint32_t { kFray = 700, kFrayFine };

/// Whether leaves stop a ray at this place of a puff's skin: the skin is frayed, more so where it
/// is seen edge on.
bool leaves_at(const ValueNoise& noise, const Eigen::Vector3d& p, double facing) {
  const auto x = static_cast<float>(p.x());
  const auto y = static_cast<float>(p.y());
  const auto z = static_cast<float>(p.z());
  const float coarse = noise.at(x, y, z, 0.32F, kFray);
  const float fine = noise.at(x, y, z, 0.11F, kFrayFine);
  return 0.55F * coarse + 0.75F * fine + 1.0F * static_cast<float>(facing) > 0.22F;
}

std::optional<BodyHit> meet_faces(std::span<const Face> faces, const Eigen::Vector3d& origin,
                                  const Eigen::Vector3d& direction, double from, double to) {
  const Face* entered = nullptr;
  for (const Face& face : faces) {
    const double slope = face.normal.dot(direction);
    const double gap = face.offset - face.normal.dot(origin);
    if (slope == 0.0) {
      if (gap < 0.0) return std::nullopt;
      continue;
    }
    const double t = gap / slope;
    if (slope < 0.0) {
      if (t > from) {
        from = t;
        entered = &face;
      }
    } else {
      to = std::min(to, t);
    }
    if (from >= to) return std::nullopt;
  }
  if (entered == nullptr) return std::nullopt;
  return BodyHit{from, entered->normal, entered->material};
}

std::optional<BodyHit> meet_puffs(std::span<const Puff> puffs, const Eigen::Vector3d& origin,
                                  const Eigen::Vector3d& direction, double from, double to,
                                  const ValueNoise& noise) {
  const double speed = direction.norm();
  std::optional<BodyHit> best;
  for (const Puff& puff : puffs) {
    const Eigen::Vector3d o = (origin - puff.centre).cwiseQuotient(puff.radius);
    const Eigen::Vector3d d = direction.cwiseQuotient(puff.radius);
    const double a = d.squaredNorm();
    const double b = o.dot(d);
    const double root = b * b - a * (o.squaredNorm() - 1.0);
    if (root <= 0.0) continue;
    const double half = std::sqrt(root);
    for (const double t : {(-b - half) / a, (-b + half) / a}) {
      if (t <= from || t >= to) continue;
      const Eigen::Vector3d p = origin + t * direction;
      Eigen::Vector3d normal = (o + t * d).cwiseQuotient(puff.radius).normalized();
      const double facing = std::abs(normal.dot(direction)) / speed;
      if (!leaves_at(noise, p, facing)) continue;
      if (normal.dot(direction) > 0.0) normal = -normal;  // the far skin, seen from within
      to = t;
      best = BodyHit{t, normal, Material::kLeaves};
      break;
    }
  }
  return best;
}

Face face_through(const Eigen::Vector3d& normal, const Eigen::Vector3d& point, Material material) {
  const Eigen::Vector3d unit = normal.normalized();
  return {unit, unit.dot(point), material};
}

struct Axes {
  Eigen::Vector3d along;
  Eigen::Vector3d across;
  Eigen::Vector3d foot;
};

Axes axes_of(const Block& block) {
  const double c = std::cos(block.yaw);
  const double s = std::sin(block.yaw);
  return {{c, s, 0.0}, {-s, c, 0.0}, {block.centre.x(), block.centre.y(), block.bottom}};
}

Solid body_of(const Block& block, const Eigen::Vector3f& colour, std::uint32_t number) {
  const Axes axes = axes_of(block);
  Solid solid;
  solid.colour = colour;
  solid.number = number;
  solid.floor = block.bottom;
  solid.axis = axes.along.head<2>();
  for (const double u : {-1.0, 1.0}) {
    for (const double v : {-1.0, 1.0}) {
      const Eigen::Vector3d corner =
          axes.foot + u * block.half_length * axes.along + v * block.half_width * axes.across;
      solid.box.extend(corner);
      solid.box.extend(Eigen::Vector3d(corner.x(), corner.y(), block.top));
    }
  }
  solid.faces.push_back({-Eigen::Vector3d::UnitZ(), -block.bottom, block.sides});
  return solid;
}

}  // namespace

std::optional<BodyHit> Solid::meet(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                   double from, double to, const ValueNoise& noise) const {
  if (!faces.empty()) return meet_faces(faces, origin, direction, from, to);
  return meet_puffs(puffs, origin, direction, from, to, noise);
}

Solid make_block(const Block& block, const Eigen::Vector3f& colour, std::uint32_t number) {
  const Axes axes = axes_of(block);
  const double height = block.top - block.bottom;
  Solid solid = body_of(block, colour, number);
  const auto side = [&](const Eigen::Vector3d& outwards, double half, double inset) {
    solid.faces.push_back(face_through(height * outwards + inset * Eigen::Vector3d::UnitZ(),
                                       axes.foot + half * outwards, block.sides));
  };
  side(axes.along, block.half_length, block.inset_front);
  side(-axes.along, block.half_length, block.inset_back);
  side(axes.across, block.half_width, block.inset_side);
  side(-axes.across, block.half_width, block.inset_side);
  solid.faces.push_back({Eigen::Vector3d::UnitZ(), block.top, block.roof});
  return solid;
}

Solid make_gable(const Block& block, const Eigen::Vector3f& colour, std::uint32_t number) {
  const Axes axes = axes_of(block);
  const double height = block.top - block.bottom;
  Solid solid = body_of(block, colour, number);
  for (const double side : {-1.0, 1.0}) {
    solid.faces.push_back(
        face_through(height * side * axes.across + block.half_width * Eigen::Vector3d::UnitZ(),
                     axes.foot + side * block.half_width * axes.across, block.roof));
    solid.faces.push_back(face_through(
        side * axes.along, axes.foot + side * block.half_length * axes.along, block.sides));
  }
  return solid;
}

Solid make_post(const Eigen::Vector2d& at, double radius, double bottom, double top,
                Material material, const Eigen::Vector3f& colour, std::uint32_t number) {
  Solid solid = body_of({.centre = at,
                         .half_length = radius,
                         .half_width = radius,
                         .bottom = bottom,
                         .top = top,
                         .sides = material},
                        colour, number);
  const Eigen::Vector3d foot(at.x(), at.y(), bottom);
  for (int i = 0; i < 8; ++i) {
    const double angle = 0.25 * kPi * i;
    const Eigen::Vector3d outwards(std::cos(angle), std::sin(angle), 0.0);
    solid.faces.push_back(face_through(outwards, foot + radius * outwards, material));
  }
  solid.faces.push_back({Eigen::Vector3d::UnitZ(), top, material});
  return solid;
}

Solid make_puffs(std::vector<Puff> puffs, const Eigen::Vector3f& colour, std::uint32_t number) {
  Solid solid;
  solid.colour = colour;
  solid.number = number;
  for (const Puff& puff : puffs) {
    solid.box.extend(puff.centre - puff.radius);
    solid.box.extend(puff.centre + puff.radius);
  }
  solid.floor = solid.box.min().z();
  solid.puffs = std::move(puffs);
  return solid;
}

}  // namespace nadir::simulation
