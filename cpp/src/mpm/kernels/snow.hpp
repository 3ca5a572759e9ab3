// The snow of the particles in a chunk: one for all of them, whose constants are scalars, or each
// particle's own, whose constants are lanes.
#pragma once

#include "snowshed/material/cam_clay.hpp"
#include "snowshed/material/elastic.hpp"
#include "snowshed/mpm/kernel_api.hpp"

SNOWSHED_VARIANT_BEGIN

template <template <class> class Law, class C>
struct ChunkSnow {
  static constexpr bool plastic = Law<C>::plastic;
  Law<C> law;
  C specific_volume;  // m3/kg, before any deformation
};

template <class C>
SNOWSHED_INLINE ChunkSnow<Elastic, C> elastic_snow(const SnowConstants<C>& k) {
  return {{{k.lambda, k.mu, k.bulk}}, k.specific_volume};
}
template <class C>
SNOWSHED_INLINE ChunkSnow<CamClay, C> cam_clay_snow(const SnowConstants<C>& k) {
  return {{{k.lambda, k.mu, k.bulk}, k.m2, k.beta, k.xi, k.hardening}, k.specific_volume};
}

/// The only snow of a scene.
template <class T, template <class> class Law>
struct OneSnow {
  using Chunk = ChunkSnow<Law, T>;

  explicit OneSnow(const SnowConstants<T>* snows) {
    if constexpr (Chunk::plastic)
      snow = cam_clay_snow(snows[0]);
    else
      snow = elastic_snow(snows[0]);
  }

  SNOWSHED_INLINE const Chunk& of(const ParticleView<T>&, int, int) const { return snow; }

  Chunk snow;
};

/// Several snows, of either law: an elastic one has Cam-Clay constants that never yield (see
/// snow_constants).
template <class T>
struct SeveralSnows {
  using Chunk = ChunkSnow<CamClay, Lanes<T>>;

  explicit SeveralSnows(const SnowConstants<T>* snows) : snows(snows) {}

  /// Of `n` particles from `first`; as in `load`, lanes beyond repeat the first.
  SNOWSHED_INLINE Chunk of(const ParticleView<T>& p, int first, int n) const {
    SnowConstants<Lanes<T>> lanes{};
    for (int l = 0; l < lane_count<T>; ++l) {
      const SnowConstants<T>& own = snows[p.kind[first + (l < n ? l : 0)]];
      lanes.lambda[l] = own.lambda;
      lanes.mu[l] = own.mu;
      lanes.bulk[l] = own.bulk;
      lanes.m2[l] = own.m2;
      lanes.beta[l] = own.beta;
      lanes.xi[l] = own.xi;
      lanes.hardening[l] = own.hardening;
      lanes.specific_volume[l] = own.specific_volume;
    }
    return cam_clay_snow(lanes);
  }

  const SnowConstants<T>* snows;
};

SNOWSHED_VARIANT_END
