// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "nadir/map_matching/cuda/formula.hpp"

namespace nadir::cuda {

/// A pixel of a template that was turned by a heading onto the map's grid (RotatedTemplate).
struct TurnedPixel {
  float value = 0.0F;
  float mask = 0.0F;
  float weight = 0.0F;
  float seen = 0.0F;
};

/// The pixels that all templates of a call lie within, relative to the robot's pixel.
struct Box {
  int left = 0;
  int top = 0;
  int width = 0;
  int height = 0;
};

/// Which of several grids of width x height, and where in it.
struct GridPlace {
  int which = 0;
  int row = 0;
  int column = 0;
};

/// Of the items of a batch, which are far below 2^32: divisions of 32 bits cost a GPU a fraction of
/// those of 64.
NADIR_HOST_DEVICE inline GridPlace grid_place(std::int64_t item, std::int64_t width, int height) {
  const auto at = static_cast<std::uint32_t>(item);
  const auto columns = static_cast<std::uint32_t>(width);
  const std::uint32_t line = at / columns;
  const std::uint32_t which = line / static_cast<std::uint32_t>(height);
  return {static_cast<int>(which),
          static_cast<int>(line - which * static_cast<std::uint32_t>(height)),
          static_cast<int>(at - line * columns)};
}

struct Heading {
  double cosine = 1.0;
  double sine = 0.0;
};

/// rotate_template() with masked holes: one item for each pixel of the box of each heading.
struct TurnTemplates {
  const std::uint8_t* local = nullptr;  ///< the template's channel; 0 = hole
  int local_width = 0;
  int local_height = 0;
  double west = 0.0;              ///< of the template, in its own frame, metres
  double north = 0.0;             ///< likewise
  double local_resolution = 0.1;  ///< metres a pixel
  double map_resolution = 0.1;
  bool weighted = false;        ///< by equation [4], normalised distances
  bool weighted_norms = false;  ///< in `seen` too
  const Heading* headings = nullptr;
  int count = 0;
  Box box;
  TurnedPixel* turned = nullptr;

  NADIR_HOST_DEVICE std::int64_t items() const {
    return static_cast<std::int64_t>(count) * box.width * box.height;
  }

  NADIR_HOST_DEVICE void run(std::int64_t item) const {
    const GridPlace place = grid_place(item, box.width, box.height);
    const Heading heading = headings[place.which];
    const double x = (box.left + place.column) * map_resolution;
    const double y = -(box.top + place.row) * map_resolution;
    const double at_column = (heading.cosine * x + heading.sine * y - west) / local_resolution;
    const double at_row = (north - (heading.cosine * y - heading.sine * x)) / local_resolution;
    turned[item] = pixel(at_column, at_row);
  }

 private:
  NADIR_HOST_DEVICE TurnedPixel pixel(double at_column, double at_row) const {
    if (at_column < 0.0 || at_row < 0.0 || at_column > local_width || at_row > local_height) {
      return {};
    }
    const double left = floor(at_column - 0.5);
    const double top = floor(at_row - 0.5);
    const double right_share = at_column - 0.5 - left;
    const double bottom_share = at_row - 0.5 - top;
    double sum = 0.0;
    double carried = 0.0;
    for (int j = 0; j < 2; ++j) {
      for (int i = 0; i < 2; ++i) {
        const int u = static_cast<int>(left) + i;
        const int v = static_cast<int>(top) + j;
        if (u < 0 || v < 0 || u >= local_width || v >= local_height) continue;
        const std::uint8_t grey = local[static_cast<std::int64_t>(v) * local_width + u];
        if (grey == 0) continue;
        const double share = (i == 0 ? 1.0 - right_share : right_share) *
                             (j == 0 ? 1.0 - bottom_share : bottom_share);
        sum += share * grey;
        carried += share;
      }
    }
    if (carried < 0.5) return {};
    const double weight = weighted ? weight_at(at_column, at_row) : 1.0;
    return {static_cast<float>(sum / carried), 1.0F, static_cast<float>(weight),
            weighted_norms ? static_cast<float>(weight) : 1.0F};
  }

  NADIR_HOST_DEVICE double weight_at(double column, double row) const {
    const double half_width = local_width / 2.0;
    const double half_height = local_height / 2.0;
    return 2.0 - (fabs(half_width - column) / half_width) * (fabs(half_height - row) / half_height);
  }
};

/// What is summed once of every turned template.
struct TemplateStats {
  double total_seen = 0.0;
  float mean = 0.0F;  ///< grey, of the pixels that take part
};

/// One block for each template.
struct SumTemplates {
  static constexpr int kThreads = 256;
  struct Partial {
    double seen = 0.0;
    double grey = 0.0;
    double count = 0.0;
  };

  const TurnedPixel* turned = nullptr;
  int count = 0;
  int pixels = 0;  ///< of the box
  TemplateStats* stats = nullptr;

  NADIR_HOST_DEVICE int blocks() const { return count; }

  NADIR_HOST_DEVICE Partial partial(int block, int thread) const {
    Partial sum;
    const TurnedPixel* own = turned + static_cast<std::int64_t>(block) * pixels;
    for (int i = thread; i < pixels; i += kThreads) {
      sum.seen += own[i].seen;
      sum.grey += own[i].mask * own[i].value;
      sum.count += own[i].mask;
    }
    return sum;
  }

  NADIR_HOST_DEVICE static void merge(Partial& to, const Partial& from) {
    to.seen += from.seen;
    to.grey += from.grey;
    to.count += from.count;
  }

  NADIR_HOST_DEVICE void finish(int block, const Partial& sum) const {
    const double mean = sum.count > 0.0 ? sum.grey / sum.count : 0.0;
    stats[block] = {sum.seen, static_cast<float>(mean)};
  }
};

}  // namespace nadir::cuda
