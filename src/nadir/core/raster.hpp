// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nadir {

/// A dense image: `height` rows of `width` pixels of `channels` interleaved values, without
/// padding. Row 0 is the top (north) edge.
template <class T>
class Raster {
 public:
  Raster() = default;
  Raster(int width, int height, T fill = T{}, int channels = 1)
      : width_(width),
        height_(height),
        channels_(channels),
        values_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                    static_cast<std::size_t>(channels),
                fill) {}

  int width() const { return width_; }
  int height() const { return height_; }
  int channels() const { return channels_; }
  bool empty() const { return values_.empty(); }
  bool contains(int column, int row) const {
    return column >= 0 && row >= 0 && column < width_ && row < height_;
  }
  template <class U>
  bool same_size(const Raster<U>& other) const {
    return width_ == other.width() && height_ == other.height();
  }

  T& at(int column, int row, int channel = 0) { return values_[index(column, row, channel)]; }
  const T& at(int column, int row, int channel = 0) const {
    return values_[index(column, row, channel)];
  }
  std::span<T> row(int row) { return {values_.data() + index(0, row, 0), row_size()}; }
  std::span<const T> row(int row) const { return {values_.data() + index(0, row, 0), row_size()}; }
  std::vector<T>& values() { return values_; }
  const std::vector<T>& values() const { return values_; }

  bool operator==(const Raster&) const = default;

 private:
  std::size_t row_size() const {
    return static_cast<std::size_t>(width_) * static_cast<std::size_t>(channels_);
  }
  std::size_t index(int column, int row, int channel) const {
    return (static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
            static_cast<std::size_t>(column)) *
               static_cast<std::size_t>(channels_) +
           static_cast<std::size_t>(channel);
  }

  int width_ = 0;
  int height_ = 0;
  int channels_ = 1;
  std::vector<T> values_;
};

}  // namespace nadir
