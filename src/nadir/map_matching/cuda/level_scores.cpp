// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "nadir/map_matching/cuda/surfaces.hpp"

namespace nadir::cuda {
namespace {

/// Levels of a group: as many planes as stay in the second-level cache of a large GPU from the
/// product over the transform to the sum, or a few dozen small ones.
int levels_at_once(const PlaneShape& shape) {
  constexpr std::int64_t kBytes = std::int64_t{24} << 20U;
  constexpr std::int64_t kMost = 32;
  const std::int64_t plane = shape.reals() * static_cast<std::int64_t>(sizeof(float));
  return static_cast<int>(std::clamp<std::int64_t>(kBytes / plane, 1, kMost));
}

std::size_t group_reals(const PlaneShape& shape) {
  return static_cast<std::size_t>(levels_at_once(shape) * shape.reals());
}

/// Groups whose spectra may be kept: half of the work memory.
std::size_t most_groups(const Device& device, const PlaneShape& shape) {
  const std::size_t fit = device.workspace_bytes() / 2 / (group_reals(shape) * sizeof(float));
  return std::max<std::size_t>(fit, 1);
}

/// Forgets the levels of another part of the map.
void belong_to(LevelSpectra& levels, const MapSpectra& spectra) {
  if (levels.part == &spectra) return;
  const bool same_size =
      levels.shape.width == spectra.shape.width && levels.shape.height == spectra.shape.height;
  if (!same_size) levels.groups.clear();
  levels.first_level.assign(levels.groups.size(), -1);
  levels.next = 0;
  levels.shape = spectra.shape;
  levels.part = &spectra;
}

/// Where the spectra of a new group are to go.
std::size_t slot_for_group(DeviceMap& map) {
  LevelSpectra& levels = map.levels;
  if (levels.groups.size() < most_groups(*map.device, levels.shape)) {
    levels.groups.emplace_back(*map.device);
    levels.first_level.push_back(-1);
    return levels.groups.size() - 1;
  }
  for (int stream = 0; stream < Device::kStreams; ++stream) map.device->wait(stream);  // readers
  const std::size_t slot = levels.next;
  levels.next = (slot + 1) % levels.groups.size();
  levels.first_level[slot] = -1;  // nothing, should the device fail
  return slot;
}

/// The spectra of the group that begins with level `first`.
const Complex* group_spectra(DeviceMap& map, const MapSpectra& spectra, int first, BatchedFft& fft,
                             int stream) {
  LevelSpectra& levels = map.levels;
  const auto found = std::find(levels.first_level.begin(), levels.first_level.end(), first);
  auto slot = static_cast<std::size_t>(found - levels.first_level.begin());
  if (found == levels.first_level.end()) {
    slot = slot_for_group(map);
    float* planes = levels.groups[slot].reserve(group_reals(spectra.shape));
    map.device->launch(LevelPlanes{map.pixels.data(), map.width, spectra.crop, first,
                                   levels_at_once(spectra.shape), spectra.shape, planes},
                       stream);
    fft.forward(planes);
    map.device->wait(stream);  // the other stream reads them too
    levels.first_level[slot] = first;
  }
  // A real in place of its spectrum: two floats are one complex.
  return reinterpret_cast<const Complex*>(levels.groups[slot].data());
}

/// Moments of all windows, and the levels that the means of each template take.
std::vector<LevelRange> window_moments(DeviceMap& map, const SurfaceJob& job,
                                       const PlaneShape& shape, const Batch& batch,
                                       const Box& positions) {
  Device& device = *map.device;
  StreamWork& work = map.work[static_cast<std::size_t>(batch.stream)];
  const auto count = static_cast<std::size_t>(batch.count);
  const auto window =
      static_cast<std::size_t>(positions.width) * static_cast<std::size_t>(positions.height);
  PaperStats* sums = work.paper_stats.reserve(count);
  device.launch(SumDeviations{work.turned.data(), work.stats.data(), batch.count,
                              job.box.width * job.box.height, sums},
                batch.stream);
  float* mean = work.mean.reserve(count * window);
  device.launch(
      WindowMoments{work.product_planes.data(), work.stats.data(), sums, batch.count, job.rule,
                    map.mean_grey, shape, positions, mean, work.norm.reserve(count * window),
                    work.score.data(), work.share.data()},
      batch.stream);

  const std::size_t parts = count * FindLevels::kParts;
  LevelRange* ranges = work.ranges.reserve(parts);
  LevelRange* staged = work.staged_ranges.reserve(parts);
  device.launch(FindLevels{mean, batch.count, static_cast<int>(window), ranges}, batch.stream);
  device.download(staged, ranges, parts * sizeof(LevelRange), batch.stream);
  device.wait(batch.stream);
  std::vector<LevelRange> result(count);
  for (std::size_t i = 0; i < parts; ++i) {
    FindLevels::merge(result[i / FindLevels::kParts], staged[i]);
  }
  return result;
}

BatchedFft& transform_of_levels(Device& device, StreamWork& work, const PlaneShape& shape,
                                int stream) {
  const bool fits = work.level_fft && work.level_shape.width == shape.width &&
                    work.level_shape.height == shape.height;
  if (!fits) {
    work.level_fft.reset();
    work.level_fft = device.make_fft(shape, levels_at_once(shape), stream);
    work.level_shape = shape;
  }
  return *work.level_fft;
}

}  // namespace

void score_by_levels(DeviceMap& map, const SurfaceJob& job, const MapSpectra& spectra,
                     const Batch& batch, const Box& positions) {
  Device& device = *map.device;
  StreamWork& work = map.work[static_cast<std::size_t>(batch.stream)];
  const PlaneShape& shape = spectra.shape;
  belong_to(map.levels, spectra);
  const std::vector<LevelRange> ranges = window_moments(map, job, shape, batch, positions);

  const int at_once = levels_at_once(shape);
  BatchedFft& fft = transform_of_levels(device, work, shape, batch.stream);
  float* products = work.level_planes.reserve(group_reals(shape));
  const std::int64_t window = static_cast<std::int64_t>(positions.width) * positions.height;
  for (int k = 0; k < batch.count; ++k) {
    const LevelRange& range = ranges[static_cast<std::size_t>(k)];
    const std::int64_t planes = std::int64_t{k} * template_planes(Formula::kPaper);
    const float* deviation = work.template_planes.data() + (planes + 2) * shape.reals();
    for (int first = range.first - range.first % at_once; first <= range.last; first += at_once) {
      const Complex* levels = group_spectra(map, spectra, first, fft, batch.stream);
      device.launch(MultiplyLevels{levels, reinterpret_cast<const Complex*>(deviation), at_once,
                                   shape, reinterpret_cast<Complex*>(products)},
                    batch.stream);
      fft.inverse(products);
      device.launch(AddLevels{products, work.paper_stats.data() + k, first, at_once, shape,
                              positions, work.mean.data() + k * window,
                              work.norm.data() + k * window, work.score.data() + k * window},
                    batch.stream);
    }
  }
}

}  // namespace nadir::cuda
