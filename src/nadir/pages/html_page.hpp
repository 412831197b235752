// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace nadir::html {

/// The parts of a page that opens from disk without a network: pictures lie inside it, there are no
/// scripts, it is light or dark as the reader's system is, and it can be read on a phone. `Markup`
/// is finished HTML; everything else is text of any kind and is escaped here.
using Markup = std::string;

Markup page(const std::string& title, const Markup& content);
Markup title(const std::string& text, const std::string& subtitle);
Markup heading(const std::string& text);
Markup paragraph(const std::string& text);
/// What the reader is to take away, in words; `good` says how it is marked.
Markup headline(const std::string& text, bool good);
Markup warning(const std::string& text);
Markup code(const std::string& text);

/// A large number and what it is.
struct KeyFigure {
  std::string value;
  std::string name;
};
Markup key_figures(const std::vector<KeyFigure>& figures);

/// A cell of a table; a text, or a text that leads to a file beside the page.
struct Cell {
  Cell(std::string shown, std::string leads_to = {})  // NOLINT(google-explicit-constructor)
      : text(std::move(shown)), link(std::move(leads_to)) {}
  Cell(const char* shown) : text(shown) {}  // NOLINT(google-explicit-constructor)
  std::string text;
  std::string link;  ///< a path relative to the page; may be empty
};
using Row = std::vector<Cell>;

/// `head` may be empty. The first column stands to the left; the others as numbers do, or as texts.
enum class Columns { kNumbers, kTexts };
Markup table(const Row& head, const std::vector<Row>& rows, Columns columns);

/// A picture or chart with its caption; several stand side by side where there is room.
Markup figure(const Markup& content, const std::string& caption);
Markup side_by_side(const std::vector<Markup>& figures);
/// `data_uri` as of data_uri().
Markup image(const std::string& data_uri, const std::string& alternative);
/// A whole SVG document as a part of the page.
Markup inline_svg(std::string svg);

/// Shown when its summary is clicked.
Markup folded(const std::string& summary, const Markup& content);

/// "data:image/png;base64,…"
std::string data_uri(const std::string& media_type, std::string_view bytes);

}  // namespace nadir::html
