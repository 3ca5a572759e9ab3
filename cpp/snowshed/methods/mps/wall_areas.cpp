#include "snowshed/methods/mps/wall_areas.hpp"

#include <cmath>

#include "snowshed/methods/mps/kernel_function.hpp"
#include "snowshed/methods/mps/wall_images.hpp"

namespace snowshed::methods::mps {
namespace {

/// Contacts of an obstacle lie on the same face if the cosine between their normals is at least
/// this.
constexpr double min_face_cosine = 0.5;

double tangential_weight(const KernelConstants& k, double distance) {
  return filling_weight(kernel_weight(distance, k.radius));
}

/// Sum of the weights over the contacts of a lattice.
double lattice_cover(int dimension, const KernelConstants& k) {
  const int reach = int(std::ceil(k.radius)), across = dimension == 3 ? reach : 0;
  double sum = 0;
  for (int y = -across; y <= across; ++y)
    for (int x = -reach; x <= reach; ++x)
      sum += tangential_weight(k, std::sqrt(double(x * x + y * y)));
  return sum;
}

/// A measure of the areas around a contact's foot.
template <int D>
struct Cover {
  const Model<D>& model;
  const RowLists<WallContact<D>>& contacts;
  const std::vector<double>& areas;
  const WallContact<D>& at;

  double weight(const VecD<D>& separation) const {
    const VecD<D> along = separation - separation.dot(at.normal) * at.normal;
    return tangential_weight(model.kernel, along.norm() / model.settings().spacing);
  }

  /// The contacts of particle j with the same face, and their images behind the walls of a corner,
  /// where the surface ends but the pressure does not.
  double of(std::size_t j, const VecD<D>& separation) const {
    double sum = 0;
    for (const WallContact<D>* c = contacts.begin(j); c < contacts.end(j); ++c) {
      if (c->obstacle != at.obstacle || c->normal.dot(at.normal) < min_face_cosine) continue;
      double weights = weight(separation);
      for (const WallContact<D>* b = contacts.begin(j); b < contacts.end(j); ++b)
        if (b->obstacle != at.obstacle && std::abs(b->normal.dot(at.normal)) <= max_corner_cosine)
          weights += weight(separation - 2 * b->distance * b->normal);
      sum += areas[contacts.index_of(c)] * weights;
    }
    return sum;
  }
};

}  // namespace

template <int D>
std::vector<double> contact_areas(const Model<D>& model, const Particles<D>& p,
                                  const Neighbourhood<D>& near) {
  const RowLists<WallContact<D>>& contacts = near.contacts;
  const Settings& s = model.settings();
  std::vector<double> shares(contacts.all().size());
  for (std::size_t i = 0; i < p.size(); ++i)
    for (const WallContact<D>* c = contacts.begin(i); c < contacts.end(i); ++c)
      shares[contacts.index_of(c)] = share_of_wall(c->distance / s.spacing, model.second_layer) *
                                     p.mass[i] / (s.density * s.spacing);
  const double on_lattice = lattice_cover(D, model.kernel) * std::pow(s.spacing, D - 1);
  std::vector<double> areas = shares;
  for_each_particle(p.size(), model.threads_for(p.size()), [&](std::size_t i) {
    for (const WallContact<D>* c = contacts.begin(i); c < contacts.end(i); ++c) {
      double& area = areas[contacts.index_of(c)];
      if (!(area > 0)) continue;
      const Cover<D> cover{model, contacts, shares, *c};
      double sum = cover.of(i, VecD<D>::Zero());
      for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e)
        sum += cover.of(near.lists.neighbour(e), near.separation(e));
      const double crowding = sum / on_lattice;
      // The wet part of a wall ends at the free surface, so that sparse contacts there are no gap.
      if (crowding > 1 || !near.below_surface[i]) area /= crowding;
    }
  });
  return areas;
}

template std::vector<double> contact_areas(const Model<2>&, const Particles<2>&,
                                           const Neighbourhood<2>&);
template std::vector<double> contact_areas(const Model<3>&, const Particles<3>&,
                                           const Neighbourhood<3>&);

}  // namespace snowshed::methods::mps
