// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Marks a function that runs on the GPU and, in the tests, on the CPU. All code below
/// map_matching/cuda that a kernel reaches is marked so, stands in headers, and is C++17: the
/// newest that CUDA 11.8 knows.
#if defined(__CUDACC__)
#define NADIR_HOST_DEVICE __host__ __device__
#else
#define NADIR_HOST_DEVICE
#endif

/// Before a loop: the GPU's compiler writes its body `times` times.
#if defined(__CUDA_ARCH__)
#define NADIR_PRAGMA(text) _Pragma(#text)
#define NADIR_UNROLL(times) NADIR_PRAGMA(unroll times)
#else
#define NADIR_UNROLL(times)
#endif
