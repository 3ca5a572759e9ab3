// The snow slide: depth-averaged particles with cohesive bonds on terrain (AvaFrame's
// com5SnowSlide; Tonnel et al. 2023, doi:10.5194/gmd-16-7013-2023, for its solver com1DFA).
#pragma once

#include <memory>
#include <vector>

#include "snowshed/geometry/height_field.hpp"
#include "snowshed/methods/capabilities.hpp"
#include "snowshed/methods/slide/areas.hpp"
#include "snowshed/methods/slide/settings.hpp"
#include "snowshed/methods/slide/state.hpp"

namespace snowshed::methods::slide {

struct Options {
  Settings settings;
  double gravity = 9.81;          // m/s2, along -z
  geometry::HeightField terrain;  // on the computing grid
  Areas areas;                    // from the terrain's south-west node
  bool energy = false;            // whether to keep the energy balance
};

/// A slide as a method, with its own additions. `seed` returns the particles of the release areas
/// (`seed_release`).
class Solver : public Method, public SeedsItself, public KeepsEnergy, public ReportsRun {
 public:
  /// Number of particles that `seed` returns, and of those that come later.
  virtual std::size_t count_seeds() const = 0;
  virtual const Terrain& terrain() const = 0;
  virtual const PeakFields& peaks() const = 0;
  virtual const GridFields& flow() const = 0;
  virtual const Bonds& bonds() const = 0;
  virtual std::int64_t bonds_made() const = 0;
  virtual const MassBalance& mass_balance() const = 0;
  virtual std::vector<LateReleaseFact> late_releases() const = 0;
  virtual std::vector<DamFact> dams() const = 0;
  /// The ground that adapts to the snow; null if it does not. `terrain` is the first ground.
  virtual const ChangingGround* ground() const = 0;
  /// Number of bonds of snow that became ground.
  virtual std::int64_t bonds_in_ground() const = 0;
};

/// Throws InputError if a release area reaches beyond the terrain or into a hole of it, or makes
/// too many particles.
std::unique_ptr<Solver> make_solver(Options);

}  // namespace snowshed::methods::slide
