// The slide's kernels for one instruction set.
#include "snowshed/methods/slide/kernels/ground.hpp"
#include "snowshed/methods/slide/kernels/interaction.hpp"
#include "snowshed/methods/slide/kernels/motion.hpp"

SNOWSHED_VARIANT_BEGIN
namespace {

void locate(const SlideView& s, std::ptrdiff_t begin, std::ptrdiff_t end) {
  for_each_lanes(begin, end, [&](const Lanes& l) {
    const QuadPlace place = place_of(s, l.load(s.x), l.load(s.y));
    const QuadRecord ground = interpolated(s.ground, s.columns, place);
    store_place(s, l, place, upward(ground.b, ground.c));
  });
}

void ground(const SlideView& s, std::ptrdiff_t begin, std::ptrdiff_t end) {
  for_each_lanes(begin, end, [&](const Lanes& l) { ground_lanes(s, l); });
}

void pressure(const SlideView& s, int row) { pressure_row(s, row); }

bool stretch_bonds(const SlideView& s, std::ptrdiff_t begin, std::ptrdiff_t end) {
  QuadMask broken{};
  for_each_lanes(begin, end, [&](const Lanes& l) { broken |= stretch_lanes(s, l); });
  return any(broken);
}

void pull(const SlideView& s, std::ptrdiff_t begin, std::ptrdiff_t end) {
  for (std::ptrdiff_t i = begin; i < end; ++i) pull_particle(s, i);
}

double advance(const SlideView& s, std::ptrdiff_t begin, std::ptrdiff_t end) {
  double kinetic = 0;
  for_each_lanes(begin, end, [&](const Lanes& l) { kinetic += move_lanes(s, l); });
  return kinetic;
}

void thickness(const SlideView& s, std::ptrdiff_t begin, std::ptrdiff_t end) {
  for_each_lanes(begin, end,
                 [&](const Lanes& l) { l.store(s.thickness, flow_at(s, stored_place(s, l)).a); });
}

}  // namespace

extern const SlideKernels slide_kernel_table;
const SlideKernels slide_kernel_table{&locate, &ground,  &pressure, &stretch_bonds,
                                      &pull,   &advance, &thickness};

SNOWSHED_VARIANT_END
