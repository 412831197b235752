// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hwy/aligned_allocator.h>

#include <cstddef>
#include <new>

namespace nadir::cpu {

/// Memory at the borders of vectors. Throws std::bad_alloc, where Highway's own gives a null
/// pointer.
template <class T>
hwy::AlignedFreeUniquePtr<T[]> allocate_aligned(std::size_t count) {
  auto memory = hwy::AllocateAligned<T>(count);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace nadir::cpu
