// SPDX-License-Identifier: Apache-2.0
#include "nadir/report/svg_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "nadir/report/axes.hpp"
#include "nadir/report/markup.hpp"

namespace nadir::report {
namespace {

std::string hex(Colour colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour.red, colour.green, colour.blue);
}

/// Halfway to white: dark colours of curves would be lost on a dark page.
Colour lightened(Colour colour) {
  constexpr int kWhite = 255;
  const auto lighter = [](int level) {
    return static_cast<std::uint8_t>(level + (kWhite - level) * 2 / 5);
  };
  return {lighter(colour.red), lighter(colour.green), lighter(colour.blue)};
}

std::string curve_colours(bool dark) {
  std::string rules;
  for (std::size_t i = 0; i < kCurveColours; ++i) {
    const Colour colour = dark ? lightened(curve_colour(i)) : curve_colour(i);
    rules += fmt::format("--c{}:{};", i, hex(colour));
  }
  return rules;
}

/// Scoped by the class of the chart: inside a page it speaks of charts alone.
std::string style() {
  std::string text = fmt::format(
      ".chart{{--ink:{};--muted:{};--grid:{};--frame:{};--paper:{};--band:{};{}"
      "font:12px system-ui,-apple-system,'Segoe UI',Roboto,sans-serif}}",
      hex(kInk), hex(kMuted), hex(kGrid), hex(kFrame), hex(kPaper), hex(kBandColour),
      curve_colours(false));
  text += fmt::format(
      "@media(prefers-color-scheme:dark){{.chart{{--ink:#e4e7eb;--muted:#9aa3ad;--grid:#2e343c;"
      "--frame:#5b646f;--paper:#1b1f24;--band:{};{}}}}}",
      hex(lightened(kBlue)), curve_colours(true));
  text +=
      ".chart text{fill:var(--ink)}.chart .muted{fill:var(--muted);font-size:11px}"
      ".chart .bold{font-weight:600}.chart .paper{fill:var(--paper)}"
      ".chart .grid{stroke:var(--grid);stroke-width:1}"
      ".chart .frame{stroke:var(--frame);stroke-width:1}"
      ".chart .curve{fill:none;stroke-width:1.5;stroke-linejoin:round;stroke-linecap:round}"
      ".chart .box{fill-opacity:.3;stroke-width:1.5}.chart .median{stroke-width:3}";
  text += fmt::format(".chart .band{{fill:var(--band);fill-opacity:{}}}", kBandOpacity);
  for (std::size_t i = 0; i < kCurveColours; ++i) {
    text += fmt::format(
        ".chart .c{0}{{stroke:var(--c{0})}}.chart .dot.c{0},.chart .box.c{0}{{fill:var(--c{0})}}",
        i);
  }
  return text;
}

std::string with_class(std::string_view classes) {
  return classes.empty() ? std::string{} : fmt::format(" class=\"{}\"", classes);
}

}  // namespace

std::string svg_number(double value) {
  std::string text = fmt::format("{:.2f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string curve_class(std::size_t index) { return fmt::format("c{}", index % kCurveColours); }

double svg_text_width(std::string_view text) {
  constexpr double kAverage = 6.4;  // of a 12 px sans-serif, rather too wide than too narrow
  const auto characters = std::ranges::count_if(
      text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; });
  return kAverage * static_cast<double>(characters);
}

SvgSheet::SvgSheet(double width, double height, const std::string& title) {
  content_ = fmt::format(
      "<svg class=\"chart\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" "
      "role=\"img\" "
      "aria-label=\"{}\"><style>{}</style>\n",
      svg_number(width), svg_number(height), escaped(title), style());
  rectangle({0.0, 0.0, width, height}, "paper");
}

void SvgSheet::line(Position from, Position to, std::string_view classes) {
  content_ +=
      fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\"{}/>\n", svg_number(from.x),
                  svg_number(from.y), svg_number(to.x), svg_number(to.y), with_class(classes));
}

void SvgSheet::path(const std::string& data, std::string_view classes) {
  content_ += fmt::format("<path d=\"{}\"{}/>\n", data, with_class(classes));
}

void SvgSheet::disc(Position centre, double radius, std::string_view classes) {
  content_ += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\"{}/>\n", svg_number(centre.x),
                          svg_number(centre.y), svg_number(radius), with_class(classes));
}

void SvgSheet::rectangle(const Box& box, std::string_view classes) {
  content_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"{}/>\n",
                          svg_number(box.left), svg_number(box.top), svg_number(box.width),
                          svg_number(box.height), with_class(classes));
}

void SvgSheet::text(Position position, std::string_view text, std::string_view anchor,
                    std::string_view classes) {
  content_ += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"{}\"{}>{}</text>\n",
                          svg_number(position.x), svg_number(position.y), anchor,
                          with_class(classes), escaped(text));
}

std::string SvgSheet::finish() const { return content_ + "</svg>\n"; }

}  // namespace nadir::report
