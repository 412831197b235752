// SPDX-License-Identifier: Apache-2.0
#pragma once

// What every file that uses GDAL needs; nothing of it appears in the public headers.

#include <cpl_error.h>
#include <cpl_minixml.h>
#include <gdal_priv.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace nadir {

/// Keeps what GDAL reports on this thread off stderr, and remembers the first failure.
class GdalErrors {
 public:
  GdalErrors() { CPLPushErrorHandlerEx(&GdalErrors::collect, this); }
  ~GdalErrors() { CPLPopErrorHandler(); }
  GdalErrors(const GdalErrors&) = delete;
  GdalErrors& operator=(const GdalErrors&) = delete;
  GdalErrors(GdalErrors&&) = delete;
  GdalErrors& operator=(GdalErrors&&) = delete;

  bool failed() const { return failed_; }
  const std::string& first_failure() const { return first_failure_; }

 private:
  static void CPL_STDCALL collect(CPLErr level, CPLErrorNum number, const char* message);

  bool failed_ = false;
  std::string first_failure_;
};

/// A GDAL configuration option that holds on this thread, for a while.
class GdalSetting {
 public:
  GdalSetting(const char* name, const char* value) : name_(name) {
    CPLSetThreadLocalConfigOption(name, value);
  }
  ~GdalSetting() { CPLSetThreadLocalConfigOption(name_, nullptr); }
  GdalSetting(const GdalSetting&) = delete;
  GdalSetting& operator=(const GdalSetting&) = delete;
  GdalSetting(GdalSetting&&) = delete;
  GdalSetting& operator=(GdalSetting&&) = delete;

 private:
  const char* name_;
};

struct GdalDatasetCloser {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using GdalDataset = std::unique_ptr<GDALDataset, GdalDatasetCloser>;

struct XmlCloser {
  void operator()(CPLXMLNode* node) const { CPLDestroyXMLNode(node); }
};
using XmlTree = std::unique_ptr<CPLXMLNode, XmlCloser>;

/// The largest raster that is read as a whole: a map of more pixels could not be indexed.
inline constexpr std::int64_t kMostRasterPixels = (std::int64_t{1} << 31U) - 1;

/// Throws Error (input) where the header of a raster declares blocks that are larger than the
/// raster and than 64 million pixels: GDAL would make room for one of them.
void check_block_size(GDALDataset& dataset, const std::filesystem::path& path);
/// That, and that the raster has no more than kMostRasterPixels.
void check_raster_size(GDALDataset& dataset, const std::filesystem::path& path);

/// The driver of a format ("GTiff", "PNG", "MEM"); registers GDAL's drivers at the first call.
/// Throws Error (processing) where this GDAL was built without it.
GDALDriver& gdal_driver(const char* name);

}  // namespace nadir
