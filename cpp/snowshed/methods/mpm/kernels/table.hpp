// The functions that are compiled for a choice of features.
#pragma once

#include "snowshed/methods/mpm/kernels/node_kernels.hpp"
#include "snowshed/methods/mpm/kernels/particle_kernels.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::mpm)

template <class T, int D, Transfer transfer, Basis basis, class Snows, bool energy>
Kernels<T> kernels_for() {
  using P = ParticleKernels<T, D, transfer, basis, Snows, energy>;
  // Motion is the same for any snow.
  using Motion =
      ParticleKernels<T, D, transfer, basis, SingleMaterial<T, material::Elastic>, false>;
  using G = NodeKernels<T, D, basis, transfer != Transfer::apic, energy>;
  Kernels<T> kernels{&P::scatter, &P::g2p2g,       nullptr,    &Motion::probe,    &G::gather,
                     &G::update,  &G::update_free, &G::finish, &G::carried_motion};
  if constexpr (TransferRule<T, D, transfer, basis>::averages)
    kernels.scatter_average = &scatter_average<T, D, basis>;
  return kernels;
}

/// `Law` is the Cam-Clay law. The kernels for checks always use RegularisedCamClay.
template <class T, int D, Transfer transfer, Basis basis, template <class> class Law>
Kernels<T> with_law(const KernelChoice& c) {
  if (c.checks())
    return kernels_for<T, D, transfer, basis, MaterialPerParticle<T, material::RegularisedCamClay>,
                       true>();
  if (c.material_per_particle())
    return kernels_for<T, D, transfer, basis, MaterialPerParticle<T, Law>, false>();
  return c.model == material::SnowModel::cam_clay
             ? kernels_for<T, D, transfer, basis, SingleMaterial<T, Law>, false>()
             : kernels_for<T, D, transfer, basis, SingleMaterial<T, material::Elastic>, false>();
}
template <class T, int D, Transfer transfer, Basis basis>
Kernels<T> with_snow(const KernelChoice& c) {
  if constexpr (transfer == Transfer::affine_flip)
    return with_law<T, D, transfer, basis, material::RegularisedCamClay>(c);
  else
    return with_law<T, D, transfer, basis, material::CamClay>(c);
}
template <class T, int D, Transfer transfer>
Kernels<T> with_basis(const KernelChoice& c) {
  return c.basis == Basis::quadratic ? with_snow<T, D, transfer, Basis::quadratic>(c)
                                     : with_snow<T, D, transfer, Basis::cubic>(c);
}
template <class T, int D>
Kernels<T> table(const KernelChoice& c) {
  switch (c.transfer) {
    case Transfer::flip:
      return with_basis<T, D, Transfer::flip>(c);
    case Transfer::apic:
      return with_basis<T, D, Transfer::apic>(c);
    case Transfer::affine_flip:
      break;
  }
  return with_basis<T, D, Transfer::affine_flip>(c);
}

Kernels<float> float_2d(const KernelChoice&);
Kernels<float> float_3d(const KernelChoice&);
Kernels<double> double_2d(const KernelChoice&);
Kernels<double> double_3d(const KernelChoice&);

SNOWSHED_MODULE_VARIANT_END
