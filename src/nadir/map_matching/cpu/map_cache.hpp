// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <mutex>

#include "nadir/map_matching/cpu/correlator.hpp"
#include "nadir/map_matching/surface.hpp"

namespace nadir::cpu {

/// The map's side of the correlations: of one region, at one size of the transform.
struct MapSpectra {
  Correlator correlator;
  double shift = 0.0;     ///< R' = (R - shift) / 64
  Spectrum mask = {};     ///< of V
  Spectrum value = {};    ///< of V R'
  Spectrum squares = {};  ///< of V R'^2
  Spectrum seen = {};     ///< of what was really seen; empty where that is V
};

/// What the CPU keeps of a map once a first match has computed it: the spectra of the whole map at
/// the last size of the transform. Several threads may ask at once; each gets the same values.
class MapCache : public PreparedMap {
 public:
  using Spectra = std::shared_ptr<const MapSpectra>;

  /// The kept spectra where they are of `size`, else what `compute` returns, kept from now on.
  Spectra whole_map(const FftSize& size, const std::function<Spectra()>& compute);

 private:
  std::mutex mutex_;
  Spectra whole_map_;
};

}  // namespace nadir::cpu
