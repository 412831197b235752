// SPDX-License-Identifier: Apache-2.0
// The text of a canvas: OpenCV's stroke font, set at sub-pixel size by the canvas's oversampling.
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "nadir/report/canvas.hpp"

namespace nadir::report {
namespace {

constexpr double kCapitalHeight = 0.7;       ///< of the text's size
constexpr double kFontCapitalHeight = 21.0;  ///< of FONT_HERSHEY_SIMPLEX at scale 1
constexpr double kSmallest = 0.72;           ///< a fitted text shrinks to this before it is cut
constexpr char kDegree = '\x01';             ///< stands for the degree sign, which the font lacks

double scale_of(const TextStyle& style) {
  return kFine * style.size * kCapitalHeight / kFontCapitalHeight;
}

int thickness_of(const TextStyle& style) {
  return std::max(1, cvRound(kFine * style.size * (style.bold ? 0.125 : 0.072)));
}

/// UTF-8 in the characters that the font has.
std::string spelled(std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 13> kSpellings{
      {{"°", "\x01"},
       {"±", "+/-"},
       {"–", "-"},
       {"—", "-"},
       {"−", "-"},
       {"²", "^2"},
       {"·", "."},
       {"µ", "u"},
       {"σ", "sigma"},
       {"×", "x"},
       {"→", "->"},
       {"…", "..."},
       {"≤", "<="}}};
  std::string result;
  while (!text.empty()) {
    const auto* const spelling = std::find_if(
        kSpellings.begin(), kSpellings.end(),
        [&](const auto& pair) { return text.substr(0, pair.first.size()) == pair.first; });
    const auto lead = static_cast<unsigned char>(text.front());
    if (spelling != kSpellings.end()) {
      result += spelling->second;
      text.remove_prefix(spelling->first.size());
    } else {
      // One '?' a character: UTF-8 continuation bytes (10xxxxxx) are passed over.
      if (lead >= 0x20 && lead < 0x7F) result += text.front();
      if (lead >= 0xC0) result += '?';
      if (lead < 0x20) result += text.front() == kDegree ? kDegree : ' ';
      text.remove_prefix(1);
    }
  }
  return result;
}

int run_width(const std::string& run, const TextStyle& style) {
  int baseline = 0;
  return cv::getTextSize(run, cv::FONT_HERSHEY_SIMPLEX, scale_of(style), thickness_of(style),
                         &baseline)
      .width;
}

int degree_width(const TextStyle& style) { return cvRound(kFine * 0.42 * style.size); }

/// Calls `run(text, x)` for each stretch of plain text and `degree(x)` for each degree sign;
/// returns the whole width in sheet pixels.
template <class Run, class Degree>
int typeset(const std::string& text, const TextStyle& style, const Run& run, const Degree& degree) {
  int x = 0;
  std::size_t start = 0;
  while (start < text.size()) {
    const std::size_t end = std::min(text.find(kDegree, start), text.size());
    const std::string plain = text.substr(start, end - start);
    if (!plain.empty()) run(plain, x);
    if (!plain.empty()) x += run_width(plain, style);
    if (end < text.size()) {
      degree(x);
      x += degree_width(style);
    }
    start = end + 1;
  }
  return x;
}

int typeset_width(const std::string& text, const TextStyle& style) {
  return typeset(
      text, style, [](const std::string&, int) {}, [](int) {});
}

void draw_text(cv::Mat& pixels, const std::string& text, cv::Point origin, const TextStyle& style,
               Colour colour, int thickness) {
  const cv::Scalar ink(colour.red, colour.green, colour.blue);
  typeset(
      text, style,
      [&](const std::string& plain, int x) {
        cv::putText(pixels, plain, {origin.x + x, origin.y}, cv::FONT_HERSHEY_SIMPLEX,
                    scale_of(style), ink, thickness, cv::LINE_AA);
      },
      [&](int x) {
        const int radius = cvRound(kFine * (style.bold ? 0.15 : 0.12) * style.size);
        const cv::Point centre(origin.x + x + cvRound(kFine * 0.2 * style.size),
                               origin.y - cvRound(kFine * 0.62 * style.size));
        cv::circle(pixels, centre, radius, ink, thickness, cv::LINE_AA);
      });
}

}  // namespace

double text_width(std::string_view text, const TextStyle& style) {
  return typeset_width(spelled(text), style) / kFine;
}

void Canvas::text(Position position, std::string_view text, const TextStyle& style) {
  const std::string content = spelled(text);
  const int width = typeset_width(content, style);
  const double before = style.align == Align::kLeft     ? 0.0
                        : style.align == Align::kCentre ? 0.5 * width
                                                        : width;
  const cv::Point origin(cvRound(kFine * position.x - before),
                         cvRound(kFine * (position.y + 0.5 * kCapitalHeight * style.size)));
  cv::Mat pixels(sheet_.height(), sheet_.width(), CV_8UC3, sheet_.values().data());
  const int thickness = thickness_of(style);
  if (style.halo) {
    draw_text(pixels, content, origin, style, *style.halo,
              thickness + cvRound(kFine * 0.26 * style.size));
  }
  draw_text(pixels, content, origin, style, style.colour, thickness);
}

void Canvas::fitted_text(Position position, std::string_view text, double width, TextStyle style) {
  const double wanted = text_width(text, style);
  if (wanted > width) style.size *= std::max(kSmallest, width / wanted);
  std::string content = spelled(text);
  if (text_width(text, style) > width) {
    while (!content.empty() && text_width(content + "...", style) > width) content.pop_back();
    content += "...";
  }
  this->text(position, content, style);
}

}  // namespace nadir::report
