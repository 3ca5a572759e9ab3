// The particle side of a step. Thesis 1.2.2: transfer to the grid (1.2.10, 1.2.23), forces (1.2.13
// in Kirchhoff form), elastic trial (1.2.14), return mapping, transfer back (1.2.24-1.2.26).
//
// `g2p2g` takes a particle through a whole step and adds it to the sums of the next step, so that
// the particle's state is read and written only once.
#pragma once

#include "snowshed/methods/mpm/energy_rule.hpp"
#include "snowshed/methods/mpm/kernels/average_stencil.hpp"
#include "snowshed/methods/mpm/kernels/material_lookup.hpp"
#include "snowshed/methods/mpm/kernels/stress.hpp"
#include "snowshed/methods/mpm/kernels/tile.hpp"
#include "snowshed/methods/mpm/kernels/transfer_rules.hpp"
#include "snowshed/methods/mpm/kernels/user_return.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::mpm)

template <class T, int D, Transfer transfer, Basis basis, class Snows, bool energy>
struct ParticleKernels {
  using Snow = typename Snows::Chunk;
  using V = SimdPack<T>;
  using Tensor = material::Sym<V, D>;
  using Rule = TransferRule<T, D, transfer, basis>;
  using Tile = TileSums<T, D, basis>;
  static constexpr int W = simd_width<T>;

  const StepParameters<T>& step;
  const ParticleView<T>& p;
  const Snows snows;
  BlockStats& stats;

  ParticleKernels(const StepParameters<T>& s, const ParticleView<T>& v, BlockStats& b)
      : step(s), p(v), snows(s.snows), stats(b) {}

  /// One chunk's state in registers.
  struct State {
    V cell[D], velocity[D], plastic, mass;
    typename Rule::CarriedValues carried;
    Tensor be_minus_identity;
  };

  SNOWSHED_INLINE void read(State& s, int at, int n) const {
    SNOWSHED_UNROLL
    for (int d = 0; d < D; ++d) {
      s.cell[d] = load(p.cell[d] + at, n);
      s.velocity[d] = load(p.velocity[d] + at, n);
    }
    SNOWSHED_UNROLL
    for (int k = 0; k < Tensor::size; ++k)
      s.be_minus_identity.c[k] = load(p.be_minus_identity[k] + at, n);
    s.carried.read(p, at, n);
    if constexpr (Snow::plastic) s.plastic = load(p.plastic + at, n);
    s.mass = load(p.mass + at, n);
  }

  SNOWSHED_INLINE void write(const State& s, int at, int n) const {
    SNOWSHED_UNROLL
    for (int d = 0; d < D; ++d) {
      store(p.cell[d] + at, s.cell[d], n);
      store(p.velocity[d] + at, s.velocity[d], n);
    }
    SNOWSHED_UNROLL
    for (int k = 0; k < Tensor::size; ++k)
      store(p.be_minus_identity[k] + at, s.be_minus_identity.c[k], n);
    s.carried.write(p, at, n);
    if constexpr (Snow::plastic) store(p.plastic + at, s.plastic, n);
  }

  // --- grid to particles ------------------------------------------------------------------

  /// Returns the smallest multiple of a pack's lanes that is at least n.
  static constexpr int whole_packs(int n) { return (n + W - 1) / W * W; }

  /// Turns a row of values for each particle into a pack for each value.
  template <int count>
  SNOWSHED_INLINE static void transpose_rows(const T (&rows)[W][count], V (&columns)[count]) {
    SNOWSHED_UNROLL
    for (int c = 0; c < count; c += W) {
      V square[W];
      SNOWSHED_UNROLL
      for (int l = 0; l < W; ++l) std::memcpy(&square[l], &rows[l][c], sizeof(V));
      transpose(square);
      SNOWSHED_UNROLL
      for (int l = 0; l < W; ++l) columns[c + l] = square[l];
    }
  }
  template <int count>
  SNOWSHED_INLINE static void transpose_columns(const V (&columns)[count], T (&rows)[W][count]) {
    SNOWSHED_UNROLL
    for (int c = 0; c < count; c += W) {
      V square[W];
      SNOWSHED_UNROLL
      for (int l = 0; l < W; ++l) square[l] = columns[c + l];
      transpose(square);
      SNOWSHED_UNROLL
      for (int l = 0; l < W; ++l) std::memcpy(&rows[l][c], &square[l], sizeof(V));
    }
  }

  /// All values that a chunk takes from the grid.
  struct Motion {
    V pic[D], gradient[D][D];  // gradient[i][j] = dt d v_i / d x_j
    typename Rule::TakenValues taken;
  };

  SNOWSHED_INLINE void interpolate(const Stencil<T, D, basis>& stencil, const T* tile, int n,
                                   Motion& m) const {
    constexpr int derived = Rule::derived_values, row = node_values + D * derived;
    const typename Rule::Interpolation weights(stencil);
    alignas(64) T rows[W][whole_packs(row)];
    for (int l = 0; l < n; ++l) {
      const auto sums = interpolate_nodes<Rule, T, D, basis>(weights, l, tile + stencil.address[l]);
      sums.value.template store<Rule::taken>(rows[l]);
      for (int j = 0; j < D; ++j)
        sums.along[j].template store<Rule::interpolated>(rows[l] + node_values + j * derived);
    }
    for (int l = n; l < W; ++l) std::memcpy(rows[l], rows[0], row * sizeof(T));
    V columns[whole_packs(row)];
    transpose_rows(rows, columns);
    const T per_step = step.dt / step.dx;
    SNOWSHED_UNROLL
    for (int i = 0; i < D; ++i) {
      m.pic[i] = columns[i];
      SNOWSHED_UNROLL
      for (int j = 0; j < D; ++j)
        m.gradient[i][j] = columns[node_values + j * derived + i] * per_step;
    }
    m.taken.read(columns, columns + node_values, step.dx);
  }

  SNOWSHED_INLINE V largest_gradient(const Motion& m) const {
    V r = abs(m.gradient[0][0]);
    for (int i = 0; i < D; ++i)
      for (int j = 0; j < D; ++j) r = max(r, abs(m.gradient[i][j]));
    return r;
  }

  // --- the particle's own step ------------------------------------------------------------

  SNOWSHED_INLINE void move(State& s, const Motion& m) const {
    for (int d = 0; d < D; ++d) s.cell[d] += m.pic[d] * (step.dt / step.dx);
    m.taken.move(s.velocity, s.carried, m.pic, step.flip_ratio);
  }

  /// Finds the change of velocity towards the average over the coarse grid, before the particles
  /// move. (The sum of mass times change is zero, because the average has the same weights.)
  SNOWSHED_INLINE void damp(const State& s, const AverageTile<T>& average, int n,
                            V (&change)[D]) const {
    const AverageStencil<T, D, basis> stencil(average, s.cell);
    SNOWSHED_UNROLL
    for (int d = 0; d < D; ++d) change[d] = s.velocity[d];
    for (int l = 0; l < n; ++l) {
      const auto mean = stencil.sum(l);
      SNOWSHED_UNROLL
      for (int d = 0; d < D; ++d) change[d][l] = mean[1 + d];
    }
    SNOWSHED_UNROLL
    for (int d = 0; d < D; ++d) change[d] = average.share * (change[d] - s.velocity[d]);
  }

  /// Adds a change of velocity, and records the energy that it takes.
  SNOWSHED_INLINE void add_velocity(State& s, const V (&change)[D], int n) const {
    for (int d = 0; d < D; ++d) {
      if constexpr (energy)
        for (int l = 0; l < n; ++l)
          stats.energy.damping -= double(s.mass[l]) * double(change[d][l]) *
                                  (double(s.velocity[d][l]) + 0.5 * double(change[d][l]));
      s.velocity[d] += change[d];
    }
  }

  /// Returns the stress of the present elastic strain. With plastic laws the strain is first
  /// returned to the yield surface, unless this has been done (`committed`).
  SNOWSHED_INLINE Stress<V, D> stress(State& s, const Snow& snow, int at, int n,
                                      bool committed) const {
    if constexpr (Snow::plastic)
      if (step.constitutive) {
        const auto user = user_stress(step, p, s.be_minus_identity, s.plastic, at, n, committed);
        s.be_minus_identity = user.be_minus_identity;
        s.plastic = user.plastic;
        return {user.tau, user.strain_squared};
      }
    return stress_of(s.be_minus_identity, snow.law.elastic,
                     [&](material::PQ<V>& pq) SNOWSHED_INLINE_LAMBDA {
                       bool changed = false;
                       if constexpr (Snow::plastic) {
                         const material::PQ<V> trial = pq;
                         changed = !committed && return_to_yield(pq, s, snow, at, n);
                         if constexpr (energy) record_energy(trial, pq, s.mass, snow, n);
                       }
                       return changed;
                     });
  }

  /// Returns the trial of a chunk to the yield surface, by the law of the snow or of the user;
  /// returns whether any stress may have changed.
  SNOWSHED_INLINE bool return_to_yield(material::PQ<V>& pq, State& s, const Snow& snow, int at,
                                       int n) const {
    if (!step.law) return snow.law.return_map(pq, s.plastic, step.overstress);
    const auto returned = user_return(step, p, pq.p, pq.q, s.plastic, at, n);
    pq = {returned.p, returned.q};
    s.plastic = returned.plastic;
    return true;
  }

  /// Records the elastic energy, and the plastic work of the return.
  void record_energy(const material::PQ<V>& trial, const material::PQ<V>& now, const V& mass,
                     const Snow& snow, int n) const {
    const auto& el = snow.law.elastic;
    for (int l = 0; l < n; ++l) {
      const double volume = double(mass[l]) * double(snow.specific_volume[l]);
      add_strain_energy(volume, el.bulk[l], el.mu[l], {trial.p[l], trial.q[l]},
                        {now.p[l], now.q[l]}, stats.energy);
    }
  }

  /// Adds the power of the new stresses in the motion of this step.
  void record_stress_power(const State& s, const Motion& m, const Tensor& tau, const Snow& snow,
                           int n) const {
    V work = broadcast<V>(T(0));
    for (int i = 0; i < D; ++i)
      for (int j = 0; j < D; ++j) work += tau(i, j) * m.gradient[i][j];
    for (int l = 0; l < n; ++l)
      stats.energy.stress_power -=
          double(s.mass[l]) * double(snow.specific_volume[l]) * double(work[l]) / double(step.dt);
  }

  void record_kinetic_energy(const State& s, int n) const {
    for (int l = 0; l < n; ++l) {
      double v2 = 0;
      for (int d = 0; d < D; ++d) v2 += double(s.velocity[d][l]) * double(s.velocity[d][l]);
      v2 += s.carried.squared(double(step.dx), l);
      stats.energy.kinetic += 0.5 * double(s.mass[l]) * v2;
    }
  }

  // --- particles to grid ------------------------------------------------------------------

  /// Adds a chunk to the tile: mass, momentum, and the force -V0 tau grad w (1.2.13).
  SNOWSHED_INLINE void scatter_chunk(const Stencil<T, D, basis>& stencil, const State& s,
                                     const Tensor& tau, const Snow& snow, int n, T* tile) const {
    constexpr int row = half_node * Rule::given_halves;
    V columns[whole_packs(row)]{};
    const V force_scale = s.mass * (-snow.specific_volume / step.dx);
    columns[0] = s.mass;
    SNOWSHED_UNROLL
    for (int i = 0; i < D; ++i) {
      columns[1 + i] = s.mass * s.velocity[i];
      SNOWSHED_UNROLL
      for (int j = 0; j < D; ++j) columns[half_node * (1 + j) + i] = force_scale * tau(i, j);
    }
    s.carried.give(columns, s.mass, step.dx);
    alignas(64) T rows[W][whole_packs(row)];
    transpose_columns(columns, rows);
    const typename Rule::Scattering weights(stencil);
    for (int l = 0; l < n; ++l) {
      const T* nothing = nullptr;
      NodeSums<T, D> sums;
      sums.value = Node<T>::of_halves(rows[l], nothing);
      for (int j = 0; j < D; ++j) sums.along[j] = Rule::given(rows[l], j);
      scatter_nodes<Rule, T, D, basis>(weights, l, sums, tile + stencil.address[l]);
    }
  }

  /// Records a particle whose strain is not finite or beyond the limit.
  SNOWSHED_INLINE void check(const V& strain_squared, int at, int n) const {
    const auto sound = strain_squared <= T(elastic_strain_limit * elastic_strain_limit);
    if (!any(sound == 0)) return;
    for (int l = 0; l < n; ++l) {
      if (sound[l]) continue;
      stats.unsound = at + l;
      stats.elastic_strain = std::sqrt(double(strain_squared[l]));
    }
  }

  // --- blocks -----------------------------------------------------------------------------

  /// Calls f(first particle, number) for each chunk of a block.
  template <class F>
  SNOWSHED_INLINE static void for_each_chunk(int first, int count, F f) {
    for (int at = first; at < first + count; at += W)
      f(at, first + count - at < W ? first + count - at : W);
  }

  /// Clears the part of the tile that a chunk needs. Returns whether its nodes lie in the tile.
  SNOWSHED_INLINE bool make_room(const Stencil<T, D, basis>& stencil, SimdMask<T>& reach,
                                 Tile& tile) const {
    reach |= stencil.reach;
    if (any((stencil.reach & ~tile.cleared()) != 0)) tile.extend(int(bits_in(stencil.reach)));
    if (!stencil.inside) stats.escaped = true;
    return stencil.inside;
  }

  void scatter_block(int first, int count, Tile& tile) const {
    SimdMask<T> reach{};
    for_each_chunk(first, count, [&](int at, int n) SNOWSHED_INLINE_LAMBDA {
      State s;
      read(s, at, n);
      const Stencil<T, D, basis> stencil(s.cell);
      if (!make_room(stencil, reach, tile)) return;
      const Snow& snow = snows.of(p, at, n);
      const Tensor tau = stress(s, snow, at, n, true).tau;
      scatter_chunk(stencil, s, tau, snow, n, tile.values());
      if constexpr (energy) record_kinetic_energy(s, n);
    });
    stats.reach = int(bits_in(reach));
  }

  void g2p2g_block(int first, int count, const T* velocities, const AverageTile<T>* average,
                   Tile& tile) const {
    V speed = broadcast<V>(T(0));
    SimdMask<T> reach{};
    for_each_chunk(first, count, [&](int at, int n) SNOWSHED_INLINE_LAMBDA {
      State s;
      read(s, at, n);
      Motion m;
      interpolate(Stencil<T, D, basis>(s.cell), velocities, n, m);
      V velocity_change[D];
      if constexpr (Rule::averages)
        if (average) damp(s, *average, n, velocity_change);
      move(s, m);
      if constexpr (Rule::averages)
        if (average) add_velocity(s, velocity_change, n);
      update_left_cauchy_green(s.be_minus_identity, m.gradient);
      const Snow& snow = snows.of(p, at, n);
      const auto [tau, strain_squared] = stress(s, snow, at, n, false);
      write(s, at, n);

      V v2 = s.velocity[0] * s.velocity[0], u2 = m.pic[0] * m.pic[0];
      for (int d = 1; d < D; ++d) {
        v2 += s.velocity[d] * s.velocity[d];
        u2 += m.pic[d] * m.pic[d];
      }
      speed = max(speed, max(v2, u2));
      if constexpr (energy) record_stress_power(s, m, tau, snow, n);
      check(strain_squared + T(0) * v2, at, n);
      if constexpr (energy) record_kinetic_energy(s, n);

      const Stencil<T, D, basis> stencil(s.cell);
      if (make_room(stencil, reach, tile)) scatter_chunk(stencil, s, tau, snow, n, tile.values());
    });
    stats.reach = int(bits_in(reach));
    stats.max_speed_squared = double(largest(speed));
  }

  void probe_block(int first, int count, const T* velocities) const {
    V strain = broadcast<V>(T(0));
    for_each_chunk(first, count, [&](int at, int n) SNOWSHED_INLINE_LAMBDA {
      V cell[D];
      for (int d = 0; d < D; ++d) cell[d] = load(p.cell[d] + at, n);
      Motion m;
      interpolate(Stencil<T, D, basis>(cell), velocities, n, m);
      strain = max(strain, largest_gradient(m));
    });
    stats.strain = double(largest(strain));
  }

  // --- entries of the table ---------------------------------------------------------------

  static constexpr int tile_size = tile_nodes<D>(basis) * node_values;

  static void load_velocities(const T* const* blocks, int reach, T* tile) {
    const auto copy = [&](int neighbour, int from, int to, auto length) {
      std::memcpy(tile + to * node_values, blocks[neighbour] + from * node_values,
                  length * node_values * sizeof(T));
    };
    for_each_shared_row<D, basis>(touched_by<D>(reach), copy);
  }

  static void scatter(const StepParameters<T>& step, const ParticleView<T>& p, int first, int count,
                      T* values, BlockStats& stats) {
    Tile tile(values, 0);
    ParticleKernels(step, p, stats).scatter_block(first, count, tile);
  }
  static void g2p2g(const StepParameters<T>& step, const ParticleView<T>& p, int first, int count,
                    const T* const* velocities, const AverageTile<T>* average, T* values,
                    BlockStats& stats) {
    alignas(64) T around[tile_size];
    load_velocities(velocities, stats.reach, around);
    Tile tile(values, stats.reach);
    ParticleKernels(step, p, stats).g2p2g_block(first, count, around, average, tile);
  }
  static void probe(const StepParameters<T>& step, const ParticleView<T>& p, int first, int count,
                    const T* const* velocities, BlockStats& stats) {
    alignas(64) T around[tile_size];
    load_velocities(velocities, stats.reach, around);
    ParticleKernels(step, p, stats).probe_block(first, count, around);
  }
};

SNOWSHED_MODULE_VARIANT_END
