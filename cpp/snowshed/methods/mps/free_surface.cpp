// The layers below the free surface.
#include <algorithm>

#include "snowshed/methods/mps/forces.hpp"

namespace snowshed::methods::mps {
namespace {

/// The first moment that particle i lacks towards the particles at the surface, m.
template <int D>
double open_moment(const Neighbourhood<D>& near, std::size_t i) {
  VecD<D> side = VecD<D>::Zero(), outwards = VecD<D>::Zero();
  const auto add = [&](std::size_t j, double weight, const VecD<D>& separation) {
    side += weight * separation;
    if (near.surface[j]) outwards += weight * separation;
  };
  for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e)
    if (const std::size_t j = near.lists.neighbour(e); !near.dry[j])
      add(j, double(near.weight[e]), near.separation(e));
  for (const WallImage<D>* m = near.images.begin(i); m < near.images.end(i); ++m)
    add(m->neighbour, double(m->weight), m->separation);
  return std::max(0.0, -side.dot(outwards.stableNormalized()));
}

}  // namespace

template <int D>
void find_open_moments(const Model<D>& model, const Particles<D>& particles,
                       Neighbourhood<D>& near) {
  for_each_particle(particles.size(), model.threads_for(particles.size()), [&](std::size_t i) {
    if (near.below_surface[i] && !near.surface[i] && particles.kind[i] != Kind::dummy_wall)
      near.open_moment[i] = open_moment(near, i);
  });
}

template void find_open_moments(const Model<2>&, const Particles<2>&, Neighbourhood<2>&);
template void find_open_moments(const Model<3>&, const Particles<3>&, Neighbourhood<3>&);

}  // namespace snowshed::methods::mps
