// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "nadir/map_matching/cuda/surfaces.hpp"

namespace nadir::cuda {
namespace {

struct PixelList {
  std::vector<GridPixel> pixels;
  TemplateStats stats;
};

PixelList list_pixels(const RotatedTemplate& local, int pitch) {
  PixelList list;
  double sum = 0.0;
  for (int row = 0; row < local.value.height(); ++row) {
    for (int column = 0; column < local.value.width(); ++column) {
      if (local.mask.at(column, row) == 0.0F) continue;
      list.pixels.push_back({(local.top + row) * pitch + local.left + column,
                             local.value.at(column, row), local.weight.at(column, row),
                             local.seen.at(column, row)});
      sum += local.value.at(column, row);
    }
  }
  const auto count = static_cast<double>(std::max<std::size_t>(list.pixels.size(), 1));
  list.stats = {local.total_seen, static_cast<float>(sum / count)};
  return list;
}

/// Copies a batch's lists, one behind the other, to the device.
void upload_lists(Device& device, StreamWork& work, const Batch& batch,
                  std::span<const RotatedTemplate> templates, int pitch) {
  const auto count = static_cast<std::size_t>(batch.count);
  std::vector<PixelList> lists;
  std::size_t total = 0;
  for (const RotatedTemplate& local :
       templates.subspan(static_cast<std::size_t>(batch.first), count)) {
    lists.push_back(list_pixels(local, pitch));
    total += lists.back().pixels.size();
  }
  GridPixel* pixels = work.staged_pixels.reserve(total);
  int* first = work.staged_first.reserve(count + 1);
  TemplateStats* stats = work.staged_stats.reserve(count);
  first[0] = 0;
  for (std::size_t i = 0; i < count; ++i) {
    std::copy(lists[i].pixels.begin(), lists[i].pixels.end(), pixels + first[i]);
    first[i + 1] = first[i] + static_cast<int>(lists[i].pixels.size());
    stats[i] = lists[i].stats;
  }
  device.upload(work.pixels.reserve(total), pixels, total * sizeof(GridPixel), batch.stream);
  device.upload(work.first.reserve(count + 1), first, (count + 1) * sizeof(int), batch.stream);
  device.upload(work.stats.reserve(count), stats, count * sizeof(TemplateStats), batch.stream);
}

}  // namespace

void sum_surfaces(DeviceMap& map, const SurfaceJob& job, std::span<const RotatedTemplate> templates,
                  SurfaceSink& sink) {
  Device& device = *map.device;
  const Box area{job.window.left + job.box.left, job.window.top + job.box.top,
                 job.window.width + job.box.width - 1, job.window.height + job.box.height - 1};
  const PadMap pad{map.pixels.data(), map.width, map.height, area,
                   map.padded.reserve(static_cast<std::size_t>(area.width) *
                                      static_cast<std::size_t>(area.height))};
  device.launch(pad, 0);
  device.wait(0);  // both streams read it

  const auto window =
      static_cast<std::size_t>(job.window.width) * static_cast<std::size_t>(job.window.height);
  const std::size_t bytes = window * (2 * sizeof(float) + sizeof(PeakKey)) +
                            static_cast<std::size_t>(job.box.width) *
                                static_cast<std::size_t>(job.box.height) * sizeof(GridPixel);
  const int size = batch_size(job.count, device.workspace_bytes(), bytes);
  const std::size_t scores = window * static_cast<std::size_t>(size);
  for_each_batch(map, job.count, size, sink, [&](const Batch& batch) {
    StreamWork& work = map.work[static_cast<std::size_t>(batch.stream)];
    upload_lists(device, work, batch, templates, area.width);
    DirectSurfaces surfaces;
    surfaces.map = pad.padded;
    surfaces.pitch = area.width;
    surfaces.origin = -job.box.top * area.width - job.box.left;
    surfaces.pixels = work.pixels.data();
    surfaces.first = work.first.data();
    surfaces.stats = work.stats.data();
    surfaces.count = batch.count;
    surfaces.width = job.window.width;
    surfaces.height = job.window.height;
    surfaces.rule = job.rule;
    surfaces.map_shift = map.mean_grey;
    surfaces.score = work.score.reserve(scores);
    surfaces.share = work.share.reserve(scores);
    device.launch(surfaces, batch.stream);
  });
}

}  // namespace nadir::cuda
