// Sums of the nodes as whole numbers, which are the same in whatever order they are added: every
// run on every card has the same bits.
#pragma once

#include "snowshed/methods/mpm/gpu/tile.cuh"

namespace snowshed::methods::mpm::gpu {

/// Units of mass, momentum and force, and their inverses.
struct Units {
  float of[3], per[3];

  __device__ Units(const Constants& k, float momentum) : of{k.mass_unit, momentum, k.force_unit} {
    for (int i = 0; i < 3; ++i) {
      of[i] = ::ldexpf(of[i], -unit_bits);
      per[i] = 1 / of[i];
    }
  }
  static __device__ constexpr int kind(int sum) { return sum == 0 ? 0 : sum < 4 ? 1 : 2; }
};

__device__ inline void add_integer(unsigned long long* sum, long long amount) {
  atomicAdd(sum, (unsigned long long)(amount));
}

/// Adds to a sum of a tile. Shared memory adds numbers of 32 bits in one instruction, but neither
/// floats nor numbers of 64 bits.
__device__ inline void add_parts(int* high, int* low, float amount) {
  const float above = ::floorf(amount * (1.0f / 65536));
  atomicAdd(high, int(above));
  atomicAdd(low, int(::rintf(amount - 65536 * above)));
}

/// Change of a particle's momentum per cell, row by row.
template <bool affine>
struct GivenMoments {
  float moment[9];
};
template <>
struct GivenMoments<false> {};

/// Values of a particle that its nodes get, in units of the particle's arrays.
template <bool affine>
struct Given : GivenMoments<affine> {
  float mass, momentum[3], force[6];  // force: -V0 tau / dx
};

/// The moments of the particles of a tile.
template <int count, bool affine>
struct MomentArrays {
  float moment[9][count];

  __device__ void set(int q, const Given<true>& g) {
    for (int k = 0; k < 9; ++k) moment[k][q] = g.moment[k];
  }
  /// Adds the moments to the momentum of a particle at a line of nodes.
  __device__ void add(int q, float x, float y, float (&momentum)[3], float (&along_z)[3]) const {
#pragma unroll
    for (int d = 0; d < 3; ++d) {
      momentum[d] += moment[3 * d][q] * x + moment[3 * d + 1][q] * y;
      along_z[d] = moment[3 * d + 2][q];
    }
  }
};
template <int count>
struct MomentArrays<count, false> {
  __device__ void set(int, const Given<false>&) {}
};

/// The particles of a tile, as they are given to the nodes.
template <int count, bool affine_>
struct GivenArrays {
  static constexpr bool affine = affine_;
  MomentArrays<count, affine> moments;
  Quad fraction_and_mass[count], momentum_and_xx[count], force[count];  // yy, zz, xy, xz
  float yz[count];

  __device__ void set(int q, const float (&fraction)[3], const Given<affine>& g) {
    fraction_and_mass[q] = {fraction[0], fraction[1], fraction[2], g.mass};
    momentum_and_xx[q] = {g.momentum[0], g.momentum[1], g.momentum[2], g.force[0]};
    force[q] = {g.force[1], g.force[2], g.force[3], g.force[4]};
    yz[q] = g.force[5];
    moments.set(q, g);
  }
};

/// The quadratic spline at one of a particle's three nodes, c + s t^2 with t = a + b f. A lane has
/// the same node for all particles, so that it needs no branch.
struct NodeSpline {
  float a, b, c, s, offset;

  __device__ explicit NodeSpline(int node)
      : a(node == 0   ? 1.0f
          : node == 1 ? -0.5f
                      : 0.0f),
        b(node == 0 ? -1.0f : 1.0f),
        c(node == 1 ? 0.75f : 0.0f),
        s(node == 1 ? -1.0f : 0.5f),
        offset(node_offset(node)) {}
  __device__ float weight(float fraction, float& slope) const {
    const float t = a + b * fraction;
    slope = 2 * b * s * t;
    return c + s * t * t;
  }
};

/// Sums of a line of three nodes along z.
struct LineSums {
  float node[3][node_sums];

  __device__ LineSums() : node{} {}

  /// Adds a particle. The line is that of some of its nodes along x and y.
  template <class Arrays>
  __device__ void add(const Arrays& given, int q, const NodeSpline& of_x, const NodeSpline& of_y) {
    const Quad at = given.fraction_and_mass[q], p = given.momentum_and_xx[q], t = given.force[q];
    const float yz = given.yz[q];
    float slope_x, slope_y, wz[3], gz[3];
    const float wx = of_x.weight(at.x, slope_x), wy = of_y.weight(at.y, slope_y);
    BSpline<Basis::quadratic>::evaluate(at.z, wz, gz);
    const float w = wx * wy, along_x = slope_x * wy, along_y = wx * slope_y;
    float momentum[3] = {p.x, p.y, p.z}, per_cell[3] = {};  // at the line; its change along z
    if constexpr (Arrays::affine)
      given.moments.add(q, of_x.offset - at.x, of_y.offset - at.y, momentum, per_cell);
    const float carried[4] = {w * at.w, w * momentum[0], w * momentum[1], w * momentum[2]};
    const float across[3] = {along_x * p.w + along_y * t.z, along_x * t.z + along_y * t.x,
                             along_x * t.w + along_y * yz};
    const float along_z[3] = {w * t.w, w * yz, w * t.y};
#pragma unroll
    for (int k = 0; k < 3; ++k) {
#pragma unroll
      for (int v = 0; v < 4; ++v) node[k][v] += wz[k] * carried[v];
      if constexpr (Arrays::affine)
#pragma unroll
        for (int v = 0; v < 3; ++v)
          node[k][1 + v] += wz[k] * w * (node_offset(k) - at.z) * per_cell[v];
#pragma unroll
      for (int v = 0; v < 3; ++v) node[k][4 + v] += wz[k] * across[v] + gz[k] * along_z[v];
    }
  }
};

/// Adds a stray to the nodes of the grid.
template <bool affine>
__device__ inline void scatter_stray(const Place& place, const Given<affine>& given,
                                     unsigned long long* integers, const std::int32_t* around,
                                     const Units& units) {
  GivenArrays<1, affine> single;
  single.set(0, place.fraction, given);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      LineSums line;
      line.add(single, 0, NodeSpline(i), NodeSpline(j));
      for (int k = 0; k < 3; ++k) {
        const int n =
            grid_node(place.lowest[0] + i, place.lowest[1] + j, place.lowest[2] + k, around);
        for (int v = 0; v < node_sums; ++v)
          add_integer(integers + n * node_stride + v,
                      ::llrintf(line.node[k][v] * units.per[Units::kind(v)]));
      }
    }
}

}  // namespace snowshed::methods::mpm::gpu
