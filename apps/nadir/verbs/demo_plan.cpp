// SPDX-License-Identifier: Apache-2.0
#include "verbs/demo_plan.hpp"

#include <fmt/format.h>

#include "nadir/aerial_mapping/mapping.hpp"

namespace nadir::cli {
namespace {

/// The frame from which on the robot is localized. Its cameras look ahead: the local map, 18 m
/// wide, is filled when the robot has driven half of that, 0.8 m a frame. Until then it shows a
/// wedge of road, which fits many places along it.
constexpr int kFirstFrame = 12;

/// How much of a site is made.
struct Extent {
  int photos;
  int frames;
  std::vector<std::string> more;  ///< options of `nadir simulate`
};

Extent whole() { return {30, 60, {}}; }

/// A smaller campus, and smaller images.
Extent quick_one() {
  return {
      8,
      24,
      {"--set", "simulation.width_m=90", "--set", "simulation.depth_m=70", "--set",
       "simulation.flight_image_width=1000", "--set", "simulation.flight_image_height=750", "--set",
       "simulation.flight_focal_px=780", "--set", "simulation.stereo_image_width=480", "--set",
       "simulation.stereo_image_height=360", "--set", "simulation.stereo_focal_px=285"}};
}

std::vector<std::string> simulate(const std::string& out, const Extent& extent,
                                  const std::string& seed) {
  std::vector<std::string> arguments{"simulate",
                                     "-o",
                                     out + "/site",
                                     "--gps",
                                     "rtk",
                                     "--photos",
                                     std::to_string(extent.photos),
                                     "--frames",
                                     std::to_string(extent.frames),
                                     "--seed",
                                     seed};
  arguments.insert(arguments.end(), extent.more.begin(), extent.more.end());
  return arguments;
}

}  // namespace

const std::vector<DemoMethod>& demo_methods() {
  static const std::vector<DemoMethod> methods{
      {"ncc+PF", "run_ncc", {"--preset", "paper", "--score", "ncc"}},
      {"wncc+PF", "run_wncc", {"--preset", "paper"}},
      {"height", "run_height", {"--layers", "height"}},
      {"colour", "run_colour", {"--layers", "colour"}},
      {"default", "run", {}}};
  return methods;
}

DemoPlan plan_demo(const std::string& out, bool quick, std::uint64_t seed) {
  const Extent extent = quick ? quick_one() : whole();
  const std::string seed_text = std::to_string(seed);
  DemoPlan plan;
  plan.steps.push_back({"simulate", simulate(out, extent, seed_text)});
  plan.map = out + "/campus.tif";
  std::string surface = out + "/campus.surface.tif";
  if (can_solve_poses()) {
    plan.steps.push_back({"map", {"map", out + "/site/photos", "-o", plan.map}});
  } else {
    plan.stand_ins.emplace_back("map");
    plan.map = out + "/site/truth/map.tif";
    surface = out + "/site/truth/surface.tif";
  }
  plan.steps.push_back({"ground",
                        {"ground", out + "/site/stereo", "-o", out + "/drive", "--map", plan.map,
                         "--surface", surface}});
  plan.steps.push_back({"match",
                        {"match", out + "/drive", "--frame", std::to_string(extent.frames - 1),
                         "-o", out + "/match"}});
  for (const DemoMethod& method : demo_methods()) {
    const std::string run = out + "/" + method.folder;
    DemoStep step{"localize",
                  {"localize", out + "/drive", "-o", run, "--frames",
                   fmt::format("{}:{}", kFirstFrame, extent.frames - 1), "--prior", "truth",
                   "--seed", seed_text}};
    step.arguments.insert(step.arguments.end(), method.options.begin(), method.options.end());
    step.is_nadirs_own = &method == &demo_methods().back();
    plan.steps.push_back(std::move(step));
    plan.steps.push_back({"eval",
                          {"eval", run + "/trajectory.tum", "--truth", out + "/drive/truth.tum"},
                          &method == &demo_methods().back()});
  }
  plan.steps.push_back({"report", {"report", out}});
  return plan;
}

}  // namespace nadir::cli
