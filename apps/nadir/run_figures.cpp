// SPDX-License-Identifier: Apache-2.0
#include "run_figures.hpp"

#include <tbb/parallel_for.h>

#include <functional>

#include "nadir/io/image.hpp"

namespace nadir::cli {
namespace {

Figure diagnostics(const RunFigures& figures) {
  Curve particles{"N_eff", {}, {}};
  Curve score{"best score", {}, {}};
  Curve valid{"valid weight", {}, {}};
  Curve mass{"cluster mass", {}, {}};
  for (const FrameRecord& record : figures.result.records) {
    const double seconds = record.estimate.stamp.seconds();
    for (Curve* curve : {&particles, &score, &valid, &mass}) curve->x.push_back(seconds);
    particles.y.push_back(record.estimate.effective_particles);
    score.y.push_back(record.estimate.best_score);
    valid.y.push_back(record.estimate.valid_weight);
    mass.y.push_back(record.estimate.cluster_mass);
  }
  return draw_panels({{"particles", {particles}}, {"score", {score}}, {"share", {valid, mass}}},
                     "stamp, s", figures.title);
}

Figure errors(const RunFigures& figures) {
  Curve position{"position error", {}, {}};
  Curve yaw{"yaw error", {}, {}};
  for (const PoseError& error : figures.evaluation->errors) {
    for (Curve* curve : {&position, &yaw}) curve->x.push_back(error.stamp.seconds());
    position.y.push_back(error.translation_m);
    yaw.y.push_back(degrees(error.yaw_rad));
  }
  return draw_panels({{"error, m", {position}}, {"yaw error, deg", {yaw}}}, "stamp, s",
                     figures.title);
}

/// First, middle and last: more rows than a screen has are not looked at.
std::vector<Comparison> comparisons_of(const RunResult& result) {
  const std::vector<Comparison>& all = result.comparisons;
  if (all.size() <= 3) return all;
  return {all.front(), all[all.size() / 2], all.back()};
}

}  // namespace

Trajectory odometry_alone(const Odometry& odometry, const RunResult& result,
                          const Trajectory& truth) {
  const Trajectory estimated = result.trajectory();
  const auto& first = truth.empty() ? estimated.front() : truth.front();
  Trajectory alone;
  std::optional<Transform2<frames::Map, frames::Odom>> map_from_odom;
  for (const auto& [stamp, odom_from_robot] : odometry) {
    if (stamp < first.stamp || stamp > estimated.back().stamp) continue;
    if (!map_from_odom) map_from_odom = first.pose * odom_from_robot.inverse();
    alone.push_back({stamp, *map_from_odom * odom_from_robot});
  }
  return alone;
}

std::vector<std::string> draw_run(const std::filesystem::path& folder, const RunFigures& figures,
                                  const StopToken& stop) {
  std::vector<Track> tracks{{"estimate", figures.result.trajectory()}};
  if (!figures.truth.empty()) tracks.push_back({"truth", figures.truth});
  if (!figures.odometry.empty()) tracks.push_back({"odometry alone", figures.odometry});
  struct Picture {
    std::string name;
    std::function<Figure()> draw;
  };
  std::vector<Picture> pictures{
      {"trajectory.png", [&] { return draw_trajectories(figures.map, tracks, figures.title); }},
      {"swarm.png", [&] { return draw_swarms(figures.map, figures.result.swarms, figures.title); }},
      {"comparison.png",
       [&] {
         return draw_comparisons(figures.map, comparisons_of(figures.result), figures.title);
       }},
      {"coverage.png",
       [&] { return draw_coverage(figures.map, figures.result.seen, figures.title); }},
      {"diagnostics.png", [&] { return diagnostics(figures); }},
  };
  if (figures.evaluation != nullptr) {
    pictures.push_back({"error.png", [&] { return errors(figures); }});
  }
  tbb::parallel_for(std::size_t{0}, pictures.size(), [&](std::size_t k) {
    stop.check();
    write_png(folder / pictures[k].name, pictures[k].draw());
  });
  std::vector<std::string> names;
  for (const Picture& picture : pictures) names.push_back(picture.name);
  return names;
}

}  // namespace nadir::cli
