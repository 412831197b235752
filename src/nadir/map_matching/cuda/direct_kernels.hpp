// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nadir/map_matching/cuda/turn_kernels.hpp"

namespace nadir::cuda {

/// Pixels that are read as one 16-byte word.
inline constexpr int kWord = 4;
struct alignas(16) PixelWord {
  float value[kWord] = {};
};

/// A rectangle of the map with holes around it, so that no position reads outside; as single
/// precision, so that no pair of pixels converts. Two planes: greys, and 1 where the map was seen.
struct PadMap {
  const std::uint8_t* map = nullptr;  ///< 0 = hole
  int map_width = 0;
  int map_height = 0;
  Box area;           ///< may reach beyond the map on all sides
  float hole = 0.0F;  ///< the grey of what was not seen
  float* grey = nullptr;
  float* seen = nullptr;

  NADIR_HOST_DEVICE std::int64_t items() const {
    return static_cast<std::int64_t>(area.width) * area.height;
  }
  NADIR_HOST_DEVICE void run(std::int64_t item) const {
    const GridPlace place = grid_place(item, area.width, area.height);
    const int column = area.left + place.column;
    const int row = area.top + place.row;
    const bool inside = column >= 0 && row >= 0 && column < map_width && row < map_height;
    const std::uint8_t pixel =
        inside ? map[static_cast<std::int64_t>(row) * map_width + column] : std::uint8_t{0};
    grey[item] = pixel == 0 ? hole : static_cast<float>(pixel);
    seen[item] = pixel == 0 ? 0.0F : 1.0F;
  }
};

/// kWord neighbouring pixels of a row of a turned template.
struct alignas(16) TemplateWord {
  float grey[kWord] = {};
  std::uint32_t takes_part = 0;  ///< a bit for each pixel; holes do where they are white
  std::uint32_t seen = 0;        ///< likewise: no hole
};

/// A row of a turned template, from its first word that takes part to its last.
struct TemplateRow {
  int offset = 0;  ///< in the padded map, from the pixel below the box's first to the row's first
  int first = 0;   ///< of its words
  int end = 0;
};

struct TemplateRows {
  int first = 0;  ///< of its rows
  int end = 0;
  double count = 0.0;       ///< pixels that take part
  double total_seen = 0.0;  ///< of them not holes
};

/// `a * b + c` for a `b` that is 0 or 1: the product is exact, and one instruction rounds as two.
NADIR_HOST_DEVICE inline float add_where(float a, float b, float c) {
#if defined(__CUDA_ARCH__)
  return __fmaf_rn(a, b, c);
#else
  return a * b + c;
#endif
}

/// The distances |R - P| and (R - P)^2 (sad and ssd, which weigh no pixel), summed over the pixels
/// of each template at each position. An item is kColumns neighbouring positions of one row: a word
/// of the map serves them all, and the loop does little but add.
struct DirectSurfaces {
  static constexpr int kColumns = 8;
  static constexpr int kPixels = kColumns + kWord;  ///< of the map, below a word at all columns

  const float* grey = nullptr;  ///< PadMap
  const float* seen = nullptr;
  int pitch = 0;                        ///< a multiple of kWord
  const TemplateWord* words = nullptr;  ///< and one behind the last
  const TemplateRow* rows = nullptr;
  const TemplateRows* templates = nullptr;
  int count = 0;  ///< templates
  int width = 0;  ///< of the window
  int height = 0;
  Rule rule;
  float* score = nullptr;
  float* share = nullptr;

  NADIR_HOST_DEVICE int groups() const { return (width + kColumns - 1) / kColumns; }
  NADIR_HOST_DEVICE std::int64_t items() const {
    return static_cast<std::int64_t>(count) * height * groups();
  }

  NADIR_HOST_DEVICE void run(std::int64_t item) const {
    const bool squares = rule.formula == Formula::kSsd;
    if (rule.whole_square) return squares ? run_as<true, true>(item) : run_as<false, true>(item);
    return squares ? run_as<true, false>(item) : run_as<false, false>(item);
  }

 private:
  template <bool Squares, bool WholeSquare>
  NADIR_HOST_DEVICE void run_as(std::int64_t item) const {
    const GridPlace place = grid_place(item, groups(), height);
    const int column = place.column * kColumns;
    const int below = place.row * pitch + column;
    const TemplateRows own = templates[place.which];
    double distance[kColumns] = {};
    float compared[kColumns] = {};  // a count: exact
    for (int i = own.first; i < own.end; ++i) {
      float sum[kColumns] = {};  // of a row in single precision
      sum_row<Squares, WholeSquare>(rows[i], below + rows[i].offset, sum, compared);
      for (int c = 0; c < kColumns; ++c) distance[c] += sum[c];
    }
    for (int c = 0; c < kColumns && column + c < width; ++c) {
      const std::int64_t at =
          (static_cast<std::int64_t>(place.which) * height + place.row) * width + column + c;
      write(at, own, distance[c], compared[c]);
    }
  }

  template <bool Squares, bool WholeSquare>
  NADIR_HOST_DEVICE void sum_row(const TemplateRow& row, int below, float* sum,
                                 float* compared) const {
    // The map's pixels below the word, and one word more: loads are a turn ahead of their use.
    float r[kPixels + kWord];
    float v[kPixels + kWord];
    for (int i = 0; i < kPixels; i += kWord) load_map(below, i, r, v);
    TemplateWord word = words[row.first];
    // Four times: then every word of the map is back where it was, and none has to be moved.
    NADIR_UNROLL(4)
    for (int i = row.first; i < row.end; ++i) {
      load_map(below, kPixels, r, v);
      const TemplateWord next = words[i + 1];
      add_word<Squares, WholeSquare>(word, r, v, sum, compared);
      word = next;
      for (int k = 0; k < kPixels; ++k) {
        r[k] = r[k + kWord];
        v[k] = v[k + kWord];
      }
      below += kWord;
    }
  }

  NADIR_HOST_DEVICE void load_map(int below, int i, float* r, float* v) const {
    load(grey + below + i, r + i);
    load(seen + below + i, v + i);
  }

  NADIR_HOST_DEVICE static void load(const float* from, float* to) {
    const PixelWord word = *reinterpret_cast<const PixelWord*>(from);
    for (int i = 0; i < kWord; ++i) to[i] = word.value[i];
  }

  /// Adds a word of the template to all columns. All threads of a warp are at the same one, so that
  /// leaving out a pixel costs no divergence.
  template <bool Squares, bool WholeSquare>
  NADIR_HOST_DEVICE static void add_word(const TemplateWord& word, const float* r, const float* v,
                                         float* sum, float* compared) {
    for (int k = 0; k < kWord; ++k) {
      if ((word.takes_part >> k & 1U) != 0) {
        for (int c = 0; c < kColumns; ++c) {
          const float difference = r[k + c] - word.grey[k];
          const float distance = Squares ? difference * difference : fabsf(difference);
          sum[c] = WholeSquare ? sum[c] + distance : add_where(distance, v[k + c], sum[c]);
          if (!WholeSquare) compared[c] += v[k + c];
        }
      }
      if (WholeSquare && (word.seen >> k & 1U) != 0) {
        for (int c = 0; c < kColumns; ++c) compared[c] += v[k + c];
      }
    }
  }

  NADIR_HOST_DEVICE void write(std::int64_t at, const TemplateRows& own, double distance,
                               double compared) const {
    const double part = share_of(compared, own.total_seen);
    const double pixels = rule.whole_square ? own.count : compared;
    share[at] = static_cast<float>(part);
    score[at] = static_cast<float>(is_enough(rule, part) && pixels > 0.0 ? -distance / pixels
                                                                         : undefined());
  }
};

}  // namespace nadir::cuda
