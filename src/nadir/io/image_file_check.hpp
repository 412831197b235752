// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

namespace nadir {

/// Throws Error (input) where a JPEG or PNG ends before its end marker: decoders fill the missing
/// part with grey and say nothing. Other formats pass: their decoders do notice.
void check_image_is_whole(const std::filesystem::path& path, std::string_view bytes);

}  // namespace nadir
