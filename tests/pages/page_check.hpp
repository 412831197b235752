// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace nadir::testing {

/// What is wrong with the markup of a page: tags that are not closed or cross each other, a `<` or
/// `&` that is none. Empty where nothing is.
std::string markup_fault(const std::string& page);

/// What a page would ask others for, or run: addresses, files, style sheets, scripts. Empty where
/// it keeps to itself.
std::string foreign_part(const std::string& page);

}  // namespace nadir::testing
