// The snow of the particles in a chunk. If all particles have the same snow, its constants are
// scalars. If each particle has its own, the constants are SIMD packs.
#pragma once

#include "snowshed/material/cam_clay.hpp"
#include "snowshed/material/elastic.hpp"
#include "snowshed/methods/mpm/kernel_api.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::mpm)

template <template <class> class Law, class C>
struct ChunkMaterial {
  static constexpr bool plastic = Law<C>::plastic;
  Law<C> law;
  C specific_volume;  // m3/kg, before any deformation
};

template <class C>
SNOWSHED_INLINE ChunkMaterial<material::Elastic, C> elastic_snow(const MaterialConstants<C>& k) {
  return {{{k.lambda, k.mu, k.bulk}}, k.specific_volume};
}
template <template <class> class Law, class C>
SNOWSHED_INLINE ChunkMaterial<Law, C> cam_clay_snow(const MaterialConstants<C>& k) {
  return {cam_clay_law<Law>(k), k.specific_volume};
}

/// The only snow of a scene.
template <class T, template <class> class Law>
struct SingleMaterial {
  using Chunk = ChunkMaterial<Law, T>;

  explicit SingleMaterial(const MaterialConstants<T>* snows) {
    if constexpr (Chunk::plastic)
      snow = cam_clay_snow<Law>(snows[0]);
    else
      snow = elastic_snow(snows[0]);
  }

  SNOWSHED_INLINE const Chunk& of(const ParticleView<T>&, int, int) const { return snow; }

  Chunk snow;
};

/// Several snows, Cam-Clay or elastic. Elastic snow has Cam-Clay constants with which it never
/// yields (see material_constants).
template <class T, template <class> class Law>
struct MaterialPerParticle {
  using Chunk = ChunkMaterial<Law, SimdPack<T>>;

  explicit MaterialPerParticle(const MaterialConstants<T>* snows) : snows(snows) {}

  /// Returns the constants of `n` particles from `first`. Further lanes repeat the first, as in
  /// `load`.
  SNOWSHED_INLINE Chunk of(const ParticleView<T>& p, int first, int n) const {
    const MaterialConstants<T>* own[simd_width<T>];
    for (int l = 0; l < simd_width<T>; ++l) own[l] = &snows[p.material_id[first + (l < n ? l : 0)]];
    using K = MaterialConstants<T>;
    MaterialConstants<SimdPack<T>> lanes{gather_constants(own, &K::lambda),
                                         gather_constants(own, &K::mu),
                                         gather_constants(own, &K::bulk),
                                         gather_constants(own, &K::m2),
                                         gather_constants(own, &K::beta),
                                         gather_constants(own, &K::xi),
                                         gather_constants(own, &K::hardening),
                                         gather_constants(own, &K::specific_volume),
                                         {},
                                         {}};
    if constexpr (std::is_same_v<Law<T>, material::RegularisedCamClay<T>>) {
      lanes.softening = gather_constants(own, &K::softening);
      lanes.band_begin = gather_constants(own, &K::band_begin);
    }
    return cam_clay_snow<Law>(lanes);
  }

  SNOWSHED_INLINE static SimdPack<T> gather_constants(const MaterialConstants<T>* const* own,
                                                      T MaterialConstants<T>::* constant) {
    auto lanes = broadcast<SimdPack<T>>(own[0]->*constant);
    for (int l = 1; l < simd_width<T>; ++l) lanes[l] = own[l]->*constant;
    return lanes;
  }

  const MaterialConstants<T>* snows;
};

SNOWSHED_MODULE_VARIANT_END
