// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <vector>

#include "nadir/map_matching/cuda/device.hpp"
#include "nadir/map_matching/surface.hpp"

namespace nadir::cuda {

/// How the options' score is computed here.
Rule rule_of(const MatchingOptions& options);

/// Whether `rule` is a function of correlations; the others are summed directly.
bool is_correlation(const Rule& rule);

/// Pixels as the kernels take them: 0 where there is a hole.
std::vector<std::uint8_t> with_holes(const ChannelImage& channel);

/// The map's planes after the transform, kept for all searches of the same extent.
struct MapSpectra {
  explicit MapSpectra(Device& device) : planes(device) {}
  PlaneShape shape;  ///< empty before the first search
  Box crop;          ///< the part of the map
  Memory<float> planes;
};

/// Spectra of LevelPlanes over the part of the map that `part` is of, in groups of levels: made
/// when a search first needs them and kept, as many as fit.
struct LevelSpectra {
  const MapSpectra* part = nullptr;  ///< null: what is held is of no use
  PlaneShape shape;
  std::vector<Memory<float>> groups;
  std::vector<int> first_level;  ///< of each group; -1 = nothing
  std::size_t next = 0;          ///< the group to give up where no more fit
};

/// What one stream works in. Grows to the largest search and stays.
struct StreamWork {
  explicit StreamWork(Device& device)
      : turned(device),
        stats(device),
        template_planes(device),
        product_planes(device),
        paper_stats(device),
        mean(device),
        norm(device),
        ranges(device),
        level_planes(device),
        words(device),
        rows(device),
        templates(device),
        score(device),
        share(device),
        keys(device),
        staged_turned(device),
        staged_words(device),
        staged_rows(device),
        staged_templates(device),
        staged_ranges(device),
        staged_scores(device) {}
  Memory<TurnedPixel> turned;
  Memory<TemplateStats> stats;
  Memory<float> template_planes;
  Memory<float> product_planes;
  Memory<PaperStats> paper_stats;
  Memory<float> mean;
  Memory<float> norm;
  Memory<LevelRange> ranges;
  Memory<float> level_planes;
  Memory<TemplateWord> words;
  Memory<TemplateRow> rows;
  Memory<TemplateRows> templates;
  Memory<float> score;
  Memory<float> share;
  Memory<PeakKey> keys;
  Staging<TurnedPixel> staged_turned;
  Staging<TemplateWord> staged_words;
  Staging<TemplateRow> staged_rows;
  Staging<TemplateRows> staged_templates;
  Staging<LevelRange> staged_ranges;
  Staging<float> staged_scores;
  std::unique_ptr<BatchedFft> template_fft;
  std::unique_ptr<BatchedFft> product_fft;
  PlaneShape fft_shape;  ///< that the two were made for
  int fft_batch = 0;
  Formula fft_formula = Formula::kZeroMean;
  std::unique_ptr<BatchedFft> level_fft;
  PlaneShape level_shape;  ///< likewise
};

/// A map on a device, and all that is kept there for it: the pixels, uploaded once, their spectra,
/// the work memory of the streams. Hold `mutex` while using it: matches in one map take turns.
struct DeviceMap : PreparedMap {
  DeviceMap(std::unique_ptr<Device> on, const MapIndex& map);

  std::unique_ptr<Device> device;  // first, since the memory below is its own
  std::mutex mutex;
  int width = 0;
  int height = 0;
  float mean_grey = 0.0F;
  Memory<std::uint8_t> pixels{*device};
  Memory<std::uint32_t> quads{*device};
  Memory<std::uint32_t> white_quads{*device};  ///< only where holes take part
  QuadMap quad_map;
  MapSpectra whole{*device};  ///< of searches over most of the map
  MapSpectra part{*device};   ///< of the last search in a window
  LevelSpectra levels;
  std::array<StreamWork, Device::kStreams> work{StreamWork(*device), StreamWork(*device)};
  Memory<float> padded{*device};
  Memory<Heading> headings{*device};
  Memory<std::uint8_t> local{*device};
  Memory<float> sampled{*device};
  Memory<PixelPose> poses{*device};
  Memory<PaperMoments> moments{*device};
  Memory<double> pose_scores{*device};
};

}  // namespace nadir::cuda
