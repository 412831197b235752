// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/detail/gdal_support.hpp"

#include <mutex>

#include "nadir/core/error.hpp"

namespace nadir {

void GdalErrors::collect(CPLErr level, CPLErrorNum /*number*/, const char* message) {
  auto* self = static_cast<GdalErrors*>(CPLGetErrorHandlerUserData());
  if (level < CE_Failure || self->failed_) return;
  self->failed_ = true;
  self->first_failure_ = message;
}

GDALDriver& gdal_driver(const char* name) {
  static std::once_flag registered;
  std::call_once(registered, [] {
    const GdalErrors quiet;  // a plugin that cannot be loaded matters only to who needs it
    GDALAllRegister();
  });
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(name);
  if (driver == nullptr) {
    throw Error(ErrorKind::kProcessing, "GDAL was built without its driver", name,
                "install a complete GDAL");
  }
  return *driver;
}

}  // namespace nadir
