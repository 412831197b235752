// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "nadir/map_matching/cuda/surfaces.hpp"

namespace nadir::cuda {
namespace {

int round_up(int size, int step) { return (size + step - 1) / step * step; }

/// Templates one behind the other, as DirectSurfaces reads them.
struct Lists {
  std::vector<TemplateWord> words;
  std::vector<TemplateRow> rows;
  std::vector<TemplateRows> templates;
};

/// Pixels from `column` of the box on, of a row of a template that begins at `left` in it.
TemplateWord word_at(const RotatedTemplate& local, int row, int column, int left) {
  TemplateWord word;
  for (int k = 0; k < kWord; ++k) {
    const int at = column + k - left;
    if (!local.value.contains(at, row) || local.mask.at(at, row) == 0.0F) continue;
    word.grey[k] = local.value.at(at, row);
    word.takes_part |= 1U << static_cast<unsigned>(k);
    if (local.seen.at(at, row) != 0.0F) word.seen |= 1U << static_cast<unsigned>(k);
  }
  return word;
}

void append_row(Lists& lists, const RotatedTemplate& local, int row, int left, int offset) {
  const std::size_t first = lists.words.size();
  const int begin = left - left % kWord;
  for (int column = begin; column < left + local.value.width(); column += kWord) {
    const TemplateWord word = word_at(local, row, column, left);
    if (word.takes_part == 0 && lists.words.size() == first) {
      offset += kWord;
    } else {
      lists.words.push_back(word);
    }
  }
  while (lists.words.size() > first && lists.words.back().takes_part == 0) lists.words.pop_back();
  if (lists.words.size() == first) return;
  lists.rows.push_back(
      {offset + begin, static_cast<int>(first), static_cast<int>(lists.words.size())});
}

void append_template(Lists& lists, const RotatedTemplate& local, const Box& box, int pitch) {
  TemplateRows own{static_cast<int>(lists.rows.size()), 0, 0.0, local.total_seen};
  for (int row = 0; row < local.value.height(); ++row) {
    append_row(lists, local, row, local.left - box.left, (local.top - box.top + row) * pitch);
  }
  own.end = static_cast<int>(lists.rows.size());
  for (const float mask : local.mask.values()) own.count += mask;
  lists.templates.push_back(own);
}

template <class T>
const T* uploaded(Device& device, const std::vector<T>& values, Staging<T>& staging, Memory<T>& to,
                  int stream) {
  std::copy(values.begin(), values.end(), staging.reserve(values.size()));
  device.upload(to.reserve(values.size()), staging.data(), values.size() * sizeof(T), stream);
  return to.data();
}

/// The part of the map below all positions, in whole words and one more, that is read ahead, behind
/// its last column.
PadMap pad_map(DeviceMap& map, const SurfaceJob& job) {
  PadMap pad{map.pixels.data(), map.width, map.height, {}, job.rule.whole_square ? kWhite : 0.0F};
  pad.area = {
      job.window.left + job.box.left, job.window.top + job.box.top,
      round_up(job.window.width, DirectSurfaces::kColumns) + round_up(job.box.width, kWord) + kWord,
      job.window.height + job.box.height - 1};
  const auto plane = static_cast<std::size_t>(pad.items());
  pad.grey = map.padded.reserve(2 * plane);
  pad.seen = pad.grey + plane;
  map.device->launch(pad, 0);
  map.device->wait(0);  // both streams read it
  return pad;
}

}  // namespace

void sum_surfaces(DeviceMap& map, const SurfaceJob& job, std::span<const RotatedTemplate> templates,
                  SurfaceSink& sink) {
  Device& device = *map.device;
  const PadMap pad = pad_map(map, job);
  const auto window =
      static_cast<std::size_t>(job.window.width) * static_cast<std::size_t>(job.window.height);
  const std::size_t words = static_cast<std::size_t>(round_up(job.box.width, kWord) / kWord) *
                            static_cast<std::size_t>(job.box.height);
  const std::size_t bytes =
      window * (2 * sizeof(float) + sizeof(PeakKey)) + words * sizeof(TemplateWord);
  const int size = batch_size(job.count, device.workspace_bytes(), bytes);
  const std::size_t scores = window * static_cast<std::size_t>(size);
  for_each_batch(map, job, size, sink, [&](const Batch& batch) {
    StreamWork& work = map.work[static_cast<std::size_t>(batch.stream)];
    Lists lists;
    for (const RotatedTemplate& local : templates.subspan(static_cast<std::size_t>(batch.first),
                                                          static_cast<std::size_t>(batch.count))) {
      append_template(lists, local, job.box, pad.area.width);
    }
    lists.words.emplace_back();  // read ahead, not used
    DirectSurfaces surfaces;
    surfaces.grey = pad.grey;
    surfaces.seen = pad.seen;
    surfaces.pitch = pad.area.width;
    surfaces.words = uploaded(device, lists.words, work.staged_words, work.words, batch.stream);
    surfaces.rows = uploaded(device, lists.rows, work.staged_rows, work.rows, batch.stream);
    surfaces.templates =
        uploaded(device, lists.templates, work.staged_templates, work.templates, batch.stream);
    surfaces.count = batch.count;
    surfaces.width = job.window.width;
    surfaces.height = job.window.height;
    surfaces.rule = job.rule;
    surfaces.score = work.score.reserve(scores);
    surfaces.share = work.share.reserve(scores);
    device.launch(surfaces, batch.stream);
  });
}

}  // namespace nadir::cuda
