#include "snowshed/methods/grains/clumps.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <unordered_map>

#include "snowshed/core/angles.hpp"
#include "snowshed/core/errors.hpp"

namespace snowshed::methods::grains {
namespace {

constexpr std::uint32_t no_sphere = std::numeric_limits<std::uint32_t>::max();

void check_image(const LabelImage& image) {
  std::size_t voxels = 1;
  for (const std::size_t n : image.size) {
    if (n == 0) throw InputError("labels", "the image is empty");
    if (n > std::size_t(no_sphere) / voxels)
      throw InputError("labels", "the image has more than 2^32 voxels");
    voxels *= n;
  }
  if (voxels != image.labels.size())
    throw InputError("labels", std::to_string(image.labels.size()) + " given for " +
                                   std::to_string(voxels) + " voxels");
  if (!(image.voxel_size > 0 && image.voxel_size < 1e3))
    throw InputError("voxel_size", "must be positive, and below 1000 m");
  for (const std::int32_t label : image.labels)
    if (label < 0)
      throw InputError("labels", std::to_string(label) + " is negative; 0 is air, grains are > 0");
}

/// Calls visit(voxel, i, j, k) for each voxel of ice, in the order of storage.
template <class Visit>
void for_each_ice(const LabelImage& image, const Visit& visit) {
  std::size_t voxel = 0;
  for (std::size_t k = 0; k < image.size[2]; ++k)
    for (std::size_t j = 0; j < image.size[1]; ++j)
      for (std::size_t i = 0; i < image.size[0]; ++i, ++voxel)
        if (image.labels[voxel] != 0) visit(voxel, i, j, k);
}

/// Whether a voxel shares a face with air or another grain. The outside of the image counts as air,
/// because plates and walls touch the grains there.
bool is_interface(const LabelImage& image, std::size_t i, std::size_t j, std::size_t k) {
  const std::int32_t own = image.at(i, j, k);
  const auto [nx, ny, nz] = image.size;
  if (i == 0 || j == 0 || k == 0 || i + 1 == nx || j + 1 == ny || k + 1 == nz) return true;
  return image.at(i - 1, j, k) != own || image.at(i + 1, j, k) != own ||
         image.at(i, j - 1, k) != own || image.at(i, j + 1, k) != own ||
         image.at(i, j, k - 1) != own || image.at(i, j, k + 1) != own;
}

/// Calls visit(voxel, neighbour) for each face that voxels of two grains share.
template <class Visit>
void for_each_bond(const LabelImage& image, const Visit& visit) {
  const auto [nx, ny, nz] = image.size;
  const std::size_t row = nx, layer = nx * ny;
  const auto meet = [&](std::size_t voxel, std::size_t other) {
    const std::int32_t label = image.labels[other];
    if (label != 0 && label != image.labels[voxel]) visit(voxel, other);
  };
  for_each_ice(
      image, [&, ny = ny, nz = nz](std::size_t voxel, std::size_t i, std::size_t j, std::size_t k) {
        if (i + 1 < row) meet(voxel, voxel + 1);
        if (j + 1 < ny) meet(voxel, voxel + row);
        if (k + 1 < nz) meet(voxel, voxel + layer);
      });
}

/// Index of the clump of each label. Clumps are in the order of their labels.
class ClumpOfLabel {
 public:
  explicit ClumpOfLabel(const LabelImage& image) {
    for_each_ice(image, [&](std::size_t voxel, std::size_t, std::size_t, std::size_t) {
      find(image.labels[voxel], true);
    });
    std::vector<std::int32_t> labels;
    labels.reserve(clumps_.size());
    for (const auto& [label, clump] : clumps_) labels.push_back(label);
    std::sort(labels.begin(), labels.end());
    for (std::uint32_t c = 0; c < labels.size(); ++c) clumps_[labels[c]] = c;
    last_label_ = 0;
  }

  std::size_t size() const { return clumps_.size(); }
  std::uint32_t operator()(std::int32_t label) { return find(label, false); }

 private:
  /// Remembers the last label, because consecutive voxels mostly have the same.
  std::uint32_t find(std::int32_t label, bool insert) {
    if (label == last_label_) return last_clump_;
    last_label_ = label;
    last_clump_ = insert ? clumps_.try_emplace(label, 0).first->second : clumps_.at(label);
    return last_clump_;
  }

  std::unordered_map<std::int32_t, std::uint32_t> clumps_;
  std::int32_t last_label_ = 0;  // air, which is not looked up
  std::uint32_t last_clump_ = 0;
};

Vec3 voxel_center(const LabelImage& image, std::size_t i, std::size_t j, std::size_t k) {
  return image.voxel_size * Vec3(double(i) + 0.5, double(j) + 0.5, double(k) + 0.5);
}

/// Finds volume, centre and inertia of each clump from its voxels, which are cubes.
void weigh(const LabelImage& image, ClumpOfLabel& clump_of, std::vector<Clump>& clumps) {
  const double side = image.voxel_size, volume = side * side * side;
  for_each_ice(image, [&](std::size_t voxel, std::size_t i, std::size_t j, std::size_t k) {
    Clump& c = clumps[clump_of(image.labels[voxel])];
    c.volume += volume;
    c.center += volume * voxel_center(image, i, j, k);
  });
  for (Clump& c : clumps) c.center /= c.volume;
  for_each_ice(image, [&](std::size_t voxel, std::size_t i, std::size_t j, std::size_t k) {
    Clump& c = clumps[clump_of(image.labels[voxel])];
    const Vec3 d = voxel_center(image, i, j, k) - c.center;
    c.inertia +=
        volume * ((d.squaredNorm() + side * side / 6) * Mat3::Identity() - d * d.transpose());
  });
}

}  // namespace

SampleSize measure_sample(const LabelImage& image) {
  check_image(image);
  SampleSize size;
  size.grains = ClumpOfLabel(image).size();
  for_each_ice(image, [&](std::size_t, std::size_t i, std::size_t j, std::size_t k) {
    size.spheres += is_interface(image, i, j, k);
  });
  for_each_bond(image, [&](std::size_t, std::size_t) { ++size.bonds; });
  // Measured memory of the solver, with the second list of pairs that exists during a search.
  size.bytes = 160 * size.spheres + 450 * size.bonds + 1500 * size.grains;
  return size;
}

void check_grain_diameter(double median) {
  if (median >= min_grain_diameter && median <= max_grain_diameter) return;
  char text[200];
  std::snprintf(text, sizeof text,
                "wrongly scaled: its grains measure %.3g m; those of snow measure %g to %g m; is "
                "the voxel size in m?",
                median, min_grain_diameter, max_grain_diameter);
  throw InputError("", text);
}

double median_diameter(const Sample& sample) {
  std::vector<double> volumes;
  for (const Clump& c : sample.clumps) volumes.push_back(c.volume);
  const auto middle = volumes.begin() + std::ptrdiff_t(volumes.size() / 2);
  std::nth_element(volumes.begin(), middle, volumes.end());
  return std::cbrt(6 / pi * *middle);
}

Sample make_sample(const LabelImage& image) {
  check_image(image);
  ClumpOfLabel clump_of(image);
  if (clump_of.size() == 0) throw InputError("labels", "no grain: all voxels are air");
  Sample sample;
  sample.radius = 0.5 * image.voxel_size;
  sample.box =
      image.voxel_size * Vec3(double(image.size[0]), double(image.size[1]), double(image.size[2]));
  sample.clumps.resize(clump_of.size());
  weigh(image, clump_of, sample.clumps);

  std::uint32_t spheres = 0;
  for_each_ice(image, [&](std::size_t voxel, std::size_t i, std::size_t j, std::size_t k) {
    if (is_interface(image, i, j, k)) ++sample.clumps[clump_of(image.labels[voxel])].spheres;
  });
  for (Clump& c : sample.clumps) {
    c.first_sphere = spheres;
    spheres += c.spheres;
  }
  sample.spheres.resize(spheres);
  std::vector<std::uint32_t> next(sample.clumps.size());
  for (std::size_t c = 0; c < next.size(); ++c) next[c] = sample.clumps[c].first_sphere;
  std::vector<std::uint32_t> sphere_at(image.labels.size(), no_sphere);
  for_each_ice(image, [&](std::size_t voxel, std::size_t i, std::size_t j, std::size_t k) {
    if (!is_interface(image, i, j, k)) return;
    sphere_at[voxel] = next[clump_of(image.labels[voxel])]++;
    sample.spheres[sphere_at[voxel]] = voxel_center(image, i, j, k);
  });
  std::size_t bonds = 0;
  for_each_bond(image, [&](std::size_t, std::size_t) { ++bonds; });
  sample.bonds.reserve(bonds);
  for_each_bond(image, [&](std::size_t voxel, std::size_t other) {
    sample.bonds.push_back({sphere_at[voxel], sphere_at[other]});
  });
  return sample;
}

}  // namespace snowshed::methods::grains
