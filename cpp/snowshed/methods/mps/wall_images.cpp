#include "snowshed/methods/mps/wall_images.hpp"

#include <algorithm>
#include <cmath>

namespace snowshed::methods::mps {
namespace {

constexpr std::size_t particles_with_images = 256;
/// Minimum distance of a particle's image from a wall, in l0.
constexpr double min_image_distance = 0.1;

/// Another particle's contact with the same obstacle, or null.
template <int D>
const WallContact<D>* contact_with(const RowLists<WallContact<D>>& contacts, std::size_t k,
                                   std::uint32_t obstacle) {
  for (const WallContact<D>* c = contacts.begin(k); c < contacts.end(k); ++c)
    if (c->obstacle == obstacle) return c;
  return nullptr;
}

template <int D>
struct ImageMaker {
  const RowLists<WallContact<D>>& contacts;
  double reach, least;
  std::vector<WallImage<D>>& list;

  double height(const WallContact<D>& c) const { return std::max(c.distance, least); }

  float make(std::size_t k, const VecD<D>& separation, double r2, const WallContact<D>* a,
             const WallContact<D>* b, double shift_a, double shift_b) {
    if (r2 >= reach * reach) return 0;
    const float weight = float(reach / std::sqrt(r2) - 1);
    const std::uint32_t first = std::uint32_t(contacts.index_of(a));
    const std::uint32_t second = b ? std::uint32_t(contacts.index_of(b)) : first;
    VecD<D> to = separation - shift_a * a->normal;
    if (b) to -= shift_b * b->normal;
    list.push_back(
        {std::uint32_t(k), weight, float(weight / r2), to, {first, second}, {shift_a, shift_b}});
    return weight;
  }

  /// Makes all images of k; returns the sum of their weights.
  float make_all(std::size_t i, std::size_t k, const VecD<D>& separation) {
    float sum = 0;
    const double r2 = separation.squaredNorm();
    for (const WallContact<D>* a = contacts.begin(i); a < contacts.end(i); ++a) {
      const WallContact<D>* ka = contact_with(contacts, k, a->obstacle);
      if (!ka || ka->distance > ka->thickness) continue;
      const double with_a = r2 + 4 * height(*a) * height(*ka);
      sum += make(k, separation, with_a, a, nullptr, 2 * height(*ka), 0);
      for (const WallContact<D>* b = a + 1; b < contacts.end(i); ++b) {
        const WallContact<D>* kb = contact_with(contacts, k, b->obstacle);
        if (!kb || std::abs(a->normal.dot(b->normal)) > max_corner_cosine) continue;
        sum += make(k, separation, with_a + 4 * height(*b) * height(*kb), a, b, 2 * height(*ka),
                    2 * height(*kb));
      }
    }
    return sum;
  }
};

}  // namespace

template <int D>
void WallImages<D>::update(const particles::NeighbourLists<D>& lists,
                           const RowLists<WallContact<D>>& contacts, double reach, double spacing,
                           int threads, const AlignedVector<float>& direct,
                           AlignedVector<float>& weight) {
  weight.resize(lists.pairs());
  images_.update(lists.size(), particles_with_images, threads,
                 [&](std::size_t begin, std::size_t end, std::uint32_t* first,
                     std::vector<WallImage<D>>& list) {
                   ImageMaker<D> maker{contacts, reach, min_image_distance * spacing, list};
                   for (std::size_t i = begin; i < end; ++i) {
                     const std::size_t before = list.size();
                     const bool near = contacts.begin(i) < contacts.end(i);
                     if (near) maker.make_all(i, i, VecD<D>::Zero());
                     for (std::uint32_t e = lists.begin(i); e < lists.end(i); ++e) {
                       weight[e] = direct[e];
                       if (near)
                         weight[e] += maker.make_all(i, lists.neighbour(e), lists.separation(e));
                     }
                     first[i + 1] = std::uint32_t(list.size() - before);
                   }
                 });
}

template <int D>
void WallImages<D>::clear(std::size_t particles) {
  images_.update(particles, particles + 1, 1,
                 [](std::size_t, std::size_t, std::uint32_t*, std::vector<WallImage<D>>&) {});
}

template class WallImages<2>;
template class WallImages<3>;

}  // namespace snowshed::methods::mps
