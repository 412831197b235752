// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nadir/map_matching/cuda/turn_kernels.hpp"

namespace nadir::cuda {

/// A rectangle of the map with holes around it, so that no position reads outside.
struct PadMap {
  const std::uint8_t* map = nullptr;  ///< 0 = hole
  int map_width = 0;
  int map_height = 0;
  Box area;  ///< may reach beyond the map on all sides
  std::uint8_t* padded = nullptr;

  NADIR_HOST_DEVICE std::int64_t items() const {
    return static_cast<std::int64_t>(area.width) * area.height;
  }
  NADIR_HOST_DEVICE void run(std::int64_t item) const {
    const int column = area.left + static_cast<int>(item % area.width);
    const int row = area.top + static_cast<int>(item / area.width);
    const bool inside = column >= 0 && row >= 0 && column < map_width && row < map_height;
    padded[item] =
        inside ? map[static_cast<std::int64_t>(row) * map_width + column] : std::uint8_t{0};
  }
};

/// A pixel of a turned template that takes part, as one 16-byte word.
struct alignas(16) GridPixel {
  int offset = 0;  ///< of the map's pixel below it from the map's pixel below the robot
  float value = 0.0F;
  float weight = 0.0F;
  float seen = 0.0F;  ///< 0 where the template has a hole
};

/// Every score by summation over the pixels of each template at each position, as the paper has it.
/// An item is kColumns positions of one row; neighbouring items read neighbouring map pixels.
struct DirectSurfaces {
  static constexpr int kColumns = 4;
  static constexpr int kLanes = 32;  ///< between the columns of an item
  static constexpr int kChunk =
      256;  ///< pixels summed in single precision before they join the sum

  const std::uint8_t* map = nullptr;  ///< padded: its first pixel is the first that is needed
  int pitch = 0;
  int origin = 0;  ///< index of the map's pixel below the window's first position
  const GridPixel* pixels = nullptr;  ///< of all templates
  const int* first = nullptr;         ///< of each template in `pixels`, and the end
  const TemplateStats* stats = nullptr;
  int count = 0;  ///< templates
  int width = 0;  ///< of the window
  int height = 0;
  Rule rule;
  float map_shift = 0.0F;
  float* score = nullptr;
  float* share = nullptr;

  NADIR_HOST_DEVICE int groups() const {
    return (width + kColumns * kLanes - 1) / (kColumns * kLanes);
  }
  NADIR_HOST_DEVICE std::int64_t items() const {
    return static_cast<std::int64_t>(count) * height * groups() * kLanes;
  }

  NADIR_HOST_DEVICE void run(std::int64_t item) const {
    switch (rule.formula) {
      case Formula::kSsd:
        return run_as<Formula::kSsd>(item);
      case Formula::kSad:
        return run_as<Formula::kSad>(item);
      case Formula::kCosine:
        return run_as<Formula::kCosine>(item);
      case Formula::kWeightedCosine:
        return run_as<Formula::kWeightedCosine>(item);
      case Formula::kPaper:
        return run_as<Formula::kPaper>(item);
      case Formula::kZeroMean:
        return run_as<Formula::kZeroMean>(item);
    }
  }

 private:
  struct Place {
    int which = 0;
    int row = 0;
    int column = 0;  ///< the first of kColumns
    Shifts shifts;
  };

  template <Formula Which>
  NADIR_HOST_DEVICE void run_as(std::int64_t item) const {
    Place place;
    const auto lane = static_cast<int>(item % kLanes);
    const auto group = static_cast<int>(item / kLanes % groups());
    place.column = group * kColumns * kLanes + lane;
    place.row = static_cast<int>(item / kLanes / groups() % height);
    place.which = static_cast<int>(item / kLanes / groups() / height);
    place.shifts = shifts_of(place.which);
    Sums<double> sums[kColumns];
    sum_pixels<Which>(place, sums);
    PaperMoments moments[kColumns];
    if constexpr (Which == Formula::kPaper) {
      for (int c = 0; c < kColumns; ++c) moments[c] = paper_moments(sums[c]);
      sum_deviations(place, moments, sums);
    }
    for (int c = 0; c < kColumns; ++c) {
      if (place.column + c * kLanes < width) write(place, c, sums[c]);
    }
  }

  NADIR_HOST_DEVICE Shifts shifts_of(int which) const {
    // The cosines are of the grey values themselves.
    const bool shifted = rule.formula == Formula::kZeroMean || rule.formula == Formula::kPaper;
    return shifted ? Shifts{map_shift, stats[which].mean} : Shifts{};
  }

  /// The map below the robot; a column beyond the window stays on its last position.
  NADIR_HOST_DEVICE const std::uint8_t* below(const Place& place, int c) const {
    const int column = place.column + c * kLanes;
    return map + origin + static_cast<std::int64_t>(place.row) * pitch +
           (column < width ? column : width - 1);
  }

  NADIR_HOST_DEVICE Pair pair_of(const GridPixel& pixel, std::uint8_t grey) const {
    const bool on_map = grey != 0;
    const float part = rule.whole_square ? 1.0F : on_map ? pixel.seen : 0.0F;
    return {on_map ? static_cast<float>(grey) : kWhite, pixel.value,
            on_map || rule.whole_square ? pixel.weight : 0.0F, part};
  }

  template <Formula Which>
  NADIR_HOST_DEVICE void sum_pixels(const Place& place, Sums<double>* sums) const {
    const std::uint8_t* base[kColumns];
    for (int c = 0; c < kColumns; ++c) base[c] = below(place, c);
    const int end = first[place.which + 1];
    for (int begin = first[place.which]; begin < end; begin += kChunk) {
      Sums<float> chunk[kColumns];
      const int stop = begin + kChunk < end ? begin + kChunk : end;
      for (int i = begin; i < stop; ++i) {
        const GridPixel pixel = pixels[i];
        for (int c = 0; c < kColumns; ++c) {
          const std::uint8_t grey = base[c][pixel.offset];
          if (grey != 0) chunk[c].seen += pixel.seen;
          add_pair<Which>(chunk[c], pair_of(pixel, grey), place.shifts);
        }
      }
      for (int c = 0; c < kColumns; ++c) add(sums[c], chunk[c]);
    }
  }

  NADIR_HOST_DEVICE void sum_deviations(const Place& place, const PaperMoments* moments,
                                        Sums<double>* sums) const {
    const std::uint8_t* base[kColumns];
    for (int c = 0; c < kColumns; ++c) base[c] = below(place, c);
    const int end = first[place.which + 1];
    for (int begin = first[place.which]; begin < end; begin += kChunk) {
      float chunk[kColumns] = {};
      const int stop = begin + kChunk < end ? begin + kChunk : end;
      for (int i = begin; i < stop; ++i) {
        const GridPixel pixel = pixels[i];
        for (int c = 0; c < kColumns; ++c) {
          add_deviation(chunk[c], pair_of(pixel, base[c][pixel.offset]), place.shifts, moments[c]);
        }
      }
      for (int c = 0; c < kColumns; ++c) sums[c].distance += chunk[c];
    }
  }

  NADIR_HOST_DEVICE void write(const Place& place, int c, const Sums<double>& sums) const {
    const std::int64_t at = (static_cast<std::int64_t>(place.which) * height + place.row) * width +
                            place.column + static_cast<std::int64_t>(c) * kLanes;
    const double compared = share_of(sums.seen, stats[place.which].total_seen);
    share[at] = static_cast<float>(compared);
    score[at] =
        static_cast<float>(is_enough(rule, compared) ? score_of(rule.formula, sums) : undefined());
  }
};

}  // namespace nadir::cuda
