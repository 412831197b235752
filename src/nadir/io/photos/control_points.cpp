// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/photos/control_points.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "nadir/io/detail/text_table.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/maps/metric_frame.hpp"

namespace nadir {
namespace {

using Place = std::array<double, 3>;

struct Line {
  Place place{};
  std::string name;
  ListedControlPoint::Mark mark;
};

Line parse(const TextRow& row) {
  const std::vector<std::string>& f = row.words;
  if (f.size() < 6) {
    throw Error(ErrorKind::kInput,
                std::to_string(f.size()) +
                    " fields, `east north height column row photo [name]` are expected",
                row.where, "correct the line");
  }
  const auto value = [&](std::size_t i, const char* what) {
    return number_in_file(f[i], what, row.where);
  };
  Line line;
  line.place = {value(0, "east"), value(1, "north"), value(2, "height")};
  line.mark = {f[5], value(3, "column"), value(4, "row"), row.where};
  if (f.size() > 6) line.name = f[6];
  return line;
}

}  // namespace

std::vector<ListedControlPoint> read_control_points(const std::filesystem::path& path) {
  const std::vector<TextRow> rows = read_text_table(path);
  if (rows.empty()) throw input_error(path, "holds no control points");
  const GeodeticReader reader(rows.front().text, rows.front().where);
  std::vector<ListedControlPoint> points;
  std::map<Place, std::size_t> known;
  std::map<std::string, std::size_t> named;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const Line line = parse(rows[i]);
    const auto [found, added] = known.try_emplace(line.place, points.size());
    if (added) {
      ListedControlPoint point;
      point.name = line.name.empty() ? "gcp" + std::to_string(points.size() + 1) : line.name;
      point.position = reader.read(line.place[0], line.place[1], line.place[2], line.mark.where);
      if (!named.try_emplace(point.name, points.size()).second) {
        throw Error(ErrorKind::kInput, "the name " + point.name + " stands for two places",
                    line.mark.where, "correct the coordinates or the name");
      }
      points.push_back(std::move(point));
    }
    points[found->second].marks.push_back(line.mark);
  }
  if (points.empty()) {
    throw input_error(path, "holds no control points below its first line",
                      "write `east north height column row photo [name]` lines");
  }
  return points;
}

}  // namespace nadir
