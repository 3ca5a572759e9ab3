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
    const SnowConstants<T>* own[lane_count<T>];
    for (int l = 0; l < lane_count<T>; ++l) own[l] = &snows[p.kind[first + (l < n ? l : 0)]];
    using K = SnowConstants<T>;
    return cam_clay_snow(SnowConstants<Lanes<T>>{
        lanes_of(own, &K::lambda), lanes_of(own, &K::mu), lanes_of(own, &K::bulk),
        lanes_of(own, &K::m2), lanes_of(own, &K::beta), lanes_of(own, &K::xi),
        lanes_of(own, &K::hardening), lanes_of(own, &K::specific_volume)});
  }

  SNOWSHED_INLINE static Lanes<T> lanes_of(const SnowConstants<T>* const* own,
                                           T SnowConstants<T>::* constant) {
    auto lanes = broadcast<Lanes<T>>(own[0]->*constant);
    for (int l = 1; l < lane_count<T>; ++l) lanes[l] = own[l]->*constant;
    return lanes;
  }

  const SnowConstants<T>* snows;
};

SNOWSHED_VARIANT_END
