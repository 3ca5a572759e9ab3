#include "snowshed/methods/slide/grid_fields.hpp"

#include <algorithm>
#include <cmath>

#include "snowshed/core/parallel.hpp"

namespace snowshed {
namespace {

void hand_on(const GridPlace& p, double mass, double ux, double uy, double uz, int columns,
             GridFields::Node* corner) {
  const double weights[4] = {(1 - p.east) * (1 - p.north), p.east * (1 - p.north),
                             (1 - p.east) * p.north, p.east * p.north};
  GridFields::Node* nodes[4] = {corner, corner + 1, corner + columns, corner + columns + 1};
  for (int i = 0; i < 4; ++i) {
    const double share = mass * weights[i];
    nodes[i]->thickness += share;
    nodes[i]->vx += share * ux;
    nodes[i]->vy += share * uy;
    nodes[i]->vz += share * uz;
  }
}

}  // namespace

void GridFields::reserve(const Terrain& terrain) {
  nodes_.reserve((std::size_t(terrain.columns()) + 2) * (std::size_t(terrain.rows()) + 2));
}

void GridFields::update(const Terrain& terrain, const SlideParticles& particles,
                        const std::vector<GridPlace>& places, const CellLists& cells,
                        double density, int threads) {
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
      for (std::uint32_t e = cells.begin(0, row); e < cells.begin(columns_, row); ++e) {
        const std::uint32_t i = cells.particle(e);
        const GridPlace& p = places[i];
        hand_on(p, particles.mass[i], particles.ux[i], particles.uy[i], particles.uz[i], columns_,
                &nodes_[local(p.column, p.row)]);
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
