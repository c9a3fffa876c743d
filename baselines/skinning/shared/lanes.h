#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "baselines/skinning/shared/influences.h"
#include "core/parallel.h"

// Four doubles at a time, for the sources of this folder only. GCC's vector types compile for every
// instruction set (two SSE2 registers where there is no AVX).

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // every function here is inlined: no ABI is crossed

namespace geoprior::skinning::lanes {

using Double4 [[gnu::vector_size(32)]] = double;
using Float4 [[gnu::vector_size(16)]] = float;

[[gnu::always_inline]] inline Double4 load(const double* p) {
  Double4 x;
  std::memcpy(&x, p, sizeof x);
  return x;
}

[[gnu::always_inline]] inline Double4 load(const float* p) {
#if defined(__AVX__)
  return _mm256_cvtps_pd(_mm_loadu_ps(p));
#else
  Float4 x;
  std::memcpy(&x, p, sizeof x);
  return __builtin_convertvector(x, Double4);
#endif
}

[[gnu::always_inline]] inline void store(double* p, const Double4& x) {
  std::memcpy(p, &x, sizeof x);
}

[[gnu::always_inline]] inline Double4 all(double x) { return Double4{x, x, x, x}; }

/// a b + c; fused where the instruction set has it (its results differ in the last bit from sets
/// that have not).
[[gnu::always_inline]] inline Double4 multiply_add(const Double4& a, const Double4& b,
                                                   const Double4& c) {
#if defined(__FMA__) && defined(__AVX__)
  return _mm256_fmadd_pd(a, b, c);
#else
  return a * b + c;
#endif
}

/// Element `lane` in all places.
template <int lane>
[[gnu::always_inline]] inline Double4 spread(const Double4& x) {
  return __builtin_shufflevector(x, x, lane, lane, lane, lane);
}

/// Rows become columns.
[[gnu::always_inline]] inline void transpose(Double4& a, Double4& b, Double4& c, Double4& d) {
  const Double4 ab_lo = __builtin_shufflevector(a, b, 0, 4, 2, 6);
  const Double4 ab_hi = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Double4 cd_lo = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const Double4 cd_hi = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  a = __builtin_shufflevector(ab_lo, cd_lo, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab_hi, cd_hi, 0, 1, 4, 5);
  c = __builtin_shufflevector(ab_lo, cd_lo, 2, 3, 6, 7);
  d = __builtin_shufflevector(ab_hi, cd_hi, 2, 3, 6, 7);
}

/// Sums of the elements of each argument.
[[gnu::always_inline]] inline Double4 sums(const Double4& a, const Double4& b, const Double4& c,
                                           const Double4& d) {
  const Double4 ab =
      __builtin_shufflevector(a, b, 0, 4, 2, 6) + __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Double4 cd =
      __builtin_shufflevector(c, d, 0, 4, 2, 6) + __builtin_shufflevector(c, d, 1, 5, 3, 7);
  return __builtin_shufflevector(ab, cd, 0, 1, 4, 5) + __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
}

/// Copies past the caches (the destination is not read, nothing useful is evicted); a plain copy
/// where the instruction set has no such store.
inline void stream(const double* from, double* to, std::size_t n) {
#if defined(__AVX__)
  std::size_t i = 0;
  for (; i < n && reinterpret_cast<std::uintptr_t>(to + i) % 32 != 0; ++i) to[i] = from[i];
  for (; i + 4 <= n; i += 4) _mm256_stream_pd(to + i, _mm256_loadu_pd(from + i));
#elif defined(__SSE2__)
  std::size_t i = 0;
  for (; i < n && reinterpret_cast<std::uintptr_t>(to + i) % 16 != 0; ++i) to[i] = from[i];
  for (; i + 2 <= n; i += 2) _mm_stream_pd(to + i, _mm_loadu_pd(from + i));
#else
  std::size_t i = 0;
#endif
  for (; i < n; ++i) to[i] = from[i];
}

inline void stream_fence() {
#if defined(__SSE2__)
  _mm_sfence();
#endif
}

/// One value a joint for the length of a call; on the stack up to 256 joints.
template <class Value>
class JointTable {
 public:
  explicit JointTable(std::size_t joints) {
    if (joints > on_stack_.size()) on_heap_ = std::make_unique<Value[]>(joints);
    values_ = on_heap_ ? on_heap_.get() : on_stack_.data();
  }
  Value& operator[](std::size_t joint) { return values_[joint]; }
  [[nodiscard]] const Value* data() const { return values_; }

 private:
  std::array<Value, 256> on_stack_;
  std::unique_ptr<Value[]> on_heap_;
  Value* values_;
};

/// From this many vertices on the posed positions (12 MB, beside 22 MB read) do not stay in a cache
/// anyway, and are written past it.
constexpr int kStreamedVertices = 500'000;

/// Blocks between the one that is computed and the one that is asked of the memory: the arithmetic
/// of a block fills the processor's window, so that loads would not run ahead by themselves.
constexpr std::size_t kAhead = 16;

/// Asks for the cache line `ahead` elements after `p`, which may lie beyond the end of the array.
template <class T>
[[gnu::always_inline]] inline void prefetch(const T* p, std::size_t ahead) {
  const std::uintptr_t address = reinterpret_cast<std::uintptr_t>(p) + ahead * sizeof(T);
  __builtin_prefetch(reinterpret_cast<const void*>(address), 0, 3);
}

/// One block of four vertices as a kernel sees it.
struct Block {
  const double* rest;           ///< 4 x, 4 y, 4 z
  const std::uint16_t* joints;  ///< 4 a slot
  const float* weights;         ///< 4 a slot from the second on
  int slots;
};

/// Weight of the strongest influence: what the others leave of 1.
[[gnu::always_inline]] inline Double4 first_weight(const Block& block) {
  Double4 w = all(1.0);
  for (int s = 1; s < block.slots; ++s) w -= load(block.weights + 4 * (s - 1));
  return w;
}

/// Calls `kernel(block, x, y, z)` for all blocks of a chunk; the kernel sets the posed coordinates.
template <class Kernel>
[[gnu::always_inline]] inline void for_chunk(const PackedInfluences& packed, std::size_t chunk,
                                             Eigen::MatrixX3d& posed, const Kernel& kernel) {
  constexpr std::size_t kBlocks = PackedInfluences::kChunkBlocks;
  // Padded: rows 4 KiB apart would fall into the same sets of the first cache.
  alignas(32) double buffer[3][4 * kBlocks + 8];
  const std::size_t first = chunk * kBlocks;
  const std::size_t last = std::min(first + kBlocks, packed.slots.size());
  const std::size_t slots_before = packed.chunk_slots[chunk];
  const std::uint16_t* joints = packed.joints.data() + 4 * slots_before;
  const float* weights = packed.weights.data() + 4 * (slots_before - first);
  for (std::size_t b = first; b < last; ++b) {
    const int slots = packed.slots[b];
    prefetch(packed.rest.data() + 12 * b, 12 * kAhead);
    prefetch(packed.rest.data() + 12 * b, 12 * kAhead + 8);
    prefetch(joints, 16 * kAhead);
    prefetch(weights, 12 * kAhead);
    Double4 x, y, z;
    kernel(Block{packed.rest.data() + 12 * b, joints, weights, slots}, x, y, z);
    store(&buffer[0][4 * (b - first)], x);
    store(&buffer[1][4 * (b - first)], y);
    store(&buffer[2][4 * (b - first)], z);
    joints += 4 * static_cast<std::ptrdiff_t>(slots);
    weights += 4 * static_cast<std::ptrdiff_t>(slots - 1);
  }
  const std::size_t total = packed.vertex_count;
  const std::size_t count = std::min(4 * last, total) - 4 * first;
  for (std::size_t k = 0; k < 3; ++k) {
    double* to = posed.data() + k * total + 4 * first;
    if (packed.vertex_count >= kStreamedVertices) {
      stream(buffer[k], to, count);
    } else {
      std::memcpy(to, buffer[k], count * sizeof(double));
    }
  }
  if (packed.vertex_count >= kStreamedVertices) stream_fence();
}

/// The same for all chunks, in parallel; sizes `posed`.
template <class Kernel>
void for_all_chunks(const PackedInfluences& packed, Eigen::MatrixX3d& posed, const Kernel& kernel) {
  posed.resize(packed.vertex_count, 3);
  parallel_blocks(packed.chunk_slots.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t chunk = begin; chunk < end; ++chunk) for_chunk(packed, chunk, posed, kernel);
  });
}

}  // namespace geoprior::skinning::lanes

#pragma GCC diagnostic pop
