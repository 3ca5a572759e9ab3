// One particle in registers, and its part of a step (see kernels/particle_kernels.hpp).
#pragma once

#include "snowshed/methods/mpm/gpu/average.cuh"
#include "snowshed/methods/mpm/gpu/energy.cuh"
#include "snowshed/methods/mpm/kernels/stress.hpp"

namespace snowshed::methods::mpm::gpu {

using Strain = material::Sym<float, 3>;

/// Variant of the kernels of particles: one snow or several; FLIP, or a transfer with an affine
/// velocity; with the balance of energy or without it. As on the processor, all but the simplest
/// have the regularised law.
template <bool several_, bool affine_, bool energy_ = false>
struct Variant {
  static constexpr bool several = several_, affine = affine_, energy = energy_;
  static constexpr bool regularised = several || affine;
  using Law = material::CamClayLaw<float, regularised>;
};

/// Shares of a step that are the same for all particles.
struct StepShares {
  float dt, dx, cells_per_speed, flip_ratio;  // s; m; dt/dx, s/m
  float overstress;                           // see CamClayLaw
  float damping;                              // towards the average over a length

  __device__ StepShares(const Control& c, const Constants& k)
      : dt(float(c.dt)),
        dx(float(k.dx)),
        cells_per_speed(dt / dx),
        flip_ratio(k.damping_rate >= 0 ? float(::exp(-double(k.damping_rate) * c.dt))
                                       : k.flip_ratio),
        overstress(k.relaxation_time > 0 ? float(k.relaxation_time / (c.dt + k.relaxation_time))
                                         : 0.0f),
        damping(damping_of(c, k)) {}
};

/// Returns the constants of a particle's snow.
template <class Variant>
__device__ inline MaterialConstants<float> snow_of(const ParticleArrays& p, int i,
                                                   const Constants& k) {
  if (Variant::several) return k.snows[p.material_id[i]];
  return k.snow;
}

/// The affine velocity of a particle, which FLIP does not have.
template <bool affine>
struct AffineVelocity {
  float c[9];  // 1/s, row by row

  __device__ void read(const ParticleArrays& p, int i) {
#pragma unroll
    for (int k = 0; k < 9; ++k) c[k] = p.affine[k][i];
  }
  __device__ void write(const ParticleArrays& p, int i) const {
#pragma unroll
    for (int k = 0; k < 9; ++k) p.affine[k][i] = c[k];
  }
  __device__ void take(const NodeMeans<true>& m, float dx) {
    constexpr float inverse_inertia = float(apic_inverse_inertia(Basis::quadratic));
#pragma unroll
    for (int k = 0; k < 9; ++k) c[k] = m.moment[k / 3][k % 3] * (inverse_inertia / dx);
  }
  __device__ void give(Given<true>& g, float mass, float dx) const {
#pragma unroll
    for (int k = 0; k < 9; ++k) g.moment[k] = mass * c[k] * dx;
  }
  __device__ float largest() const {
    float all = 0;
    for (int k = 0; k < 9; ++k) all = ::fmaxf(all, ::fabsf(c[k]));
    return all;
  }
  __device__ double squared() const {
    double sum = 0;
    for (int k = 0; k < 9; ++k) sum += double(c[k]) * double(c[k]);
    return sum;
  }
};
template <>
struct AffineVelocity<false> {
  __device__ void read(const ParticleArrays&, int) {}
  __device__ void write(const ParticleArrays&, int) const {}
  __device__ void take(const NodeMeans<false>&, float) {}
  __device__ void give(Given<false>&, float, float) const {}
  __device__ float largest() const { return 0; }
  __device__ double squared() const { return 0; }
};

template <class Variant>
struct ParticleState {
  static constexpr bool affine = Variant::affine;
  float cell[3], velocity[3], plastic, mass;
  AffineVelocity<affine> spin;
  Strain be_minus_identity;
  ParticleRecord<Variant::energy> record;

  __device__ void read_cell(const ParticleArrays& p, int i) {
#pragma unroll
    for (int d = 0; d < 3; ++d) cell[d] = p.cell[d][i];
  }
  __device__ void read_rest(const ParticleArrays& p, int i) {
#pragma unroll
    for (int d = 0; d < 3; ++d) velocity[d] = p.velocity[d][i];
    spin.read(p, i);
#pragma unroll
    for (int k = 0; k < 6; ++k) be_minus_identity.c[k] = p.be_minus_identity[k][i];
    plastic = p.plastic ? p.plastic[i] : 0.0f;
    mass = p.mass[i];
  }
  __device__ void write(const ParticleArrays& p, int i) const {
#pragma unroll
    for (int d = 0; d < 3; ++d) {
      p.cell[d][i] = cell[d];
      p.velocity[d][i] = velocity[d];
    }
    spin.write(p, i);
#pragma unroll
    for (int k = 0; k < 6; ++k) p.be_minus_identity[k][i] = be_minus_identity.c[k];
    if (p.plastic) p.plastic[i] = plastic;
  }

  /// Moves with the nodes, and takes their change of velocity (1.2.26).
  __device__ void move(const NodeMeans<affine>& m, const StepShares& step) {
    float gradient[3][3];  // dt grad v
#pragma unroll
    for (int d = 0; d < 3; ++d) {
      const float pic = m.value[d], change = m.value[3 + d];
      cell[d] += pic * step.cells_per_speed;
      velocity[d] = pic + step.flip_ratio * (velocity[d] + change - pic);
#pragma unroll
      for (int j = 0; j < 3; ++j) gradient[d][j] = m.gradient[d][j] * step.cells_per_speed;
    }
    spin.take(m, step.dx);
    update_left_cauchy_green(be_minus_identity, gradient);
  }

  /// Returns the stress; first returns the strain to the yield surface, unless this has been done.
  __device__ Stress<float, 3> stress(const MaterialConstants<float>& snow, float overstress,
                                     bool committed) {
    const typename Variant::Law law = law_of(snow);
    return stress_of(be_minus_identity, law.elastic, [&](material::PQ<float>& pq) {
      const material::PQ<float> trial = pq;
      const bool changed = !committed && law.return_map(pq, plastic, overstress);
      record.add_return(trial, pq, law.elastic, volume(snow));
      return changed;
    });
  }

  /// Volume before any deformation, m3.
  __device__ double volume(const MaterialConstants<float>& snow) const {
    return double(mass) * double(snow.specific_volume);
  }

  __device__ float speed_squared() const {
    return velocity[0] * velocity[0] + velocity[1] * velocity[1] + velocity[2] * velocity[2];
  }

  __device__ void record_kinetic(double dx) {
    record.add_kinetic(mass, velocity, spin.squared(), dx);
  }

  __device__ Given<affine> given(const Strain& tau, float specific_volume, float dx) const {
    Given<affine> g;
    spin.give(g, mass, dx);
    g.mass = mass;
#pragma unroll
    for (int d = 0; d < 3; ++d) g.momentum[d] = mass * velocity[d];
    const float scale = mass * (-specific_volume / dx);
#pragma unroll
    for (int k = 0; k < 6; ++k) g.force[k] = scale * tau.c[k];
    return g;
  }

 private:
  static __device__ typename Variant::Law law_of(const MaterialConstants<float>& snow) {
    if constexpr (Variant::regularised)
      return cam_clay_law<material::RegularisedCamClay>(snow);
    else
      return cam_clay_law<material::CamClay>(snow);
  }
};

/// Raises the largest of some numbers, none of which is negative.
__device__ inline void raise(float* largest, float value) {
  atomicMax(reinterpret_cast<int*>(largest), __float_as_int(value));
}

/// Leaves a particle to the kernel of the strays.
__device__ inline void add_stray(std::int32_t* strays, Control* control, int i) {
  strays[atomicAdd(&control->strays, 1)] = i;
}

/// A particle after a step. Its nodes take it only if it is sound.
template <bool affine>
struct Moved {
  Given<affine> given;
  bool sound;
};

/// Moves a particle of a block with its nodes, and damps it towards the average.
template <class Variant>
__device__ inline void move(ParticleState<Variant>& s, const NodeMeans<Variant::affine>& m,
                            const AverageArrays& average, int block, const StepShares& step) {
  if (!Variant::affine || !(step.damping > 0)) return s.move(m, step);
  float change[3];
  find_damping(average, block, step.damping, s.cell, s.velocity, change);
  s.move(m, step);
  s.record.add_damping(s.mass, s.velocity, change);
  for (int d = 0; d < 3; ++d) s.velocity[d] += change[d];
}

/// The largest values of the particles of a thread.
struct Largest {
  float speed_squared = 0, spin = 0;
};

/// Takes a particle through a step whose node means are known, and writes it.
template <class Variant>
__device__ inline Moved<Variant::affine> finish_particle(ParticleState<Variant>& s,
                                                         const NodeMeans<Variant::affine>& m,
                                                         const ParticleArrays& p, int i,
                                                         const Constants& k, const StepShares& step,
                                                         Control* control, Largest& largest) {
  const MaterialConstants<float> snow = snow_of<Variant>(p, i, k);
  const Stress<float, 3> stress = s.stress(snow, step.overstress, false);
  s.write(p, i);
  s.record.add_stress_power(s.volume(snow), stress.tau, m.gradient, k.dx);
  s.record_kinetic(k.dx);
  const float own = s.speed_squared(), u = m.value[0], v = m.value[1], w = m.value[2];
  largest.speed_squared = ::fmaxf(largest.speed_squared, ::fmaxf(own, u * u + v * v + w * w));
  largest.spin = ::fmaxf(largest.spin, s.spin.largest());
  constexpr float limit = float(elastic_strain_limit * elastic_strain_limit);
  Moved<Variant::affine> moved{
      s.given(stress.tau, snow.specific_volume, step.dx),
      stress.strain_squared + 0 * own <= limit};  // false if a value is not finite
  if (!moved.sound) atomicMin(&control->unsound, i);
  return moved;
}

}  // namespace snowshed::methods::mpm::gpu
