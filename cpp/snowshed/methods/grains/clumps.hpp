// From a segmented image to rigid clumps of spheres.
#pragma once

#include <cstdint>
#include <vector>

#include "snowshed/core/vec.hpp"
#include "snowshed/methods/grains/label_image.hpp"
#include "snowshed/methods/grains/label_pieces.hpp"

namespace snowshed::grains {

/// A grain: a rigid body with spheres on its surface. Spheres are those of Sample from
/// `first_sphere` on.
struct Clump {
  Vec3 centre = Vec3::Zero();   // m, of mass
  double volume = 0;            // m3, of all its voxels
  Mat3 inertia = Mat3::Zero();  // m5, over density, about the centre, in space
  std::uint32_t first_sphere = 0, spheres = 0;
};

/// A pair of spheres of two grains that are bonded.
struct BondedPair {
  std::uint32_t first, second;
};

/// Clumps in a box that begins at the origin.
struct Sample {
  Vec3 box = Vec3::Zero();  // m
  double radius = 0;        // m, of all spheres
  std::vector<Clump> clumps;
  std::vector<Vec3> spheres;  // m, centres in space
  std::vector<BondedPair> bonds;
  LabelPieces pieces;  // pieces in the image, if they were counted
};

/// Size of the sample of an image, known before it is made.
struct SampleSize {
  std::size_t grains = 0, spheres = 0, bonds = 0, bytes = 0;
};
SampleSize measure_sample(const LabelImage&);

/// Diameters of grains of snow, m: no grain of real snow is smaller or larger.
inline constexpr double min_grain_diameter = 2e-5, max_grain_diameter = 1e-2;

/// Throws InputError unless the median diameter of grains, m, is that of snow. It is not if the
/// voxel size is in another unit than metres.
void check_grain_diameter(double median);

/// The median over the grains of the diameter of spheres with their volumes, m.
double median_diameter(const Sample&);

/// Every voxel at an interface, with air or another grain, becomes a sphere of the voxel's size
/// with the voxel's centre; bonds join voxels of two grains that share a face. Mass and inertia are
/// those of all voxels of a grain. Throws InputError without a grain.
Sample make_sample(const LabelImage&);

}  // namespace snowshed::grains
