#include "snowshed/methods/slide/grid_fields.hpp"

#include <algorithm>
#include <cmath>

#include "snowshed/core/parallel.hpp"

namespace snowshed {
namespace {

/// Four values of a node, added at once.
typedef double Four __attribute__((vector_size(32), may_alias, aligned(8)));

void hand_on(double east, double north, const Four& carried, int columns,
             GridFields::Node* corner) {
  Four* south = reinterpret_cast<Four*>(corner);
  Four* above = south + columns;
  south[0] += (1 - east) * (1 - north) * carried;
  south[1] += east * (1 - north) * carried;
  above[0] += (1 - east) * north * carried;
  above[1] += east * north * carried;
}

}  // namespace

void GridFields::reserve(const Terrain& terrain) {
  nodes_.reserve((std::size_t(terrain.columns()) + 2) * (std::size_t(terrain.rows()) + 2));
}

void GridFields::update(const Terrain& terrain, const SlideParticles& particles,
                        const AlignedVector<double>& east, const AlignedVector<double>& north,
                        const CellLists& cells, double density, int threads) {
  first_column_ = cells.first_column();
  first_row_ = cells.first_row();
  columns_ = cells.columns();
  rows_ = cells.rows();
  nodes_.resize(std::size_t(columns_) * std::size_t(rows_));
  std::fill(nodes_.begin(), nodes_.end(), Node{0, 0, 0, 0});

  // A row of cells hands on to two rows of nodes: every other row at a time, so that no two threads
  // meet and the sums do not depend on how many there are.
  for (const int parity : {0, 1})
    parallel_pieces((rows_ + 1 - parity) / 2, threads, 1, [&](std::ptrdiff_t pair, std::ptrdiff_t) {
      const int row = int(2 * pair) + parity;
      for (int column = 0; column < columns_; ++column) {
        Node* corner = &nodes_[std::size_t(row) * std::size_t(columns_) + std::size_t(column)];
        for (std::uint32_t e = cells.begin(column, row); e < cells.begin(column + 1, row); ++e) {
          const std::uint32_t i = cells.particle(e);
          const double mass = particles.mass[i];
          const Four carried{mass, mass * particles.ux[i], mass * particles.uy[i],
                             mass * particles.uz[i]};
          hand_on(east[i], north[i], carried, columns_, corner);
        }
      }
    });

  parallel_pieces(rows_, threads, 1, [&](std::ptrdiff_t j, std::ptrdiff_t) {
    Node* row = &nodes_[std::size_t(j) * std::size_t(columns_)];
    for (int i = 0; i < columns_; ++i) {
      Node& n = row[i];
      if (!(n.thickness > 0)) continue;
      const double per_mass = 1 / n.thickness;
      n.vx *= per_mass;
      n.vy *= per_mass;
      n.vz *= per_mass;
      n.thickness /= terrain.node(first_column_ + i, first_row_ + int(j)).area * density;
    }
  });
}

/// Calls visit(node of the terrain, node) for the nodes that hold snow.
template <class Visit>
void GridFields::for_each_covered(const Terrain& terrain, Visit visit) const {
  for (int j = 0; j < rows_; ++j)
    for (int i = 0; i < columns_; ++i) {
      const Node& n = nodes_[std::size_t(j) * std::size_t(columns_) + std::size_t(i)];
      if (n.thickness > 0) visit(terrain.index(first_column_ + i, first_row_ + j), n);
    }
}

void GridFields::raise(PeakFields& peaks, const Terrain& terrain) const {
  for_each_covered(terrain, [&](std::size_t node, const Node& n) {
    peaks.thickness[node] = std::max(peaks.thickness[node], n.thickness);
    const double speed = std::sqrt(n.vx * n.vx + n.vy * n.vy + n.vz * n.vz);
    peaks.speed[node] = std::max(peaks.speed[node], speed);
  });
}

std::vector<double> GridFields::thickness_everywhere(const Terrain& terrain) const {
  std::vector<double> values(std::size_t(terrain.columns()) * std::size_t(terrain.rows()), 0.0);
  for_each_covered(terrain, [&](std::size_t node, const Node& n) { values[node] = n.thickness; });
  return values;
}

std::vector<double> GridFields::speed_everywhere(const Terrain& terrain) const {
  std::vector<double> values(std::size_t(terrain.columns()) * std::size_t(terrain.rows()), 0.0);
  for_each_covered(terrain, [&](std::size_t node, const Node& n) {
    values[node] = std::sqrt(n.vx * n.vx + n.vy * n.vy + n.vz * n.vz);
  });
  return values;
}

}  // namespace snowshed
