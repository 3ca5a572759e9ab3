// An independent reference for the return mapping: the rate equations of cohesive Modified
// Cam-Clay, integrated with an adaptive Runge-Kutta method (Dormand-Prince 5(4)). It shares no code
// with the material and does not use its p-q form; stress and flow are full tensors.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace snowshed::material {

struct LawConstants {
  double youngs_modulus, poissons_ratio, slope, cohesion, hardening;
};

template <int D>
struct MaterialState {
  Eigen::Matrix<double, D, D> strain;  // elastic
  double ev;
};

class RateEquations {
 public:
  double bulk, mu, hardening;  // K_d, mu, and K of (1.2.7); Pa

  RateEquations(const LawConstants& s, int dimension) : snow_(s) {
    const double E = s.youngs_modulus, nu = s.poissons_ratio;
    mu = E / (2 * (1 + nu));
    bulk = E * nu / ((1 + nu) * (1 - 2 * nu)) + 2 * mu / dimension;
    hardening = E / (3 - 6 * nu);
  }

  double p0(double ev) const { return hardening * std::sinh(snow_.hardening * std::max(-ev, 0.0)); }
  double p0_slope(double ev) const {
    return ev < 0 ? -hardening * snow_.hardening * std::cosh(snow_.hardening * ev) : 0.0;
  }

  template <int D>
  double p(const Eigen::Matrix<double, D, D>& strain) const {
    return -bulk * strain.trace();
  }
  template <int D>
  Eigen::Matrix<double, D, D> deviatoric_stress(const Eigen::Matrix<double, D, D>& strain) const {
    return 2 * mu * (strain - strain.trace() / D * Eigen::Matrix<double, D, D>::Identity());
  }
  template <int D>
  double q(const Eigen::Matrix<double, D, D>& strain) const {
    return std::sqrt(1.5) * deviatoric_stress<D>(strain).norm();
  }
  template <int D>
  double yield(const MaterialState<D>& x) const {
    const double q_now = q<D>(x.strain), p_now = p<D>(x.strain), p0_now = p0(x.ev);
    return shear() * q_now * q_now + m2() * (p_now + snow_.cohesion * p0_now) * (p_now - p0_now);
  }

  /// Returns the state after a straight strain path. The path is elastic up to the yield surface
  /// and plastic from there on. Bisection finds the crossing, because y is convex along an elastic
  /// path.
  template <int D>
  MaterialState<D> integrate(MaterialState<D> x, const Eigen::Matrix<double, D, D>& path) const {
    const auto elastic_to = [&](double t) { return MaterialState<D>{x.strain + t * path, x.ev}; };
    double t = 0;
    const double on_surface = 1e-10 * m2() * p0(x.ev) * p0(x.ev);
    if (yield<D>(x) < -on_surface || !loading<D>(x, path)) {
      if (yield<D>(elastic_to(1)) <= 0) return elastic_to(1);
      // Unloading may start on the surface. The crossing then lies after the minimum of y.
      double low = 0, high = 1;
      for (int i = 0; i < 200; ++i) {
        const double a = low + (high - low) / 3, b = high - (high - low) / 3;
        if (yield<D>(elastic_to(a)) < yield<D>(elastic_to(b)))
          high = b;
        else
          low = a;
      }
      high = 1;
      for (int i = 0; i < 200; ++i) {
        t = (low + high) / 2;
        if (yield<D>(elastic_to(t)) > 0)
          high = t;
        else
          low = t;
      }
      x = elastic_to(t);
    }
    return plastic<D>(x, path, t);
  }

 private:
  double m2() const { return snow_.slope * snow_.slope; }
  double shear() const { return 1 + 2 * snow_.cohesion; }

  template <int D>
  bool loading(const MaterialState<D>& x, const Eigen::Matrix<double, D, D>& rate) const {
    return drive<D>(x, rate) > 0;
  }

  double y_p(double p, double p0) const { return m2() * (2 * p - (1 - snow_.cohesion) * p0); }

  /// Returns dy/dt of an elastic step at this strain rate.
  template <int D>
  double drive(const MaterialState<D>& x, const Eigen::Matrix<double, D, D>& rate) const {
    const auto s = deviatoric_stress<D>(x.strain);
    return -y_p(p<D>(x.strain), p0(x.ev)) * bulk * rate.trace() +
           6 * mu * shear() * s.cwiseProduct(rate).sum();
  }

  /// Returns the rates of elastic strain and e_v from dy = 0 (associative flow: plastic strain rate
  /// gamma dy/dtau, dy/dtau = -y_p I/D + 3 (1 + 2 beta) s).
  template <int D>
  MaterialState<D> rates(const MaterialState<D>& x, const Eigen::Matrix<double, D, D>& rate) const {
    using Matrix = Eigen::Matrix<double, D, D>;
    const Matrix s = deviatoric_stress<D>(x.strain);
    const double p_now = p<D>(x.strain), p0_now = p0(x.ev), yp = y_p(p_now, p0_now);
    const double y_p0 = m2() * ((snow_.cohesion - 1) * p_now - 2 * snow_.cohesion * p0_now);
    const double resistance =
        bulk * yp * yp + 18 * mu * shear() * shear() * s.squaredNorm() + y_p0 * p0_slope(x.ev) * yp;
    if (!(resistance > 0)) throw std::runtime_error("softening steeper than elasticity");
    const double gamma = std::max(0.0, drive<D>(x, rate)) / resistance;
    const Matrix flow = -yp / D * Matrix::Identity() + 3 * shear() * s;
    return {rate - gamma * flow, -gamma * yp};
  }

  /// Returns the state shortly after the compaction of snow without strength has begun. Stress, p0
  /// and e_v then grow in proportion to time. Their ratio r = p/p0 follows from the yield condition
  /// for the shear stress that the strain rate causes.
  template <int D>
  MaterialState<D> recompacted(const Eigen::Matrix<double, D, D>& rate, double time) const {
    using Matrix = Eigen::Matrix<double, D, D>;
    const Matrix dev = rate - rate.trace() / D * Matrix::Identity();
    const double h = -p0_slope(-1e-12);
    const auto compaction = [&](double r) { return -bulk * rate.trace() / (bulk + r * h); };
    const auto stress = [&](double r) {  // ds/dt
      const double n = 2 * r - (1 - snow_.cohesion);
      return Matrix(2 * mu * dev * n / (n + 6 * mu * shear() / (m2() * h)));
    };
    double low = (1 - snow_.cohesion) / 2, high = 1;
    for (int i = 0; i < 100; ++i) {
      const double r = (low + high) / 2;
      const double q2 =
          m2() * (r + snow_.cohesion) * (1 - r) / shear() * std::pow(h * compaction(r), 2);
      (1.5 * stress(r).squaredNorm() < q2 ? low : high) = r;
    }
    const double pressure = low * h * compaction(low) * time;
    return {stress(low) * time / (2 * mu) - pressure / (bulk * D) * Matrix::Identity(),
            -compaction(low) * time};
  }

  template <int D>
  MaterialState<D> plastic(MaterialState<D> x, const Eigen::Matrix<double, D, D>& path,
                           double t) const {
    static constexpr double a[7][6] = {
        {},
        {1.0 / 5},
        {3.0 / 40, 9.0 / 40},
        {44.0 / 45, -56.0 / 15, 32.0 / 9},
        {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
        {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
        {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
    static constexpr double error[7] = {71.0 / 57600,      0,          -71.0 / 16695, 71.0 / 1920,
                                        -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
    constexpr double tolerance = 1e-15;  // yield strains are about 1e-3
    double h = 1e-4;
    while (t < 1) {
      h = std::min(h, 1 - t);
      if (x.ev > -1e-9) {  // full softening: the stress is zero, all strain is plastic
        const double gap = x.ev + x.strain.trace(), end = gap + (1 - t) * path.trace();
        if (end >= 0) return {Eigen::Matrix<double, D, D>::Zero(), end};
        t += std::max(0.0, -gap / path.trace());
        h = 1e-5 * (1 - t);
        x = recompacted<D>(path, h);
        t += h;
        continue;
      }
      MaterialState<D> k[7], next, difference{Eigen::Matrix<double, D, D>::Zero(), 0};
      for (int i = 0; i < 7; ++i) {
        next = x;
        for (int j = 0; j < i; ++j) {
          next.strain += h * a[i][j] * k[j].strain;
          next.ev += h * a[i][j] * k[j].ev;
        }
        k[i] = rates<D>(next, path);
        difference.strain += h * error[i] * k[i].strain;
        difference.ev += h * error[i] * k[i].ev;
      }
      const double excess = std::max(difference.strain.norm(), std::abs(difference.ev)) / tolerance;
      if (excess <= 1 && next.ev < 0) {
        x = next;
        t += h;
        if (!loading<D>(x, path)) return integrate<D>(x, (1 - t) * path);  // unloads midway
      }
      const double factor = 0.9 * std::pow(std::max(excess, 1e-5), -0.2);
      h *= next.ev < 0 ? std::clamp(factor, 0.2, 3.0) : 0.5;
      if (h < 1e-15) throw std::runtime_error("the rate equations have become singular");
    }
    return x;
  }

  LawConstants snow_;
};

}  // namespace snowshed::material
