#include "snowshed/methods/pressure_map.hpp"

#include <cmath>

#include "snowshed/methods/archive.hpp"

namespace snowshed::methods {
namespace {

constexpr double half_window = 0.005;  // s
constexpr double rounding = 1e-9;      // s, between the end of a step and that of a half

/// A face is seen along z if the normal's z component is at least this, otherwise along x or y.
/// Common slopes (0, 30, 45, 60 and 90 degrees) are far from it, so that rounding does not change
/// the axis within a face.
constexpr double seen_from_above = 0.47;
constexpr double seen_along_x = 0.68;  // the same for x among x and y

int axis_of(const Vec3& normal) {
  if (std::abs(normal.z()) >= seen_from_above) return 2;
  return std::abs(normal.x()) >= seen_along_x * std::hypot(normal.x(), normal.y()) ? 0 : 1;
}

/// The two other axes.
constexpr int others[3][2] = {{1, 2}, {0, 2}, {0, 1}};

template <class Archive, class Patches>
void visit_patches(Archive& archive, Patches& patches) {
  archive.columns(patches, column("forces/patch", &Patch::key),
                  column("forces/point", &Patch::point), column("forces/normal", &Patch::normal),
                  column("forces/pushed", &Patch::pushed),
                  column("forces/pushed_before", &Patch::pushed_before),
                  column("forces/sampled", &Patch::sampled), column("forces/peak", &Patch::peak),
                  column("forces/peak_time", &Patch::peak_time));
}

}  // namespace

std::int32_t PressureMap::patch_at(int obstacle, const Vec3& point, const Vec3& normal) {
  const int axis = axis_of(normal), side = normal[axis] < 0 ? 1 : 0;
  Patch patch;
  patch.key = {obstacle, 2 * axis + side, 0, 0, 0};
  for (int k = 0; k < 2; ++k) {
    const int d = others[axis][k];
    if (dimension_ == 2 && d == 1) continue;
    patch.key[std::size_t(2 + k)] = std::int32_t(std::floor(point[d] / edge_));
  }
  const auto [at, is_new] = index_.try_emplace(patch.key, std::int32_t(patches_.size()));
  if (is_new) {
    patch.point = point;
    patch.normal = normal;
    place(patch);
    patches_.push_back(patch);
  }
  return at->second;
}

/// Moves the point of a patch to its middle, and finds its area.
void PressureMap::place(Patch& patch) const {
  const int axis = patch.key[1] / 2;
  patch.point = on_face(patch, 0.5, 0.5);
  patch.area = (dimension_ == 2 ? edge_ : edge_ * edge_) / std::abs(patch.normal[axis]);
}

/// The point of the face at a place of the patch's cell, 0 to 1 along each of its axes.
Vec3 PressureMap::on_face(const Patch& patch, double first, double second) const {
  const int axis = patch.key[1] / 2;
  const double place[2] = {first, second};
  Vec3 x = patch.point;
  for (int k = 0; k < 2; ++k) {
    const int d = others[axis][k];
    if (dimension_ == 2 && d == 1) continue;
    x[d] = (patch.key[std::size_t(2 + k)] + place[k]) * edge_;
  }
  x[axis] -= (x - patch.point).dot(patch.normal) / patch.normal[axis];
  return x;
}

std::vector<Vec3> PressureMap::corners(const Patch& patch) const {
  if (dimension_ == 2) {
    const bool second = others[patch.key[1] / 2][0] == 1;  // seen along x
    return {on_face(patch, 0, 0), second ? on_face(patch, 0, 1) : on_face(patch, 1, 0)};
  }
  return {on_face(patch, 0, 0), on_face(patch, 1, 0), on_face(patch, 1, 1), on_face(patch, 0, 1)};
}

void PressureMap::begin_event(double time) noexcept {
  for (Patch& patch : patches_) {
    patch.peak = 0;
    patch.peak_time = time;
  }
}

bool PressureMap::half_is_over(double time) const {
  return time - half_began_ >= half_window - rounding;
}

double PressureMap::half_end() const { return half_began_ + half_window; }

void PressureMap::end_half(double time) noexcept {
  const double length = time - half_began_, window = half_before_ + length;
  if (!(window > 0)) return;
  for (Patch& patch : patches_) {
    const double pressure = (patch.pushed_before + patch.pushed) / (window * patch.area);
    if (pressure > patch.peak) {
      patch.peak = pressure;
      patch.peak_time = time;
    }
    patch.pushed_before = patch.pushed;
    patch.pushed = 0;
  }
  half_before_ = length;
  half_began_ = time;
}

void PressureMap::save(io::BinaryWriter& out) const {
  StateWriter archive(out);
  archive.numbers("forces/half", half_began_, half_before_);
  visit_patches(archive, patches_);
}

void PressureMap::load(const io::BinaryReader& in, std::size_t obstacles) {
  const StateReader archive(in);
  archive.numbers("forces/half", half_began_, half_before_);
  visit_patches(archive, patches_);
  index_.clear();
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    Patch& patch = patches_[i];
    const int view = patch.key[1];
    if (patch.key[0] < 0 || std::size_t(patch.key[0]) >= obstacles || view < 0 || view > 5 ||
        !(std::abs(patch.normal[view / 2]) > 0.1))
      archive.refuse("a patch of a face is not sound");
    place(patch);
    index_[patch.key] = std::int32_t(i);
  }
}

}  // namespace snowshed::methods
