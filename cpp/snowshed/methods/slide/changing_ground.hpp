// Ground that adapts to the snow: it rises where snow has stopped or forest has taken it, and falls
// where the slide takes up snow. The ground changes between two steps, by the depths that wait.
#pragma once

#include <array>
#include <vector>

#include "snowshed/methods/slide/terrain.hpp"

namespace snowshed::methods::slide {

struct Model;
struct State;
struct Workspace;

/// Causes of a change of the ground.
enum class GroundChange { stopped, detrained, entrained };
inline constexpr std::size_t ground_changes = 3;

struct ChangingGround {
  explicit ChangingGround(const Terrain& first);

  Terrain terrain;              // the present ground
  std::vector<double> rise;     // m, vertical, of the present ground above the first one
  std::vector<double> waiting;  // m, by which the ground will rise
  std::vector<double> stopped;  // m, the share of these two that is snow which has stopped
  NodeRectangle waits;          // where depths wait

  /// Adds a depth (m) that waits at a node.
  void add(int column, int row, double depth) {
    waiting[terrain.index(column, row)] += depth;
    waits.include(column, row);
  }
  /// The depth of a mass (kg) of a density (kg/m3) over the area of a cell on the map, m.
  double depth_of(double mass, double density) const {
    return mass / (density * terrain.cell() * terrain.cell());
  }
  /// Adds such a depth that waits, shared by the nodes around a position.
  void add_around(const geometry::CellPosition&, double depth, bool has_stopped);
  /// Sets the ground and `waits` to what follows from the depths at the nodes.
  void derive(const Terrain& first);

  /// The rise at each node with what waits, m, and its sum over the nodes times their areas on the
  /// map, m3.
  std::vector<double> change() const;
  double volume() const;
  std::size_t bytes() const;
};

/// Compatible mode: mass (kg) at the nodes that a step adds to the ground for each cause.
struct StepChanges {
  std::array<std::vector<double>, ground_changes> mass;
  NodeRectangle nodes;
};

/// Compatible mode: marks the particles that this step has stopped in `work.removed`, and puts
/// their mass to the nodes around the positions that they had before the step.
void mark_stopped(const Model&, const State&, Workspace&);

/// Compatible mode, at the end of a step: finds the changes of the step. They wait if the change at
/// one node exceeds the smallest change, and are lost otherwise, as in AvaFrame.
void take_changes_of_step(const Model&, State&, Workspace&);

/// Improved mode, at the end of a step: counts for how long each particle has rested.
void count_rest(State&);

/// Between two steps: turns snow that has rested long enough into ground (improved mode), and
/// changes the ground if enough waits. The workspace has the memory for this. Returns whether
/// particles or the ground have changed.
bool adapt_ground(const Model&, State&, Workspace&);

/// The ground on which the snow slides now.
const Terrain& present_terrain(const Model&, const State&);

}  // namespace snowshed::methods::slide
