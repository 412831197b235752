// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/scene/things.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "nadir/core/angle.hpp"
#include "nadir/core/random.hpp"

namespace nadir::simulation {
namespace {

using Rgb = Eigen::Vector3f;

constexpr double kUnderground = 1.0;  ///< how deep walls reach, so that none floats on a slope

// Streams of random numbers; the number of the thing is added.
constexpr std::uint64_t kBuildingStream = 10'000;
constexpr std::uint64_t kTreeStream = 20'000;
constexpr std::uint64_t kBarrierStream = 30'000;

std::uint32_t next_number(const std::vector<Solid>& solids) {
  return solids.empty() ? 1U : solids.back().number + 1U;
}

Block block_on(const Area& plan, double bottom, double top) {
  Block block;
  block.centre = plan.centre;
  block.yaw = plan.yaw;
  block.half_length = plan.half_length;
  block.half_width = plan.half_width;
  block.bottom = bottom;
  block.top = top;
  return block;
}

void add_flat_roof(const Building& building, double eaves, const RandomStream& random,
                   std::uint32_t number, std::vector<Solid>& solids) {
  // A parapet of four low walls, and boxes of machinery and skylights within it.
  const Area& plan = building.plan;
  for (int side = 0; side < 4; ++side) {
    const bool along = side < 2;
    const double sign = (side & 1) != 0 ? 1.0 : -1.0;
    Area wall = plan;
    const double offset = (along ? plan.half_width : plan.half_length) - 0.15;
    wall.centre = plan.place(along ? Eigen::Vector2d(0.0, sign * offset)
                                   : Eigen::Vector2d(sign * offset, 0.0));
    (along ? wall.half_width : wall.half_length) = 0.15;
    Block block = block_on(wall, eaves - 0.1, eaves + 0.45);
    block.roof = Material::kMetal;
    block.sides = Material::kPlaster;
    solids.push_back(make_block(block, {0.42F, 0.41F, 0.39F}, number));
  }
  const auto boxes = static_cast<std::uint64_t>(2.0 + plan.half_length * plan.half_width / 16.0);
  for (std::uint64_t i = 0; i < boxes; ++i) {
    Area box = plan;
    box.centre = plan.place({random.uniform(20 + 4 * i, -0.75, 0.75) * plan.half_length,
                             random.uniform(21 + 4 * i, -0.7, 0.7) * plan.half_width});
    box.half_length = random.uniform(22 + 4 * i, 0.4, 1.3);
    box.half_width = random.uniform(23 + 4 * i, 0.35, 0.9);
    const bool skylight = (i & 1U) != 0;
    Block block = block_on(box, eaves - 0.1, eaves + (skylight ? 0.3 : 0.9));
    block.sides = Material::kMetal;
    block.roof = skylight ? Material::kGlass : Material::kMetal;
    solids.push_back(make_block(block, {0.38F, 0.39F, 0.40F}, number));
  }
}

}  // namespace

void add_building(const Building& building, double ground, std::uint64_t seed,
                  std::vector<Solid>& solids) {
  static const std::array<Rgb, 6> wall_colours{Rgb(0.50F, 0.46F, 0.38F), Rgb(0.42F, 0.20F, 0.13F),
                                               Rgb(0.55F, 0.53F, 0.50F), Rgb(0.45F, 0.36F, 0.24F),
                                               Rgb(0.36F, 0.38F, 0.40F), Rgb(0.35F, 0.17F, 0.12F)};
  const RandomStream random(seed, kBuildingStream + building.look);
  const std::uint32_t number = next_number(solids);
  const std::size_t look = building.look % wall_colours.size();
  const Material wall = look == 1 || look == 5 ? Material::kBrick : Material::kPlaster;
  const double eaves = ground + building.height;
  Block body = block_on(building.plan, ground - kUnderground, eaves);
  body.sides = wall;
  body.roof = Material::kFlatRoof;
  Solid walls = make_block(body, wall_colours[look], number);
  walls.floor = ground;
  solids.push_back(walls);
  if (!building.gable) {
    add_flat_roof(building, eaves, random, number, solids);
    return;
  }
  Area roof = building.plan;
  roof.half_length += 0.35;
  roof.half_width += 0.45;
  const double ridge = 0.75 * roof.half_width;
  Block gable = block_on(roof, eaves - 0.15, eaves + ridge);
  gable.sides = wall;
  gable.roof = Material::kTiles;
  const Rgb tiles = random.uniform(1) < 0.6 ? Rgb(0.30F, 0.115F, 0.07F) : Rgb(0.12F, 0.11F, 0.11F);
  solids.push_back(make_gable(gable, tiles, number));
  Area chimney = building.plan;
  chimney.centre = building.plan.place(
      {random.uniform(2, -0.6, 0.6) * building.plan.half_length, 0.35 * building.plan.half_width});
  chimney.half_length = chimney.half_width = 0.35;
  Block stack = block_on(chimney, eaves, eaves + ridge + 0.6);
  stack.sides = Material::kBrick;
  solids.push_back(make_block(stack, wall_colours[1], number));
}

void add_tree(const Tree& tree, double ground, std::uint64_t seed, std::vector<Solid>& solids) {
  const RandomStream random(seed, kTreeStream + tree.number);
  const std::uint32_t number = next_number(solids);
  const double crown_height = std::min(0.72 * tree.height, 2.4 * tree.crown);
  const double middle = ground + tree.height - 0.5 * crown_height;
  solids.push_back(make_post(tree.at, 0.05 + 0.02 * tree.height, ground - 0.2, middle,
                             Material::kBark, {0.12F, 0.095F, 0.07F}, number));
  const auto tint = static_cast<float>(random.uniform(900, -1.0, 1.0));
  const Rgb colour(0.066F + 0.024F * tint, 0.108F + 0.014F * tint, 0.032F + 0.004F * tint);
  const double lean_x = random.uniform(901, -0.12, 0.12) * tree.crown;
  const double lean_y = random.uniform(902, -0.12, 0.12) * tree.crown;
  constexpr std::size_t kSectors = 4;  // parts of a crown, each with a box of its own
  std::array<std::vector<Puff>, kSectors> sectors;
  constexpr std::uint64_t kPuffs = 52;
  for (std::uint64_t i = 0; i < kPuffs; ++i) {
    // Spread over a ball (golden angle), then pushed about: no two crowns are alike.
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(kPuffs);
    const double z = 1.0 - 1.8 * share + random.uniform(5 * i, -0.15, 0.15);
    const double angle = 2.39996 * static_cast<double>(i) + random.uniform(5 * i + 1, -0.6, 0.6);
    const double flat = std::sqrt(std::max(0.05, 1.0 - z * z));
    const double out = random.uniform(5 * i + 2, 0.40, 0.92);
    const double size = random.uniform(5 * i + 3, 0.17, 0.36) * tree.crown;
    Puff puff;
    puff.centre = {tree.at.x() + lean_x * z + out * flat * tree.crown * std::cos(angle),
                   tree.at.y() + lean_y * z + out * flat * tree.crown * std::sin(angle),
                   middle + 0.5 * out * 1.15 * z * crown_height};
    puff.radius = {size, size, random.uniform(5 * i + 4, 0.6, 0.9) * size};
    const double turn = angle / (2.0 * kPi);
    const auto sector = static_cast<std::size_t>((turn - std::floor(turn)) * kSectors);
    sectors[std::min(sector, kSectors - 1)].push_back(puff);
  }
  // The middle is dense: no ray passes a whole crown unhindered.
  const double core = 0.55 * tree.crown;
  sectors[0].push_back({{tree.at.x(), tree.at.y(), middle}, {core, core, 0.36 * crown_height}});
  for (const std::vector<Puff>& puffs : sectors) {
    if (!puffs.empty()) solids.push_back(make_puffs(puffs, colour, number));
  }
}

void add_barrier(const Barrier& barrier, double ground, std::uint64_t seed,
                 std::vector<Solid>& solids) {
  const Area& plan = barrier.plan;
  const std::uint32_t number = next_number(solids);
  if (!barrier.hedge) {
    Block block = block_on(plan, ground - kUnderground, ground + barrier.height);
    block.sides = Material::kBrick;
    Solid wall = make_block(block, {0.36F, 0.22F, 0.15F}, number);
    wall.floor = ground;
    solids.push_back(wall);
    return;
  }
  const RandomStream random(seed, kBarrierStream + plan.number);
  const auto count = static_cast<std::uint64_t>(std::max(2.0, plan.half_length / 0.28));
  std::vector<Puff> puffs;
  for (std::uint64_t i = 0; i < count; ++i) {
    const double along = (2.0 * (static_cast<double>(i) + 0.5) / static_cast<double>(count) - 1.0) *
                         plan.half_length;
    const double size = random.uniform(3 * i, 0.95, 1.2) * plan.half_width;
    const Eigen::Vector2d at = plan.place({along, random.uniform(3 * i + 1, -0.08, 0.08)});
    Puff puff;
    puff.centre = {at.x(), at.y(), ground + 0.5 * barrier.height};
    puff.radius = {std::max(size, 0.4), std::max(size, 0.4),
                   random.uniform(3 * i + 2, 0.52, 0.62) * barrier.height};
    puffs.push_back(puff);
    if (puffs.size() == 12 || i + 1 == count) {  // short pieces: a ray asks few puffs
      solids.push_back(make_puffs(puffs, {0.045F, 0.085F, 0.028F}, number));
      puffs.clear();
    }
  }
}

void add_post(const Post& post, double ground, std::vector<Solid>& solids) {
  const std::uint32_t number = next_number(solids);
  const Rgb grey(0.20F, 0.21F, 0.22F);
  solids.push_back(
      make_post(post.at, 0.07, ground - 0.2, ground + post.height, Material::kMetal, grey, number));
  const Eigen::Vector2d arm(std::cos(post.yaw), std::sin(post.yaw));
  Block lamp;
  lamp.centre = post.at + 0.6 * arm;
  lamp.yaw = post.yaw;
  lamp.half_length = 0.75;
  lamp.half_width = 0.09;
  lamp.bottom = ground + post.height - 0.12;
  lamp.top = ground + post.height;
  lamp.sides = lamp.roof = Material::kMetal;
  solids.push_back(make_block(lamp, grey, number));
}

void add_car(const Car& car, std::vector<Solid>& solids) {
  static const std::array<Rgb, 8> paints{Rgb(0.60F, 0.60F, 0.60F),  Rgb(0.030F, 0.032F, 0.036F),
                                         Rgb(0.36F, 0.37F, 0.39F),  Rgb(0.16F, 0.17F, 0.18F),
                                         Rgb(0.35F, 0.035F, 0.03F), Rgb(0.04F, 0.09F, 0.26F),
                                         Rgb(0.55F, 0.56F, 0.53F),  Rgb(0.07F, 0.14F, 0.10F)};
  const RandomStream random(car.seed, 1);
  const std::uint32_t number = next_number(solids);
  const Rgb& paint =
      paints[static_cast<std::size_t>(random.uniform(0) * static_cast<double>(paints.size()))];
  const double length = random.uniform(1, 3.9, 4.8);
  const double width = random.uniform(2, 1.72, 1.86);
  const double height = random.uniform(3, 1.42, 1.62);
  const bool van = random.uniform(4) < 0.2;
  const Eigen::Vector2d forward(std::cos(car.yaw), std::sin(car.yaw));
  const Eigen::Vector2d left(-forward.y(), forward.x());

  Block body;
  body.centre = car.at;
  body.yaw = car.yaw;
  body.half_length = 0.5 * length;
  body.half_width = 0.5 * width;
  body.bottom = car.ground + 0.2;
  body.top = car.ground + 0.56 * height;
  body.inset_front = 0.12;
  body.inset_back = 0.06;
  body.inset_side = 0.05;
  body.sides = body.roof = Material::kCarPaint;
  solids.push_back(make_block(body, paint, number));

  Block cabin = body;
  cabin.half_length = (van ? 0.40 : 0.31) * length;
  cabin.centre = car.at - (van ? 0.06 : 0.05) * length * forward;
  cabin.half_width = 0.5 * width - 0.05;
  cabin.bottom = body.top - 0.01;
  cabin.top = car.ground + height;
  cabin.inset_front = 0.17 * length;
  cabin.inset_back = van ? 0.12 : 0.55;
  cabin.inset_side = 0.17;
  cabin.sides = Material::kGlass;
  cabin.roof = Material::kCarPaint;
  solids.push_back(make_block(cabin, paint, number));

  for (const double end : {-1.0, 1.0}) {
    for (const double side : {-1.0, 1.0}) {
      Block wheel;
      wheel.centre = car.at + end * 0.31 * length * forward + side * (0.5 * width - 0.1) * left;
      wheel.yaw = car.yaw;
      wheel.half_length = 0.3;
      wheel.half_width = 0.12;
      wheel.bottom = car.ground - 0.05;
      wheel.top = car.ground + 0.6;
      wheel.inset_front = wheel.inset_back = 0.12;
      wheel.sides = wheel.roof = Material::kRubber;
      solids.push_back(make_block(wheel, {0.02F, 0.02F, 0.02F}, number));
    }
  }
}

}  // namespace nadir::simulation
