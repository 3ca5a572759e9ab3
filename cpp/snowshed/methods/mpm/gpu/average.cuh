// Averages of the velocities over a length, towards which velocities are damped: sums of mass and
// momentum on a coarse grid, see velocity_average.hpp. Sleeping snow has sums of its own.
#pragma once

#include "snowshed/methods/mpm/gpu/sums.cuh"

namespace snowshed::methods::mpm::gpu {

/// Returns the share of their difference from the average that velocities lose in the present step;
/// zero if it does not damp.
__device__ inline float damping_of(const Control& c, const Constants& k) {
  if (!(k.average_share > 0) || !damps_after(c.undamped_steps)) return 0;
  return float(damped_share(k.average_rate, c.undamped_time + c.dt) * k.average_share);
}

/// The coarse nodes around a particle of a block.
struct CoarseNodes {
  const std::int32_t* around;  // coarse blocks around the block
  const AverageBlock& block;
  float weight[3][3];
  int lowest[3];  // from the first node of the first coarse block

  __device__ CoarseNodes(const AverageArrays& a, int b, const float (&cell)[3])
      : around(a.around + std::int64_t(b) * a.around_size), block(a.blocks[b]) {
    constexpr float offset = float(base_offset(Basis::quadratic));
    for (int d = 0; d < 3; ++d) {
      const float position = (cell[d] + offset) * a.per_cell + (block.origin[d] - 0.5f);
      // Rounding may place the outermost particles beyond the tile.
      const float base = ::fminf(::fmaxf(::floorf(position), 0.0f), float(a.edge - 3));
      float slopes[3];
      BSpline<Basis::quadratic>::evaluate(position - base, weight[d], slopes);
      lowest[d] = int(base) + block.shift[d];
    }
  }

  /// Calls f(node, weight) for each of them.
  template <class F>
  __device__ void for_each(const F& f) const {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k) {
          const int x = lowest[0] + i, y = lowest[1] + j, z = lowest[2] + k;
          const int at = ((x >> 2) * block.count[1] + (y >> 2)) * block.count[2] + (z >> 2);
          f(around[at] * nodes_of_block + (x & 3) * 16 + (y & 3) * 4 + (z & 3),
            weight[0][i] * weight[1][j] * weight[2][k]);
        }
  }
};

/// Finds the change of a particle's velocity towards the average, before the particle moves.
__device__ inline void find_damping(const AverageArrays& a, int block, float share,
                                    const float (&cell)[3], const float (&velocity)[3],
                                    float (&change)[3]) {
  float mean[3] = {};
  CoarseNodes(a, block, cell).for_each([&](int n, float weight) {
    const Quad v = a.mean[n];
    mean[0] += weight * v.x;
    mean[1] += weight * v.y;
    mean[2] += weight * v.z;
  });
  for (int d = 0; d < 3; ++d) change[d] = share * (mean[d] - velocity[d]);
}

}  // namespace snowshed::methods::mpm::gpu

/// Adds mass and momentum of the listed blocks to the sums of the coarse grid: of the awake snow,
/// if the step damps, or of the sleeping snow.
extern "C" __global__ void __launch_bounds__(128)
    scatter_average(snowshed::methods::mpm::gpu::ParticleLaunch l, std::int32_t asleep,
                    const snowshed::methods::mpm::gpu::Control* control,
                    snowshed::methods::mpm::gpu::Constants k) {
  using namespace snowshed::methods::mpm::gpu;
  if (!asleep && (control->phase != Phase::accepted || !(damping_of(*control, k) > 0))) return;
  unsigned long long* sums = asleep ? l.average.asleep : l.average.integers;
  const Units units(k, control->momentum_unit);
  const int b = l.list[blockIdx.x];
  for (int i = l.blocks.first[b] + int(threadIdx.x); i < l.blocks.first[b + 1];
       i += int(blockDim.x)) {
    float cell[3], given[average_sums];
    given[0] = l.particles.mass[i];
    for (int d = 0; d < 3; ++d) {
      cell[d] = l.particles.cell[d][i];
      given[1 + d] = given[0] * l.particles.velocity[d][i];
    }
    for (int v = 0; v < average_sums; ++v) given[v] *= units.per[Units::kind(v)];
    CoarseNodes(l.average, b, cell).for_each([&](int n, float weight) {
      for (int v = 0; v < average_sums; ++v)
        add_integer(sums + n * average_sums + v, ::llrintf(weight * given[v]));
    });
  }
}

/// Turns the sums of the coarse grid into mean velocities, a thread block to a coarse block.
extern "C" __global__ void __launch_bounds__(64)
    average_nodes(snowshed::methods::mpm::gpu::AverageArrays a,
                  const snowshed::methods::mpm::gpu::Control* control,
                  snowshed::methods::mpm::gpu::Constants k) {
  using namespace snowshed::methods::mpm;
  using namespace snowshed::methods::mpm::gpu;
  if (control->phase != Phase::accepted || !(damping_of(*control, k) > 0)) return;
  const Units units(k, control->momentum_unit);
  const int n = int(blockIdx.x) * nodes_of_block + int(threadIdx.x);
  float sums[average_sums];
  for (int v = 0; v < average_sums; ++v) {
    unsigned long long& awake = a.integers[n * average_sums + v];
    long long sum = (long long)(awake);
    awake = 0;
    if (a.asleep) sum += (long long)(a.asleep[n * average_sums + v]);
    sums[v] = float(sum) * units.of[Units::kind(v)];
  }
  const float per_mass = sums[0] > min_node_mass<float> ? 1 / sums[0] : 0.0f;
  a.mean[n] = {sums[1] * per_mass, sums[2] * per_mass, sums[3] * per_mass, 0};
}
