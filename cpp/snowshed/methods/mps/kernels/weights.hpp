// Weights of pairs, and their sums over a row, which is a particle. `offset` (D arrays), `weight`,
// `slope` and `corrected` have a value per pair; `correction` has an upper half by rows per
// particle.
#pragma once

#include "snowshed/methods/mps/kernels/row_packs.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::mps)

/// weight[pair] = w(r) = reach/r - 1, slope[pair] = w(r)/r^2; `sum` and `filling` are the row's
/// sums of w and of filling_weight.
template <int D>
SNOWSHED_INLINE void weigh_row(const PairRows& rows, const float* const* offset, float reach,
                               float* weight, float* slope, float& sum, float& filling,
                               std::size_t row) {
  using V = SimdPack<float>;
  V total{}, filled{};
  for_each_pack<V>(rows, row, [&](const RowPack<V>& pack) SNOWSHED_INLINE_LAMBDA {
    V square{};
    SNOWSHED_UNROLL
    for (int d = 0; d < D; ++d) {
      const V r = pack.load(offset[d]);
      square += r * r;
    }
    square = max(square, broadcast<V>(1e-4f * reach * reach));  // particles at the same position
    const V distance = sqrt(square);
    const V w = max(V(reach / distance - 1.0f), V{});
    pack.store(weight, w);
    pack.store(slope, V(w / square));
    const V q = distance / reach, left = max(V(1.0f - q), V{}), rest = left * left;
    const auto used = first_lanes<V>(pack.count);
    total += select(used, w, V{});
    filled += select(used, V(rest * rest * (1.0f + 4.0f * q)), V{});
  });
  sum = sum_lanes(total);
  filling = sum_lanes(filled);
}

/// The row's sums of slope * r x r, weight * r x r and weight * r.
template <int D>
SNOWSHED_INLINE void sum_row_moments(const PairRows& rows, const float* const* offset,
                                     const float* weight, const float* slope,
                                     RowMoments<D>& moments, std::size_t row) {
  using V = SimdPack<float>;
  constexpr int half = RowMoments<D>::half;
  V by_slope[half] = {}, by_weight[half] = {}, side[D] = {};
  for_each_pack<V>(rows, row, [&](const RowPack<V>& pack) SNOWSHED_INLINE_LAMBDA {
    const V w = pack.load(weight), s = pack.load(slope);
    V r[D];
    SNOWSHED_UNROLL
    for (int d = 0; d < D; ++d) r[d] = pack.load(offset[d]);
    int k = 0;
    SNOWSHED_UNROLL
    for (int a = 0; a < D; ++a) {
      const V weighted = w * r[a];
      side[a] += weighted;
      SNOWSHED_UNROLL
      for (int b = a; b < D; ++b, ++k) {
        by_slope[k] += s * r[a] * r[b];
        by_weight[k] += weighted * r[b];
      }
    }
  });
  SNOWSHED_UNROLL
  for (int k = 0; k < half; ++k) {
    moments.slope[k] = sum_lanes(by_slope[k]);
    moments.weight[k] = sum_lanes(by_weight[k]);
  }
  SNOWSHED_UNROLL
  for (int d = 0; d < D; ++d) moments.side[d] = sum_lanes(side[d]);
}

/// corrected[pair] = weight[pair] * clamp(e . B e, 0.5, 2); e is the direction of the separation,
/// and B the mean of both particles' corrections.
template <int D>
SNOWSHED_INLINE void find_isotropic_weights(const PairRows& rows, const float* const* offset,
                                            const float* weight, const float* correction,
                                            float* corrected, std::size_t row) {
  using V = SimdPack<float>;
  constexpr int half = RowMoments<D>::half;
  for_each_pack<V>(rows, row, [&](const RowPack<V>& pack) SNOWSHED_INLINE_LAMBDA {
    const IndexPack<V> at = pack.load_index(rows.index) * half;
    V r[D], square{}, sum{};
    SNOWSHED_UNROLL
    for (int d = 0; d < D; ++d) {
      r[d] = pack.load(offset[d]);
      square += r[d] * r[d];
    }
    int k = 0;
    SNOWSHED_UNROLL
    for (int a = 0; a < D; ++a) SNOWSHED_UNROLL
    for (int b = a; b < D; ++b, ++k) {
      const V both = gather<V>(correction + k, at) + correction[row * half + std::size_t(k)];
      sum += (a == b ? 0.5f : 1.0f) * both * r[a] * r[b];
    }
    const V ratio = sum / max(square, broadcast<V>(1e-30f));
    pack.store(corrected,
               V(pack.load(weight) * clamp(ratio, broadcast<V>(0.5f), broadcast<V>(2.0f))));
  });
}

SNOWSHED_MODULE_VARIANT_END
