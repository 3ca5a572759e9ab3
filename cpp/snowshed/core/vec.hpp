// Host-side vectors. Geometry is always three-dimensional and in double; a two-dimensional scene
// lives in the plane y = 0 with coordinates (x, z).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace snowshed {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

template <int D>
using VecD = Eigen::Matrix<double, D, 1>;

/// (x, z) -> (x, 0, z); identity in 3D.
inline Vec3 embed(const VecD<2>& v) { return {v[0], 0.0, v[1]}; }
inline Vec3 embed(const VecD<3>& v) { return v; }

/// (x, y, z) -> (x, z); identity in 3D.
template <int D>
VecD<D> section(const Vec3& v) {
  if constexpr (D == 2)
    return {v[0], v[2]};
  else
    return v;
}

/// Rotation about +y, the matrix R_y of the thesis's equation (A.4.1): it takes
/// the x axis to (cos, 0, -sin), that is, tilts it down in the slide direction.
inline Mat3 rotation_about_y(double radians) {
  return Eigen::AngleAxisd(radians, Vec3::UnitY()).toRotationMatrix();
}

}  // namespace snowshed
