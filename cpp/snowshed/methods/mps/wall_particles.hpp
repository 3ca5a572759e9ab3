// Walls as particles that are fixed to an obstacle.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "snowshed/methods/mps/boundary.hpp"
#include "snowshed/methods/mps/particles.hpp"

namespace snowshed::methods::mps {

/// Wall particles of obstacles, made where snow comes near.
///
/// They lie in layers half a spacing, one and a half, ... below the surface. The first layer
/// consists of inner walls. The others consist of dummy walls, and are as many as fill the radius
/// of a particle at the surface (as published). Wall particles are the points of a lattice, moved
/// along the normal to the middle of their layer; the lattice follows the faces of boxes and
/// planes, so that these are covered evenly. On other surfaces, particles that are nearer than
/// `min_separation` push each other apart along the surface (ours). Obstacles thinner than a
/// particle have one layer, in the middle. Obstacles too thin for dummies between the inner walls
/// of both sides have dummies only, so that no pressure goes through them (ours).
template <int D>
class WallParticles {
 public:
  WallParticles() = default;
  /// `obstacles` must live as long as this. `reach` is the radius of the weight function, m.
  WallParticles(const std::vector<Obstacle>& obstacles, double spacing, double reach);

  /// Appends to the snow all wall particles within reach of the snow or of inner walls next to it.
  /// `period` as in CellOrder.
  void append_near(double time, double period, double mass, Particles<D>& snow);

  std::size_t bytes() const;

 private:
  using Cell = std::array<std::int32_t, D>;
  struct Hash {
    std::size_t operator()(const Cell& c) const;
  };
  struct Point {
    VecD<D> position, normal;  // m, in the frame of the group
    std::uint32_t obstacle;
    Kind kind;
  };
  using Points = std::vector<Point>;
  /// A point of a lattice, moved to the middle of its layer, if it lies in one.
  struct LayerPoint {
    bool exists = false;
    VecD<D> position;  // m
    double depth = 0;  // m, of the layer
  };
  /// The lattice from which the particles of an obstacle are made. Neighbouring cells need the same
  /// points, and each point evaluates a shape that may have many triangles.
  struct Lattice {
    Mat3 axes = Mat3::Identity();
    Vec3 origin = Vec3::Zero();
    std::unordered_map<Cell, LayerPoint, Hash> placed{};
  };
  /// Obstacles that do not move relative to each other, and the particles of all cells requested so
  /// far.
  struct Group {
    std::vector<std::uint32_t> obstacles;
    std::unordered_map<Cell, Points, Hash> made;
    std::unordered_map<Cell, bool, Hash> near;  // whether cells around have wall particles
  };

  const Points& points_in(Group&, const Cell&);
  bool is_near_wall(Group&, const Cell&);
  LayerPoint place(const geometry::LevelSet&, const Vec3& lattice_point) const;
  void make(std::uint32_t obstacle, const Cell&, Points&);
  void push_apart(const geometry::LevelSet&, std::vector<VecD<D>>& points,
                  const std::vector<double>& depth) const;
  void append_group(Group&, const geometry::RigidPose&, double period,
                    const std::vector<Cell>& snow_cells, double mass, Particles<D>& to);

  const std::vector<Obstacle>* obstacles_ = nullptr;
  double spacing_ = 0, edge_ = 0;
  int layers_ = 0;
  std::vector<Lattice> lattices_;  // one per obstacle
  std::vector<Group> groups_;      // the group at rest is the first
};

/// Removes the wall particles; the others keep their order.
template <int D>
void remove_walls(Particles<D>&);

}  // namespace snowshed::methods::mps
