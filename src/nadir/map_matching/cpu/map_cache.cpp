// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/cpu/map_cache.hpp"

namespace nadir::cpu {

MapCache::Spectra MapCache::whole_map(const FftSize& size,
                                      const std::function<Spectra()>& compute) {
  {
    const std::scoped_lock lock(mutex_);
    if (whole_map_ && whole_map_->correlator.size() == size) return whole_map_;
  }
  // Without the lock: a thread that waits for its tasks may be given one that comes here.
  Spectra computed = compute();
  const std::scoped_lock lock(mutex_);
  whole_map_ = computed;
  return computed;
}

}  // namespace nadir::cpu
