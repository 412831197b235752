// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace nadir {

/// One file of the viewer's page, web/dist, built into the program by tools/embed_web.py.
struct WebAsset {
  std::string_view path;  ///< as requested: "/index.html"
  const char* media_type = "";
  std::string_view gzip;
  const char* etag = "";
};

std::span<const WebAsset> web_assets();

}  // namespace nadir
