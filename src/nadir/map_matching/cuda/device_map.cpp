// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/cuda/device_map.hpp"

#include "nadir/map_matching/rotated_template.hpp"

namespace nadir::cuda {
namespace {

/// The quads with white holes and a white surround, in the layout of nadir::Quads.
std::vector<std::uint32_t> white_quads_of(const ChannelImage& map) {
  constexpr int kMargin = Quads::kMargin;
  const auto grey_at = [&](int u, int v) -> std::uint32_t {
    if (!map.value.contains(u, v) || map.valid.at(u, v) == 0) {
      return static_cast<std::uint32_t>(kWhite);
    }
    return map.value.at(u, v);
  };
  std::vector<std::uint32_t> words;
  for (int v = -kMargin; v < map.value.height() + kMargin; ++v) {
    for (int u = -kMargin; u < map.value.width() + kMargin; ++u) {
      words.push_back(grey_at(u, v) | (grey_at(u + 1, v) << 8U) | (grey_at(u, v + 1) << 16U) |
                      (grey_at(u + 1, v + 1) << 24U));
    }
  }
  return words;
}

template <class T>
const T* uploaded(Device& device, Memory<T>& memory, const std::vector<T>& values) {
  T* to = memory.reserve(values.size());
  device.upload(to, values.data(), values.size() * sizeof(T), 0);
  device.wait(0);
  return to;
}

}  // namespace

Rule rule_of(const MatchingOptions& options) {
  const auto formula = [&] {
    switch (options.score) {
      case Score::kSsd:
        return Formula::kSsd;
      case Score::kSad:
        return Formula::kSad;
      case Score::kNcc:
        return Formula::kCosine;
      case Score::kWncc:
        return Formula::kWeightedCosine;
      case Score::kWnccPaper:
        return Formula::kPaper;
      case Score::kZncc:
      case Score::kZwncc:
        break;
    }
    return Formula::kZeroMean;
  };
  return {formula(), pixel_role(options).whole_square, options.min_valid_weight};
}

bool is_correlation(const Rule& rule) {
  if (rule.formula == Formula::kPaper) return true;  // a function of many: level_kernels.hpp
  return !rule.whole_square && rule.formula != Formula::kSad;
}

std::vector<std::uint8_t> with_holes(const ChannelImage& channel) {
  std::vector<std::uint8_t> pixels = channel.value.values();
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (channel.valid.values()[i] == 0) pixels[i] = 0;
  }
  return pixels;
}

DeviceMap::DeviceMap(std::unique_ptr<Device> on, const MapIndex& map)
    : device(std::move(on)),
      width(map.channel().value.width()),
      height(map.channel().value.height()),
      mean_grey(static_cast<float>(map.mean_grey())) {
  uploaded(*device, pixels, with_holes(map.channel()));
  const auto& words = map.quads().words;
  quad_map.words = uploaded(*device, quads, words.values());
  quad_map.width = words.width();
  quad_map.height = words.height();
  if (rule_of(map.options()).whole_square) {
    quad_map.white = uploaded(*device, white_quads, white_quads_of(map.channel()));
  }
}

}  // namespace nadir::cuda
