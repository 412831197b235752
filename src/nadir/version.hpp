// SPDX-License-Identifier: Apache-2.0
#pragma once

// The version of nadir, for the preprocessor of who builds with it. CMakeLists.txt reads it here.
#define NADIR_VERSION_MAJOR 0
#define NADIR_VERSION_MINOR 1
#define NADIR_VERSION_PATCH 0

#define NADIR_TEXT_OF_(x) #x
#define NADIR_TEXT_OF(x) NADIR_TEXT_OF_(x)
/// "0.1.0"
#define NADIR_VERSION                \
  NADIR_TEXT_OF(NADIR_VERSION_MAJOR) \
  "." NADIR_TEXT_OF(NADIR_VERSION_MINOR) "." NADIR_TEXT_OF(NADIR_VERSION_PATCH)
