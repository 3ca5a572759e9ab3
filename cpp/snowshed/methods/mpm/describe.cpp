#include "snowshed/methods/mpm/describe.hpp"

#include "snowshed/methods/allowed.hpp"

namespace snowshed::methods::mpm {

void describe(SettingsVisitor& v, Settings& n) {
  v.accuracy({"dx", "scheme", "precision", "transfer", "flip_ratio", "damping_rate",
              "damping_length", "crack_band_length", "relaxation_time", "contact", "contact_radius",
              "fields", "event_friction", "basis", "courant_factor", "strain_limit", "sleep_speed",
              "sleep_time"});
  v.alias("courant_factor", "step_factor");  // its name up to version 0.1
  v.number("dx", n.dx, "m", allowed::size, "Size of grid cells and voxels");
  const Scheme before = n.scheme;
  v.choice("scheme", n.scheme,
           "Mechanisms that belong together: objective sets transfer affine_flip, damping_rate 380 "
           "1/s, damping_length and crack_band_length 0.01 m, contact touch and fields of events, "
           "unless they are given; thesis keeps the defaults of these settings");
  // Settings that are read next may differ from the scheme.
  if (n.scheme != before) n.adopt(n.scheme);
  v.choice("precision", n.precision, "Floating-point type of the particles and the grid");
  v.choice("transfer", n.transfer, "Transfer of velocities between particles and grid");
  v.number(
      "flip_ratio", n.flip_ratio, "", fraction,
      "Share of FLIP in FLIP/PIC in each step, so that shorter steps damp more; 0 is pure PIC");
  v.number_instead("damping_rate", n.damping_rate, "flip_ratio", "1/s", non_negative.up_to(1e9),
                   "Rate of the damping, independent of the time step, in place of flip_ratio");
  v.number("damping_length", n.damping_length, "m", allowed::size_or_zero,
           "Length over which affine_flip averages velocities to damp them at the damping rate, "
           "independent of the grid; 0: the damping is PIC's, over dx");
  v.number("crack_band_length", n.crack_band_length, "m", allowed::size_or_zero,
           "Width of a crack: dilating snow softens dx/width times as fast as its law, so that a "
           "crack takes the same energy per area on any grid; 0: the law itself");
  v.number(
      "relaxation_time", n.relaxation_time, "s", allowed::time,
      "Time in which stress beyond the yield surface relaxes, a viscosity of snow that yields; "
      "0: at once, the law itself");
  v.choice(
      "contact", n.contact,
      "Snow on which a node of an obstacle acts: all snow whose splines reach the node (kernel), "
      "or only snow beside a particle that touches the obstacle itself (touch)");
  v.number("contact_radius", n.contact_radius, "", positive.up_to(1.0),
           "Contact radius of a particle, relative to half the spacing of particles");
  v.choice(
      "fields", n.fields,
      "Velocity fields of the grid: one for all snow, which then sticks together on contact, or "
      "one for the snow of each event, which then touches, slides and separates");
  v.number("event_friction", n.event_friction, "", allowed::coefficient,
           "With fields of events: friction between the snow of different events, relative to that "
           "of the snow itself at the critical state, M/sqrt(3)");
  v.choice("basis", n.basis, "B-spline of the grid");
  v.number("courant_factor", n.courant_factor, "", positive.up_to(1.0),
           "Time step relative to the largest stable time step");
  v.number("strain_limit", n.strain_limit, "", positive.up_to(0.5),
           "Largest |dt grad v| that a step may impose on a particle");
  v.number("sleep_speed", n.sleep_speed, "m/s", non_negative.up_to(1e4),
           "Snow slower than this drops out of the steps until something moves it; 0: never");
  v.number("sleep_time", n.sleep_time, "s", allowed::time,
           "Time for which snow must stay below sleep_speed without speeding up");
  v.integer("threads", n.threads, non_negative.up_to(4096), "Threads; 0: all");
  v.choice("device", n.device,
           "Device that computes the steps: the processor (cpu), a graphics card of NVIDIA (gpu), "
           "or a card if one is there and can compute the scene (auto)");
}

std::vector<UnusedSettings> unused_settings(const Settings& n) {
  return {{n.transfer == Transfer::apic, "transfer is \"apic\"", {"flip_ratio"}},
          {n.contact == ContactRule::kernel, "contact is \"kernel\"", {"contact_radius"}},
          {n.fields == Fields::one, "fields is \"one\"", {"event_friction"}},
          {n.sleep_speed == 0, "sleep_speed is 0", {"sleep_time"}}};
}

}  // namespace snowshed::methods::mpm
