// Laws of the user: compiled functions in place of laws of the material point method, or beside
// them. Several threads call them at once, so they must not depend on shared data that changes, and
// must not throw. A scene cannot hold them, nor can a checkpoint, which only holds their name.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace snowshed::methods {

/// Returns the stress of `count` particles after their elastic trial. `p` and `q` are pressure and
/// Mises stress in the Kirchhoff measure (Pa), positive in compression. `plastic_strain` is the
/// volumetric plastic strain, the state of the law: dp/K must be added to it if p changes by dp, K
/// the bulk modulus. The snow keeps its elasticity and the direction of its deviatoric stress.
/// `snow` has the index of each particle's snow. T is the type of numerics.precision.
template <class T>
using MaterialLaw = void (*)(std::int64_t count, T* p, T* q, T* plastic_strain,
                             const std::uint8_t* snow, double time_step);

/// Returns the stress of `count` particles from their elastic strain after the trial, and that
/// strain. Component k of particle i stands at `strain[k * count + i]`; the components are xx, zz,
/// xz in 2D and xx, yy, zz, xy, xz, yz in 3D. `strain` is the elastic Hencky strain, ln V_e,
/// positive in tension; the law replaces it by the strain that remains elastic. `stress` receives
/// Kirchhoff's stress (Pa), positive in tension. `plastic_strain` is the volumetric plastic strain:
/// what the trace of `strain` loses must be added to it. `own` holds the law's own numbers,
/// `UserLaws::own_numbers` for each particle, number k of particle i at `own[k * count + i]`; they
/// begin with zero. `snow` has the index of each particle's snow.
///
/// With a time step of 0 the law must return the stress of the state that it is given, and change
/// nothing: so the grid is computed again from particles, for example after a checkpoint.
template <class T>
using ConstitutiveLaw = void (*)(std::int64_t count, T* strain, T* stress, T* plastic_strain,
                                 T* own, const std::uint8_t* snow, double time_step);

/// Largest number of a constitutive law's own numbers for each particle.
inline constexpr int max_own_numbers = 8;

/// Returns Coulomb's coefficient of a contact at a sliding speed (m/s) and a normal stress (Pa).
using FrictionLaw = double (*)(double speed, double normal_stress);

/// Finds the acceleration (m/s2) at `count` positions (m), in addition to gravity. In 2D, y is
/// zero, and ay has no effect.
using BodyForce = void (*)(std::int64_t count, const double* x, const double* y, const double* z,
                           double time, double* ax, double* ay, double* az);

/// Finds the pose of an obstacle at a time on the clock of the whole run (s): its translation (m),
/// its rotation about the origin before (a vector, rad), its velocity (m/s) and its angular
/// velocity (rad/s), three numbers each.
using MotionLaw = void (*)(double time, double* pose);

struct UserLaws {
  std::string name;              // in messages and checkpoints
  void* material = nullptr;      // a MaterialLaw; null: the law of the snow
  void* constitutive = nullptr;  // a ConstitutiveLaw, in place of the law and the elasticity
  int own_numbers = 0;           // numbers of the constitutive law for each particle
  BodyForce body_force = nullptr;
  std::map<std::string, FrictionLaw> friction;  // by the name of the obstacle
  std::map<std::string, MotionLaw> motion;      // by the name of the obstacle
  std::string digest;                           // digest of the functions' code; empty if unknown

  bool any() const {
    return material || constitutive || body_force || !friction.empty() || !motion.empty();
  }
};

}  // namespace snowshed::methods
