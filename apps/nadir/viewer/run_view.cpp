// SPDX-License-Identifier: Apache-2.0
#include "viewer/run_view.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "nadir/core/error.hpp"
#include "nadir/io/base64.hpp"
#include "nadir/io/maps/metric_frame.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"
#include "nadir/pipelines/site.hpp"
#include "run_record.hpp"

namespace nadir::cli {
namespace {

namespace fs = std::filesystem;

/// How far around the estimate a heat map looks.
constexpr double kHeatHalfSize = 8.0;
/// Frames copied while the run cannot add one: microseconds.
constexpr std::ptrdiff_t kCopiedAtATime = 256;

EncodedImage encode_png(const cv::Mat& image) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", image, bytes, {cv::IMWRITE_PNG_COMPRESSION, 1});
  return {"image/png", {bytes.begin(), bytes.end()}};
}

/// Blue, green, red, alpha.
cv::Mat with_alpha(const Orthomosaic& ortho) {
  cv::Mat image(ortho.height(), ortho.width(), CV_8UC4);
  const int channels = ortho.image.channels();
  for (int row = 0; row < ortho.height(); ++row) {
    for (int column = 0; column < ortho.width(); ++column) {
      const auto value = [&](int channel) {
        return ortho.image.at(column, row, channels == 3 ? channel : 0);
      };
      const bool seen = ortho.valid.at(column, row) != 0;
      image.at<cv::Vec4b>(row, column) =
          cv::Vec4b(value(2), value(1), value(0), seen ? std::uint8_t{255} : std::uint8_t{0});
    }
  }
  return image;
}

/// Longitude and latitude (degrees) of the map's corners NW, NE, SW, SE; null where the map says no
/// reference system, or one that is not on the Earth. Between them a page interpolates: over a
/// kilometre of UTM that is right to 2 cm.
Json corners_on_earth(const MapTiles& tiles) {
  const GeoReference& geo = tiles.geo();
  if (geo.crs.empty()) return nullptr;
  const double east = geo.west + tiles.width() * geo.resolution;
  const double south = geo.north - tiles.height() * geo.resolution;
  try {
    const GeodeticReader reader(geo.crs, "map");
    Json corners = Json::array();
    for (const auto& [x, y] : {std::pair{geo.west, geo.north}, std::pair{east, geo.north},
                               std::pair{geo.west, south}, std::pair{east, south}}) {
      const GeodeticPosition corner = reader.read(x, y, 0.0, "map");
      corners.push_back({corner.longitude_deg, corner.latitude_deg});
    }
    return corners;
  } catch (const Error&) {  // a local system: metres alone are shown
    return nullptr;
  }
}

fs::path source(const Json& manifest, const char* role, const fs::path& given,
                const fs::path& run) {
  fs::path named = !given.empty() ? given : source_in(manifest, role);
  if (!named.empty() && fs::exists(named)) return named;
  const std::string what =
      named.empty() ? std::string("does not say where its ") + role + " is"
                    : std::string("its ") + role + " " + named.string() + " is not there any more";
  throw Error(ErrorKind::kInput, what, run.string(), std::string("give --") + role);
}

/// The site of a run; empty of one that mapped its drive on the way and kept no local maps.
fs::path site_of(const Json& manifest, const fs::path& given, const fs::path& run) {
  const bool drive = manifest.value("sources", Json::object()).contains("drive");
  return given.empty() && drive ? fs::path{} : source(manifest, "site", given, run);
}

/// The matching options of the run; one that this version does not know is left at its default.
LocalizerOptions options_of(const Json& manifest) {
  LocalizerOptions options;
  OptionTable table = option_table(options);
  const Json values = manifest.value("options", Json::object());
  for (const auto& [name, entry] : values.items()) {
    if (table.find(name) == nullptr || !entry.contains("value")) continue;
    table.set(name, option_text(entry["value"]));
  }
  return options;
}

}  // namespace

RunView::RunView(RunSources sources, const LocalizerOptions& options, fs::path particle_file,
                 bool live)
    : sources_(std::move(sources)),
      sequence_(sources_.site.empty() ? Sequence{} : read_sequence(sources_.site)),
      options_(options),
      particle_file_(std::move(particle_file)),
      tiles_(std::make_unique<MapTiles>(sources_.map)),
      live_(live) {}

std::unique_ptr<RunView> RunView::open(const fs::path& run, RunSources sources) {
  if (!fs::is_directory(run)) {
    throw Error(ErrorKind::kInput, "no such folder", run.string(),
                "give a folder that `nadir localize` wrote");
  }
  const Json manifest = read_manifest(run);
  sources.site = site_of(manifest, sources.site, run);
  sources.map = source(manifest, "map", sources.map, run);
  const fs::path folder = first_run_in(run);
  auto view =
      std::make_unique<RunView>(sources, options_of(manifest), folder / "particles.bin", false);
  if (sources.site.empty()) {
    const fs::path drive = source_in(manifest, "drive");
    view->sequence_.name = (drive / "").parent_path().filename().string();
  }
  const Json settings{{"version", manifest.value("version", "")},
                      {"arguments", manifest.value("arguments", Json::array())},
                      {"started", manifest.value("started", "")},
                      {"seed", manifest.value("seed", 0U)},
                      {"threads", manifest.value("threads", 0)},
                      {"options", manifest.value("options", Json::object())}};
  view->settings_ = json_text(settings);
  for (ViewFrame& frame : read_view_frames(folder)) {
    frame.truth = truth_at(view->sequence_, frame.stamp);
    view->add(std::move(frame));
  }
  return view;
}

void RunView::add(ViewFrame frame) {
  // At once, and not when first asked: the file of a live run changes its name when the run ends.
  std::unique_ptr<ParticleLogReader> opened;
  if (particle_log() == nullptr && fs::exists(particle_file_)) {
    opened = std::make_unique<ParticleLogReader>(particle_file_);
  }
  const std::scoped_lock lock(mutex_);
  if (particles_ == nullptr) particles_ = std::move(opened);
  frames_.push_back(std::move(frame));
}

void RunView::finish() {
  const std::scoped_lock lock(mutex_);
  live_ = false;
}

bool RunView::live() const {
  const std::scoped_lock lock(mutex_);
  return live_;
}

std::size_t RunView::size() const {
  const std::scoped_lock lock(mutex_);
  return frames_.size();
}

std::optional<ViewFrame> RunView::frame_at(std::size_t frame) const {
  const std::scoped_lock lock(mutex_);
  if (frame >= frames_.size()) return std::nullopt;
  return frames_[frame];
}

/// All frames, copied a few at a time: the run may add one in between and does not wait for a long
/// copy.
std::vector<ViewFrame> RunView::frames() const {
  std::vector<ViewFrame> frames;
  frames.reserve(size());
  for (;;) {
    const std::scoped_lock lock(mutex_);
    const auto first = frames_.begin() + std::ssize(frames);
    const auto count = std::min<std::ptrdiff_t>(frames_.end() - first, kCopiedAtATime);
    if (count == 0) return frames;
    frames.insert(frames.end(), first, first + count);
  }
}

/// Null until the run has one.
ParticleLogReader* RunView::particle_log() const {
  const std::scoped_lock lock(mutex_);
  return particles_.get();
}

/// The odometry, laid onto the first estimate.
Json RunView::odometry_track(const std::vector<ViewFrame>& frames) const {
  Json track = Json::array();
  if (!sequence_.odometry || frames.empty()) return track;
  const Odometry& odometry = *sequence_.odometry;
  const auto at = [&](Stamp stamp) {
    return std::ranges::lower_bound(odometry, stamp, {}, &StampedPose<frames::Odom>::stamp);
  };
  const auto first = at(frames.front().stamp);
  if (first == odometry.end()) return track;
  const auto map_from_odom = frames.front().map_from_robot * first->pose.inverse();
  for (auto pose = first; pose != odometry.end() && pose->stamp <= frames.back().stamp; ++pose) {
    const Pose2 placed = map_from_odom * pose->pose;
    track.push_back({placed.x, placed.y});
  }
  return track;
}

Json RunView::document() const {
  const GeoReference& geo = tiles_->geo();
  Json document{{"name", sequence_.name}, {"settings", Json::parse(settings_)}};
  document["map"] = {{"width", tiles_->width()},
                     {"height", tiles_->height()},
                     {"west", geo.west},
                     {"north", geo.north},
                     {"resolution", geo.resolution},
                     {"levels", tiles_->levels()},
                     {"tile_size", MapTiles::kTileSize},
                     {"corners", corners_on_earth(*tiles_)}};
  document["live"] = live();
  const std::vector<ViewFrame> frames = this->frames();
  document["odometry"] = odometry_track(frames);
  document["frames"] = Json::array();
  for (const ViewFrame& frame : frames) document["frames"].push_back(to_json(frame));
  return document;
}

std::optional<std::vector<LoggedParticle>> RunView::particles(std::size_t frame) const {
  ParticleLogReader* const log = particle_log();
  if (log == nullptr || !frame_at(frame)) return std::nullopt;
  auto particles = log->read(frame);
  if (!particles) return std::nullopt;
  // Relative to the map's corner, which the client knows, and not to the log's own anchor.
  const Point2<frames::Map> anchor = log->anchor();
  for (LoggedParticle& particle : *particles) {
    particle.x += static_cast<float>(anchor.x - tiles_->geo().west);
    particle.y += static_cast<float>(anchor.y - tiles_->geo().north);
  }
  return particles;
}

std::optional<RunView::LocalMapImage> RunView::local_map(std::size_t frame) const {
  const auto wanted = frame_at(frame);
  if (!wanted) return std::nullopt;
  const auto found =
      std::ranges::find(sequence_.local_maps, wanted->number, &Sequence::LocalMap::number);
  if (found == sequence_.local_maps.end()) return std::nullopt;
  const Orthomosaic local = read_orthomosaic(found->image);
  return LocalMapImage{encode_png(with_alpha(local)), local.geo, local.width(), local.height()};
}

std::optional<Json> RunView::heat_map(std::size_t frame) const {
  const auto wanted = frame_at(frame);
  if (!wanted) return std::nullopt;
  const auto found =
      std::ranges::find(sequence_.local_maps, wanted->number, &Sequence::LocalMap::number);
  if (found == sequence_.local_maps.end()) return std::nullopt;
  const std::scoped_lock lock(index_mutex_);
  if (!index_)
    index_ = std::make_unique<MapIndex>(read_orthomosaic(sources_.map), options_.matching);
  const Template local = make_template(read_orthomosaic(found->image), options_.matching);
  const Pose2& pose = wanted->map_from_robot;
  const MatchResult result =
      match(*index_, local, {Point2<frames::Map>{pose.x, pose.y}, kHeatHalfSize, pose.yaw, 0.0});
  if (result.volume.score.empty()) return std::nullopt;
  const Raster<float> best = result.volume.best_over_headings();
  float low = std::numeric_limits<float>::infinity();
  float high = -low;
  for (const float score : best.values()) {
    if (std::isnan(score)) continue;
    low = std::min(low, score);
    high = std::max(high, score);
  }
  if (!(low < high)) return std::nullopt;
  cv::Mat grey(best.height(), best.width(), CV_8UC4, cv::Scalar::all(0));
  for (int row = 0; row < best.height(); ++row) {
    for (int column = 0; column < best.width(); ++column) {
      const float score = best.at(column, row);
      if (std::isnan(score)) continue;
      const auto level =
          static_cast<std::uint8_t>(std::lround(255.0F * (score - low) / (high - low)));
      grey.at<cv::Vec4b>(row, column) = cv::Vec4b(level, level, level, 255);
    }
  }
  const GeoReference& geo = result.volume.geo;
  return Json{{"west", geo.west},
              {"north", geo.north},
              {"resolution", geo.resolution},
              {"width", best.width()},
              {"height", best.height()},
              {"lowest", low},
              {"highest", high},
              {"png", base64(encode_png(grey).bytes)}};
}

}  // namespace nadir::cli
