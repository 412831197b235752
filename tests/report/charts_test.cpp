// SPDX-License-Identifier: Apache-2.0
#include "nadir/report/charts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "nadir/report/markup.hpp"
#include "support/nan.hpp"

namespace nadir {
namespace {

using test::kNan;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The `d` of every path of these classes, in their order.
std::vector<std::string> paths(const std::string& svg, const std::string& classes) {
  const std::string begin = "<path d=\"";
  const std::string end = "\" class=\"" + classes + "\"/>";
  std::vector<std::string> found;
  for (std::size_t at = svg.find(begin); at != std::string::npos; at = svg.find(begin, at + 1)) {
    const std::size_t from = at + begin.size();
    const std::size_t quote = svg.find('"', from);
    if (svg.compare(quote, end.size(), end) == 0) found.push_back(svg.substr(from, quote - from));
  }
  return found;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t times = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++times;
  }
  return times;
}

void expect_whole(const std::string& svg) {
  EXPECT_TRUE(svg.starts_with("<svg "));
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
  const std::string drawn = svg.substr(svg.find("</style>"));
  EXPECT_EQ(drawn.find("nan"), std::string::npos) << drawn;
  EXPECT_EQ(drawn.find("inf"), std::string::npos) << drawn;
}

std::string of_curve(const std::vector<double>& x, const std::vector<double>& y) {
  return svg_panels({{"value", {{"", x, y}}}}, "x", "title");
}

// The plot lies from 48 to 466 to the right and from 30 to 150 downwards.
TEST(SvgPanels, ACurveLiesExactlyWhereItsAxesSay) {
  const std::string svg = of_curve({0.0, 5.0, 10.0}, {0.0, 4.0, 2.0});
  expect_whole(svg);
  ASSERT_EQ(paths(svg, "curve c0").size(), 1U);
  EXPECT_EQ(paths(svg, "curve c0")[0], "M48 150 L257 30 L466 90");
}

TEST(SvgPanels, ABandIsClosedBetweenItsBounds) {
  const Band band{"2 sigma", {0.0, 10.0}, {-1.0, -2.0}, {1.0, 2.0}};
  const std::string svg = svg_panels({{"value", {}, {band}}}, "x", "title");
  expect_whole(svg);
  ASSERT_EQ(paths(svg, "band").size(), 1U);
  EXPECT_EQ(paths(svg, "band")[0], "M48 60 L466 30 L466 150 L48 120 Z");
  EXPECT_NE(svg.find(">2 sigma</text>"), std::string::npos);
}

TEST(SvgPanels, GapsInterruptCurveAndBand) {
  const std::vector<double> x{0.0, 1.0, 2.0, 3.0, 4.0};
  const std::vector<double> y{0.0, 1.0, kNan, 1.0, 4.0};
  const std::string svg = of_curve(x, y);
  EXPECT_EQ(paths(svg, "curve c0").size(), 2U);
  const Band band{"", x, {0.0, 0.0, kNan, 0.0, 0.0}, {1.0, 1.0, 1.0, 1.0, 1.0}};
  EXPECT_EQ(paths(svg_panels({{"v", {}, {band}}}, "x", "t"), "band").size(), 2U);
}

TEST(SvgPanels, AValueBetweenGapsIsADot) {
  const std::string svg = of_curve({0.0, 1.0, 2.0, 3.0, 4.0}, {1.0, kNan, 3.0, kNan, 4.0});
  expect_whole(svg);
  EXPECT_EQ(paths(svg, "curve c0").size(), 0U);
  EXPECT_EQ(count(svg, "<circle "), 3U);
}

TEST(SvgPanels, EmptyAndOddInputsAreDrawn) {
  expect_whole(svg_panels({}, "", ""));
  expect_whole(svg_panels({{"nothing", {}}}, "x", "t"));
  expect_whole(of_curve({}, {}));
  expect_whole(of_curve({3.0}, {5.0}));
  expect_whole(of_curve({1.0, 2.0, 3.0}, {5.0}));
  expect_whole(of_curve({1.0, 2.0}, {kNan, kNan}));
  expect_whole(of_curve({0.0, 1.0}, {1.0, kInfinity}));
  expect_whole(of_curve({0.0, 1.0}, {2.0, 2.0}));
  EXPECT_NE(of_curve({1.0}, {kNan}).find("no values"), std::string::npos);
}

TEST(SvgPanels, LongCurvesStaySmallAndKeepTheirExtremes) {
  std::vector<double> x;
  std::vector<double> y;
  for (int i = 0; i < 200000; ++i) {
    x.push_back(i);
    y.push_back(i == 123456 ? 10.0 : std::sin(0.1 * i));
  }
  const std::string svg = of_curve(x, y);
  EXPECT_LT(svg.size(), 80000U);
  std::string path = paths(svg, "curve c0").at(0);
  std::ranges::replace_if(
      path, [](char c) { return c == 'M' || c == 'L'; }, ' ');
  std::istringstream numbers(path);
  double highest = kInfinity;  // y grows downwards
  for (double across = 0.0, down = 0.0; numbers >> across >> down;)
    highest = std::min(highest, down);
  EXPECT_NEAR(highest, 30.0, 0.01);
}

TEST(SvgPanels, EveryTextIsEscaped) {
  const std::string bad = "<b>&\"x\"";
  const std::string svg = svg_panels({{bad, {{bad, {0.0, 1.0}, {0.0, 1.0}}}}}, bad, bad);
  EXPECT_EQ(svg.find(bad), std::string::npos);
  EXPECT_EQ(svg.find("<b>"), std::string::npos);
  EXPECT_GE(count(svg, "&lt;b&gt;&amp;&quot;x&quot;"), 3U);
}

TEST(SvgPanels, SameInputSameBytes) {
  EXPECT_EQ(of_curve({0.0, 1.0}, {0.3, 0.1}), of_curve({0.0, 1.0}, {0.3, 0.1}));
}

TEST(SvgRows, BoxesLieAtTheQuantiles) {
  // 0, 1, ..., 100: the plot is 354 wide from 60 on and ends at the largest value.
  Sample sample{"stage", {}};
  for (int i = 100; i >= 0; --i) sample.values.push_back(i);
  const std::string svg = svg_rows({sample}, "time, ms", "title");
  expect_whole(svg);
  EXPECT_NE(svg.find("<rect x=\"148.5\" y=\"15\" width=\"177\" height=\"16\" class=\"box c0\"/>"),
            std::string::npos)
      << svg;
  EXPECT_NE(svg.find("<line x1=\"237\" y1=\"15\" x2=\"237\" y2=\"31\" class=\"median c0\"/>"),
            std::string::npos);
  EXPECT_NE(svg.find("<circle cx=\"414\" cy=\"23\" r=\"2\" class=\"dot c0\"/>"), std::string::npos);
  EXPECT_NE(svg.find(">50.0</text>"), std::string::npos);
}

TEST(SvgRows, OneValueIsABarAndWhatIsNoTimeIsLeftOut) {
  const std::string svg = svg_rows({{"a", {4.0}}, {"b", {2.0, kNan, -1.0}}}, "s", "t");
  expect_whole(svg);
  EXPECT_NE(svg.find("<rect x=\"60\" y=\"15\" width=\"354\" height=\"16\" class=\"dot c0\"/>"),
            std::string::npos)
      << svg;
  EXPECT_NE(svg.find("width=\"177\" height=\"16\" class=\"dot c1\""), std::string::npos);
}

TEST(SvgRows, EmptyInputsAreDrawn) {
  expect_whole(svg_rows({}, "s", "t"));
  expect_whole(svg_rows({{"none", {}}}, "s", "t"));
  expect_whole(svg_rows({{"none", {kNan}}, {"zero", {0.0, 0.0}}}, "s", "t"));
}

TEST(Markup, EscapesWhatMarkupIsMadeOf) {
  EXPECT_EQ(report::escaped("a<b> & \"c\" 'd'"), "a&lt;b&gt; &amp; &quot;c&quot; &#39;d&#39;");
  EXPECT_EQ(report::escaped("5\u00b0 ok"), "5\u00b0 ok");
  EXPECT_EQ(report::escaped(std::string("a\0b\x1b", 4)), "a b ");
}

TEST(SvgPanels, LastDigitsAreNotTheScale) {
  const std::string svg =
      svg_panels({{"share", {{"share", {0.0, 1.0, 2.0}, {1.0, 0.999996, 1.0}}}}}, "s", "title");
  EXPECT_EQ(svg.find("0.99999"), std::string::npos) << svg;
  EXPECT_NE(svg.find(">1.0<"), std::string::npos) << svg;
}

}  // namespace
}  // namespace nadir
