// The tile of a block of particles: 8^3 nodes from one below the block, of the 27 blocks of nodes
// around it. Particles whose nodes do not lie in it are strays; the blocks around have these nodes.
#pragma once

#include "snowshed/methods/mpm/gpu/control.cuh"
#include "snowshed/methods/mpm/kernels/bspline.hpp"

namespace snowshed::methods::mpm::gpu {

inline constexpr int tile_edge = 8, tile_nodes = tile_edge * tile_edge * tile_edge;

/// Cells from -1 to `edge` in which a particle's lowest node may lie.
inline constexpr int tile_cells_edge = edge + 2;
inline constexpr int tile_cells = tile_cells_edge * tile_cells_edge * tile_cells_edge;

__device__ inline bool in_tile(const float (&cell)[3]) {
  bool inside = true;
  for (int d = 0; d < 3; ++d) inside = inside && cell[d] >= -1.0f && cell[d] < float(edge + 1);
  return inside;
}

/// Whether a particle may take another step, in which it moves by less than half a cell, before it
/// must be sorted: its nodes then lie in the blocks around.
__device__ inline bool may_move_on(const float (&cell)[3]) {
  bool inside = true;
  for (int d = 0; d < 3; ++d)
    inside = inside && cell[d] >= -float(edge) + 0.5f && cell[d] < float(edge) + 1.5f;
  return inside;
}

/// The lowest node of a particle as a node of the tile, and how far the particle is past it.
struct Place {
  float fraction[3];
  int lowest[3];

  __device__ explicit Place(const float (&cell)[3]) {
#pragma unroll
    for (int d = 0; d < 3; ++d) {
      const float below = ::floorf(cell[d]);
      lowest[d] = int(below) + 1;
      fraction[d] = cell[d] - below;
    }
  }
};

/// Returns the node of the grid that is node (i, j, k) of the tile, or up to three nodes beyond it.
__device__ inline int grid_node(int i, int j, int k, const std::int32_t* around) {
  const auto side = [](int n) { return (n + 3) >> 2; };
  const auto within = [](int n) { return (n + 3) & 3; };
  return around[side(i) * 9 + side(j) * 3 + side(k)] * nodes_of_block + within(i) * 16 +
         within(j) * 4 + within(k);
}
__device__ inline int grid_node(int t, const std::int32_t* around) {
  return grid_node(t >> 6, t >> 3 & 7, t & 7, around);
}

/// The values of a node of which particles take means.
inline constexpr int taken_values = 6;  // velocity and its change

/// Nodes of a tile in shared memory, from a particle's lowest one.
struct TileNodes {
  const Quad* velocity;
  const Pair* change;

  __device__ void read(int i, int j, int k, float (&node)[taken_values]) const {
    const int at = (i * tile_edge + j) * tile_edge + k;
    const Quad a = velocity[at];
    const Pair b = change[at];
    node[0] = a.x, node[1] = a.y, node[2] = a.z, node[3] = a.w, node[4] = b.x, node[5] = b.y;
  }
};

/// The same nodes in the memory of the grid.
struct GridNodes {
  const Quad* velocity;
  const Pair* change;
  const std::int32_t* around;
  int lowest[3];

  __device__ void read(int i, int j, int k, float (&node)[taken_values]) const {
    const int at = grid_node(lowest[0] + i, lowest[1] + j, lowest[2] + k, around);
    const Quad a = velocity[at];
    const Pair b = change[at];
    node[0] = a.x, node[1] = a.y, node[2] = a.z, node[3] = a.w, node[4] = b.x, node[5] = b.y;
  }
};

/// Sums over a particle's nodes of the velocity times the distance of the node, in cells.
template <bool affine>
struct NodeMoments {
  float moment[3][3];
};
template <>
struct NodeMoments<false> {};

/// Means over a particle's nodes: of the node values, and the gradient of the velocity, per cell.
template <bool affine>
struct NodeMeans : NodeMoments<affine> {
  float value[taken_values], gradient[3][3];
};

/// A line of three nodes, as the second one and the steps between them. Weights add up to one, and
/// their derivatives to zero; sums over steps are therefore exact for constant values.
template <int count>
struct NodeLine {
  float second[count], step[2][count];

  __device__ explicit NodeLine(const float (&nodes)[3][count]) {
#pragma unroll
    for (int v = 0; v < count; ++v) {
      second[v] = nodes[1][v];
      step[0][v] = nodes[1][v] - nodes[0][v];
      step[1][v] = nodes[2][v] - nodes[1][v];
    }
  }
  __device__ void mean(const float (&weights)[2], float (&out)[count]) const {
#pragma unroll
    for (int v = 0; v < count; ++v)
      out[v] = second[v] + weights[0] * step[0][v] + weights[1] * step[1][v];
  }
  /// The sum of the velocities with weights that add up to zero.
  __device__ void moment(const float (&weights)[2], float (&out)[3]) const {
#pragma unroll
    for (int v = 0; v < 3; ++v) out[v] = weights[0] * step[0][v] + weights[1] * step[1][v];
  }
  /// The derivative of the velocity, per cell.
  __device__ void slope(float weight, float (&out)[3]) const {
#pragma unroll
    for (int v = 0; v < 3; ++v) out[v] = step[0][v] + weight * (step[1][v] - step[0][v]);
  }
};

/// The place of a node past that from which a particle's fraction counts, in cells.
__device__ constexpr float node_offset(int node) {
  return float(node) - float(base_offset(Basis::quadratic));
}

/// Weights of the steps between the nodes of a particle along each direction.
struct StepWeights {
  float value[3][2], slope[3], moment[3][2];

  __device__ explicit StepWeights(const float (&fraction)[3]) {
#pragma unroll
    for (int d = 0; d < 3; ++d) {
      float w[3], g[3], r[2];
      BSpline<Basis::quadratic>::evaluate(fraction[d], w, g);
      weights_of_steps(w, value[d]);
      weights_of_steps(g, r);
      slope[d] = r[1];
#pragma unroll
      for (int k = 0; k < 3; ++k) w[k] *= node_offset(k) - fraction[d];
      weights_of_steps(w, moment[d]);
    }
  }
};

__device__ inline void transpose(const float (&along)[3][3], float (&out)[3][3]) {
#pragma unroll
  for (int v = 0; v < 3; ++v)
#pragma unroll
    for (int d = 0; d < 3; ++d) out[v][d] = along[d][v];
}

template <bool affine, class Nodes>
__device__ inline void interpolate(const float (&fraction)[3], const Nodes& nodes,
                                   NodeMeans<affine>& m) {
  const StepWeights weights(fraction);
  float plane[3][taken_values], along_y[3][3], along_z[3][3], moment_y[3][3], moment_z[3][3];
#pragma unroll
  for (int i = 0; i < 3; ++i) {
    float line[3][taken_values], line_z[3][3], line_moment[3][3];
#pragma unroll
    for (int j = 0; j < 3; ++j) {
      float node[3][taken_values];
#pragma unroll
      for (int k = 0; k < 3; ++k) nodes.read(i, j, k, node[k]);
      const NodeLine<taken_values> of_z(node);
      of_z.mean(weights.value[2], line[j]);
      of_z.slope(weights.slope[2], line_z[j]);
      if constexpr (affine) of_z.moment(weights.moment[2], line_moment[j]);
    }
    const NodeLine<taken_values> of_y(line);
    of_y.mean(weights.value[1], plane[i]);
    of_y.slope(weights.slope[1], along_y[i]);
    NodeLine<3>(line_z).mean(weights.value[1], along_z[i]);
    if constexpr (affine) {
      of_y.moment(weights.moment[1], moment_y[i]);
      NodeLine<3>(line_moment).mean(weights.value[1], moment_z[i]);
    }
  }
  const NodeLine<taken_values> of_x(plane);
  of_x.mean(weights.value[0], m.value);
  float along[3][3];
  of_x.slope(weights.slope[0], along[0]);
  NodeLine<3>(along_y).mean(weights.value[0], along[1]);
  NodeLine<3>(along_z).mean(weights.value[0], along[2]);
  transpose(along, m.gradient);
  if constexpr (affine) {
    of_x.moment(weights.moment[0], along[0]);
    NodeLine<3>(moment_y).mean(weights.value[0], along[1]);
    NodeLine<3>(moment_z).mean(weights.value[0], along[2]);
    transpose(along, m.moment);
  }
}

/// Copies the velocities of the nodes of a tile to shared memory.
__device__ inline void load_tile(const GridArrays& grid, const std::int32_t* around, Quad* velocity,
                                 Pair* change) {
  for (int t = int(threadIdx.x); t < tile_nodes; t += int(blockDim.x)) {
    const int n = grid_node(t, around);
    velocity[t] = grid.velocity[n];
    change[t] = grid.change[n];
  }
}

}  // namespace snowshed::methods::mpm::gpu
