// The slide's kernels for one instruction set.
#include "snowshed/methods/slide/kernels/bond_forces.hpp"
#include "snowshed/methods/slide/kernels/ground.hpp"
#include "snowshed/methods/slide/kernels/map_pressure.hpp"
#include "snowshed/methods/slide/kernels/mean_speed.hpp"
#include "snowshed/methods/slide/kernels/motion.hpp"
#include "snowshed/methods/slide/kernels/node_sums.hpp"
#include "snowshed/methods/slide/kernels/surface_pressure.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::slide)
namespace {

void locate(const View& s, std::ptrdiff_t begin, std::ptrdiff_t end) {
  for_each_lanes(begin, end, [&](const Lanes& l) {
    const PackCellPosition position = cell_position(s, l.load(s.x), l.load(s.y));
    store_position(s, l, position, ground_at(s, position).normal);
  });
}

void ground(const View& s, std::ptrdiff_t begin, std::ptrdiff_t end) {
  for_each_batch(begin, end, [&](std::ptrdiff_t first, std::ptrdiff_t last, int packs) {
    ground_batch(s, first, last, packs);
  });
}

void weigh_pressure(const View& s, int row) { weigh_row(s, row); }

void surface_pressure(const View& s, int row) { surface_pressure_row(s, row); }

void map_pressure(const View& s, int row) { map_pressure_row(s, row); }

bool stretch_bonds(const View& s, std::ptrdiff_t begin, std::ptrdiff_t end) {
  PackMask broken{};
  for_each_lanes(begin, end, [&](const Lanes& l) { broken |= store_bond_forces(s, l); });
  return any_lane(broken);
}

double advance(const View& s, std::ptrdiff_t begin, std::ptrdiff_t end) {
  double kinetic = 0;
  for_each_batch(begin, end, [&](std::ptrdiff_t first, std::ptrdiff_t last, int packs) {
    kinetic += move_batch(s, first, last, packs);
  });
  return kinetic;
}

void sum_row_on_nodes(const View& s, int row) { sum_on_nodes(s, row); }

void raise_mean_speed_of_row(const View& s, int row) { raise_mean_speed(s, row); }

void thickness(const View& s, std::ptrdiff_t begin, std::ptrdiff_t end) {
  for_each_lanes(begin, end, [&](const Lanes& l) {
    l.store(s.thickness, flow_at(s, stored_position(s, l)).a);
  });
}

void bounds(const std::int32_t* values, std::ptrdiff_t count, std::int32_t& low,
            std::int32_t& high) {
  std::int32_t least = values[0], most = values[0];
  for (std::ptrdiff_t i = 1; i < count; ++i) {
    least = values[i] < least ? values[i] : least;
    most = values[i] > most ? values[i] : most;
  }
  low = least;
  high = most;
}

}  // namespace

extern const Kernels kernel_table;
const Kernels kernel_table{
    &locate,        &ground,  &weigh_pressure,   &surface_pressure,        &map_pressure,
    &stretch_bonds, &advance, &sum_row_on_nodes, &raise_mean_speed_of_row, &thickness,
    &bounds};

SNOWSHED_MODULE_VARIANT_END
