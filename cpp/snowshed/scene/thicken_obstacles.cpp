#include "snowshed/scene/thicken_obstacles.hpp"

#include <sstream>

namespace snowshed::scene {
namespace {

std::string millimetres(double metres) {
  std::ostringstream text;
  text.precision(3);
  text << 1000 * metres << " mm";
  return text.str();
}

std::string position_text(const Vec3& x, int dimension) {
  std::ostringstream text;
  text.precision(4);
  // Adding 0 makes 0 of -0.
  const auto rounded = [](double v) { return std::abs(v) < 5e-5 ? 0.0 : v; };
  if (dimension == 2)
    text << "(x, z) = (" << rounded(x.x()) << ", " << rounded(x.z()) << ") m";
  else
    text << "(x, y, z) = (" << rounded(x.x()) << ", " << rounded(x.y()) << ", " << rounded(x.z())
         << ") m";
  return text.str();
}

std::string note_on(const geometry::Thickening& t, const methods::Obstacle& obstacle,
                    const Scene& scene) {
  const std::string unit = scene.numerics->info().length_unit;
  const std::string name =
      obstacle.name.empty() ? "an obstacle" : "obstacle '" + obstacle.name + "'";
  const std::string required_thickness = millimetres(2 * scene.numerics->resolution());
  if (t.is_dilated)
    return name + " is " + millimetres(t.thickness) + " thick, less than two " + unit +
           ": it is made " + required_thickness + " thick, " + millimetres(t.outward) +
           " more on each side";
  return name + " has parts thinner than two " + unit + ", down to " + millimetres(t.thickness) +
         " at " + position_text(t.thinnest, scene.dimension) + ": there it is made " +
         required_thickness + " thick, up to " + millimetres(t.outward) + " more on each side";
}

}  // namespace

std::vector<methods::Obstacle> thicken_obstacles(const Scene& scene,
                                                 const std::vector<methods::Obstacle>& given,
                                                 std::vector<std::string>& notes) {
  std::vector<methods::Obstacle> resolved = given;
  for (methods::Obstacle& obstacle : resolved) {
    geometry::ThickSolid solid = scene.numerics->thickened(obstacle.shape, scene.dimension);
    if (solid.thickening) notes.push_back(note_on(*solid.thickening, obstacle, scene));
    obstacle.shape = std::move(solid.shape);
  }
  return resolved;
}

}  // namespace snowshed::scene
