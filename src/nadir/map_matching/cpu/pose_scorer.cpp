// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/cpu/pose_scorer.hpp"

#include <cmath>

#include "nadir/map_matching/rotated_template.hpp"

// Compiled once per vector width and dispatched at run time (Highway).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nadir/map_matching/cpu/pose_scorer.cpp"
#include <hwy/foreach_target.h>  // must stand before highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace nadir::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::ScalableTag<float>;
using Floats = hn::Vec<FloatTag>;

/// The samples under one vector of pixels: R' with 0 in holes, and 1 or 0 for seen or hole.
struct Samples {
  Floats value;
  Floats seen;
};

HWY_INLINE Samples sample(const Quads& map, Floats column, Floats row, int base_column,
                          int base_row, float map_shift) {
  const FloatTag d;
  const hn::RebindToSigned<FloatTag> di;
  const hn::RebindToUnsigned<FloatTag> du;
  const Floats left = hn::Floor(column);
  const Floats top = hn::Floor(row);
  const Floats across = hn::Sub(column, left);
  const Floats down = hn::Sub(row, top);

  const auto clamp = [&](hn::Vec<decltype(di)> index, int highest) {
    return hn::Min(hn::Max(index, hn::Zero(di)), hn::Set(di, highest));
  };
  const auto u =
      clamp(hn::Add(hn::ConvertTo(di, left), hn::Set(di, base_column)), map.words.width() - 1);
  const auto v =
      clamp(hn::Add(hn::ConvertTo(di, top), hn::Set(di, base_row)), map.words.height() - 1);
  const auto index = hn::Add(hn::Mul(v, hn::Set(di, map.words.width())), u);
  const auto quad = hn::GatherIndex(du, map.words.values().data(), index);

  const auto byte = [&](auto word) {
    return hn::ConvertTo(d, hn::BitCast(di, hn::And(word, hn::Set(du, 255U))));
  };
  const Floats upper_left = byte(quad);
  const Floats upper_right = byte(hn::ShiftRight<8>(quad));
  const Floats lower_left = byte(hn::ShiftRight<16>(quad));
  const Floats lower_right = byte(hn::ShiftRight<24>(quad));
  const Floats upper = hn::MulAdd(across, hn::Sub(upper_right, upper_left), upper_left);
  const Floats lower = hn::MulAdd(across, hn::Sub(lower_right, lower_left), lower_left);
  const Floats grey = hn::MulAdd(down, hn::Sub(lower, upper), upper);

  const auto hole = hn::RebindMask(d, hn::Eq(quad, hn::Zero(du)));
  const Floats seen = hn::IfThenElse(hole, hn::Zero(d), hn::Set(d, 1.0F));
  const Floats shifted = hn::Mul(hn::Sub(grey, hn::Set(d, map_shift)),
                                 hn::Set(d, static_cast<float>(1.0 / kGreyScale)));
  return {hn::Mul(shifted, seen), seen};
}

double total(Floats lanes) {
  const FloatTag d;
  HWY_ALIGN float values[hn::MaxLanes(FloatTag{})];
  hn::Store(lanes, d, values);
  double sum = 0.0;
  for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) sum += static_cast<double>(values[lane]);
  return sum;
}

Sums sum_pixels(const Quads& map, const PixelList& pixels, const PixelPose& pose) {
  const FloatTag d;
  const std::size_t lanes = hn::Lanes(d);
  // The integer part of the position stays an integer: float32 keeps full precision in any map.
  const double whole_column = std::floor(pose.column);
  const double whole_row = std::floor(pose.row);
  const int base_column = static_cast<int>(whole_column) + Quads::kMargin;
  const int base_row = static_cast<int>(whole_row) + Quads::kMargin;
  const Floats column0 = hn::Set(d, static_cast<float>(pose.column - whole_column));
  const Floats row0 = hn::Set(d, static_cast<float>(pose.row - whole_row));
  const Floats c = hn::Set(d, static_cast<float>(pose.cosine));
  const Floats s = hn::Set(d, static_cast<float>(pose.sine));
  const auto map_shift = static_cast<float>(pixels.shifts.map);

  Floats a = hn::Zero(d), r = a, rr = a, p = a, pp = a, rp = a, wp = a, wrp = a;
  // The lists are padded to whole vectors with pixels of no weight.
  for (std::size_t i = 0; i < pixels.x.size(); i += lanes) {
    const Floats x = hn::LoadU(d, &pixels.x[i]);
    const Floats y = hn::LoadU(d, &pixels.y[i]);
    const Floats column = hn::Add(column0, hn::Sub(hn::Mul(c, x), hn::Mul(s, y)));
    const Floats row = hn::Sub(row0, hn::Add(hn::Mul(s, x), hn::Mul(c, y)));
    const Samples under = sample(map, column, row, base_column, base_row, map_shift);
    const Floats weight = hn::LoadU(d, &pixels.a[i]);
    const Floats weighted = hn::Mul(weight, under.value);
    const Floats local = hn::LoadU(d, &pixels.p[i]);
    a = hn::MulAdd(weight, under.seen, a);
    r = hn::Add(r, weighted);
    rr = hn::MulAdd(weighted, under.value, rr);
    p = hn::MulAdd(local, under.seen, p);
    pp = hn::MulAdd(hn::LoadU(d, &pixels.pp[i]), under.seen, pp);
    rp = hn::MulAdd(local, under.value, rp);
    if (pixels.wp.empty()) continue;
    const Floats product = hn::LoadU(d, &pixels.wp[i]);
    wp = hn::MulAdd(product, under.seen, wp);
    wrp = hn::MulAdd(product, under.value, wrp);
  }
  return {total(a), total(r), total(rr), total(p), total(pp), total(rp), total(wp), total(wrp)};
}

}  // namespace nadir::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nadir::cpu {
namespace {

/// More lanes than any vector has.
constexpr std::size_t kPadding = 64;

}  // namespace

HWY_EXPORT(sum_pixels);

Sums sum_at(const Quads& map, const PixelList& pixels, const PixelPose& pose) {
  return HWY_DYNAMIC_DISPATCH(sum_pixels)(map, pixels, pose);
}

PixelList list_pixels(const ChannelImage& local, const MatchingOptions& options,
                      double map_resolution, double map_shift) {
  const PixelRole role = pixel_role(options);
  PixelList list;
  list.shifts.map = map_shift;
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < local.value.values().size(); ++i) {
    if (local.valid.values()[i] == 0) continue;
    sum += local.value.values()[i];
    count += 1.0;
  }
  list.shifts.local = count > 0.0 ? sum / count : 0.0;

  for (int row = 0; row < local.value.height(); ++row) {
    for (int column = 0; column < local.value.width(); ++column) {
      if (local.valid.at(column, row) == 0) continue;
      const PixelCoordinate centre{column + 0.5, row + 0.5};
      const double weight = role.weighted ? pixel_weight(role.weight, centre, local.value.width(),
                                                         local.value.height())
                                          : 1.0;
      const double a = role.weighted_norms ? weight : 1.0;
      const double unit = (local.value.at(column, row) - list.shifts.local) / kGreyScale;
      list.x.push_back(static_cast<float>(local.geo.x_at(centre.column) / map_resolution));
      list.y.push_back(static_cast<float>(local.geo.y_at(centre.row) / map_resolution));
      list.a.push_back(static_cast<float>(a));
      list.p.push_back(static_cast<float>(a * unit));
      list.pp.push_back(static_cast<float>(a * unit * unit));
      if (options.score == Score::kWncc) {
        list.wp.push_back(static_cast<float>(weight * local.value.at(column, row) / kGreyScale));
      }
      list.total_seen += a;
    }
  }
  const std::size_t padded = (list.x.size() + kPadding - 1) / kPadding * kPadding;
  for (auto* values : {&list.x, &list.y, &list.a, &list.p, &list.pp}) values->resize(padded, 0.0F);
  if (!list.wp.empty()) list.wp.resize(padded, 0.0F);
  return list;
}

}  // namespace nadir::cpu
#endif  // HWY_ONCE
