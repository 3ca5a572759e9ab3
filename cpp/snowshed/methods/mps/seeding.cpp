#include "snowshed/methods/mps/seeding.hpp"

#include <cmath>
#include <utility>

#include "snowshed/core/message_format.hpp"
#include "snowshed/sampling/lattice.hpp"

namespace snowshed::methods::mps {
namespace {

std::string in_millimetres(double metres) { return show_rounded(1000 * metres) + " mm"; }

/// Adds a note on a body that is too small for a lattice of particles of equal mass.
void note_coarse_lattice(const geometry::LevelSet& shape, const Settings& settings,
                         double mass_ratio, std::size_t particles,
                         std::vector<std::string>& notes) {
  constexpr double max_unevenness = 0.02;
  const double thickness = 2 * shape.inradius();
  const std::string count =
      std::to_string(particles) + (particles == 1 ? " particle" : " particles");
  if (thickness < settings.spacing * (1 - 1e-6))
    notes.push_back("is " + in_millimetres(thickness) + " thick, less than the spacing of " +
                    in_millimetres(settings.spacing) + ": it becomes " + count +
                    " that fill no layer, and neither pressure nor yield stress are resolved; "
                    "give a smaller /numerics/spacing");
  else if (std::abs(mass_ratio - 1) > max_unevenness)
    notes.push_back("becomes " + count + " of " + show_rounded(mass_ratio) +
                    " times the mass that a cell of the spacing holds, so that its mass is right; "
                    "give a smaller /numerics/spacing");
}

}  // namespace

void seed_on_lattice(const Settings& s, const geometry::LevelSet& shape, int dimension,
                     const StopRequest& stop, ParticleBatch& batch,
                     std::vector<std::string>& notes) {
  sampling::LatticeFilling filling = sampling::fill_lattice(shape, dimension, s.spacing, stop);
  const std::size_t count = filling.positions.size();
  batch.positions = std::move(filling.positions);
  batch.mass = s.density * filling.volume / double(count);
  const double cell = std::pow(s.spacing, dimension);
  note_coarse_lattice(shape, s, filling.volume / (cell * double(count)), count, notes);
}

}  // namespace snowshed::methods::mps
