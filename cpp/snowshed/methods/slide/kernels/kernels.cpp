// The slide's kernels for one instruction set.
#include "snowshed/methods/slide/kernels/bond_forces.hpp"
#include "snowshed/methods/slide/kernels/ground.hpp"
#include "snowshed/methods/slide/kernels/map_pressure.hpp"
#include "snowshed/methods/slide/kernels/mean_speed.hpp"
#include "snowshed/methods/slide/kernels/motion.hpp"
#include "snowshed/methods/slide/kernels/node_sums.hpp"
#include "snowshed/methods/slide/kernels/surface_pressure.hpp"

SNOWSHED_VARIANT_BEGIN
namespace {

void locate(const SlideView& s, std::ptrdiff_t begin, std::ptrdiff_t end) {
  for_each_lanes(begin, end, [&](const Lanes& l) {
    const PackPlace place = place_of(s, l.load(s.x), l.load(s.y));
    store_place(s, l, place, ground_at(s, place).normal);
  });
}

void ground(const SlideView& s, std::ptrdiff_t begin, std::ptrdiff_t end) {
  for_each_batch(begin, end, [&](std::ptrdiff_t first, std::ptrdiff_t last, int packs) {
    ground_batch(s, first, last, packs);
  });
}

void show_heights(const SlideView& s, std::ptrdiff_t begin, std::ptrdiff_t end) {
  for (std::ptrdiff_t e = begin; e < end; ++e) s.sorted_z[e] = s.z[s.sorted_particle[e]];
}

void count_neighbours(const SlideView& s, int row) { count_row(s, row); }

void weigh_pressure(const SlideView& s, std::ptrdiff_t begin, std::ptrdiff_t end) {
  weigh_entries(s, begin, end);
}

void surface_pressure(const SlideView& s, int row) { surface_pressure_row(s, row); }

void map_pressure(const SlideView& s, int row) { map_pressure_row(s, row); }

bool stretch_bonds(const SlideView& s, std::ptrdiff_t begin, std::ptrdiff_t end) {
  PackMask broken{};
  for_each_lanes(begin, end, [&](const Lanes& l) { broken |= stretch_lanes(s, l); });
  return any_lane(broken);
}

void pull(const SlideView& s, std::ptrdiff_t begin, std::ptrdiff_t end) {
  for (std::ptrdiff_t i = begin; i < end; ++i) pull_particle(s, i);
}

double advance(const SlideView& s, std::ptrdiff_t begin, std::ptrdiff_t end) {
  double kinetic = 0;
  for_each_batch(begin, end, [&](std::ptrdiff_t first, std::ptrdiff_t last, int packs) {
    kinetic += move_batch(s, first, last, packs);
  });
  return kinetic;
}

void sum_row_on_nodes(const SlideView& s, int row) { sum_on_nodes(s, row); }

void raise_mean_speed_of_row(const SlideView& s, int row) { raise_mean_speed(s, row); }

void thickness(const SlideView& s, std::ptrdiff_t begin, std::ptrdiff_t end) {
  for_each_lanes(begin, end,
                 [&](const Lanes& l) { l.store(s.thickness, flow_at(s, stored_place(s, l)).a); });
}

}  // namespace

extern const SlideKernels slide_kernel_table;
const SlideKernels slide_kernel_table{
    &locate,         &ground,           &show_heights,     &count_neighbours,
    &weigh_pressure, &surface_pressure, &map_pressure,     &stretch_bonds,
    &pull,           &advance,          &sum_row_on_nodes, &raise_mean_speed_of_row,
    &thickness};

SNOWSHED_VARIANT_END
