// The pairs of a row, some at a time.
#pragma once

#include "snowshed/core/simd_pack.hpp"
#include "snowshed/methods/mps/kernel_api.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::mps)

/// Indices for the lanes of V.
template <class V>
struct IndexOf {
  typedef std::int32_t type __attribute__((vector_size(4 * lane_count<V>), may_alias));
  typedef float bits __attribute__((vector_size(4 * lane_count<V>), may_alias));
};
template <class V>
using IndexPack = typename IndexOf<V>::type;

/// The `count` pairs of a row from `entry` on, at most as many as V has lanes.
template <class V>
struct RowPack {
  std::size_t entry;
  int count;

  /// The neighbours of the pairs, and particle 0 in the lanes beyond.
  SNOWSHED_INLINE IndexPack<V> load_index(const std::uint32_t* p) const {
    using Bits = typename IndexOf<V>::bits;
    return (IndexPack<V>)load_some<Bits>(reinterpret_cast<const float*>(p + entry));
  }
  /// The values of the pairs, and zero in the lanes beyond.
  SNOWSHED_INLINE V load(const float* p) const {
    using Bits = typename IndexOf<V>::bits;
    if constexpr (sizeof(Scalar<V>) == 4)
      return load_some<V>(p + entry);
    else
      return __builtin_convertvector(load_some<Bits>(p + entry), V);
  }
  SNOWSHED_INLINE void store(float* p, const V& v) const {
    using Bits = typename IndexOf<V>::bits;
    if constexpr (sizeof(Scalar<V>) == 4)
      store_pack(p + entry, v, count);
    else
      store_pack<Bits>(p + entry, __builtin_convertvector(v, Bits), count);
  }

 private:
  template <class T>
  SNOWSHED_INLINE T load_some(const float* p) const {
    if (count < lane_count<T>) return load_first<T>(p, count, T{});
    T v;
    std::memcpy(&v, p, sizeof v);
    return v;
  }
};

template <class V, class Visit>
SNOWSHED_INLINE void for_each_pack(const PairRows& rows, std::size_t row, const Visit& visit) {
  constexpr int lanes = lane_count<V>;
  const std::size_t end = rows.first[row + 1];
  for (std::size_t e = rows.first[row]; e < end; e += lanes)
    visit(RowPack<V>{e, e + lanes <= end ? lanes : int(end - e)});
}

/// The values at some indices.
template <class V>
SNOWSHED_INLINE V gather(const Scalar<V>* p, const IndexPack<V>& index) {
#if defined(__AVX512F__)
  if constexpr (sizeof(Scalar<V>) == 4)
    return (V)_mm512_mask_i32gather_ps((__m512)V{}, __mmask16(0xffff), (__m512i)index, p, 4);
  else
    return (V)_mm512_mask_i32gather_pd((__m512d)V{}, __mmask8(0xff), (__m256i)index, p, 8);
#elif defined(__AVX2__)
  if constexpr (sizeof(Scalar<V>) == 4)
    return (V)_mm256_mask_i32gather_ps((__m256)V{}, p, (__m256i)index, (__m256)(V{} == V{}), 4);
  else
    return (V)_mm256_mask_i32gather_pd((__m256d)V{}, p, (__m128i)index, (__m256d)(V{} == V{}), 8);
#else
  V v;
  for (int i = 0; i < lane_count<V>; ++i) v[i] = p[index[i]];
  return v;
#endif
}

template <class V>
SNOWSHED_INLINE Scalar<V> sum_lanes(const V& v) {
  return combine_lanes(v,
                       [](const auto& a, const auto& b) SNOWSHED_INLINE_LAMBDA { return a + b; });
}

SNOWSHED_MODULE_VARIANT_END
