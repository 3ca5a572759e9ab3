// Settings of the material point method in a scene.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "snowshed/methods/mpm/basis.hpp"

namespace snowshed::methods::mpm {

enum class Precision { float32, float64 };
enum class Transfer { flip, apic, affine_flip };
enum class ContactRule { kernel, touch };
enum class Scheme { thesis, objective };
enum class Fields { one, events };
/// `automatic`: on a card if one is there and can compute the scene, otherwise on the processor.
enum class DeviceSetting { cpu, gpu, automatic };

/// Settings of the material point method: grid, transfer, time step, sleep.
struct Settings {
  Scheme scheme = Scheme::thesis;  // the mechanisms below that belong together, see `adopt`
  double dx = 0.01;                // m, grid and voxel size
  Precision precision = Precision::float32;
  Transfer transfer = Transfer::flip;
  double flip_ratio = 0.99;            // share of FLIP in each step; PIC has the rest and damps
  std::optional<double> damping_rate;  // 1/s, in place of flip_ratio, independent of the step
  double damping_length = 0;           // m, over which the damping averages; 0: by PIC, over dx
  double crack_band_length = 0;        // m, see `softening`; 0: none
  double relaxation_time = 0;          // s, of stress beyond the yield surface; 0: none
  ContactRule contact = ContactRule::kernel;
  double contact_radius = 0.6;  // contact radius of particles, over half their spacing
  Fields fields = Fields::one;
  double event_friction = 1;  // friction between fields of events, over the snow's M/sqrt(3)
  Basis basis = Basis::quadratic;
  double courant_factor = 0.9;  // time step over the largest stable time step
  double strain_limit = 0.2;    // largest |dt grad v| a step may impose on a particle
  double sleep_speed = 0.02;    // m/s, snow slower than this drops out of the steps; 0: never
  double sleep_time = 0.04;     // s, time for which snow must be slower before it drops out
  int threads = 0;              // 0: all
  DeviceSetting device = DeviceSetting::cpu;

  /// Sets the mechanisms of a scheme; all other settings stay. `thesis` is the scheme of the
  /// thesis. The results of `objective` depend less on the grid.
  void adopt(Scheme chosen) {
    const Settings thesis;
    scheme = chosen;
    transfer = thesis.transfer;
    flip_ratio = thesis.flip_ratio;
    damping_rate = thesis.damping_rate;
    damping_length = thesis.damping_length;
    crack_band_length = thesis.crack_band_length;
    relaxation_time = thesis.relaxation_time;
    contact = thesis.contact;
    contact_radius = thesis.contact_radius;
    fields = thesis.fields;
    event_friction = thesis.event_friction;
    if (chosen == Scheme::thesis) return;
    transfer = Transfer::affine_flip;
    damping_rate = 380.0;
    damping_length = crack_band_length = 0.01;
    contact = ContactRule::touch;
    fields = Fields::events;
  }

  /// Returns the smallest length that the method resolves, m.
  double resolution() const { return dx; }

  /// Whether particles carry an affine velocity.
  bool has_affine() const { return transfer != Transfer::flip; }
  /// Whether velocities are damped towards their average over a length, not by PIC.
  bool damps_over_length() const { return damping_length > 0; }

  /// FLIP's share in a step of dt seconds. Motion that the grid does not resolve keeps this part of
  /// its velocity. With a damping_rate, the part exp(-rate t) is left after a time t, whatever the
  /// length of the steps.
  double flip_share(double dt) const {
    if (damps_over_length()) return 1.0;
    return damping_rate ? std::exp(-*damping_rate * dt) : flip_ratio;
  }

  /// Factor by which snow that dilates beyond its initial volume softens faster than by its own
  /// law. Cracks are a few cells wide. With this factor they take the same energy per area on any
  /// grid.
  double softening() const { return crack_band_length > 0 ? dx / crack_band_length : 1.0; }

  /// Share of the stress beyond the yield surface that is left after a step of dt seconds.
  double overstress_share(double dt) const {
    return relaxation_time > 0 ? relaxation_time / (dt + relaxation_time) : 0.0;
  }

  /// Returns the mean rate (1/s) at which velocities were damped over `steps` steps in `time` (s).
  /// For a share of FLIP it is -ln(share)/dt. Returns nothing for APIC, which has no such share,
  /// for pure PIC, whose rate would be infinite, and before the first step.
  std::optional<double> mean_damping_rate(std::int64_t steps, double time) const {
    if (transfer == Transfer::apic) return std::nullopt;
    if (damping_rate) return damping_rate;
    if (!(flip_ratio > 0) || steps == 0 || !(time > 0)) return std::nullopt;
    return std::abs(std::log(flip_ratio)) * double(steps) / time;
  }
};

}  // namespace snowshed::methods::mpm
