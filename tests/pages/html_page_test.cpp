// SPDX-License-Identifier: Apache-2.0
#include "nadir/pages/html_page.hpp"

#include <gtest/gtest.h>

#include "nadir/report/charts.hpp"
#include "page_check.hpp"

namespace nadir::cli {
namespace {

using testing::foreign_part;
using testing::markup_fault;

constexpr const char* kBad = "</td><script src=\"http://x\">alert('1')</script>&";

TEST(HtmlPage, EveryPartIsWellFormedWhateverItsTextIs) {
  const std::string svg = svg_panels({{"y", {{"a", {0.0, 1.0}, {0.0, 1.0}}}}}, "x", "t");
  const html::Markup parts = html::title(kBad, kBad) + html::heading(kBad) + html::paragraph(kBad) +
                             html::headline(kBad, true) + html::headline(kBad, false) +
                             html::warning(kBad) + html::code(kBad) +
                             html::key_figures({{kBad, kBad}}) +
                             html::table({kBad, kBad}, {{kBad, "2"}}, html::Columns::kNumbers) +
                             html::table({}, {{"1", kBad}}, html::Columns::kTexts) +
                             html::side_by_side({html::figure(html::inline_svg(svg), kBad)}) +
                             html::image(html::data_uri("image/png", "bytes"), kBad) +
                             html::folded(kBad, html::paragraph(kBad));
  const std::string page = html::page(kBad, parts);
  EXPECT_EQ(markup_fault(page), "");
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_NE(page.find("&lt;script src=&quot;"), std::string::npos);
}

TEST(HtmlPage, AsksForNothing) {
  const std::string svg = svg_rows({{"a", {1.0, 2.0}}}, "x", "t");
  const std::string page = html::page("t", html::figure(html::inline_svg(svg), "c") +
                                               html::image(html::data_uri("image/png", ""), ""));
  EXPECT_EQ(foreign_part(page), "");
  EXPECT_NE(page.find("prefers-color-scheme:dark"), std::string::npos);
  EXPECT_NE(page.find("name=\"viewport\""), std::string::npos);
}

TEST(HtmlPage, ACellMayLeadToAFileBesideThePage) {
  const html::Markup markup =
      html::table({}, {html::Row{html::Cell("run", "run/report.html")}}, html::Columns::kTexts);
  EXPECT_NE(markup.find("<a href=\"run/report.html\">run</a>"), std::string::npos);
}

TEST(HtmlPage, DataUriIsBase64) {
  EXPECT_EQ(html::data_uri("image/png", "nadir"), "data:image/png;base64,bmFkaXI=");
  EXPECT_EQ(html::data_uri("image/png", ""), "data:image/png;base64,");
}

TEST(PageCheck, FindsWhatItIsFor) {
  EXPECT_NE(markup_fault("<p><b></p></b>"), "");
  EXPECT_NE(markup_fault("<p>"), "");
  EXPECT_NE(markup_fault("<p>a & b</p>"), "");
  EXPECT_EQ(markup_fault("<p>a &amp; b<img alt=\"\"></p>"), "");
  EXPECT_NE(foreign_part("<img src=\"a.png\">"), "");
  EXPECT_NE(foreign_part("<a href=\"https://x\">"), "");
}

}  // namespace
}  // namespace nadir::cli
