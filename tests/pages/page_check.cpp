// SPDX-License-Identifier: Apache-2.0
#include "page_check.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <vector>

namespace nadir::testing {
namespace {

/// Elements of HTML that have no end.
bool is_void(const std::string& name) {
  static const std::set<std::string> kVoid{"img", "meta", "br", "hr", "link", "input"};
  return kVoid.contains(name);
}

bool is_entity_at(const std::string& page, std::size_t at) {
  const std::string_view rest = std::string_view(page).substr(at);
  return std::ranges::any_of(std::array{"&lt;", "&gt;", "&amp;", "&quot;", "&#39;"},
                             [&](const char* entity) { return rest.starts_with(entity); });
}

/// Content of a <style> is no markup.
std::string without_styles(const std::string& page) {
  std::string rest;
  std::size_t from = 0;
  for (std::size_t at = page.find("<style>"); at != std::string::npos;
       at = page.find("<style>", from)) {
    rest += page.substr(from, at - from);
    from = page.find("</style>", at) + 8;
  }
  return rest + page.substr(from);
}

std::string around(const std::string& page, std::size_t at) {
  return "near '" + page.substr(at, 60) + "'";
}

}  // namespace

std::string markup_fault(const std::string& whole) {
  const std::string page = without_styles(whole);
  std::vector<std::string> open;
  for (std::size_t i = 0; i < page.size(); ++i) {
    if (page[i] == '&' && !is_entity_at(page, i)) return "a bare & " + around(page, i);
    if (page[i] == '>') return "a bare > " + around(page, i);
    if (page[i] != '<') continue;
    const std::size_t end = page.find('>', i);
    if (end == std::string::npos) return "a tag without end " + around(page, i);
    const std::string tag = page.substr(i + 1, end - i - 1);
    if (tag.find('<') != std::string::npos) return "a bare < " + around(page, i);
    const bool closing = tag.starts_with('/');
    const std::size_t from = closing ? 1 : 0;
    const std::string name = tag.substr(from, tag.find_first_of(" /\n", from) - from);
    if (closing) {
      if (open.empty() || open.back() != name) return "</" + name + "> " + around(page, i);
      open.pop_back();
    } else if (!tag.starts_with('!') && !tag.ends_with('/') && !is_void(name)) {
      open.push_back(name);
    }
    i = end;
  }
  return open.empty() ? "" : "<" + open.back() + "> is not closed";
}

std::string foreign_part(const std::string& page) {
  for (const char* part : {"http:", "https:", "file:", "<script", "<link", "<iframe", "@import",
                           "url(", "javascript:", "onerror", "onload"}) {
    const std::size_t found = page.find(part);
    if (found != std::string::npos) return around(page, found);
  }
  // xlink:href ends in href too
  for (const std::string attribute : {"src=\"", "href=\""}) {
    for (std::size_t at = page.find(attribute); at != std::string::npos;
         at = page.find(attribute, at + 1)) {
      if (page.compare(at + attribute.size(), 5, "data:") != 0) return around(page, at);
    }
  }
  return "";
}

}  // namespace nadir::testing
