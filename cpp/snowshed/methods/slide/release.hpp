// The particles that a slide begins with.
#pragma once

#include <string>
#include <vector>

#include "snowshed/core/stop_request.hpp"
#include "snowshed/methods/method.hpp"
#include "snowshed/methods/slide/areas.hpp"
#include "snowshed/methods/slide/settings.hpp"

namespace snowshed::methods::slide {

/// Returns the nominal mass of a fresh particle, kg: the mass of a layer of `layer_thickness` over
/// one cell. A cell gets as many particles as its mass contains whole nominal masses.
double nominal_particle_mass(const Settings& settings, double cell);

/// Returns the distance on the map between neighbouring particles of a batch, m: the median over a
/// sample. 0 for a single particle.
double lattice_spacing(const ParticleBatch& batch);

/// Throws InputError if the release has so many particles or corners that setting it up takes more
/// than some seconds or a gigabyte.
void check_effort(const Settings& settings, const Terrain& terrain, const std::vector<Area>& areas);

/// An area, and its path in the scene.
struct NamedArea {
  const Area* area;
  std::string path;
};
std::vector<NamedArea> named_areas(const std::vector<Area>& areas, const std::string& list);

/// Throws InputError if a particle lies within the area `last` and an earlier one, because the
/// amount of snow there is not defined. Areas may touch.
void refuse_overlap(const Terrain& terrain, const std::vector<NamedArea>& areas, std::size_t last,
                    const ParticleBatch& batch);

/// Improved mode: the particles of one area; see `seed_release`. Errors name `path`.
ParticleBatch seed_polygon(const Settings& settings, const Terrain& terrain, const Area& area,
                           const std::string& path, const StopRequest& stop = {});

/// Compatible mode: the particles of areas with the given thickness at the nodes.
ParticleBatch seed_nodes(const Settings& settings, const Terrain& terrain,
                         const std::vector<Area>& areas, const std::vector<double>& thickness,
                         const std::string& path, const StopRequest& stop = {});

/// Returns the particles of all release areas, on triangular lattices, a batch for each area.
///
/// Improved mode: the lattice of each area begins at its centre and follows its mean slope, so the
/// result does not depend on the position of the grid. A layer thinner than `layer_thickness` has
/// one particle per cell. The mass is exactly that of the thickness over the sloping area.
///
/// Compatible mode: one lattice begins at the grid's origin. The mean slope of all areas decides
/// the number of particles per cell. The particles of a cell share its mass. All are in one batch.
///
/// Throws InputError if an area holds no particle, or, in compatible mode, is too thin for one.
///
/// Throws Stopped on request.
std::vector<ParticleBatch> seed_release(const Settings& settings, const Terrain& terrain,
                                        const std::vector<Area>& areas,
                                        const StopRequest& stop = {});

}  // namespace snowshed::methods::slide
