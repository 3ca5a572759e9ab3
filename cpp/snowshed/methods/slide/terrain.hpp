// The ground that snow slides on, with the values for interpolation at each node.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "snowshed/core/vec.hpp"
#include "snowshed/geometry/height_field.hpp"

namespace snowshed::methods::slide {

/// Slopes at the first row and column of the grid. AvaFrame 2.1 takes these nodes as level.
enum class BorderSlope { one_sided, level_in_the_south_west };

/// Columns and rows of a grid's nodes, the last ones included.
struct NodeRectangle {
  int first_column = 0, first_row = 0, last_column = -1, last_row = -1;

  bool empty() const { return last_column < first_column || last_row < first_row; }
  void include(int column, int row) {
    if (empty()) {
      *this = {column, row, column, row};
      return;
    }
    first_column = std::min(first_column, column);
    first_row = std::min(first_row, row);
    last_column = std::max(last_column, column);
    last_row = std::max(last_row, row);
  }
  /// Calls visit(column, row) for each node.
  template <class Visit>
  void for_each(Visit visit) const {
    for (int row = first_row; row <= last_row; ++row)
      for (int column = first_column; column <= last_column; ++column) visit(column, row);
  }
};

/// Elevations, slopes and areas at the nodes of a grid. Positions are given from its south-west
/// node. Vectors and scalars are bilinear between the nodes of a cell.
class Terrain {
 public:
  struct Node {
    double height;            // m; NaN if nothing is known
    double slope_x, slope_y;  // the normal is (slope_x, slope_y, 1), not normalised
    double area;              // m2, of the ground within half a cell of the node
  };

  explicit Terrain(const geometry::HeightField& field, BorderSlope border = BorderSlope::one_sided);

  /// Sets the heights of the nodes in a rectangle to those of `first` plus a rise (m), and the
  /// slopes and areas that follow from them.
  void set_rise(const Terrain& first, const std::vector<double>& rise, const NodeRectangle& where);

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  double cell() const { return cell_; }
  double west() const { return west_; }
  double south() const { return south_; }
  std::size_t index(int column, int row) const {
    return std::size_t(row) * std::size_t(columns_) + std::size_t(column);
  }
  const Node& node(int column, int row) const { return nodes_[index(column, row)]; }
  const Node* nodes() const { return nodes_.data(); }

  /// The position of a point in the grid; outside if it lies beyond the last nodes.
  geometry::CellPosition cell_position(double x, double y) const {
    return geometry::find_cell(x * per_cell_, y * per_cell_, columns_, rows_);
  }

  /// Whether the south-west node of a cell is known.
  bool known(const geometry::CellPosition& p) const {
    return !std::isnan(node(p.column, p.row).height);
  }

  double height(const geometry::CellPosition& p) const {
    const Node* a = &nodes_[index(p.column, p.row)];
    const Node* b = a + columns_;
    const double w0 = (1 - p.east) * (1 - p.north), w1 = p.east * (1 - p.north),
                 w2 = (1 - p.east) * p.north, w3 = p.east * p.north;
    return w0 * a[0].height + w1 * a[1].height + w2 * b[0].height + w3 * b[1].height;
  }

  /// The upward unit normal.
  Vec3 normal(const geometry::CellPosition& p) const {
    const Node* a = &nodes_[index(p.column, p.row)];
    const Node* b = a + columns_;
    const double w0 = (1 - p.east) * (1 - p.north), w1 = p.east * (1 - p.north),
                 w2 = (1 - p.east) * p.north, w3 = p.east * p.north;
    return upward(w0 * a[0].slope_x + w1 * a[1].slope_x + w2 * b[0].slope_x + w3 * b[1].slope_x,
                  w0 * a[0].slope_y + w1 * a[1].slope_y + w2 * b[0].slope_y + w3 * b[1].slope_y);
  }

  std::size_t bytes() const { return nodes_.capacity() * sizeof(Node); }

 private:
  static Vec3 upward(double slope_x, double slope_y) {
    const double z = 1 / std::sqrt(1 + slope_x * slope_x + slope_y * slope_y);
    return {slope_x * z, slope_y * z, z};
  }

  void find_slope(int column, int row);

  int columns_, rows_;
  double cell_, per_cell_, west_, south_;
  BorderSlope border_;
  std::vector<Node> nodes_;
};

}  // namespace snowshed::methods::slide
