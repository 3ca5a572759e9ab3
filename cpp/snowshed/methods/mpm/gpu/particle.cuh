// One particle in registers, and its part of a step (see kernels/particle_kernels.hpp).
#pragma once

#include "snowshed/methods/mpm/gpu/sums.cuh"
#include "snowshed/methods/mpm/kernels/stress.hpp"

namespace snowshed::methods::mpm::gpu {

using Strain = material::Sym<float, 3>;

/// Shares of a step that are the same for all particles.
struct StepShares {
  float dt, cells_per_speed, flip_ratio;  // s; dt/dx, s/m

  __device__ StepShares(const Control& c, const Constants& k)
      : dt(float(c.dt)),
        cells_per_speed(float(c.dt) / float(k.dx)),
        flip_ratio(k.damping_rate >= 0 ? float(::exp(-double(k.damping_rate) * c.dt))
                                       : k.flip_ratio) {}
};

/// Returns the constants of a particle's snow.
template <bool several>
__device__ inline MaterialConstants<float> snow_of(const ParticleArrays& p, int i,
                                                   const Constants& k) {
  if (several) return k.snows[p.material_id[i]];
  return k.snow;
}

struct ParticleState {
  float cell[3], velocity[3], plastic, mass;
  Strain be_minus_identity;

  __device__ void read_cell(const ParticleArrays& p, int i) {
#pragma unroll
    for (int d = 0; d < 3; ++d) cell[d] = p.cell[d][i];
  }
  __device__ void read_rest(const ParticleArrays& p, int i) {
#pragma unroll
    for (int d = 0; d < 3; ++d) velocity[d] = p.velocity[d][i];
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
#pragma unroll
    for (int k = 0; k < 6; ++k) p.be_minus_identity[k][i] = be_minus_identity.c[k];
    if (p.plastic) p.plastic[i] = plastic;
  }

  /// Moves with the nodes, and takes their change of velocity (1.2.26).
  __device__ void move(const NodeMeans& m, const StepShares& step) {
    float gradient[3][3];  // dt grad v
#pragma unroll
    for (int d = 0; d < 3; ++d) {
      const float pic = m.value[d], change = m.value[3 + d];
      cell[d] += pic * step.cells_per_speed;
      velocity[d] = pic + step.flip_ratio * (velocity[d] + change - pic);
#pragma unroll
      for (int j = 0; j < 3; ++j) gradient[d][j] = m.gradient[d][j] * step.cells_per_speed;
    }
    update_left_cauchy_green(be_minus_identity, gradient);
  }

  /// Returns the stress; first returns the strain to the yield surface, unless this has been done.
  __device__ Stress<float, 3> stress(const MaterialConstants<float>& snow, bool committed) {
    const auto law = cam_clay_law<material::CamClay>(snow);
    return stress_of(be_minus_identity, law.elastic, [&](material::PQ<float>& pq) {
      return !committed && law.return_map(pq, plastic);
    });
  }

  __device__ float speed_squared() const {
    return velocity[0] * velocity[0] + velocity[1] * velocity[1] + velocity[2] * velocity[2];
  }

  __device__ Given given(const Strain& tau, float specific_volume, float dx) const {
    Given g;
    g.mass = mass;
#pragma unroll
    for (int d = 0; d < 3; ++d) g.momentum[d] = mass * velocity[d];
    const float scale = mass * (-specific_volume / dx);
#pragma unroll
    for (int k = 0; k < 6; ++k) g.force[k] = scale * tau.c[k];
    return g;
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
struct Moved {
  Given given;
  bool sound;
};

/// Takes a particle through a step whose node means are known, and writes it.
template <bool several>
__device__ inline Moved finish_particle(ParticleState& s, const NodeMeans& m,
                                        const ParticleArrays& p, int i, const Constants& k,
                                        Control* control, float& fastest) {
  const MaterialConstants<float> snow = snow_of<several>(p, i, k);
  const Stress<float, 3> stress = s.stress(snow, false);
  s.write(p, i);
  const float own = s.speed_squared(), u = m.value[0], v = m.value[1], w = m.value[2];
  fastest = ::fmaxf(fastest, ::fmaxf(own, u * u + v * v + w * w));
  constexpr float limit = float(elastic_strain_limit * elastic_strain_limit);
  Moved moved{s.given(stress.tau, snow.specific_volume, float(k.dx)),
              stress.strain_squared + 0 * own <= limit};  // false if a value is not finite
  if (!moved.sound) atomicMin(&control->unsound, i);
  return moved;
}

}  // namespace snowshed::methods::mpm::gpu
