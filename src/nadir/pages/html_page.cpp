// SPDX-License-Identifier: Apache-2.0
#include "nadir/pages/html_page.hpp"

#include "nadir/io/base64.hpp"
#include "nadir/report/markup.hpp"

namespace nadir::html {
namespace {

using report::escaped;

/// The colours are those of the charts (src/nadir/report/svg_sheet.cpp).
constexpr const char* kStyle = R"(
:root{color-scheme:light dark;--ink:#212529;--muted:#5c656e;--page:#f4f6f8;--paper:#fff;
--line:#e2e5e9;--link:#0a5ea8;--good:#00795a;--warn:#b3541e;--warnpaper:#fdf3e7}
@media(prefers-color-scheme:dark){:root{--ink:#e4e7eb;--muted:#9aa3ad;--page:#121519;--paper:#1b1f24;
--line:#2e343c;--link:#7cc0f5;--good:#4fd1a5;--warn:#f0a868;--warnpaper:#2c2318}}
*{box-sizing:border-box}
body{font:16px/1.5 system-ui,-apple-system,"Segoe UI",Roboto,sans-serif;margin:0;color:var(--ink);
background:var(--page)}
main{max-width:1120px;margin:0 auto;padding:1.5rem 1rem 3rem}
h1{font-size:1.6rem;line-height:1.2;margin:.4rem 0 .2rem;overflow-wrap:anywhere}
h2{font-size:1.15rem;margin:2.2rem 0 .7rem}
p{margin:.5rem 0}a{color:var(--link)}
.subtitle{color:var(--muted);margin:0 0 1rem;overflow-wrap:anywhere}
.headline{font-size:1.1rem;background:var(--paper);border-left:5px solid var(--warn);
border-radius:6px;padding:.7rem 1rem}
.headline.good{border-color:var(--good)}
.warn{background:var(--warnpaper);border-left:5px solid var(--warn);border-radius:6px;
padding:.5rem 1rem}
.keys{display:grid;grid-template-columns:repeat(auto-fit,minmax(140px,1fr));gap:.7rem;margin:1rem 0}
.keys div{background:var(--paper);border:1px solid var(--line);border-radius:8px;padding:.6rem .9rem}
.keys b{display:block;font-size:1.35rem;font-weight:600;line-height:1.3;white-space:nowrap}
.keys span{color:var(--muted);font-size:.85rem}
.scroll{overflow-x:auto;background:var(--paper);border:1px solid var(--line);border-radius:8px;
margin:.6rem 0}
table{border-collapse:collapse;font-size:.9rem;width:100%}
td,th{padding:.35rem .8rem;text-align:right;border-top:1px solid var(--line);
font-variant-numeric:tabular-nums}
tr:first-child>*{border-top:0}
th{color:var(--muted);font-weight:600;white-space:nowrap}
td:first-child,th:first-child,.texts td,.texts th{text-align:left}
.texts td{vertical-align:top;overflow-wrap:anywhere;min-width:5rem}
figure{margin:.6rem 0;background:var(--paper);border:1px solid var(--line);border-radius:8px;
overflow:hidden}
img,figure svg{display:block;width:100%;height:auto}
figcaption{font-size:.85rem;color:var(--muted);padding:.5rem .8rem;border-top:1px solid var(--line)}
.side{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,420px),1fr));gap:.7rem;
align-items:start}
.side figure{margin:0}
pre{background:var(--paper);border:1px solid var(--line);border-radius:8px;padding:.7rem .9rem;
white-space:pre-wrap;overflow-wrap:anywhere;font-size:.85rem}
details{margin:.6rem 0}summary{cursor:pointer;color:var(--link)}
@media print{body{background:#fff}figure,table{break-inside:avoid}}
)";

Markup element(const char* tag, const char* attributes, const Markup& content) {
  return std::string("<") + tag + attributes + ">" + content + "</" + tag + ">\n";
}

Markup cell(const char* tag, const Cell& cell) {
  const std::string text = escaped(cell.text);
  if (cell.link.empty()) return std::string("<") + tag + ">" + text + "</" + tag + ">";
  return std::string("<") + tag + "><a href=\"" + escaped(cell.link) + "\">" + text + "</a></" +
         tag + ">";
}

Markup row(const char* tag, const Row& cells) {
  Markup markup;
  for (const Cell& one : cells) markup += cell(tag, one);
  return element("tr", "", markup);
}

}  // namespace

Markup page(const std::string& title, const Markup& content) {
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
         "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">"
         "<title>" +
         escaped(title) + "</title><style>" + kStyle + "</style></head>\n<body><main>\n" + content +
         "</main></body></html>\n";
}

Markup title(const std::string& text, const std::string& subtitle) {
  return element("h1", "", escaped(text)) + element("p", " class=\"subtitle\"", escaped(subtitle));
}

Markup heading(const std::string& text) { return element("h2", "", escaped(text)); }

Markup paragraph(const std::string& text) { return element("p", "", escaped(text)); }

Markup headline(const std::string& text, bool good) {
  return element("p", good ? R"( class="headline good")" : R"( class="headline")", escaped(text));
}

Markup warning(const std::string& text) {
  return element("p", R"( class="warn" role="note")", escaped(text));
}

Markup code(const std::string& text) { return element("pre", "", escaped(text)); }

Markup key_figures(const std::vector<KeyFigure>& figures) {
  Markup markup;
  for (const KeyFigure& figure : figures) {
    markup += "<div><b>" + escaped(figure.value) + "</b><span>" + escaped(figure.name) +
              "</span></div>\n";
  }
  return element("div", " class=\"keys\"", markup);
}

Markup table(const Row& head, const std::vector<Row>& rows, Columns columns) {
  Markup markup;
  if (!head.empty()) markup += row("th", head);
  for (const Row& cells : rows) markup += row("td", cells);
  const char* attributes = columns == Columns::kTexts ? " class=\"texts\"" : "";
  return element("div", " class=\"scroll\"", element("table", attributes, markup));
}

Markup figure(const Markup& content, const std::string& caption) {
  return element("figure", "", content + element("figcaption", "", escaped(caption)));
}

Markup side_by_side(const std::vector<Markup>& figures) {
  Markup markup;
  for (const Markup& one : figures) markup += one;
  return element("div", " class=\"side\"", markup);
}

Markup image(const std::string& data_uri, const std::string& alternative) {
  return "<img alt=\"" + escaped(alternative) + "\" src=\"" + data_uri + "\">";
}

Markup inline_svg(std::string svg) {
  // HTML knows what <svg> is: the name of its namespace is needed in files of their own alone.
  static constexpr std::string_view kNamespace = " xmlns=\"http://www.w3.org/2000/svg\"";
  if (const auto found = svg.find(kNamespace); found != std::string::npos) {
    svg.erase(found, kNamespace.size());
  }
  return svg;
}

Markup folded(const std::string& summary, const Markup& content) {
  return element("details", "", element("summary", "", escaped(summary)) + content);
}

std::string data_uri(const std::string& media_type, std::string_view bytes) {
  return "data:" + media_type + ";base64," + base64(bytes);
}

}  // namespace nadir::html
