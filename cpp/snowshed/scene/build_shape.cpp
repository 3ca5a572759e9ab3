#include "snowshed/scene/build_shape.hpp"

#include <cmath>
#include <map>
#include <sstream>

#include "snowshed/core/angles.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/geometry/bounds.hpp"
#include "snowshed/geometry/combine.hpp"
#include "snowshed/geometry/mesh_solid.hpp"
#include "snowshed/geometry/primitives.hpp"
#include "snowshed/geometry/readers/npy_io.hpp"
#include "snowshed/geometry/readers/vdb_file.hpp"
#include "snowshed/geometry/sample_checks.hpp"
#include "snowshed/geometry/sampled_grid.hpp"

namespace snowshed::scene {
namespace {

// Beyond this, squares and differences of coordinates lose the millimetres.
constexpr double max_length = 1e9;   // m
constexpr double min_length = 1e-9;  // m

/// Reads the fields of one ShapeSpec; errors name the bad field.
class Builder {
 public:
  Builder(const ShapeSpec& spec, int dimension, const std::string& path,
          const std::filesystem::path& base_dir, int depth, std::vector<std::string>* notes)
      : spec_(spec),
        dimension_(dimension),
        path_(path),
        base_dir_(base_dir),
        depth_(depth),
        notes_(notes) {}

  geometry::Shape build() const {
    if (depth_ > max_shape_depth)
      fail("", "shapes nested deeper than " + std::to_string(max_shape_depth) + " levels");
    static const std::map<std::string, geometry::Shape (Builder::*)() const> makers = {
        {"plane", &Builder::plane},
        {"box", &Builder::box},
        {"sphere", &Builder::sphere},
        {"cylinder", &Builder::cylinder},
        {"capsule", &Builder::capsule},
        {"plate", &Builder::plate},
        {"mesh", &Builder::mesh},
        {"grid", &Builder::grid},
        {"vdb", &Builder::vdb},
        {"union", &Builder::make_union},
        {"difference", &Builder::difference},
        {"transform", &Builder::transformed},
    };
    const auto maker = makers.find(spec_.type);
    if (maker != makers.end()) return (this->*maker->second)();
    std::string allowed;
    for (const auto& entry : makers) allowed += (allowed.empty() ? "" : ", ") + entry.first;
    fail("/type", "'" + spec_.type + "' is not a shape; allowed: " + allowed);
  }

 private:
  geometry::Shape plane() const {
    return geometry::make_plane(point(spec_.center, "/center"), direction(spec_.normal, "/normal"));
  }

  geometry::Shape box() const {
    const Vec3 center = point(spec_.center, "/center");
    Vec3 size;
    for (int axis = 0; axis < 3; ++axis)
      size[axis] =
          axis == 1 && dimension_ == 2 ? geometry::infinity : length(spec_.size[axis], "/size");
    return geometry::make_box(center, size);
  }

  geometry::Shape sphere() const {
    return geometry::make_sphere(point(spec_.center, "/center"), length(spec_.radius, "/radius"));
  }

  geometry::Shape cylinder() const {
    check_axis();
    return geometry::make_cylinder(spec_.from, spec_.to, length(spec_.radius, "/radius"));
  }

  geometry::Shape capsule() const {
    check_axis();
    return geometry::make_capsule(spec_.from, spec_.to, length(spec_.radius, "/radius"));
  }

  geometry::Shape plate() const {
    const Vec3 normal = direction(spec_.normal, "/normal");
    if (std::hypot(normal.x(), normal.z()) < 1e-6)
      fail("/normal", describe(spec_.normal) +
                          " is along y; a plate needs a normal with a part "
                          "in the x-z plane");
    return geometry::make_plate(
        point(spec_.center, "/center"), normal, length(spec_.length, "/length"),
        dimension_ == 2 ? geometry::infinity : length(spec_.width, "/width"),
        length(spec_.thickness, "/thickness"));
  }

  geometry::Shape mesh() const {
    const double scale = length(spec_.scale, "/scale");
    return geometry::make_mesh_solid(file(), scale, dimension_, notes_);
  }

  geometry::Shape grid() const {
    geometry::GridSamples samples;
    samples.origin = point(spec_.origin, "/origin", any_y);
    samples.spacing = length(spec_.spacing, "/spacing");
    const std::filesystem::path path = file();
    geometry::NpyArray array = geometry::read_npy(path);
    const std::vector<std::size_t>& n = array.shape;
    const bool flat = n.size() == 2;
    if (flat && dimension_ == 3)
      throw InputError(path.string(),
                       "a two-dimensional array; a three-dimensional scene needs "
                       "a grid with the indices [x][y][z]");
    samples.counts = {n[0], flat ? 1 : n[1], flat ? n[1] : n[2]};
    samples.values = std::move(array.values);
    geometry::require_counts(samples, path.string());
    geometry::repair_distances(samples, path.string(), notes_);
    return in_scene(std::move(samples), path.string());
  }

  geometry::Shape vdb() const {
    const geometry::VdbSource source{file(), spec_.grid, length(spec_.threshold, "/threshold"),
                                     length(spec_.scale, "/scale")};
    return in_scene(geometry::read_vdb(source), source.path.string());
  }

  geometry::Shape make_union() const { return geometry::unite(children(1)); }

  geometry::Shape difference() const {
    std::vector<geometry::Shape> shapes = children(2);
    geometry::Shape first = shapes.front();
    shapes.erase(shapes.begin());
    return geometry::subtract(std::move(first), std::move(shapes));
  }

  geometry::Shape transformed() const {
    if (spec_.shapes.size() != 1)
      fail("/shapes", std::to_string(spec_.shapes.size()) + " shapes; a transform takes one");
    const Vec3 translation = point(spec_.translate, "/translate");
    const Vec3 axis = direction(spec_.axis, "/axis", any_y);
    if (dimension_ == 2 && std::hypot(axis.x(), axis.z()) > 0)
      fail("/axis", describe(spec_.axis) +
                        " is not along y, the only axis that keeps a "
                        "two-dimensional scene in its plane");
    if (!(std::abs(spec_.angle) <= 36000))
      fail("/angle", describe(spec_.angle) + "; allowed: -36000 to 36000 degrees");
    const double angle = radians(std::fmod(spec_.angle, 360.0));
    return geometry::transform(children(1).front(),
                               Eigen::AngleAxisd(angle, axis).toRotationMatrix(), translation);
  }

  std::vector<geometry::Shape> children(std::size_t at_least) const {
    if (spec_.shapes.size() < at_least)
      fail("/shapes", std::to_string(spec_.shapes.size()) + " shapes; at least " +
                          std::to_string(at_least) + " needed");
    std::vector<geometry::Shape> shapes;
    for (std::size_t i = 0; i < spec_.shapes.size(); ++i)
      shapes.push_back(Builder(spec_.shapes[i], dimension_, path_ + "/shapes/" + std::to_string(i),
                               base_dir_, depth_ + 1, notes_)
                           .build());
    return shapes;
  }

  geometry::Shape in_scene(geometry::GridSamples samples, const std::string& where) const {
    if (dimension_ == 2) samples = geometry::samples_at_y0(samples, where);
    return geometry::make_sampled_grid(std::move(samples), where);
  }

  std::filesystem::path file() const {
    if (spec_.file.empty()) fail("/file", "missing; a file name is needed");
    return base_dir_ / spec_.file;
  }

  void check_axis() const {
    if ((point(spec_.to, "/to") - point(spec_.from, "/from")).norm() < min_length)
      fail("/to", describe(spec_.to) + " equals 'from'; the ends of the axis must differ");
  }

  enum InPlane { in_plane, any_y };

  Vec3 point(const Vec3& value, const char* field, InPlane plane = in_plane) const {
    if (!(value.cwiseAbs().maxCoeff() <= max_length) || !value.allFinite())
      fail(field, describe(value) + "; allowed: finite coordinates up to 1e9 m");
    if (plane == in_plane && dimension_ == 2 && value.y() != 0)
      fail(field, describe(value) + "; y must be 0 in a two-dimensional scene");
    return value;
  }

  Vec3 direction(const Vec3& value, const char* field, InPlane plane = in_plane) const {
    const Vec3 v = point(value, field, plane);
    if (v.norm() < min_length) fail(field, describe(value) + "; a direction must not be zero");
    return v.normalized();
  }

  double length(double value, const char* field) const {
    if (!(value >= min_length && value <= max_length))
      fail(field, describe(value) + "; must be positive (1e-9 to 1e9)");
    return value;
  }

  static std::string describe(double value) {
    std::ostringstream text;
    text << value;
    return text.str();
  }

  static std::string describe(const Vec3& v) {
    return "[" + describe(v.x()) + ", " + describe(v.y()) + ", " + describe(v.z()) + "]";
  }

  [[noreturn]] void fail(const std::string& field, const std::string& what) const {
    throw InputError(path_ + field, what);
  }

  const ShapeSpec& spec_;
  const int dimension_;
  const std::string& path_;
  const std::filesystem::path& base_dir_;
  const int depth_;
  std::vector<std::string>* const notes_;
};

}  // namespace

geometry::Shape build_shape(const ShapeSpec& spec, int dimension, const std::string& json_path,
                            const std::filesystem::path& base_dir,
                            std::vector<std::string>* notes) {
  return Builder(spec, dimension, json_path, base_dir, 1, notes).build();
}

}  // namespace snowshed::scene
