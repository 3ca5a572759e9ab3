// The particles that a slide begins with.
#pragma once

#include <vector>

#include "snowshed/methods/method.hpp"
#include "snowshed/methods/slide/areas.hpp"
#include "snowshed/methods/slide/settings.hpp"

namespace snowshed {

/// The mass that a fresh particle has at most, kg: that of a layer of the given thickness over a
/// cell.
double mass_per_particle(const SlideSettings& settings, double cell);

/// The distance from a particle of a batch to the nearest other one, m, as seen from above; the
/// median of a sample. 0 for a single particle.
double lattice_spacing(const ParticleBatch& batch);

/// Returns the particles of all release areas, on triangular lattices, a batch for each area.
///
/// Improved mode: the lattice of each area begins at its centre and follows its mean slope, so
/// that the result does not depend on how the grid lies; a layer thinner than a particle's has
/// one particle a cell; the mass is exactly that of the thickness over the sloping area. Compatible
/// mode: one lattice from the grid's origin, so many particles a cell as the mean slope of all
/// areas asks for, each with its share of its cell's mass, all in one batch.
///
/// Throws InputError where an area holds no particle, or, in compatible mode, is too thin for one.
std::vector<ParticleBatch> seed_release(const SlideSettings& settings, const Terrain& terrain,
                                        const std::vector<SlideArea>& areas);

}  // namespace snowshed
