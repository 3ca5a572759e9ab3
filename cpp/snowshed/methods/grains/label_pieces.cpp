#include "snowshed/methods/grains/label_pieces.hpp"

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "snowshed/core/errors.hpp"

namespace snowshed::methods::grains {
namespace {

/// Disjoint sets of voxels. The first voxel in the order of storage identifies a set.
class VoxelSets {
 public:
  explicit VoxelSets(std::size_t voxels) : first_(voxels) {
    for (std::size_t v = 0; v < voxels; ++v) first_[v] = std::uint32_t(v);
  }

  std::uint32_t find(std::uint32_t voxel) {
    while (first_[voxel] != voxel) voxel = first_[voxel] = first_[first_[voxel]];
    return voxel;
  }

  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    if (a < b) first_[b] = a;
    if (b < a) first_[a] = b;
  }

 private:
  std::vector<std::uint32_t> first_;
};

/// The pieces of the labels. Images have fewer than 2^32 voxels.
VoxelSets find_pieces(const LabelImage& image) {
  const auto [nx, ny, nz] = image.size;
  VoxelSets pieces(image.labels.size());
  std::size_t voxel = 0;
  for (std::size_t k = 0; k < nz; ++k)
    for (std::size_t j = 0; j < ny; ++j)
      for (std::size_t i = 0; i < nx; ++i, ++voxel) {
        const std::int32_t own = image.labels[voxel];
        if (own == 0) continue;
        for (int n = 0; n < 13; ++n) {  // the 13 neighbours that come before
          const int dx = n % 3 - 1, dy = n / 3 % 3 - 1, dz = n / 9 - 1;
          if ((dz < 0 && k == 0) || (dy < 0 && j == 0) || (dy > 0 && j + 1 == ny) ||
              (dx < 0 && i == 0) || (dx > 0 && i + 1 == nx))
            continue;
          const std::ptrdiff_t step = (dz * std::ptrdiff_t(ny) + dy) * std::ptrdiff_t(nx) + dx;
          const auto other = std::size_t(std::ptrdiff_t(voxel) + step);
          if (image.labels[other] == own) pieces.join(std::uint32_t(voxel), std::uint32_t(other));
        }
      }
  return pieces;
}

}  // namespace

LabelPieces count_pieces(const LabelImage& image) {
  VoxelSets pieces = find_pieces(image);
  std::unordered_map<std::int32_t, std::size_t> pieces_of;
  LabelPieces counts;
  for (std::size_t v = 0; v < image.labels.size(); ++v) {
    if (image.labels[v] == 0) continue;
    ++counts.voxels;
    if (pieces.find(std::uint32_t(v)) != v) continue;
    ++counts.pieces;
    if (++pieces_of[image.labels[v]] == 2) ++counts.scattered;
  }
  counts.labels = pieces_of.size();
  return counts;
}

void check_labels(const LabelPieces& counts) {
  // Grey values have more pieces per label, and smaller ones (voxels).
  constexpr std::size_t min_piece = 8, pieces_per_label = 10;
  if (counts.pieces <= pieces_per_label * counts.labels ||
      counts.voxels >= min_piece * counts.pieces)
    return;
  throw InputError("", "not a label image: its " + std::to_string(counts.labels) + " values form " +
                           std::to_string(counts.pieces) +
                           " pieces of a few voxels each, as grey values do; find the grains of an "
                           "image with `snowshed grains segment`");
}

std::string label_note(const LabelPieces& counts, bool split) {
  if (counts.scattered > 0) {
    const std::string lie = std::to_string(counts.scattered) + " of " +
                            std::to_string(counts.labels) + " labels lie in several places, " +
                            std::to_string(counts.pieces) + " pieces in all: ";
    return lie + (split ? "each piece is a grain"
                        : "each label is one rigid grain, however far apart its pieces lie. "
                          "--split-labels (sample.split_labels) makes each piece a grain");
  }
  if (counts.labels == 1)
    return "all ice has the same label, so it is one rigid grain; `snowshed grains segment` finds "
           "the grains of an image";
  return "";
}

void split_pieces(LabelImage& image) {
  VoxelSets pieces = find_pieces(image);
  std::int32_t next = 0;
  for (std::size_t v = 0; v < image.labels.size(); ++v) {
    if (image.labels[v] == 0) continue;
    const std::size_t first = pieces.find(std::uint32_t(v));
    image.labels[v] = first == v ? ++next : image.labels[first];
  }
}

}  // namespace snowshed::methods::grains
