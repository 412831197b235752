// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nadir/map_matching/cuda/turn_kernels.hpp"

namespace nadir::cuda {

/// Into 0 .. size - 1.
NADIR_HOST_DEVICE inline int wrap(int at, int size) {
  const int rest = at % size;
  return rest < 0 ? rest + size : rest;
}

/// A plane of a batched real transform in place: rows of `width` reals, padded to the
/// width / 2 + 1 complex values of their spectrum.
struct PlaneShape {
  int width = 0;
  int height = 0;
  NADIR_HOST_DEVICE int half() const { return width / 2 + 1; }
  /// Reals from row to row.
  NADIR_HOST_DEVICE std::int64_t pitch() const { return std::int64_t{2} * half(); }
  NADIR_HOST_DEVICE std::int64_t complexes() const {
    return static_cast<std::int64_t>(half()) * height;
  }
  NADIR_HOST_DEVICE std::int64_t reals() const { return 2 * complexes(); }
  NADIR_HOST_DEVICE std::int64_t at(int column, int row) const { return row * pitch() + column; }
  /// Of the correlation at a position of `window`.
  NADIR_HOST_DEVICE std::int64_t at_position(const Box& window, const GridPlace& place) const {
    return at(wrap(window.left + place.column, width), wrap(window.top + place.row, height));
  }
};

struct Complex {
  float real = 0.0F;
  float imaginary = 0.0F;
};
NADIR_HOST_DEVICE inline Complex times_conjugate(Complex a, Complex b) {
  return {a.real * b.real + a.imaginary * b.imaginary, a.imaginary * b.real - a.real * b.imaginary};
}

/// The planes of the map: V, V R', V R'^2.
inline constexpr int kMapPlanes = 3;
/// Of a template: a, a P', a P'^2, and for the weighted cosine w P / 64. Of [5]: what takes part,
/// what was seen, w |P - Pm| / 64.
NADIR_HOST_DEVICE inline int template_planes(Formula formula) {
  return formula == Formula::kWeightedCosine ? 4 : 3;
}
/// Their products: V*a, VR'*a, VR'^2*a, V*aP', V*aP'^2, VR'*aP', and then V*wP, VR'*wP.
/// Of [5]: V, VR' and VR'^2 with what takes part, V with what was seen.
NADIR_HOST_DEVICE inline int product_planes(Formula formula) {
  if (formula == Formula::kPaper) return 4;
  return formula == Formula::kWeightedCosine ? 8 : 6;
}

/// The map's grey at a real of a plane over `crop`; 0, a hole, behind it.
NADIR_HOST_DEVICE inline std::uint8_t grey_at(const std::uint8_t* map, int map_width,
                                              const Box& crop, const PlaneShape& shape,
                                              std::int64_t item) {
  const GridPlace place = grid_place(item, shape.pitch(), shape.height);
  if (place.column >= crop.width || place.row >= crop.height) return 0;
  return map[static_cast<std::int64_t>(crop.top + place.row) * map_width + crop.left +
             place.column];
}

/// A rectangle of the map, as planes; what lies outside of it is hole.
struct MapPlanes {
  const std::uint8_t* map = nullptr;  ///< 0 = hole
  int map_width = 0;
  Box crop;  ///< the rectangle, in pixels of the map
  float shift = 0.0F;
  PlaneShape shape;
  float* planes = nullptr;

  NADIR_HOST_DEVICE std::int64_t items() const { return shape.reals(); }
  NADIR_HOST_DEVICE void run(std::int64_t item) const {
    const std::uint8_t grey = grey_at(map, map_width, crop, shape, item);
    const float value = grey == 0 ? 0.0F : (grey - shift) / kGreyScale;
    planes[item] = grey == 0 ? 0.0F : 1.0F;
    planes[shape.reals() + item] = value;
    planes[2 * shape.reals() + item] = value * value;
  }
};

/// Templates as planes: the robot's pixel is (0, 0), and what lies left of it or above wraps
/// around.
struct TemplatePlanes {
  const TurnedPixel* turned = nullptr;
  const TemplateStats* stats = nullptr;
  int count = 0;
  Box box;
  Formula formula = Formula::kZeroMean;
  PlaneShape shape;
  float* planes = nullptr;  ///< template_planes() of each template, one template after another

  NADIR_HOST_DEVICE std::int64_t items() const { return count * shape.reals(); }
  NADIR_HOST_DEVICE void run(std::int64_t item) const {
    const GridPlace place = grid_place(item, shape.pitch(), shape.height);
    const std::int64_t which = place.which;
    const int column = wrap(place.column - box.left, shape.width);
    const int row = wrap(place.row - box.top, shape.height);
    TurnedPixel pixel;
    if (place.column < shape.width && column < box.width && row < box.height) {
      pixel = turned[(which * box.height + row) * box.width + column];
    }
    const float p = pixel.mask * (pixel.value - stats[which].mean) / kGreyScale;
    float* own = planes + which * template_planes(formula) * shape.reals() +
                 shape.at(place.column, place.row);
    if (formula == Formula::kPaper) {
      own[0] = pixel.mask;
      own[shape.reals()] = pixel.seen;
      own[2 * shape.reals()] = pixel.weight * fabsf(p);
      return;
    }
    const float ap = pixel.seen * p;
    own[0] = pixel.seen;
    own[shape.reals()] = ap;
    own[2 * shape.reals()] = ap * p;
    if (formula == Formula::kWeightedCosine) {
      own[3 * shape.reals()] = pixel.weight * pixel.value / kGreyScale;
    }
  }
};

/// Spectra of the map times the conjugates of those of the templates.
struct MultiplySpectra {
  const Complex* map = nullptr;
  const Complex* templates = nullptr;
  int count = 0;
  Formula formula = Formula::kZeroMean;
  PlaneShape shape;
  Complex* products = nullptr;  ///< product_planes() of each template

  NADIR_HOST_DEVICE std::int64_t items() const { return count * shape.complexes(); }
  NADIR_HOST_DEVICE void run(std::int64_t item) const {
    const std::int64_t plane = shape.complexes();
    const std::int64_t which = item / plane;
    const std::int64_t at = item % plane;
    const Complex mask = map[at];
    const Complex value = map[plane + at];
    const Complex squares = map[2 * plane + at];
    const Complex* own = templates + which * template_planes(formula) * plane + at;
    Complex* to = products + which * product_planes(formula) * plane + at;
    const Complex a = own[0];
    const Complex p = own[plane];  // of [5], what was seen
    to[0] = times_conjugate(mask, a);
    to[plane] = times_conjugate(value, a);
    to[2 * plane] = times_conjugate(squares, a);
    if (formula == Formula::kPaper) {
      to[3 * plane] = times_conjugate(mask, p);
      return;
    }
    to[3 * plane] = times_conjugate(mask, p);
    to[4 * plane] = times_conjugate(mask, own[2 * plane]);
    to[5 * plane] = times_conjugate(value, p);
    if (formula != Formula::kWeightedCosine) return;
    to[6 * plane] = times_conjugate(mask, own[3 * plane]);
    to[7 * plane] = times_conjugate(value, own[3 * plane]);
  }
};

/// The score at every position of the window from the six (eight) correlations.
struct AssembleScores {
  const float* correlations = nullptr;
  const TemplateStats* stats = nullptr;
  int count = 0;
  Rule rule;
  float map_shift = 0.0F;
  PlaneShape shape;
  Box window;  ///< robot positions, relative to the map's rectangle
  float* score = nullptr;
  float* share = nullptr;

  NADIR_HOST_DEVICE std::int64_t items() const {
    return static_cast<std::int64_t>(count) * window.width * window.height;
  }
  NADIR_HOST_DEVICE void run(std::int64_t item) const {
    const GridPlace place = grid_place(item, window.width, window.height);
    const std::int64_t which = place.which;
    const float* own = correlations + which * product_planes(rule.formula) * shape.reals() +
                       shape.at_position(window, place);
    const double compared = share_of(sum(own, 0), stats[which].total_seen);
    share[item] = static_cast<float>(compared);
    score[item] = static_cast<float>(is_enough(rule, compared) ? score_at(own, stats[which].mean)
                                                               : undefined());
  }

 private:
  NADIR_HOST_DEVICE double sum(const float* own, int plane) const {
    // The transforms there and back multiply by the number of pixels.
    return own[plane * shape.reals()] * (1.0 / (static_cast<double>(shape.width) * shape.height));
  }

  NADIR_HOST_DEVICE double score_at(const float* own, float local_shift) const {
    Sums<double> sums;
    sums.a = sum(own, 0);
    sums.r = sum(own, 1);
    sums.rr = sum(own, 2);
    sums.p = sum(own, 3);
    sums.pp = sum(own, 4);
    sums.rp = sum(own, 5);
    if (rule.formula == Formula::kZeroMean) return score_of(rule.formula, sums);

    // The rest depends on the grey level itself: take the shifts out, R / 64 = R' + m.
    const double m = map_shift / kGreyScale;
    const double l = local_shift / kGreyScale;
    sums.rp += m * sums.p + l * sums.r + m * l * sums.a;
    sums.rr += 2.0 * m * sums.r + m * m * sums.a;
    sums.pp += 2.0 * l * sums.p + l * l * sums.a;
    const double distance = sums.rr - 2.0 * sums.rp + sums.pp;
    sums.distance = distance > 0.0 ? distance : 0.0;
    if (rule.formula == Formula::kWeightedCosine) sums.rp = sum(own, 7) + m * sum(own, 6);
    return score_of(rule.formula, sums);
  }
};

}  // namespace nadir::cuda
