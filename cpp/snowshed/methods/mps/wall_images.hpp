// Walls as mirrors: images of a particle and of its neighbours in them.
#pragma once

#include "snowshed/methods/mps/boundary.hpp"
#include "snowshed/methods/mps/kernel_function.hpp"
#include "snowshed/particles/neighbour_lists.hpp"

namespace snowshed::methods::mps {

/// Two walls make a corner, with images behind both, if the cosine between their normals is at most
/// this.
inline constexpr double max_corner_cosine = 0.7;

/// The image of particle k behind a wall, or behind two at once in a corner, for particle i. Its
/// distance is r'^2 = r^2 + 4 h_i h_k with the distances h from the wall. This is exact for plane
/// walls. It is also used for curved walls, because it keeps the distance symmetric in i and k.
template <int D>
struct WallImage {
  std::uint32_t neighbour;   // k, which may be i itself
  float weight, slope;       // w, and w/r'^2 in 1/m2
  VecD<D> separation;        // from i to the image, m
  std::uint32_t contact[2];  // indices of i's contacts; equal if there is one wall
  double mirror_shift[2];    // twice the distance of k from each wall, m; 0 without a second wall
};

template <int D>
class WallImages {
 public:
  /// Makes the images. Sets `weight` of each pair to the sum of the weights of the neighbour and of
  /// its images.
  void update(const particles::NeighbourLists<D>& lists, const RowLists<WallContact<D>>& contacts,
              double reach, double spacing, int threads, const AlignedVector<float>& direct,
              AlignedVector<float>& weight);

  /// Makes no images.
  void clear(std::size_t particles);

  const WallImage<D>* begin(std::size_t i) const { return images_.begin(i); }
  const WallImage<D>* end(std::size_t i) const { return images_.end(i); }
  std::size_t bytes() const { return images_.bytes(); }

 private:
  RowLists<WallImage<D>> images_;
};

}  // namespace snowshed::methods::mps
