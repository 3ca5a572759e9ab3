// Exact equality of scenes, independent of their descriptions. A new member of a struct does not
// compile here until it is compared.
#pragma once

#include <algorithm>
#include <tuple>

#include "snowshed/methods/grains/settings.hpp"
#include "snowshed/methods/mpm/settings.hpp"
#include "snowshed/methods/mps/settings.hpp"
#include "snowshed/methods/slide/settings.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed::scene {

inline auto tied(const material::Snow& s) {
  auto& [a, b, c, d, e, f, g, h] = s;
  return std::tie(a, b, c, d, e, f, g, h);
}
inline auto tied(const ShapeSpec& s) {
  auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, t, u] = s;
  return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, t, u);
}
inline auto tied(const geometry::MotionSpec& s) {
  auto& [a, b, c, d, e] = s;
  return std::tie(a, b, c, d, e);
}
inline auto tied(const ObstacleSpec& s) {
  auto& [a, b, c, d, e] = s;
  return std::tie(a, b, c, d, e);
}
inline auto tied(const BodySpec& s) {
  auto& [a, b, c, d, e] = s;
  return std::tie(a, b, c, d, e);
}
inline auto tied(const Panel& s) {
  auto& [a, b, c, d, e, f, g] = s;
  return std::tie(a, b, c, d, e, f, g);
}
inline auto tied(const Layer& s) {
  auto& [a, b, c] = s;
  return std::tie(a, b, c);
}
inline auto tied(const Slab& s) {
  auto& [a, b, c, d] = s;
  return std::tie(a, b, c, d);
}
inline auto tied(const Ground& s) {
  auto& [a, b, c] = s;
  return std::tie(a, b, c);
}
inline auto tied(const methods::HoleSpec& s) { return std::tie(s.outline); }
inline auto tied(const methods::AreaSpec& s) {
  auto& [a, b, c, d] = s;
  return std::tie(a, b, c, d);
}
inline auto tied(const methods::ResistanceSpec& s) {
  auto& [a, b, c] = s;
  return std::tie(a, b, c);
}
inline auto tied(const methods::PulseSpec& s) { return std::tie(s.time, s.thickness, s.speed); }
inline auto tied(const methods::InflowSpec& s) {
  auto& [a, b, c, d, e] = s;
  return std::tie(a, b, c, d, e);
}
inline auto tied(const methods::DamCornerSpec& s) { return std::tie(s.x, s.y, s.height); }
inline auto tied(const methods::DamSpec& s) {
  auto& [a, b, c, d] = s;
  return std::tie(a, b, c, d);
}
inline auto tied(const methods::TerrainSpec& s) {
  auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n] = s;
  return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m, n);
}
inline auto tied(const methods::slide::Settings& s) {
  auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, t, u, v, w, x, y, z, a2, b2, c2, d2,
         e2, f2, g2, h2, i2] = s;
  return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, t, u, v, w, x, y, z, a2, b2,
                  c2, d2, e2, f2, g2, h2, i2);
}
inline auto tied(const methods::Seeding& s) {
  auto& [a, b, c, d] = s;
  return std::tie(a, b, c, d);
}
inline auto tied(const methods::mpm::Settings& s) {
  auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, t, u] = s;
  return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, t, u);
}
inline auto tied(const methods::Events& s) {
  auto& [a, b, c, d, e] = s;
  return std::tie(a, b, c, d, e);
}
inline auto tied(const methods::Output& s) {
  auto& [a, b, c, d, e, f, g] = s;
  return std::tie(a, b, c, d, e, f, g);
}
inline auto tied(const Domain& s) {
  auto& [a, b] = s;
  return std::tie(a, b);
}
inline auto tied(const methods::SampleSpec& s) {
  auto& [a, b, c] = s;
  return std::tie(a, b, c);
}
inline auto tied(const methods::LoadingStage& s) {
  auto& [a, b, c, d] = s;
  return std::tie(a, b, c, d);
}
inline auto tied(const methods::Cone& s) {
  auto& [a, b] = s;
  return std::tie(a, b);
}
inline auto tied(const methods::grains::Settings& s) {
  auto& [a, b, c, d, e, f, g, h, i, j, k, l] = s;
  return std::tie(a, b, c, d, e, f, g, h, i, j, k, l);
}
inline auto tied(const methods::mps::Settings& s) {
  auto& [s0, s1, s2, s3, s4, s5, s6, s7, s8, s9, s10, s11, s12, s13, s14, s15, s16, s17, s18, s19,
         s20, s21, s22, s23, s24, s25, s26, s27, s28, s29, s30, s31, s32, s33, s34, s35, s36] = s;
  return std::tie(s0, s1, s2, s3, s4, s5, s6, s7, s8, s9, s10, s11, s12, s13, s14, s15, s16, s17,
                  s18, s19, s20, s21, s22, s23, s24, s25, s26, s27, s28, s29, s30, s31, s32, s33,
                  s34, s35, s36);
}
inline auto tied(const Scene& s) {
  auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, t] = s;
  return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, t);
}

// Found by argument-dependent lookup from std::tuple, std::optional and std::vector.
template <class T, class = decltype(tied(std::declval<const T&>()))>
bool operator==(const T& a, const T& b) {
  return tied(a) == tied(b);
}

/// Whether both are settings of this type, and equal.
template <class Settings>
bool have_same(const methods::MethodChoice& a, const methods::MethodChoice& b) {
  return a.is<Settings>() && b.is<Settings>() && a.as<Settings>() == b.as<Settings>();
}
inline bool operator==(const methods::MethodChoice& a, const methods::MethodChoice& b) {
  return have_same<methods::mpm::Settings>(a, b) || have_same<methods::slide::Settings>(a, b) ||
         have_same<methods::grains::Settings>(a, b) || have_same<methods::mps::Settings>(a, b);
}

}  // namespace snowshed::scene

// The parts of a scene that other modules define are compared by the same operator.
namespace snowshed::material {
using scene::operator==;
}
namespace snowshed::geometry {
using scene::operator==;
}
namespace snowshed::methods {
using scene::operator==;
namespace mpm {
using scene::operator==;
}
namespace mps {
using scene::operator==;
}
namespace slide {
using scene::operator==;
}
namespace grains {
using scene::operator==;
}
}  // namespace snowshed::methods
