// The area of a wall's surface that each contact stands for.
#pragma once

#include <vector>

#include "snowshed/methods/mps/state.hpp"

namespace snowshed::methods::mps {

/// The area of each contact, m2 (in 2D m), in the order of the contacts. On a lattice it is the
/// particle's share of the wall times l0^(D-1). Where contacts crowd along the wall, or are sparse,
/// their areas shrink or grow so that they cover the surface once.
template <int D>
std::vector<double> contact_areas(const Model<D>&, const Particles<D>&, const Neighbourhood<D>&);

}  // namespace snowshed::methods::mps
