// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace nadir {

/// A JSON document that keeps the order in which its keys were added. Who includes this header
/// needs nlohmann-json.
using Json = nlohmann::ordered_json;

/// The document as text, always valid UTF-8: indented by `indent` blanks a level, or in one line
/// where that is negative. The only way to text: nlohmann's own `dump` throws at bytes that are
/// not UTF-8, which file names may hold. Here each of them becomes U+FFFD. A number that is not
/// finite becomes null.
std::string json_text(const Json& document, int indent = -1);

/// Whether a JSON string can hold the text as it is.
bool is_utf8(std::string_view text);

/// Sets `key` of the object to a name that is read back one day. Where it is not UTF-8, `key`
/// holds it with U+FFFD and `key`_hex its bytes in hexadecimal: two names that differ only in such
/// bytes stay two.
void set_name(Json& object, const std::string& key, std::string_view name);

/// The name that set_name() wrote, byte by byte. Throws nlohmann::json::exception where the object
/// has no such key or it is no string, and Error (input) where the hexadecimal is none.
std::string name_at(const Json& object, const std::string& key);

}  // namespace nadir
