#include "write_particles.hpp"

#include <openvdb/openvdb.h>
#include <openvdb/points/PointAttribute.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/tools/SignedFloodFill.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "snowshed/geometry/sampled_grid.hpp"
#include "snowshed/sampling/particle_voxels.hpp"
#include "snowshed/sampling/voxel_set.hpp"

namespace snowshed {
namespace {

using openvdb::Coord;
using openvdb::FloatGrid;

constexpr double half_band = 3;  // voxels, the default of OpenVDB's tools

openvdb::math::Transform::Ptr lattice(double spacing, const Vec3& origin) {
  auto transform = openvdb::math::Transform::createLinearTransform(spacing);
  transform->postTranslate({origin.x(), origin.y(), origin.z()});
  return transform;
}

/// Returns the signed distance to a section that is extruded to -width/2 <= y <= width/2, at a
/// point with the signed distance `d` to the section in the plane.
double extruded(double d, double y, double width) {
  const double outside = std::abs(y) - width / 2;
  return d > 0 && outside > 0 ? std::hypot(d, outside) : std::max(d, outside);
}

FloatGrid::Ptr surface_grid(const geometry::GridSamples& samples,
                            const VdbWriteSettings& settings) {
  const double band = half_band * samples.spacing;
  const bool flat = settings.dimension == 2;
  // In 2D the layers along y cover the strip and a margin; the middle one is at y = 0.
  const int side = flat ? int(std::ceil(settings.width / 2 / samples.spacing + half_band)) : 0;
  const int layers = flat ? 2 * side + 1 : int(samples.counts[1]);
  auto grid = FloatGrid::create(float(band));
  grid->setName("surface");
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  grid->setTransform(lattice(samples.spacing, samples.origin));
  auto nodes = grid->getAccessor();
  for (int i = 0; i < int(samples.counts[0]); ++i)
    for (int j = 0; j < layers; ++j)
      for (int k = 0; k < int(samples.counts[2]); ++k) {
        const std::size_t row = std::size_t(i) * samples.counts[1] + (flat ? 0 : std::size_t(j));
        double value = samples.values[row * samples.counts[2] + std::size_t(k)];
        if (flat) value = extruded(value, (j - side) * samples.spacing, settings.width);
        if (std::abs(value) < band) nodes.setValueOn(Coord(i, j - side, k), float(value));
      }
  openvdb::tools::signedFloodFill(grid->tree());
  return grid;
}

/// Linear weights of the two nodes on either side of a coordinate in units of the spacing.
struct LinearWeights {
  int low;
  double weight[2];
  explicit LinearWeights(double u) : low(int(std::floor(u))) {
    weight[1] = u - low;
    weight[0] = 1 - weight[1];
  }
};

/// Calls add(node, weight) for the eight nodes around `x`, in 2D (layers > 0) for four in each
/// layer.
template <class Add>
void scatter(const Vec3& x, double spacing, int layers, Add add) {
  const LinearWeights a(x.x() / spacing), b(x.y() / spacing), c(x.z() / spacing);
  for (int i = 0; i < 2; ++i)
    for (int k = 0; k < 2; ++k) {
      const double weight = a.weight[i] * c.weight[k];
      if (layers == 0) {
        for (int j = 0; j < 2; ++j)
          add(Coord(a.low + i, b.low + j, c.low + k), weight * b.weight[j]);
      } else {
        for (int j = 0; j < layers; ++j) add(Coord(a.low + i, j - layers / 2, c.low + k), weight);
      }
    }
}

FloatGrid::Ptr density_grid(const ParticleCloud& cloud, const VdbWriteSettings& settings) {
  const int layers =
      settings.dimension == 2 ? std::max(1, int(std::lround(settings.width / settings.voxel))) : 0;
  // The sums are in double precision, because in single precision each particle would lose mass.
  openvdb::DoubleGrid sums;
  auto nodes = sums.getAccessor();
  const double volume = std::pow(settings.voxel, settings.dimension);
  for (std::size_t n = 0; n < cloud.positions.size(); ++n)
    scatter(cloud.positions[n], settings.voxel, layers, [&](const Coord& at, double weight) {
      if (weight > 0) nodes.setValueOn(at, nodes.getValue(at) + weight * cloud.masses[n] / volume);
    });
  auto grid = FloatGrid::create(0.0f);
  grid->setName("density");
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  grid->setTransform(lattice(settings.voxel, Vec3::Zero()));
  auto out = grid->getAccessor();
  for (auto node = sums.cbeginValueOn(); node; ++node)
    out.setValueOn(node.getCoord(), float(node.getValue()));
  return grid;
}

/// Returns the name that Houdini expects for a quantity.
std::string attribute_name(const std::string& name) { return name == "velocity" ? "v" : name; }

using PointTree = openvdb::points::PointDataTree;
using PointIndex = openvdb::tools::PointIndexGrid;

template <class Value, class Component>
void add_attribute(PointTree& tree, const PointIndex& index, const std::string& name,
                   const std::vector<Component>& components) {
  constexpr std::size_t width = sizeof(Value) / sizeof(Component);
  std::vector<Value> values(components.size() / width);
  std::copy(components.begin(), components.end(), reinterpret_cast<Component*>(values.data()));
  using Attribute = openvdb::points::TypedAttributeArray<Value>;
  openvdb::points::appendAttribute(tree, name, Attribute::attributeType());
  openvdb::points::populateAttribute(tree, index.tree(), name,
                                     openvdb::points::PointAttributeVector<Value>(values));
}

void add_attribute(PointTree& tree, const PointIndex& index, const io::PointArray& array) {
  const std::string name = attribute_name(array.name);
  if (const auto* floats = std::get_if<std::vector<float>>(&array.values)) {
    if (array.components == 3)
      add_attribute<openvdb::Vec3f>(tree, index, name, *floats);
    else
      add_attribute<float>(tree, index, name, *floats);
  } else {
    add_attribute<std::int32_t>(tree, index, name,
                                std::get<std::vector<std::int32_t>>(array.values));
  }
}

openvdb::points::PointDataGrid::Ptr point_grid(const ParticleCloud& cloud,
                                               const VdbWriteSettings& settings) {
  std::vector<openvdb::Vec3f> positions;
  for (const Vec3& x : cloud.positions) positions.emplace_back(x.x(), x.y(), x.z());
  const openvdb::points::PointAttributeVector<openvdb::Vec3f> all(positions);
  const auto transform = lattice(settings.voxel, Vec3::Zero());
  const auto index = openvdb::tools::createPointIndexGrid<PointIndex>(all, *transform);
  auto grid =
      openvdb::points::createPointDataGrid<openvdb::points::NullCodec,
                                           openvdb::points::PointDataGrid>(*index, all, *transform);
  grid->setName("particles");
  for (const io::PointArray& array : cloud.attributes) add_attribute(grid->tree(), *index, array);
  openvdb::points::appendAttribute<float>(grid->tree(), "pscale", float(settings.radius));
  return grid;
}

}  // namespace

VdbSummary write_particles(const std::string& path, const ParticleCloud& cloud,
                           const VdbWriteSettings& settings) {
  geometry::GridSamples samples = sampling::particles_to_samples(
      cloud.positions, settings.dimension, settings.voxel, settings.radius);
  const FloatGrid::Ptr surface = surface_grid(samples, settings),
                       density = density_grid(cloud, settings);
  openvdb::io::File file(path);
  file.write(openvdb::GridCPtrVec{surface, density, point_grid(cloud, settings)});
  file.close();
  VdbSummary summary;
  summary.surface_voxels = surface->activeVoxelCount();
  summary.density_voxels = density->activeVoxelCount();
  // Measured like a body of a scene, so that a body made from the file has the same volume.
  summary.volume = sampling::measure(*geometry::make_sampled_grid(std::move(samples), "surface"),
                                     settings.dimension, settings.voxel) *
                   (settings.dimension == 2 ? settings.width : 1.0);
  for (auto node = density->cbeginValueOn(); node; ++node)
    summary.mass += node.getValue() * std::pow(settings.voxel, 3);
  return summary;
}

}  // namespace snowshed
