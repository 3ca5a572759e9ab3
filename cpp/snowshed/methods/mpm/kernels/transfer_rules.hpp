// Differences between FLIP and APIC. A rule defines the weights of the nodes, the values that
// particles carry beside their velocity, the values that they take from the sums over their nodes,
// and the values that they give to the nodes.
//
// FLIP: a node holds its velocity and the change of it; particles take the change, and a share of
// the velocity (thesis 1.2.26). APIC: both halves of a node hold the velocity; particles take an
// affine velocity C too, from the sums weighted with the distance of a node (Jiang et al. 2015).
// Affine FLIP: nodes hold the same as with FLIP; particles take the change of velocity as in FLIP,
// and C of the velocity as in APIC.
#pragma once

#include "snowshed/methods/mpm/kernels/bspline.hpp"
#include "snowshed/methods/mpm/kernels/chunk.hpp"
#include "snowshed/methods/mpm/kernels/node_sums.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::mpm)

/// Values of half a node.
inline constexpr int half_node = node_values / 2;

template <class T, int D, Basis basis>
struct FlipRule {
  using V = SimdPack<T>;
  static constexpr int S = support(basis);
  /// Whether velocities may be damped towards their average on a coarse grid.
  static constexpr bool averages = false;
  /// The halves of nodes that particles take.
  static constexpr Halves taken = Halves::both;
  /// The halves that count in sums with the derivatives of weights.
  static constexpr Halves interpolated = Halves::first;  // the gradient of the velocity
  static constexpr Halves scattered = Halves::second;    // force
  static constexpr int derived_values = half_node;
  static constexpr int given_halves = 1 + D;

  /// Weights of the steps between nodes.
  struct Interpolation {
    LaneWeights<T, D, S - 1> value;
    LaneWeights<T, D, S - 2> slope;  // without the first step: the weights add up to one

    SNOWSHED_INLINE explicit Interpolation(const Stencil<T, D, basis>& stencil) {
      SNOWSHED_UNROLL
      for (int d = 0; d < D; ++d) {
        V w[S], g[S], r[S - 1];
        BSpline<basis>::evaluate(stencil.fraction[d], w, g);
        weights_of_steps(w, r);
        SNOWSHED_UNROLL
        for (int k = 0; k < S - 1; ++k) value.set(d, k, r[k]);
        weights_of_steps(g, r);
        SNOWSHED_UNROLL
        for (int k = 1; k < S - 1; ++k) slope.set(d, k - 1, r[k]);
      }
    }
    template <class Nodes>
    SNOWSHED_INLINE Node<T> derivative(const Nodes& line, int d, int lane) const {
      Node<T> sum = line.step[0];
      for (int k = 1; k < S - 1; ++k)
        add_scaled<interpolated>(sum, slope(d, k - 1, lane),
                                 difference<interpolated>(line.step[k], line.step[0]));
      return sum;
    }
  };

  /// Weights of the nodes.
  struct Scattering {
    LaneWeights<T, D, S> value, slope;

    SNOWSHED_INLINE explicit Scattering(const Stencil<T, D, basis>& stencil) {
      SNOWSHED_UNROLL
      for (int d = 0; d < D; ++d) {
        V w[S], g[S];
        BSpline<basis>::evaluate(stencil.fraction[d], w, g);
        SNOWSHED_UNROLL
        for (int k = 0; k < S; ++k) {
          value.set(d, k, w[k]);
          slope.set(d, k, g[k]);
        }
      }
    }
    SNOWSHED_INLINE T derived(int d, int k, int lane) const { return slope(d, k, lane); }
  };

  /// Particles carry nothing beside their velocity.
  struct CarriedValues {
    SNOWSHED_INLINE void read(const ParticleView<T>&, int, int) {}
    SNOWSHED_INLINE void write(const ParticleView<T>&, int, int) const {}
    /// Returns the square of the velocity (m2/s2) that has the kinetic energy of the carried
    /// values.
    double squared(double, int) const { return 0; }
    /// Writes the change of momentum per cell over the particle's nodes.
    SNOWSHED_INLINE void give(V*, const V&, T) const {}
  };

  /// Values that particles take from the sums, beside the velocity and its gradient.
  struct TakenValues {
    V change[D];
    SNOWSHED_INLINE void read(const V* value, const V*, T) {
      SNOWSHED_UNROLL
      for (int i = 0; i < D; ++i) change[i] = value[half_node + i];
    }
    /// (1.2.26)
    SNOWSHED_INLINE void move(V (&velocity)[D], CarriedValues&, const V (&pic)[D],
                              T flip_ratio) const {
      SNOWSHED_UNROLL
      for (int d = 0; d < D; ++d)
        velocity[d] = pic[d] + flip_ratio * (velocity[d] + change[d] - pic[d]);
    }
  };

  /// Returns the values that the nodes get with the derivative along j, from the halves of a row.
  SNOWSHED_INLINE static Node<T> given(const T* row, int j) {
    const T* nothing = nullptr;
    return Node<T>::of_halves(nothing, row + half_node * (1 + j));
  }
};

template <class T, int D, Basis basis>
struct ApicRule {
  using V = SimdPack<T>;
  static constexpr int S = support(basis);
  static constexpr T inverse_inertia = T(apic_inverse_inertia(basis));
  static constexpr bool averages = false;
  static constexpr Halves taken = Halves::first;  // the second one is the same
  static constexpr Halves interpolated = Halves::both;
  static constexpr Halves scattered = Halves::both;
  static constexpr int derived_values = node_values;
  static constexpr int given_halves = 1 + 2 * D;

  /// Weights times the distance from the particle to each node along d, in cells.
  SNOWSHED_INLINE static void moments(const V& fraction, const V (&w)[S], V (&moment)[S]) {
    SNOWSHED_UNROLL
    for (int k = 0; k < S; ++k) moment[k] = w[k] * (T(k - base_offset(basis)) - fraction);
  }

  struct Interpolation {
    LaneWeights<T, D, S - 1> value, slope, moment;

    SNOWSHED_INLINE explicit Interpolation(const Stencil<T, D, basis>& stencil) {
      SNOWSHED_UNROLL
      for (int d = 0; d < D; ++d) {
        V w[S], g[S], c[S];
        BSpline<basis>::evaluate(stencil.fraction[d], w, g);
        moments(stencil.fraction[d], w, c);
        set(value, d, w);
        set(slope, d, g);
        set(moment, d, c);
      }
    }
    SNOWSHED_INLINE static void set(LaneWeights<T, D, S - 1>& weights, int d, const V (&w)[S]) {
      V r[S - 1];
      weights_of_steps(w, r);
      SNOWSHED_UNROLL
      for (int k = 0; k < S - 1; ++k) weights.set(d, k, r[k]);
    }
    /// Returns the gradient in the first half and the moment in the second. The weights of both sum
    /// to zero.
    template <class Nodes>
    SNOWSHED_INLINE Node<T> derivative(const Nodes& line, int d, int lane) const {
      Node<T> sum{};
      for (int k = 0; k < S - 1; ++k)
        add_scaled_first(sum, Node<T>::of_halves(slope(d, k, lane), moment(d, k, lane)),
                         line.step[k]);
      return sum;
    }
  };

  struct Scattering {
    LaneWeights<T, D, S> value, slope, moment;

    SNOWSHED_INLINE explicit Scattering(const Stencil<T, D, basis>& stencil) {
      SNOWSHED_UNROLL
      for (int d = 0; d < D; ++d) {
        V w[S], g[S], c[S];
        BSpline<basis>::evaluate(stencil.fraction[d], w, g);
        moments(stencil.fraction[d], w, c);
        SNOWSHED_UNROLL
        for (int k = 0; k < S; ++k) {
          value.set(d, k, w[k]);
          slope.set(d, k, g[k]);
          moment.set(d, k, c[k]);
        }
      }
    }
    /// Returns a node. Its first half holds the moment, which momentum needs; its second half holds
    /// the derivative, which force needs.
    SNOWSHED_INLINE Node<T> derived(int d, int k, int lane) const {
      return Node<T>::of_halves(moment(d, k, lane), slope(d, k, lane));
    }
  };

  struct CarriedValues {
    V affine[D * D];  // C, row by row, 1/s

    SNOWSHED_INLINE void read(const ParticleView<T>& p, int at, int n) {
      SNOWSHED_UNROLL
      for (int k = 0; k < D * D; ++k) affine[k] = load(p.affine[k] + at, n);
    }
    SNOWSHED_INLINE void write(const ParticleView<T>& p, int at, int n) const {
      SNOWSHED_UNROLL
      for (int k = 0; k < D * D; ++k) store(p.affine[k] + at, affine[k], n);
    }
    double squared(double dx, int lane) const {
      double sum = 0;
      for (int k = 0; k < D * D; ++k) sum += double(affine[k][lane]) * double(affine[k][lane]);
      return dx * dx / double(inverse_inertia) * sum;
    }
    SNOWSHED_INLINE void give(V* halves, const V& mass, T dx) const {
      SNOWSHED_UNROLL
      for (int i = 0; i < D; ++i) {
        SNOWSHED_UNROLL
        for (int j = 0; j < D; ++j)
          halves[half_node * (1 + D + j) + 1 + i] = mass * affine[i * D + j] * dx;
      }
    }
  };

  struct TakenValues {
    V affine[D * D];
    SNOWSHED_INLINE void read(const V*, const V* along, T dx) {
      SNOWSHED_UNROLL
      for (int i = 0; i < D; ++i) {
        SNOWSHED_UNROLL
        for (int j = 0; j < D; ++j)
          affine[i * D + j] = along[node_values * j + half_node + i] * (inverse_inertia / dx);
      }
    }
    SNOWSHED_INLINE void move(V (&velocity)[D], CarriedValues& carried, const V (&pic)[D],
                              T) const {
      SNOWSHED_UNROLL
      for (int d = 0; d < D; ++d) velocity[d] = pic[d];
      SNOWSHED_UNROLL
      for (int k = 0; k < D * D; ++k) carried.affine[k] = affine[k];
    }
  };

  SNOWSHED_INLINE static Node<T> given(const T* row, int j) {
    return Node<T>::of_halves(row + half_node * (1 + D + j), row + half_node * (1 + j));
  }
};

template <class T, int D, Basis basis>
struct AffineFlipRule : ApicRule<T, D, basis> {
  using V = SimdPack<T>;
  using Apic = ApicRule<T, D, basis>;
  using Flip = FlipRule<T, D, basis>;
  using CarriedValues = typename Apic::CarriedValues;
  static constexpr bool averages = true;
  static constexpr Halves taken = Flip::taken;

  struct Interpolation : Apic::Interpolation {
    using Apic::Interpolation::Interpolation;
    /// Returns the gradient of the velocity in the first half and its moment in the second.
    template <class Nodes>
    SNOWSHED_INLINE Node<T> derivative(const Nodes& line, int d, int lane) const {
      Node<T> sum{};
      for (int k = 0; k < Apic::S - 1; ++k)
        add_scaled_first(sum, Node<T>::of_halves(this->slope(d, k, lane), this->moment(d, k, lane)),
                         first_twice(line.step[k]));
      return sum;
    }
  };

  struct TakenValues {
    typename Flip::TakenValues change;
    typename Apic::TakenValues affine;
    SNOWSHED_INLINE void read(const V* value, const V* along, T dx) {
      change.read(value, along, dx);
      affine.read(value, along, dx);
    }
    SNOWSHED_INLINE void move(V (&velocity)[D], CarriedValues& carried, const V (&pic)[D],
                              T flip_ratio) const {
      typename Flip::CarriedValues nothing;
      change.move(velocity, nothing, pic, flip_ratio);
      SNOWSHED_UNROLL
      for (int k = 0; k < D * D; ++k) carried.affine[k] = affine.affine[k];
    }
  };
};

template <class T, int D, Transfer transfer, Basis basis>
struct RuleOf;
template <class T, int D, Basis basis>
struct RuleOf<T, D, Transfer::flip, basis> {
  using type = FlipRule<T, D, basis>;
};
template <class T, int D, Basis basis>
struct RuleOf<T, D, Transfer::apic, basis> {
  using type = ApicRule<T, D, basis>;
};
template <class T, int D, Basis basis>
struct RuleOf<T, D, Transfer::affine_flip, basis> {
  using type = AffineFlipRule<T, D, basis>;
};

template <class T, int D, Transfer transfer, Basis basis>
using TransferRule = typename RuleOf<T, D, transfer, basis>::type;

SNOWSHED_MODULE_VARIANT_END
