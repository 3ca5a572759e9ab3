// Grains: discrete elements of snow, rigid clumps of spheres with bonds that break (Hagenmuller,
// Chambon and Naaim 2015, doi:10.5194/tc-9-1969-2015).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "snowshed/core/vec.hpp"
#include "snowshed/methods/capabilities.hpp"
#include "snowshed/methods/grains/clumps.hpp"
#include "snowshed/methods/grains/settings.hpp"
#include "snowshed/methods/scene_parts.hpp"

namespace snowshed::methods::grains {

struct Options {
  Settings settings;
  double gravity = 9.81;  // m/s2, along -z
  Sample sample;          // clumps, bonds between them, and their box
  std::vector<LoadingStage> loading;
  Cone cone;
  bool energy = false;  // whether to keep the energy balance
};

/// Instantaneous strains and stresses. Stresses are forces over the initial area, positive in
/// compression.
struct LoadingStresses {
  double axial_strain = 0;  // shortening over the initial height, since the beginning
  double shear_strain = 0;
  double top_stress = 0, bottom_stress = 0;  // Pa, along z
  double side_stress = 0;                    // Pa, mean over the four sides
  double shear_stress = 0;                   // Pa, of the top plate along x
  double cone_force = 0;                     // N
};

/// Present measurements of a loading test.
struct LoadingMeasures : LoadingStresses {
  int stage = 0;           // stage being loaded; the number of stages when all are done
  double strain = 0;       // strain of this stage: displacement over the initial height
  std::int64_t bonds = 0;  // bonded pairs of spheres
  std::int64_t broken_in_tension = 0, broken_in_shear = 0;
  std::int64_t contacts = 0;  // pairs of spheres that touch
  double coordination = 0;    // mean number of grains that a grain touches
  double solid_fraction = 0;  // ice over the volume between the plates
};

/// A contact between two grains: the sum over its pairs of spheres.
struct GrainContact {
  std::uint32_t first, second;  // grains
  Vec3 point, force;            // m; N, on the first
  bool bonded;
};

/// Grains as a method, with their own additions. The particles are the grains. `seed` returns the
/// grains of the sample, at rest, and `add` takes only these.
class Solver : public Method, public SeedsItself, public KeepsEnergy, public HasCurve {
 public:
  virtual std::size_t count_spheres() const = 0;
  virtual std::int64_t pair_searches() const = 0;  ///< since the method was made
  virtual LoadingMeasures measures() const = 0;
  virtual LoadingStresses stresses() const = 0;                  ///< a cheap part of measures()
  virtual int stage() const = 0;                                 ///< measures().stage, cheaply
  virtual std::vector<GrainContact> grain_contacts() const = 0;  ///< ordered by grains
  virtual std::vector<Vec3> sphere_positions() const = 0;        ///< m, in the order of the sample
  virtual std::vector<std::uint32_t> sphere_grains() const = 0;
};

/// Throws InputError if settings, sample and loading do not fit each other.
std::unique_ptr<Solver> make_solver(Options);

}  // namespace snowshed::methods::grains
