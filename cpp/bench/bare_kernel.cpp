#include "bare_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace snowshed {
namespace {

typedef float Node __attribute__((vector_size(32), may_alias, aligned(4)));

constexpr int chunk = 256;
constexpr float dx = 1.0f / 32, dt = 1e-4f, density = 210, lame = 5.8e5f, shear = 3.8e5f;
constexpr float flip_ratio = 0.99f;

/// Quadratic B-spline weights of three nodes and their derivatives, per cell.
struct Weights {
  float w[3], g[3];
  explicit Weights(float f) {
    const float a = 1.5f - f, b = f - 1.0f, c = f - 0.5f;
    w[0] = 0.5f * a * a, w[1] = 0.75f - b * b, w[2] = 0.5f * c * c;
    g[0] = -a, g[1] = -2 * b, g[2] = c;
  }
};

/// The first node that a particle reaches, and the weights of its three nodes along each axis.
/// Coordinates are in cells.
struct Stencil {
  int node;
  Weights x, y, z;
  Stencil(float px, float py, float pz, int ny, int nz)
      : node((base(px) * ny + base(py)) * nz + base(pz)),
        x(px - float(base(px))),
        y(py - float(base(py))),
        z(pz - float(base(pz))) {}
  static int base(float p) { return int(p - 0.5f); }
};

}  // namespace

BareKernel::BareKernel(const int (&cells)[3], int threads) : threads_(threads) {
  std::copy_n(cells, 3, cells_);
  slabs_ = (cells[0] + slab_thickness - 1) / slab_thickness;
  nodes_y_ = cells[1] + 2 * margin;
  nodes_z_ = cells[2] + 2 * margin;
  const std::size_t nodes = std::size_t(cells[0] + 2 * margin) * nodes_y_ * nodes_z_;
  sums_.assign(8 * nodes, 0.0f);
  velocities_.assign(8 * nodes, 0.0f);
  for (int i = 0; i < cells[0]; ++i)
    for (int j = 0; j < cells[1]; ++j)
      for (int k = 0; k < cells[2]; ++k)
        for (int corner = 0; corner < 8; ++corner) {
          position_[0].push_back(float(margin + i) + 0.25f + 0.5f * float(corner >> 2 & 1));
          position_[1].push_back(float(margin + j) + 0.25f + 0.5f * float(corner >> 1 & 1));
          position_[2].push_back(float(margin + k) + 0.25f + 0.5f * float(corner & 1));
        }
  mass_.assign(position_[0].size(), density * dx * dx * dx / 8);
  for (auto& v : velocity_) v.assign(size(), 0.0f);
  for (auto& s : strain_) s.assign(size(), 0.0f);
}

std::size_t BareKernel::first_particle(int slab) const {
  const int x = std::min(slab * slab_thickness, cells_[0]);
  return std::size_t(x) * cells_[1] * cells_[2] * 8;
}

template <class F>
void BareKernel::for_each_slab(int first, int stride, F f) {
#pragma omp parallel for schedule(static) num_threads(threads_)
  for (int slab = first; slab < slabs_; slab += stride) f(slab);
}

void BareKernel::step() {
  const std::ptrdiff_t values = std::ptrdiff_t(sums_.size());
#pragma omp parallel for schedule(static) num_threads(threads_)
  for (std::ptrdiff_t i = 0; i < values; ++i) sums_[i] = 0;
  for (const int colour : {0, 1})  // slabs of one colour share no node
    for_each_slab(colour, 2, [this](int slab) { particles_to_grid(slab); });
  for_each_slab(0, 1, [this](int slab) { update_nodes(slab); });
  for_each_slab(0, 1, [this](int slab) { grid_to_particles(slab); });
}

void BareKernel::particles_to_grid(int slab) {
  Node* nodes = reinterpret_cast<Node*>(sums_.data());
  for (std::size_t p = first_particle(slab); p < first_particle(slab + 1); ++p) {
    const Stencil at(position_[0][p], position_[1][p], position_[2][p], nodes_y_, nodes_z_);
    const float m = mass_[p], scale = -m / (density * dx);
    float e[6];
    for (int k = 0; k < 6; ++k) e[k] = 0.5f * strain_[k][p];
    const float volumetric = lame * (e[0] + e[1] + e[2]);
    const float t[6] = {scale * (volumetric + 2 * shear * e[0]),
                        scale * (volumetric + 2 * shear * e[1]),
                        scale * (volumetric + 2 * shear * e[2]),
                        scale * 2 * shear * e[3],
                        scale * 2 * shear * e[4],
                        scale * 2 * shear * e[5]};
    const Node value = {m, m * velocity_[0][p], m * velocity_[1][p], m * velocity_[2][p], 0, 0, 0,
                        0};
    const Node fx = {0, 0, 0, 0, t[0], t[3], t[4], 0};
    const Node fy = {0, 0, 0, 0, t[3], t[1], t[5], 0};
    const Node fz = {0, 0, 0, 0, t[4], t[5], t[2], 0};
    for (int i = 0; i < 3; ++i) {
      const Node v_i = at.x.w[i] * value + at.x.g[i] * fx, y_i = at.x.w[i] * fy,
                 z_i = at.x.w[i] * fz;
      for (int j = 0; j < 3; ++j) {
        const Node v_ij = at.y.w[j] * v_i + at.y.g[j] * y_i, z_ij = at.y.w[j] * z_i;
        Node* row = nodes + at.node + (i * nodes_y_ + j) * nodes_z_;
        for (int k = 0; k < 3; ++k) row[k] += at.z.w[k] * v_ij + at.z.g[k] * z_ij;
      }
    }
  }
}

void BareKernel::update_nodes(int slab) {
  const std::size_t plane = std::size_t(nodes_y_) * nodes_z_;
  const std::size_t nodes = sums_.size() / 8;
  const std::size_t begin = slab == 0 ? 0 : (slab * slab_thickness + margin) * plane;
  const std::size_t end =
      slab + 1 == slabs_ ? nodes : ((slab + 1) * slab_thickness + margin) * plane;
  const Node* in = reinterpret_cast<const Node*>(sums_.data());
  Node* out = reinterpret_cast<Node*>(velocities_.data());
  for (std::size_t n = begin; n < end; ++n) {
    const float m = in[n][0];
    if (!(m > 0)) {
      out[n] = Node{};
      continue;
    }
    const Node s = in[n] / m;
    const float c[3] = {dt * s[4], dt * s[5], dt * s[6]};
    out[n] = Node{s[1] + c[0], s[2] + c[1], s[3] + c[2], 0, c[0], c[1], c[2], 0};
  }
}

void BareKernel::grid_to_particles(int slab) {
  const Node* nodes = reinterpret_cast<const Node*>(velocities_.data());
  for (std::size_t begin = first_particle(slab); begin < first_particle(slab + 1); begin += chunk) {
    const int n = int(std::min<std::size_t>(chunk, first_particle(slab + 1) - begin));
    alignas(64) float change[3][chunk], pic[3][chunk], grad[9][chunk];
    for (int l = 0; l < n; ++l) {
      const std::size_t p = begin + l;
      const Stencil at(position_[0][p], position_[1][p], position_[2][p], nodes_y_, nodes_z_);
      Node value{}, gx{}, gy{}, gz{};
      for (int i = 0; i < 3; ++i) {
        Node v_i{}, y_i{}, z_i{};
        for (int j = 0; j < 3; ++j) {
          Node v_ij{}, z_ij{};
          const Node* row = nodes + at.node + (i * nodes_y_ + j) * nodes_z_;
          for (int k = 0; k < 3; ++k) {
            v_ij += at.z.w[k] * row[k];
            z_ij += at.z.g[k] * row[k];
          }
          v_i += at.y.w[j] * v_ij;
          y_i += at.y.g[j] * v_ij;
          z_i += at.y.w[j] * z_ij;
        }
        value += at.x.w[i] * v_i;
        gx += at.x.g[i] * v_i;
        gy += at.x.w[i] * y_i;
        gz += at.x.w[i] * z_i;
      }
      for (int d = 0; d < 3; ++d) {
        pic[d][l] = value[d];
        change[d][l] = value[4 + d];
        grad[3 * d][l] = gx[d];
        grad[3 * d + 1][l] = gy[d];
        grad[3 * d + 2][l] = gz[d];
      }
    }
    float *x[3], *v[3], *b[6];
    for (int d = 0; d < 3; ++d) x[d] = &position_[d][begin], v[d] = &velocity_[d][begin];
    for (int k = 0; k < 6; ++k) b[k] = &strain_[k][begin];
    constexpr float rate = dt / dx;
#pragma omp simd
    for (int l = 0; l < n; ++l) {
      float g[3][3], s[3][3], h[3][3];
      for (int k = 0; k < 9; ++k) g[k / 3][k % 3] = rate * grad[k][l];
      s[0][0] = b[0][l], s[1][1] = b[1][l], s[2][2] = b[2][l];
      s[0][1] = s[1][0] = b[3][l], s[0][2] = s[2][0] = b[4][l], s[1][2] = s[2][1] = b[5][l];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          h[i][j] = g[i][j] + g[i][0] * s[0][j] + g[i][1] * s[1][j] + g[i][2] * s[2][j];
      const auto updated = [&](int i, int j) {  // (I + g) b (I + g)^T - I
        return s[i][j] + h[i][j] + h[j][i] + h[i][0] * g[j][0] + h[i][1] * g[j][1] +
               h[i][2] * g[j][2];
      };
      b[0][l] = updated(0, 0), b[1][l] = updated(1, 1), b[2][l] = updated(2, 2);
      b[3][l] = updated(0, 1), b[4][l] = updated(0, 2), b[5][l] = updated(1, 2);
      for (int d = 0; d < 3; ++d) {
        v[d][l] = pic[d][l] + flip_ratio * (v[d][l] + change[d][l] - pic[d][l]);
        x[d][l] += rate * pic[d][l];
      }
    }
  }
}

double BareKernel::grid_mass() const {
  double sum = 0;
  for (std::size_t i = 0; i < sums_.size(); i += 8) sum += sums_[i];
  return sum;
}

double BareKernel::mass() const {
  double sum = 0;
  for (float m : mass_) sum += m;
  return sum;
}

}  // namespace snowshed
