// SPDX-License-Identifier: Apache-2.0
#include "run_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "nadir/core/angle.hpp"
#include "nadir/core/error.hpp"
#include "nadir/io/atomic_file.hpp"
#include "nadir/pages/html_page.hpp"
#include "nadir/report/text_table.hpp"
#include "run_charts.hpp"
#include "run_pictures.hpp"
#include "run_record.hpp"
#include "run_settings.hpp"
#include "run_words.hpp"

namespace nadir::cli {
namespace {

namespace fs = std::filesystem;
using html::Markup;

html::Row statistics_row(const std::string& name, const Statistics& s, double factor) {
  html::Row cells{name};
  for (const double value : {s.rmse, s.mean, s.median, s.std, s.min, s.max}) {
    cells.emplace_back(fixed(factor * value, 3));
  }
  return cells;
}

std::string nees_in_words(const Consistency& c) {
  if (c.frames == 0) return "none: no covariance can be inverted";
  return fmt::format(
      "{:.2f} on average (an honest covariance: 3; {:.2f} to {:.2f} if the frames were "
      "independent); {} of the frames under their 95 % quantile",
      c.mean_nees, c.band.low, c.band.high, percent(c.share_within_95));
}

Markup accuracy(const Judgement& judgement) {
  const Evaluation& e = judgement.evaluation;
  Markup markup = html::heading("Accuracy");
  markup += html::table({"", "RMSE", "mean", "median", "std", "min", "max"},
                        {statistics_row("APE position, m", e.ape_translation_m, 1.0),
                         statistics_row("APE heading, \u00b0", e.ape_yaw_rad, degrees(1.0)),
                         statistics_row("RPE position, m", e.rpe_translation_m, 1.0),
                         statistics_row("RPE heading, \u00b0", e.rpe_angle_rad, degrees(1.0))},
                        html::Columns::kNumbers);
  const std::string converged =
      e.time_to_converge_s ? fixed(*e.time_to_converge_s, 1) + " s after the first frame" : "never";
  std::vector<html::Row> facts{
      {"Frames with a truth",
       fmt::format("{}, of which {} got no estimate", e.truth_frames, e.unanswered_frames)},
      {"Within",
       fmt::format("0.5 m: {}, 1 m: {}, 5\u00b0: {}", percent(e.share_within_half_metre),
                   percent(e.share_within_one_metre), percent(e.share_within_five_degrees))},
      {"Error under 1 m to the end from", converged},
      {"Lost", fmt::format("{} times more than {:g} m off", e.lost_count, kLostBeyond)}};
  if (judgement.consistency) facts.push_back({"NEES", nees_in_words(*judgement.consistency)});
  markup += html::table({}, facts, html::Columns::kTexts);
  return markup + html::paragraph(
                      "APE: absolute, without any alignment; RPE: from frame to frame "
                      "(docs/glossary.md).");
}

Markup frame_table(const RunRecord& run) {
  std::vector<std::pair<std::string, std::vector<int>>> by_status;
  for (const ViewFrame& frame : run.frames) {
    auto found =
        std::ranges::find(by_status, frame.status, &decltype(by_status)::value_type::first);
    if (found == by_status.end()) found = by_status.insert(found, {frame.status, {}});
    found->second.push_back(frame.number);
  }
  std::vector<html::Row> rows;
  for (const auto& [status, numbers] : by_status) {
    rows.push_back({status_in_words(status), std::to_string(numbers.size()), stretches(numbers)});
  }
  std::vector<int> missing;
  for (std::size_t i = 1; i < run.frames.size(); ++i) {
    for (int n = run.frames[i - 1].number + 1; n < run.frames[i].number; ++n) missing.push_back(n);
  }
  if (!missing.empty()) {
    rows.push_back(
        {"no local map of this number", std::to_string(missing.size()), stretches(missing)});
  }
  return html::heading("Frames") +
         html::table({"", "frames", "numbers"}, rows, html::Columns::kTexts);
}

double median_of(const RunRecord& run, double ViewFrame::*member) {
  std::vector<double> values;
  for (const ViewFrame& frame : run.frames) values.push_back(frame.*member);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

Markup key_figures(const RunRecord& run) {
  std::vector<html::KeyFigure> figures;
  const auto compared = std::ranges::count(run.frames, "ok", &ViewFrame::status);
  figures.push_back({fmt::format("{} of {}", compared, run.frames.size()), "frames compared"});
  if (run.judgement) {
    const Evaluation& e = run.judgement->evaluation;
    figures.push_back({fixed(e.ape_translation_m.rmse, 2) + " m", "position error, RMSE"});
    figures.push_back({fixed(e.ape_translation_m.max, 2) + " m", "largest position error"});
    figures.push_back({fixed(degrees(e.ape_yaw_rad.rmse), 2) + "\u00b0", "heading error, RMSE"});
  } else {
    figures.push_back({fixed(two_sigma_m(run.frames.back().covariance), 2) + " m",
                       "position at the end, 2 sigma"});
  }
  figures.push_back(
      {fixed(median_of(run, &ViewFrame::update_ms), 1) + " ms", "to localize a frame, median"});
  return html::key_figures(figures);
}

Markup words(const RunWords& words) {
  Markup markup = html::headline(words.headline, words.good);
  for (const std::string& warning : words.warnings) markup += html::warning(warning);
  return markup;
}

Markup over_time(const std::vector<Chart>& charts) {
  std::vector<Markup> figures;
  for (const Chart& chart : charts) {
    figures.push_back(html::figure(html::inline_svg(chart.svg), chart.caption));
  }
  return html::heading("Over time") + html::side_by_side(figures);
}

/// A page, and the charts in it.
struct Report {
  Markup page;
  std::vector<Chart> charts;
};

void add_run(const RunRecord& run, const fs::path& pictures, Report& report) {
  report.charts = charts_of(run);
  report.page += words(words_of(run)) + key_figures(run);
  if (run.judgement) report.page += accuracy(*run.judgement);
  report.page += frame_table(run) + pictures_in(pictures) + over_time(report.charts);
}

std::string name_of(const Json& manifest, const fs::path& folder) {
  const fs::path site = source_in(manifest, "site");
  if (site.has_filename()) return site.filename().string();
  return folder.filename().string().empty() || folder.filename().string().starts_with('.')
             ? std::string("run")
             : folder.filename().string();
}

std::string subtitle(const Json& manifest) {
  return fmt::format("nadir {}, {}, seed {}", manifest.value("version", ""),
                     manifest.value("started", ""), manifest.value("seed", 0U));
}

/// One of several runs in one folder.
struct RunBelow {
  std::string name;
  std::string page;  ///< relative; empty where it has none
  RunRecord record;
};

html::Row comparison_row(const RunBelow& run) {
  html::Row cells{html::Cell(run.name, run.page)};
  const auto& judgement = run.record.judgement;
  const auto number = [&](double value, int places) {
    cells.emplace_back(judgement ? fixed(value, places) : "-");
  };
  const Evaluation e = judgement ? judgement->evaluation : Evaluation{};
  number(e.ape_translation_m.rmse, 3);
  number(degrees(e.ape_yaw_rad.rmse), 2);
  number(e.ape_translation_m.max, 2);
  number(e.lost_count, 0);
  cells.emplace_back(fixed(median_of(run.record, &ViewFrame::update_ms), 1));
  return cells;
}

/// A run below has a page of its own where it was started on its own: seeds of one run have not.
std::vector<RunBelow> read_runs_below(const fs::path& folder, const Json& manifest, bool linked) {
  std::vector<RunBelow> runs;
  for (const fs::path& below : runs_below(folder)) {
    const std::string name = below.filename().string();
    const bool own = fs::exists(below / "manifest.json");
    if (own && linked) write_run_report(below);
    runs.push_back({name, own && linked ? name + "/report.html" : std::string{},
                    read_run(below, own ? read_manifest(below) : manifest)});
  }
  return runs;
}

void add_runs_below(const fs::path& folder, const Json& manifest, bool linked, Report& report) {
  const std::vector<RunBelow> runs = read_runs_below(folder, manifest, linked);
  if (runs.empty()) first_run_in(folder);  // says what is missing
  report.page +=
      html::headline(fmt::format("{} runs of the same drive, compared.", runs.size()), true);
  std::vector<html::Row> rows;
  std::ranges::transform(runs, std::back_inserter(rows), comparison_row);
  report.page += html::heading("Runs") + html::table({"", "RMSE, m", "heading, \u00b0",
                                                      "largest, m", "times lost", "ms a frame"},
                                                     rows, html::Columns::kNumbers);
  if (fs::exists(folder / runs.front().name / "manifest.json")) return;
  report.page += html::heading("The first of them: " + runs.front().name);
  add_run(runs.front().record, folder, report);
}

Report report_of(const fs::path& folder, bool linked) {
  const Json manifest = read_manifest(folder);
  const std::string name = name_of(manifest, folder);
  Report report{html::title(name, subtitle(manifest)), {}};
  if (fs::exists(folder / "trajectory.tum")) {
    add_run(read_run(folder, manifest), folder, report);
  } else {
    add_runs_below(folder, manifest, linked, report);
  }
  report.page =
      html::page(name + " - nadir", report.page + settings_of(manifest) + provenance_of(manifest));
  return report;
}

}  // namespace

fs::path write_run_report(const fs::path& run_folder) {
  const Report report = report_of(run_folder, true);
  for (const Chart& chart : report.charts)
    write_file(run_folder / (chart.name + ".svg"), chart.svg);
  write_file(run_folder / "report.html", report.page);
  return run_folder / "report.html";
}

void write_run_report(const fs::path& run_folder, const fs::path& page) {
  write_file(page, report_of(run_folder, false).page);
}

}  // namespace nadir::cli
