// SPDX-License-Identifier: Apache-2.0
#include "nadir/pipelines/frame_range.hpp"

#include <algorithm>
#include <charconv>

#include "nadir/core/error.hpp"

namespace nadir {
namespace {

int parse_frame_number(const std::string& digits, const std::string& range) {
  int number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc{} || end != digits.data() + digits.size()) {
    throw Error(ErrorKind::kUsage, "'" + range + "' is not a range of frame numbers", "--frames",
                "write FIRST:LAST, both included");
  }
  return number;
}

std::string numbers_of(const Sequence& sequence) {
  return "the site has frames " + std::to_string(sequence.local_maps.front().number) + " to " +
         std::to_string(sequence.local_maps.back().number);
}

}  // namespace

FrameRange parse_frame_range(const std::string& text) {
  FrameRange range;
  if (text.empty()) return range;
  const std::size_t colon = text.find(':');
  const std::string from = text.substr(0, colon);
  const std::string to = colon == std::string::npos ? from : text.substr(colon + 1);
  if (!from.empty()) range.first = parse_frame_number(from, text);
  if (!to.empty()) range.last = parse_frame_number(to, text);
  if (range.first > range.last) {
    throw Error(ErrorKind::kUsage, "the range " + text + " ends before it begins", "--frames");
  }
  return range;
}

std::vector<Sequence::LocalMap> select_frames(const Sequence& sequence, const FrameRange& range) {
  std::vector<Sequence::LocalMap> selected;
  std::ranges::copy_if(sequence.local_maps, std::back_inserter(selected), [&](const auto& map) {
    return map.number >= range.first && map.number <= range.last;
  });
  if (selected.empty()) {
    throw Error(ErrorKind::kUsage, "no frame lies in the range", "--frames", numbers_of(sequence));
  }
  return selected;
}

const Sequence::LocalMap& find_frame(const Sequence& sequence, int number) {
  const auto found = std::ranges::find(sequence.local_maps, number, &Sequence::LocalMap::number);
  if (found == sequence.local_maps.end()) {
    throw Error(ErrorKind::kUsage, "there is no frame " + std::to_string(number), "--frame",
                numbers_of(sequence));
  }
  return *found;
}

}  // namespace nadir
