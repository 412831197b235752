// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <string>

namespace nadir {

/// A number as files of poses give it; no zero has a sign.
inline std::string nine_decimals(double value) {
  std::string text = fmt::format("{:.9f}", value);
  return text == "-0.000000000" ? text.substr(1) : text;
}

}  // namespace nadir
