// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/photos/position_list.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>

#include "nadir/core/options.hpp"
#include "nadir/io/detail/text_table.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/maps/metric_frame.hpp"

namespace nadir {
namespace {

const std::vector<std::string> kColumns{"name", "lat",   "lon",  "alt",
                                        "yaw",  "pitch", "roll", "sigma"};

/// Other names of the columns in the wild.
std::string column_name(const std::string& word) {
  static const std::map<std::string, std::string> other_names{
      {"filename", "name"}, {"file", "name"},    {"image", "name"},  {"photo", "name"},
      {"label", "name"},    {"latitude", "lat"}, {"y", "lat"},       {"longitude", "lon"},
      {"long", "lon"},      {"lng", "lon"},      {"x", "lon"},       {"altitude", "alt"},
      {"z", "alt"},         {"height", "alt"},   {"heading", "yaw"}, {"accuracy", "sigma"}};
  std::string lower = word;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  lower.erase(0, lower.find_first_not_of("# "));
  const auto found = other_names.find(lower);
  return found == other_names.end() ? lower : found->second;
}

bool is_header(const TextRow& row) {
  return std::any_of(row.fields.begin(), row.fields.end(),
                     [](const std::string& field) { return column_name(field) == "lat"; });
}

std::vector<std::string> header_of(const TextRow& row) {
  std::vector<std::string> columns;
  for (const std::string& field : row.fields) columns.push_back(column_name(field));
  for (const char* needed : {"name", "lat", "lon"}) {
    if (std::find(columns.begin(), columns.end(), needed) == columns.end()) {
      throw Error(ErrorKind::kInput, std::string("there is no column '") + needed + "'", row.where,
                  "name the columns name,lat,lon,alt[,yaw,pitch,roll,sigma]");
    }
  }
  return columns;
}

/// The fields of a line by the names of their columns; empty ones are absent.
std::map<std::string, std::string> by_column(const TextRow& row,
                                             const std::vector<std::string>& columns) {
  if (row.fields.size() > columns.size() || row.fields.size() < 3) {
    throw Error(ErrorKind::kInput,
                std::to_string(row.fields.size()) +
                    " fields, name,lat,lon,alt[,yaw,pitch,roll,"
                    "sigma] are expected",
                row.where, "correct the line");
  }
  std::map<std::string, std::string> fields;
  for (std::size_t i = 0; i < row.fields.size(); ++i) {
    if (!row.fields[i].empty()) fields[columns[i]] = row.fields[i];
  }
  return fields;
}

void check_place(const GeodeticPosition& position, const std::string& where) {
  if (std::abs(position.latitude_deg) <= 90.0 && std::abs(position.longitude_deg) <= 180.0) return;
  throw Error(ErrorKind::kInput, "latitude or longitude is impossible", where,
              "write latitude first, in degrees, or name the columns");
}

ListedPosition csv_position(const TextRow& row, const std::vector<std::string>& columns) {
  const auto fields = by_column(row, columns);
  const auto value = [&](const char* column) -> std::optional<double> {
    const auto found = fields.find(column);
    if (found == fields.end()) return std::nullopt;
    return number_in_file(found->second, column, row.where);
  };
  if (!fields.contains("name") || !fields.contains("lat") || !fields.contains("lon")) {
    throw Error(ErrorKind::kInput, "name, latitude or longitude is empty", row.where,
                "fill it in or remove the line");
  }
  ListedPosition listed;
  listed.photo = fields.at("name");
  listed.position.latitude_deg = *value("lat");
  listed.position.longitude_deg = *value("lon");
  const auto altitude = value("alt");
  listed.position.altitude_m = altitude.value_or(0.0);
  listed.position.altitude_known = altitude.has_value();
  check_place(listed.position, row.where);
  if (const auto sigma = value("sigma"); sigma && *sigma > 0.0) {
    listed.position.horizontal_sigma_m = sigma;
  }
  const auto yaw = value("yaw");
  if (yaw) {
    listed.attitude =
        GimbalAttitude{*yaw, value("pitch").value_or(-90.0), value("roll").value_or(0.0)};
  }
  return listed;
}

bool is_reference_system(const TextRow& row) {
  const std::string& text = row.text;
  return text.starts_with("EPSG:") || text.starts_with("+proj") || text.starts_with("+init") ||
         text.starts_with("WGS84 UTM") || text.starts_with("PROJCS") || text.starts_with("GEOGCS");
}

ListedPosition odm_position(const TextRow& row, const GeodeticReader& reader) {
  const std::vector<std::string>& f = row.words;
  if (f.size() < 3) {
    throw Error(ErrorKind::kInput, "photo, east and north are expected", row.where,
                "correct the line");
  }
  const auto value = [&](std::size_t i) { return number_in_file(f[i], "field", row.where); };
  ListedPosition listed;
  listed.photo = f[0];
  listed.position = reader.read(value(1), value(2), f.size() > 3 ? value(3) : 0.0, row.where);
  listed.position.altitude_known = f.size() > 3;
  if (f.size() > 7) listed.position.horizontal_sigma_m = value(7);
  if (f.size() > 8) listed.position.vertical_sigma_m = value(8);
  return listed;
}

}  // namespace

std::vector<ListedPosition> read_positions(const std::filesystem::path& path) {
  const std::vector<TextRow> rows = read_text_table(path);
  std::vector<ListedPosition> positions;
  if (rows.empty()) throw input_error(path, "holds no positions", "write name,lat,lon,alt lines");
  std::optional<GeodeticReader> reader;
  std::vector<std::string> columns = kColumns;
  const bool odm = is_reference_system(rows.front());
  if (odm) reader.emplace(rows.front().text, rows.front().where);
  const bool header = !odm && is_header(rows.front());
  if (header) columns = header_of(rows.front());
  std::set<std::string> seen;
  for (std::size_t i = odm || header ? 1 : 0; i < rows.size(); ++i) {
    positions.push_back(odm ? odm_position(rows[i], *reader) : csv_position(rows[i], columns));
    if (!seen.insert(positions.back().photo).second) {
      throw Error(ErrorKind::kInput, "the photo " + positions.back().photo + " is listed twice",
                  rows[i].where, "remove one of the lines");
    }
  }
  return positions;
}

}  // namespace nadir
