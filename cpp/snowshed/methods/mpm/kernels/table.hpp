// From a choice of features to the functions compiled for exactly them.
#pragma once

#include "snowshed/methods/mpm/kernels/node_kernels.hpp"
#include "snowshed/methods/mpm/kernels/particle_kernels.hpp"

SNOWSHED_METHOD_VARIANT_BEGIN(mpm)

template <class T, int D, Transfer transfer, Basis basis, class Snows, bool energy>
Kernels<T> kernels_for() {
  using P = ParticleKernels<T, D, transfer, basis, Snows, energy>;
  using Motion =
      ParticleKernels<T, D, transfer, basis, SingleMaterial<T, Elastic>, false>;  // of any snow
  using G = NodeKernels<T, D, basis, transfer == Transfer::flip, energy>;
  return {&P::scatter, &P::g2p2g, &Motion::probe, &G::gather, &G::update, &G::carried_motion};
}

template <class T, int D, Transfer transfer, Basis basis>
Kernels<T> with_snow(const KernelChoice& c) {
  if (c.energy) return kernels_for<T, D, transfer, basis, MaterialPerParticle<T>, true>();
  if (c.material_per_particle())
    return kernels_for<T, D, transfer, basis, MaterialPerParticle<T>, false>();
  return c.model == SnowModel::cam_clay
             ? kernels_for<T, D, transfer, basis, SingleMaterial<T, CamClay>, false>()
             : kernels_for<T, D, transfer, basis, SingleMaterial<T, Elastic>, false>();
}
template <class T, int D, Transfer transfer>
Kernels<T> with_basis(const KernelChoice& c) {
  return c.basis == Basis::quadratic ? with_snow<T, D, transfer, Basis::quadratic>(c)
                                     : with_snow<T, D, transfer, Basis::cubic>(c);
}
template <class T, int D>
Kernels<T> table(const KernelChoice& c) {
  return c.transfer == Transfer::flip ? with_basis<T, D, Transfer::flip>(c)
                                      : with_basis<T, D, Transfer::apic>(c);
}

Kernels<float> float_2d(const KernelChoice&);
Kernels<float> float_3d(const KernelChoice&);
Kernels<double> double_2d(const KernelChoice&);
Kernels<double> double_3d(const KernelChoice&);

SNOWSHED_METHOD_VARIANT_END
