// Laws of the shear stress of flowing snow: Bingham, and dilatant at high shear rates.
#pragma once

#include <algorithm>
#include <cmath>

#include "snowshed/core/angles.hpp"
#include "snowshed/methods/mps/settings.hpp"

namespace snowshed::methods::mps {

/// The shear stress over the shear rate, gdot = sqrt(2 D:D).
///
/// Up to `dilatant_rate` the stress is that of a Bingham fluid, tau = tau0 + eta gdot (20). Above
/// it grows as a power of the rate, tau = tau_c (gdot/gdot_c)^k (21), where tau_c makes it
/// continuous. The yield stress tau0 = c + max(p, 0) tan(phi) grows with the pressure. At small
/// rates tau0 is replaced by tau0 (1 - exp(-m gdot)) (22; Papanastasiou 1987,
/// doi:10.1122/1.549926), or by a linear function up to the rate 1/m (bi-viscous; Dent and Lang
/// 1983). The paper's equations are lost; their form is inferred from the wording.
struct Rheology {
  double viscosity, cohesion, friction;  // Pa s, Pa, tan(phi)
  double growth;                         // s
  double dilatant_rate, exponent;        // 1/s; infinite without the dilatant branch
  bool bi_viscous;

  static Rheology from(const Settings& s) {
    const bool yields = s.rheology != ShearLaw::newtonian;
    return {s.viscosity,
            yields ? s.cohesion : 0.0,
            yields ? std::tan(radians(s.friction_angle)) : 0.0,
            s.stress_growth,
            s.rheology == ShearLaw::bingham_dilatant ? s.dilatant_rate : HUGE_VAL,
            s.dilatant_exponent,
            s.regularisation == Regularisation::bi_viscous};
  }

  bool is_newtonian() const { return cohesion == 0 && friction == 0 && dilatant_rate == HUGE_VAL; }

  /// Whether snow with this shear rate has reached the yield stress; fluids without it always flow.
  bool flows(double rate) const { return is_newtonian() || growth * rate > 2; }

  /// Pa; `pressure` in Pa.
  double yield_stress(double pressure) const {
    return cohesion + std::max(pressure, 0.0) * friction;
  }

  /// The viscosity of a stress that acts at any shear rate: `stress`/rate, but at most `stress` m,
  /// Pa s.
  double regularised(double stress, double rate) const {
    const double x = growth * rate;
    if (bi_viscous) return stress * growth / std::max(x, 1.0);
    if (x < 1e-6) return stress * growth * (1 - 0.5 * x);
    return stress * (x < 40 ? 1 - std::exp(-x) : 1.0) / rate;  // exp(-40) is lost beside 1
  }

  /// The rate at which elastic snow without a stress yields in a step, 1/s: the yield strain over
  /// the step. It is at most the rate at which the plastic viscosity alone has the yield stress,
  /// because snow must not become stiffer when it yields.
  double yield_rate(double yield, double yield_strain, double dt) const {
    return std::min(yield_strain / dt, viscosity > 0 ? yield / viscosity : HUGE_VAL);
  }

  /// The stress over the shear rate at which elastic snow would have deformed in a step, Pa s.
  /// `rate` is the sum of the strain rate and of the elastic strain over the step. Until the snow
  /// yields its stress is yield * rate / yield_rate, and then that of the excess of the rate.
  double elastic_viscosity(double yield, double rate, double yield_rate) const {
    if (rate <= yield_rate) return yield_rate > 0 ? yield / yield_rate : viscosity;
    return flow_stress(yield, rate - yield_rate) / rate;
  }

  /// The stress of snow that flows at a shear rate, Pa.
  double flow_stress(double yield, double rate) const {
    if (rate <= dilatant_rate) return yield + viscosity * rate;
    return (yield + viscosity * dilatant_rate) * std::pow(rate / dilatant_rate, exponent);
  }

  /// The apparent viscosity eta' (22), Pa s.
  double apparent_viscosity(double yield, double rate) const {
    if (rate <= dilatant_rate) return viscosity + regularised(yield, rate);
    const double at_change = viscosity + regularised(yield, dilatant_rate);
    return at_change * std::pow(rate / dilatant_rate, exponent - 1);
  }
};

}  // namespace snowshed::methods::mps
