// SPDX-License-Identifier: Apache-2.0
#include "peers/tasks.hpp"

#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "nadir/core/random.hpp"
#include "peers/baselines.hpp"

namespace nadir::bench {
namespace {

constexpr int kHeadings = 120;

struct Difference {
  double largest = 0.0;
  double squares = 0.0;
  std::size_t count = 0;
  void add(double a, double b) {
    if (std::isnan(a) || std::isnan(b)) return;
    largest = std::max(largest, std::abs(a - b));
    squares += (a - b) * (a - b);
    ++count;
  }
  double rms() const { return count == 0 ? 0.0 : std::sqrt(squares / static_cast<double>(count)); }
};

MatchingOptions options_of(Score score, Channel channel = Channel::kAuto) {
  MatchingOptions options;
  options.score = score;
  options.channel = channel;
  return options;
}

PixelWindow whole(const MapIndex& map) {
  return {0, 0, map.channel().value.width(), map.channel().value.height()};
}

/// Our surfaces at one heading.
ScoreSurface ours(const MapIndex& map, const RotatedTemplate& local, const PixelWindow& window) {
  return cpu_backend().score_surfaces(map, std::span(&local, 1), window).front();
}

tbb::global_control threads(std::size_t count) {
  return {tbb::global_control::max_allowed_parallelism, count};
}

/// Of `fast`, on every 37th position, to the reference in double.
Difference to_reference(const MapIndex& map, const RotatedTemplate& local,
                        const PixelWindow& window, const ScoreSurface& fast) {
  Difference difference;
  for (int row = 5; row < window.height; row += 37) {
    for (int column = 3; column < window.width; column += 37) {
      const auto slow = reference_backend().score_surfaces(
          map, std::span(&local, 1), {window.left + column, window.top + row, 1, 1});
      difference.add(fast.score.at(column, row), slow.front().score.at(0, 0));
    }
  }
  return difference;
}

}  // namespace

Timings table_one(const Scene& scene, const Effort& effort) {
  const MapIndex map(scene.map, options_of(Score::kWncc));
  MatchingOptions every = map.options();
  every.min_valid_weight = 0.01;  // the loops know no least overlap
  const MapIndex loose(scene.map, every);
  const Template local = make_template(scene.local, every);
  const RotatedTemplate turned =
      rotate_template(local.channel, 0.0, every.resolution_m, pixel_role(every));
  const ChannelImage& channel = loose.channel();
  const ChannelImage& image = local.channel;
  // The robot's pixel where the template's first pixel is the map's first.
  const PixelWindow window{-turned.left, -turned.top,
                           channel.value.width() - image.value.width() + 1,
                           channel.value.height() - image.value.height() + 1};
  const int stride = effort.brute_force_stride;
  const double positions = static_cast<double>(window.width) * window.height;
  const double share =
      positions / static_cast<double>(brute_force_positions(channel, image, stride));

  std::vector<Contender> contenders;
  const auto surface = ours(loose, turned, window);
  Difference difference;
  const std::vector<double> slow = brute_force(BruteForce::kWncc, channel, image, stride);
  std::size_t next = 0;
  // An even template turned by 0 lies on half pixels: then its pixels are means of four, and the
  // loops over the unturned template differ. Compared with the reference as well.
  for (int row = 0; row < window.height; row += stride) {
    for (int column = 0; column < window.width; column += stride, ++next) {
      if (turned.value.same_size(image.value)) {
        difference.add(surface.score.at(column, row), slow[next]);
      }
    }
  }
  const Difference exact = to_reference(loose, turned, window, surface);
  contenders.push_back(
      {"ours", [&] { ours(loose, turned, window); }, exact.largest, exact.rms(), 1e-4});
  // The paper's own form, which is not one correlation: level sets.
  MatchingOptions of_paper;
  of_paper.score = Score::kWnccPaper;
  of_paper.paper_weight = PaperWeight::kNormalised;
  const MapIndex paper_map(scene.map, of_paper);
  const RotatedTemplate square =
      rotate_template(local.channel, 0.0, of_paper.resolution_m, pixel_role(of_paper));
  const Difference level_sets =
      to_reference(paper_map, square, window, ours(paper_map, square, window));
  contenders.push_back({"ours_wncc_paper", [&] { ours(paper_map, square, window); },
                        level_sets.largest, level_sets.rms(), 1e-6});
  const std::pair<const char*, BruteForce> loops[] = {
      {"sad_brute_force", BruteForce::kSad},
      {"ssd_brute_force", BruteForce::kSsd},
      {"ncc_brute_force", BruteForce::kNcc},
      {"wncc_brute_force", BruteForce::kWncc},
      {"wncc_brute_force_weight_table", BruteForce::kWnccTable}};
  for (const auto& [name, score] : loops) {
    contenders.push_back(
        {name,
         [&channel, &image, stride, which = score] { brute_force(which, channel, image, stride); },
         std::nullopt, std::nullopt, 0.0, share});
  }
  if (difference.count > 0) {
    const auto loop = std::find_if(contenders.begin(), contenders.end(), [](const auto& contender) {
      return contender.name == std::string("wncc_brute_force");
    });
    loop->max_abs_diff = difference.largest;
    loop->rms_diff = difference.rms();
    loop->allowed_diff = 1e-4;
  }
  contenders.push_back(
      {"opencv_masked", [&] { opencv_coeff(channel, turned, true); }, std::nullopt, std::nullopt});
  contenders.push_back({"opencv_unmasked", [&] { opencv_coeff(channel, turned, false); },
                        std::nullopt, std::nullopt});
  const auto one = threads(1);
  return contest("table_1", contenders, "ours", effort.rounds);
}

Timings whole_map(const Scene& scene, const Effort& effort) {
  const MapIndex map(scene.map, options_of(Score::kZwncc));
  const Template local = make_template(scene.local, map.options());
  const RotatedTemplate turned = rotate_template(
      local.channel, scene.truth.yaw, map.options().resolution_m, pixel_role(map.options()));
  const PixelWindow window = whole(map);
  const double least = map.options().min_valid_weight;
  const ScoreSurface surface = ours(map, turned, window);
  const Difference exact = to_reference(map, turned, window, surface);
  const ScoreSurface six = six_ccorr(map.channel(), turned, least, map.mean_grey());
  const Raster<float> masked = opencv_coeff(map.channel(), turned, true);
  Difference of_six, of_masked;
  for (int row = 0; row < window.height; ++row) {
    for (int column = 0; column < window.width; ++column) {
      of_six.add(surface.score.at(column, row), six.score.at(column, row));
      // Without a mask for the map, only where all of it is valid.
      if (surface.valid_weight.at(column, row) >= 1.0F - 1e-6F) {
        of_masked.add(surface.score.at(column, row), masked.at(column, row));
      }
    }
  }
  std::vector<Contender> contenders = {
      {"ours", [&] { ours(map, turned, window); }, exact.largest, exact.rms(), 1e-4},
      {"opencv_masked", [&] { opencv_coeff(map.channel(), turned, true); },
       of_masked.count > 0 ? std::optional(of_masked.largest) : std::nullopt,
       of_masked.count > 0 ? std::optional(of_masked.rms()) : std::nullopt, 1e-2},
      {"six_ccorr", [&] { six_ccorr(map.channel(), turned, least, map.mean_grey()); },
       of_six.largest, of_six.rms(), 1e-2}};
  Timings timings;
  {
    const auto one = threads(1);
    timings = contest("whole_map", contenders, "ours", effort.rounds);
  }
  std::vector<Contender> wall = {{"ours_1_thread_wall",
                                  [&] {
                                    const auto one = threads(1);
                                    for (int i = 0; i < 5; ++i) ours(map, turned, window);
                                  },
                                  exact.largest, exact.rms(), 1e-4, 0.2, true},
                                 {"ours_2_threads_wall",
                                  [&] {
                                    const auto two = threads(2);
                                    for (int i = 0; i < 5; ++i) ours(map, turned, window);
                                  },
                                  exact.largest, exact.rms(), 1e-4, 0.2, true}};
  timings.merge(contest("whole_map", wall, "ours_1_thread_wall", effort.rounds));
  return timings;
}

Timings all_headings(const Scene& scene, const Effort& effort) {
  MatchingOptions options = options_of(Score::kZwncc);
  const SearchRegion region{.yaw_half_range_rad = kPi, .yaw_step_rad = 2.0 * kPi / kHeadings};
  options.search = Search::kCoarseToFine;
  const MapIndex map(scene.map, options);
  options.search = Search::kFull;
  const MapIndex full_map(scene.map, options);
  const Template local = make_template(scene.local, options);
  const RotatedTemplate turned =
      rotate_template(local.channel, scene.truth.yaw, options.resolution_m, pixel_role(options));
  const MatchResult found = match(map, local, region);
  const MatchResult full = match(full_map, local, region);
  // By how much the best place scores less than the full search's.
  const double lost = full.candidates.front().score - found.candidates.front().score;
  std::vector<Contender> contenders = {
      {"ours", [&] { match(map, local, region); }, std::max(lost, 0.0), std::nullopt, 5e-3},
      {"ours_full_search", [&] { match(full_map, local, region); }, 0.0, std::nullopt},
      // Every heading costs the same.
      {"opencv_masked", [&] { opencv_coeff(map.channel(), turned, true); }, std::nullopt,
       std::nullopt, 0.0, static_cast<double>(kHeadings)}};
  const auto one = threads(1);
  return contest("all_headings", contenders, "ours", std::max(effort.rounds / 2, 1));
}

Timings thousand_particles(const Scene& scene, const Effort& effort) {
  MatchingOptions options = options_of(Score::kZwncc);
  options.pose_scoring = PoseScoring::kSurface;
  const MapIndex map(scene.map, options);
  options.pose_scoring = PoseScoring::kExact;
  const MapIndex exact_map(scene.map, options);
  const Template local = make_template(scene.local, options);
  const RandomStream random(1, 1);
  std::vector<Pose2> poses;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    poses.push_back({scene.truth.x + random.uniform(3 * i, -5.0, 5.0),
                     scene.truth.y + random.uniform(3 * i + 1, -5.0, 5.0),
                     scene.truth.yaw + radians(random.uniform(3 * i + 2, -5.0, 5.0))});
  }
  const std::span<const Pose2> sample =
      std::span<const Pose2>(poses).first(std::min(effort.reference_poses, poses.size()));
  const auto reference = reference_backend().score_poses(map, local, sample);
  const auto by_surface = score_poses(map, local, poses);
  const auto exactly = score_poses(exact_map, local, poses);
  const auto authors = warp_and_loop(map.channel(), local.channel, poses, options.min_valid_weight);
  Difference surface, exact, warped;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    surface.add(by_surface[i].score, reference[i].score);
    exact.add(exactly[i].score, reference[i].score);
    warped.add(authors[i], reference[i].score);
  }
  std::vector<Contender> contenders = {
      {"ours_surface", [&] { score_poses(map, local, poses); }, surface.largest, surface.rms(),
       5e-2},
      {"ours_exact", [&] { score_poses(exact_map, local, poses); }, exact.largest, exact.rms(),
       3e-3},
      // On whole pixels: it differs by what half a pixel makes.
      {"authors_warp_and_loop",
       [&] { warp_and_loop(map.channel(), local.channel, poses, options.min_valid_weight); },
       warped.largest, warped.rms(), 1.0}};
  const auto one = threads(1);
  return contest("1000_particles", contenders, "ours_surface", std::max(effort.rounds / 2, 1));
}

int frames_lost(const std::filesystem::path& data, const std::vector<int>& frames) {
  const SearchRegion region{.yaw_half_range_rad = kPi, .yaw_step_rad = 2.0 * kPi / kHeadings};
  MatchingOptions options = options_of(Score::kZwncc);
  options.search = Search::kCoarseToFine;
  int lost = 0;
  std::optional<MapIndex> coarse, full;
  for (const int frame : frames) {
    const Scene scene = aeroground_scene(data, frame);
    if (!coarse) {
      coarse.emplace(scene.map, options);
      options.search = Search::kFull;
      full.emplace(scene.map, options);
    }
    const Template local = make_template(scene.local, options);
    const MatchResult quick = match(*coarse, local, region);
    const MatchResult slow = match(*full, local, region);
    if (slow.candidates.empty()) continue;
    const MatchCandidate& best = slow.candidates.front();
    const MatchCandidate found =
        quick.candidates.empty() ? MatchCandidate{{}, -1.0, 0.0} : quick.candidates.front();
    const double apart = std::hypot(found.map_from_robot.x - best.map_from_robot.x,
                                    found.map_from_robot.y - best.map_from_robot.y);
    const bool less = found.score < best.score - 1e-3;
    if (less && apart > 0.5) ++lost;
    if (less || apart > 0.1) {
      for (const MatchCandidate& other : quick.candidates) {
        const double off = std::hypot(other.map_from_robot.x - best.map_from_robot.x,
                                      other.map_from_robot.y - best.map_from_robot.y);
        if (off < 0.7) {
          std::fprintf(stderr, "  coarse to fine has %.4f at %.2f m from it, %.2f degrees\n",
                       other.score, off,
                       (other.map_from_robot.yaw - best.map_from_robot.yaw) * 180.0 / kPi);
        }
      }
      std::fprintf(stderr, "frame %d: full search %.4f, coarse to fine %.4f, %.2f m apart\n", frame,
                   best.score, found.score, apart);
    }
  }
  std::fprintf(stderr, "coarse to fine lost %d of %zu frames against the full search\n", lost,
               frames.size());
  return lost;
}

}  // namespace nadir::bench
