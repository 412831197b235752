// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "nadir/map_matching/cuda/surfaces.hpp"

namespace nadir::cuda {
namespace {

/// Map pixels that the templates touch along one axis, first and behind the last.
struct Reach {
  int first = 0;
  int end = 0;
};
Reach reach_of(int window_first, int window_size, int box_first, int box_size) {
  return {window_first + box_first, window_first + window_size - 1 + box_first + box_size};
}

/// A size at which no template that wraps around meets the map a second time: pixels left of the
/// crop come out at its right, behind `end`. It may be smaller than the template: what does not fit
/// in touches no pixel of the crop.
int size_for(const Reach& reach, int crop_first, int crop_size) {
  return fft_size(
      std::max({crop_size, crop_first + crop_size - reach.first, reach.end - crop_first}));
}

struct Extent {
  Box crop;
  PlaneShape shape;
  double area() const { return static_cast<double>(shape.width) * shape.height; }
};

Extent extent_over(const Box& crop, const Reach& columns, const Reach& rows) {
  return {crop, {size_for(columns, crop.left, crop.width), size_for(rows, crop.top, crop.height)}};
}

bool holds(const PlaneShape& have, const PlaneShape& need) {
  return have.width >= need.width && have.height >= need.height;
}

void compute_spectra(DeviceMap& map, MapSpectra& spectra, const Extent& extent) {
  spectra.shape = {};  // nothing, should the device fail
  map.levels.part = nullptr;
  const auto size = static_cast<std::size_t>(kMapPlanes * extent.shape.reals());
  MapPlanes planes{map.pixels.data(), map.width,    extent.crop,
                   map.mean_grey,     extent.shape, spectra.planes.reserve(size)};
  map.device->launch(planes, 0);
  map.device->make_fft(extent.shape, kMapPlanes, 0)->forward(planes.planes);
  map.device->wait(0);  // the other stream reads them too
  spectra.shape = extent.shape;
  spectra.crop = extent.crop;
}

/// The spectra that a search needs: those of the whole map, kept from search to search, unless the
/// window is so small that cutting it out makes the transforms half as large.
const MapSpectra& spectra_for(DeviceMap& map, const SurfaceJob& job) {
  const Reach columns = reach_of(job.window.left, job.window.width, job.box.left, job.box.width);
  const Reach rows = reach_of(job.window.top, job.window.height, job.box.top, job.box.height);
  const Extent whole = extent_over({0, 0, map.width, map.height}, columns, rows);
  Box cut{std::max(columns.first, 0), std::max(rows.first, 0), 0, 0};
  cut.width = std::min(columns.end, map.width) - cut.left;
  cut.height = std::min(rows.end, map.height) - cut.top;
  const Extent part = extent_over(cut, columns, rows);
  if (part.area() <= 0.5 * whole.area()) {
    compute_spectra(map, map.part, part);
    return map.part;
  }
  const bool kept =
      holds(map.whole.shape, whole.shape) && map.whole.shape.reals() <= 2 * whole.shape.reals();
  if (!kept) compute_spectra(map, map.whole, whole);
  return map.whole;
}

void prepare_transforms(Device& device, StreamWork& work, PlaneShape shape, int batch,
                        Formula formula, int stream) {
  const bool fits = work.template_fft && work.fft_shape.width == shape.width &&
                    work.fft_shape.height == shape.height && work.fft_batch == batch &&
                    template_planes(work.fft_formula) == template_planes(formula);
  if (fits) return;
  work.template_fft.reset();
  work.product_fft.reset();
  work.template_fft = device.make_fft(shape, batch * template_planes(formula), stream);
  work.product_fft = device.make_fft(shape, batch * product_planes(formula), stream);
  work.fft_shape = shape;
  work.fft_batch = batch;
  work.fft_formula = formula;
}

std::size_t bytes_per_template(const SurfaceJob& job, const PlaneShape& shape) {
  const auto planes = static_cast<std::size_t>(template_planes(job.rule.formula)) +
                      static_cast<std::size_t>(product_planes(job.rule.formula));
  const auto plane = static_cast<std::size_t>(shape.reals()) * sizeof(float);
  const auto window =
      static_cast<std::size_t>(job.window.width) * static_cast<std::size_t>(job.window.height);
  const std::size_t moments = job.rule.formula == Formula::kPaper ? 2 : 0;
  // A transform may need as much again as it transforms.
  return 2 * planes * plane + window * ((2 + moments) * sizeof(float) + sizeof(PeakKey));
}

}  // namespace

void correlate_surfaces(DeviceMap& map, const SurfaceJob& job, const FillTemplates& fill,
                        SurfaceSink& sink) {
  Device& device = *map.device;
  const MapSpectra& spectra = spectra_for(map, job);
  const PlaneShape shape = spectra.shape;
  const Formula formula = job.rule.formula;
  // The other half is for the spectra of levels.
  const std::size_t bytes = device.workspace_bytes() / (formula == Formula::kPaper ? 2 : 1);
  const int size = batch_size(job.count, bytes, bytes_per_template(job, shape));
  const auto planes = static_cast<std::size_t>(size * shape.reals());
  const auto scores = static_cast<std::size_t>(size) * static_cast<std::size_t>(job.window.width) *
                      static_cast<std::size_t>(job.window.height);
  const Box positions{job.window.left - spectra.crop.left, job.window.top - spectra.crop.top,
                      job.window.width, job.window.height};

  for_each_batch(map, job, size, sink, [&](const Batch& batch) {
    StreamWork& work = map.work[static_cast<std::size_t>(batch.stream)];
    prepare_transforms(device, work, shape, size, formula, batch.stream);
    float* templates =
        work.template_planes.reserve(planes * static_cast<std::size_t>(template_planes(formula)));
    float* products =
        work.product_planes.reserve(planes * static_cast<std::size_t>(product_planes(formula)));
    fill(batch, work);
    TemplateStats* stats = work.stats.reserve(static_cast<std::size_t>(size));
    device.launch(
        SumTemplates{work.turned.data(), batch.count, job.box.width * job.box.height, stats},
        batch.stream);
    device.launch(
        TemplatePlanes{work.turned.data(), stats, batch.count, job.box, formula, shape, templates},
        batch.stream);
    work.template_fft->forward(templates);
    // A real in place of its spectrum: two floats are one complex.
    device.launch(MultiplySpectra{reinterpret_cast<const Complex*>(spectra.planes.data()),
                                  reinterpret_cast<const Complex*>(templates), batch.count, formula,
                                  shape, reinterpret_cast<Complex*>(products)},
                  batch.stream);
    work.product_fft->inverse(products);
    float* score = work.score.reserve(scores);
    float* share = work.share.reserve(scores);
    if (formula == Formula::kPaper) {
      score_by_levels(map, job, spectra, batch, positions);
      return;
    }
    device.launch(AssembleScores{products, stats, batch.count, job.rule, map.mean_grey, shape,
                                 positions, score, share},
                  batch.stream);
  });
}

}  // namespace nadir::cuda
