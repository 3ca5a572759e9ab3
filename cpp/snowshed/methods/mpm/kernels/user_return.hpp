// Calls of the user's laws of the snow for a chunk of particles. Values go in and out by copy, so
// that they stay in registers where no law of the user is.
#pragma once

#include <cstring>

#include "snowshed/material/sym_tensor.hpp"
#include "snowshed/methods/mpm/kernel_api.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::mpm)

/// The snow of each particle of a chunk.
template <class T>
SNOWSHED_INLINE const std::uint8_t* snows_of_chunk(const ParticleView<T>& p, int at) {
  static constexpr std::uint8_t only_snow[simd_width<T>] = {};
  return p.material_id ? p.material_id + at : only_snow;
}

template <class T>
struct UserReturn {
  SimdPack<T> p, q, plastic;
};

/// Returns pressure and Mises stress by the user's law of the material.
template <class T>
__attribute__((noinline)) UserReturn<T> user_return(const StepParameters<T>& step,
                                                    const ParticleView<T>& p, SimdPack<T> pressure,
                                                    SimdPack<T> mises, SimdPack<T> plastic, int at,
                                                    int n) {
  using V = SimdPack<T>;
  T values[3][simd_width<T>];
  std::memcpy(values[0], &pressure, sizeof(V));
  std::memcpy(values[1], &mises, sizeof(V));
  std::memcpy(values[2], &plastic, sizeof(V));
  step.law(n, values[0], values[1], values[2], snows_of_chunk(p, at), double(step.dt));
  UserReturn<T> returned;
  std::memcpy(&returned.p, values[0], sizeof(V));
  std::memcpy(&returned.q, values[1], sizeof(V));
  std::memcpy(&returned.plastic, values[2], sizeof(V));
  return returned;
}

template <class T, int D>
struct UserStress {
  material::Sym<SimdPack<T>, D> tau, be_minus_identity;
  SimdPack<T> plastic, strain_squared;  // the square of the norm of the remaining strain
};

/// Returns stress and state by the user's constitutive law; only the stress if the strain has been
/// returned (`committed`).
template <class T, int D>
__attribute__((noinline)) UserStress<T, D> user_stress(
    const StepParameters<T>& step, const ParticleView<T>& p,
    material::Sym<SimdPack<T>, D> be_minus_identity, SimdPack<T> plastic_strain, int at, int n,
    bool committed) {
  using Tensor = material::Sym<SimdPack<T>, D>;
  constexpr int size = Tensor::size, lanes = simd_width<T>;
  T strain[size * lanes], stress[size * lanes], plastic[lanes], own[max_own_numbers * lanes];
  const Tensor trial = material::hencky_strain(be_minus_identity);
  for (int k = 0; k < size; ++k) store(strain + k * n, trial.c[k], n);
  store(plastic, plastic_strain, n);
  for (int k = 0; k < step.own_numbers; ++k)
    std::memcpy(own + k * n, p.own[k] + at, sizeof(T) * std::size_t(n));
  step.constitutive(n, strain, stress, plastic, own, snows_of_chunk(p, at),
                    committed ? 0.0 : double(step.dt));
  UserStress<T, D> r;
  for (int k = 0; k < size; ++k) r.tau.c[k] = load(stress + k * n, n);
  r.be_minus_identity = be_minus_identity;
  r.plastic = plastic_strain;
  r.strain_squared = material::norm_squared(trial);
  if (committed) return r;
  Tensor remaining;
  for (int k = 0; k < size; ++k) remaining.c[k] = load(strain + k * n, n);
  const Tensor returned = material::cauchy_green_minus_identity(remaining);
  auto changed = remaining.c[0] != trial.c[0];
  for (int k = 1; k < size; ++k) changed = changed | (remaining.c[k] != trial.c[k]);
  for (int k = 0; k < size; ++k)
    r.be_minus_identity.c[k] = select(changed, returned.c[k], be_minus_identity.c[k]);
  r.plastic = load(plastic, n);
  r.strain_squared = material::norm_squared(remaining);
  for (int k = 0; k < step.own_numbers; ++k)
    std::memcpy(p.own[k] + at, own + k * n, sizeof(T) * std::size_t(n));
  return r;
}

SNOWSHED_MODULE_VARIANT_END
