// Makes rigid clumps of spheres from a segmented image.
#pragma once

#include <cstdint>
#include <vector>

#include "snowshed/core/vec.hpp"
#include "snowshed/methods/grains/label_image.hpp"
#include "snowshed/methods/grains/label_pieces.hpp"

namespace snowshed::methods::grains {

/// A grain: a rigid body with spheres on its surface. The clump has the spheres of Sample from
/// `first_sphere` on.
struct Clump {
  Vec3 center = Vec3::Zero();   // m, of mass
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

/// Size of the sample that an image would become.
struct SampleSize {
  std::size_t grains = 0, spheres = 0, bonds = 0, bytes = 0;
};
SampleSize measure_sample(const LabelImage&);

/// Diameters of grains of snow, m: no grain of real snow is smaller or larger.
inline constexpr double min_grain_diameter = 2e-5, max_grain_diameter = 1e-2;

/// Throws InputError unless the median diameter of grains, m, is possible for snow. It is not if
/// the voxel size is given in a unit other than metres.
void check_grain_diameter(double median);

/// The median of the grains' equivalent diameters, m: diameters of spheres with the same volumes.
double median_diameter(const Sample&);

/// Makes the sample of an image. Every voxel that shares a face with air or another grain becomes a
/// sphere of the voxel's size and centre. Bonds join voxels of two grains that share a face. Mass
/// and inertia are those of all voxels of a grain. Throws InputError if there is no grain.
Sample make_sample(const LabelImage&);

}  // namespace snowshed::methods::grains
