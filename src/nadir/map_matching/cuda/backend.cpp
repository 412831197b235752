// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/cuda/backend.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "nadir/map_matching/cuda/poses.hpp"
#include "nadir/map_matching/rotated_template.hpp"

namespace nadir::cuda {
namespace {

Box box_around(std::span<const RotatedTemplate> templates) {
  int left = templates.front().left;
  int top = templates.front().top;
  int right = left;
  int bottom = top;
  for (const RotatedTemplate& local : templates) {
    left = std::min(left, local.left);
    top = std::min(top, local.top);
    right = std::max(right, local.left + local.value.width());
    bottom = std::max(bottom, local.top + local.value.height());
  }
  return {left, top, right - left, bottom - top};
}

/// The same from the corners of the template, before it is turned; one pixel wider.
Box box_around(const ChannelImage& local, std::span<const double> yaws, double map_resolution) {
  double left = std::numeric_limits<double>::infinity();
  double top = left;
  double right = -left;
  double bottom = -left;
  for (const double yaw : yaws) {
    for (const double column : {0.0, static_cast<double>(local.value.width())}) {
      for (const double row : {0.0, static_cast<double>(local.value.height())}) {
        const double x = local.geo.x_at(column);
        const double y = local.geo.y_at(row);
        const double across = (std::cos(yaw) * x - std::sin(yaw) * y) / map_resolution;
        const double down = -(std::sin(yaw) * x + std::cos(yaw) * y) / map_resolution;
        left = std::min(left, across);
        right = std::max(right, across);
        top = std::min(top, down);
        bottom = std::max(bottom, down);
      }
    }
  }
  Box box{static_cast<int>(std::floor(left)), static_cast<int>(std::floor(top)), 0, 0};
  box.width = static_cast<int>(std::ceil(right)) - box.left + 1;
  box.height = static_cast<int>(std::ceil(bottom)) - box.top + 1;
  return box;
}

/// The positions of `asked` at which a template in the box can touch the map; empty where none can.
Box touching(const PixelWindow& asked, const Box& box, const DeviceMap& map) {
  const int left = std::max(asked.left, 1 - box.left - box.width);
  const int top = std::max(asked.top, 1 - box.top - box.height);
  const int right = std::min(asked.left + asked.width, map.width - box.left);
  const int bottom = std::min(asked.top + asked.height, map.height - box.top);
  return {left, top, std::max(right - left, 0), std::max(bottom - top, 0)};
}

bool is_empty(const Box& box) { return box.width <= 0 || box.height <= 0; }

/// Copies templates that were turned on the host, each into the common box.
void upload_turned(Device& device, const Batch& batch, std::span<const RotatedTemplate> templates,
                   const Box& box, StreamWork& work) {
  const std::size_t pixels =
      static_cast<std::size_t>(box.width) * static_cast<std::size_t>(box.height);
  const std::size_t count = pixels * static_cast<std::size_t>(batch.count);
  TurnedPixel* staged = work.staged_turned.reserve(count);
  std::fill_n(staged, count, TurnedPixel{});
  for (int k = 0; k < batch.count; ++k) {
    const int index = batch.first + k;
    const RotatedTemplate& local = templates[static_cast<std::size_t>(index)];
    TurnedPixel* own = staged + static_cast<std::size_t>(k) * pixels;
    for (int row = 0; row < local.value.height(); ++row) {
      const std::ptrdiff_t down = local.top - box.top + row;
      TurnedPixel* to = own + down * box.width + (local.left - box.left);
      for (int column = 0; column < local.value.width(); ++column) {
        to[column] = {local.value.at(column, row), local.mask.at(column, row),
                      local.weight.at(column, row), local.seen.at(column, row)};
      }
    }
  }
  device.upload(work.turned.reserve(count), staged, count * sizeof(TurnedPixel), batch.stream);
}

void run_on_templates(DeviceMap& map, const SurfaceJob& job,
                      std::span<const RotatedTemplate> templates, SurfaceSink& sink) {
  if (!is_correlation(job.rule)) {
    sum_surfaces(map, job, templates, sink);
    return;
  }
  correlate_surfaces(
      map, job,
      [&](const Batch& batch, StreamWork& work) {
        upload_turned(*map.device, batch, templates, job.box, work);
      },
      sink);
}

/// TurnTemplates for all headings, with the template and the headings on the device.
TurnTemplates turn_kernel(DeviceMap& map, const MapIndex& index, const ChannelImage& local,
                          std::span<const double> yaws, const Box& box) {
  const PixelRole role = pixel_role(index.options());
  const std::vector<std::uint8_t> pixels = with_holes(local);
  std::vector<Heading> headings;
  for (const double yaw : yaws) headings.push_back({std::cos(yaw), std::sin(yaw)});
  TurnTemplates kernel;
  std::uint8_t* to = map.local.reserve(pixels.size());
  map.device->upload(to, pixels.data(), pixels.size(), 0);
  Heading* to_headings = map.headings.reserve(headings.size());
  map.device->upload(to_headings, headings.data(), headings.size() * sizeof(Heading), 0);
  map.device->wait(0);
  kernel.local = to;
  kernel.local_width = local.value.width();
  kernel.local_height = local.value.height();
  kernel.west = local.geo.west;
  kernel.north = local.geo.north;
  kernel.local_resolution = local.geo.resolution;
  kernel.map_resolution = index.channel().geo.resolution;
  kernel.weighted = role.weighted;
  kernel.weighted_norms = role.weighted_norms;
  kernel.headings = to_headings;
  kernel.box = box;
  return kernel;
}

}  // namespace

std::shared_ptr<PreparedMap> DeviceBackend::prepare(const MapIndex& map) const {
  return std::make_shared<DeviceMap>(make_(), map);
}

std::vector<ScoreSurface> DeviceBackend::score_surfaces(const MapIndex& map,
                                                        std::span<const RotatedTemplate> templates,
                                                        const PixelWindow& window,
                                                        const StopToken& stop) const {
  return KeptMap(*this, map).score_surfaces(templates, window, stop);
}

std::vector<PoseScore> DeviceBackend::score_poses(const MapIndex& map, const Template& local,
                                                  std::span<const Pose2> map_from_robot,
                                                  const StopToken& stop) const {
  stop.check();
  return KeptMap(*this, map).score_poses(local, map_from_robot);
}

KeptMap::KeptMap(const DeviceBackend& backend, const MapIndex& map) : map_(map) {
  auto* const own = dynamic_cast<DeviceMap*>(map.prepared());
  on_device_ = own != nullptr ? std::shared_ptr<DeviceMap>(std::shared_ptr<void>{}, own)
                              : std::dynamic_pointer_cast<DeviceMap>(backend.prepare(map));
}

PlaneShape KeptMap::shape() const { return on_device_->whole.shape; }

SurfaceJob KeptMap::job_over(const Box& box, const PixelWindow& window, std::size_t templates,
                             const StopToken& stop) const {
  return {touching(window, box, *on_device_), box, static_cast<int>(templates),
          rule_of(map_.options()), stop};
}

std::vector<ScoreSurface> KeptMap::score_surfaces(std::span<const RotatedTemplate> templates,
                                                  const PixelWindow& window,
                                                  const StopToken& stop) const {
  if (templates.empty() || window.width <= 0 || window.height <= 0) return {};
  const std::lock_guard lock(on_device_->mutex);
  const SurfaceJob job = job_over(box_around(templates), window, templates.size(), stop);
  DownloadSink sink(*on_device_->device, job, window);
  if (!is_empty(job.window)) run_on_templates(*on_device_, job, templates, sink);
  return std::move(sink.surfaces);
}

std::vector<PoseScore> KeptMap::score_poses(const Template& local,
                                            std::span<const Pose2> map_from_robot) const {
  const std::lock_guard lock(on_device_->mutex);
  return score_poses_on(*on_device_, map_, local, map_from_robot);
}

std::vector<Place> KeptMap::best_places(const Template& local, std::span<const double> yaws,
                                        const PixelWindow& window, int wanted) const {
  if (yaws.empty() || window.width <= 0 || window.height <= 0) return {};
  const std::lock_guard lock(on_device_->mutex);
  const double resolution = map_.channel().geo.resolution;
  const SurfaceJob job =
      job_over(box_around(local.channel, yaws, resolution), window, yaws.size(), {});
  if (is_empty(job.window)) return {};
  PeakSink sink(*on_device_->device, job, window, wanted);
  if (is_correlation(job.rule) && !job.rule.whole_square) {
    TurnTemplates kernel = turn_kernel(*on_device_, map_, local.channel, yaws, job.box);
    const Heading* headings = kernel.headings;
    const auto turn = [&](const Batch& batch, StreamWork& work) {
      kernel.headings = headings + batch.first;
      kernel.count = batch.count;
      kernel.turned = work.turned.reserve(static_cast<std::size_t>(kernel.items()));
      on_device_->device->launch(kernel, batch.stream);
    };
    correlate_surfaces(*on_device_, job, turn, sink);
    return sink.places();
  }
  std::vector<RotatedTemplate> templates;
  for (const double yaw : yaws) {
    templates.push_back(
        rotate_template(local.channel, yaw, resolution, pixel_role(map_.options())));
  }
  run_on_templates(*on_device_, job, templates, sink);
  return sink.places();
}

}  // namespace nadir::cuda
