#include "snowshed/geometry/thickened.hpp"

#include "geometry/mesh_testing.hpp"
#include "snowshed/geometry/combine.hpp"
#include "snowshed/geometry/mesh_level_set.hpp"
#include "snowshed/geometry/mesh_section.hpp"
#include "snowshed/geometry/primitives.hpp"
#include "snowshed/geometry/sampled_grid.hpp"

namespace snowshed::geometry {
namespace {

using namespace geometry_testing;

constexpr double half = 0.1;

Vec3 random_in(Random& random, double size, int dimension) {
  Vec3 x = random_point(random, size);
  if (dimension == 2) x.y() = 0;
  return x;
}

/// Expects that both distances agree at random points beyond the surface, except for a share of
/// them.
void expect_same(const LevelSet& shape, const LevelSet& expected, int dimension, double size,
                 double tolerance, double share_off = 0.0) {
  Random random(21);
  constexpr int samples = 4000;
  int off = 0;
  for (int n = 0; n < samples; ++n) {
    const Vec3 x = random_in(random, size, dimension);
    const double d = shape.distance(x), e = expected.distance(x);
    off += e > -0.02 * half && e < 2 * half && std::abs(d - e) > tolerance;
    ASSERT_NEAR(shape.normal(x).norm(), 1, 1e-9);
  }
  EXPECT_LE(off, share_off * samples);
}

/// Expects that the thickened solid contains the given one, extends beyond it by at most half the
/// thickness, and has no thin parts.
void expect_thick(const Shape& given, int dimension, double size) {
  const ThickSolid solid = thickened(given, half, dimension);
  ASSERT_TRUE(solid.thickening);
  Random random(22);
  for (int n = 0; n < 4000; ++n) {
    const Vec3 x = random_in(random, size, dimension);
    const double before = given->distance(x), after = solid.shape->distance(x);
    ASSERT_LE(after, before + 1e-9) << x.transpose();
    if (before > 1.05 * half) {
      ASSERT_GT(after, 0) << x.transpose();
    }
  }
  EXPECT_EQ(thickened(solid.shape, half, dimension).shape, solid.shape);
  EXPECT_TRUE(find_thin_parts(*solid.shape, 0.8 * half, dimension).empty());
}

Shape box2(double x, double z, double width, double height) {
  return make_box(Vec3(x, 0, z), Vec3(width, infinity, height));
}

TEST(Thickened, ThickSolidsAreUnchanged) {
  const Shape boxes = unite({box2(0, 0, 1, 1), box2(0.9, 0.3, 1, 0.4), box2(0, 0.7, 0.4, 0.5)});
  const Shape slotted =
      subtract(box2(0, 0, 2, 1), {box2(0, 0.4, 0.05, 0.8), box2(0.6, 0, 0.3, 0.3)});
  for (const Shape& shape : {boxes, slotted}) EXPECT_EQ(thickened(shape, half, 2).shape, shape);
  const Shape solids[] = {
      make_mesh(box_mesh({-0.5, -0.7, -0.3}, {0.5, 0.7, 0.3})), make_mesh(sphere_mesh(0.5, 16)),
      subtract(make_box(Vec3::Zero(), Vec3(1, 1, 1)), {make_sphere(Vec3(0, 0, 0.5), 0.25)}),
      subtract(make_plane(Vec3::Zero(), Vec3::UnitZ()), {make_box(Vec3::Zero(), Vec3(1, 1, 1))}),
      unite({make_plane(Vec3::Zero(), Vec3::UnitZ()), make_box(Vec3::Zero(), Vec3(1, 1, 1))})};
  for (const Shape& shape : solids) EXPECT_EQ(thickened(shape, half, 3).shape, shape);
}

TEST(Thickened, CornersOfThickPartsAreUnchanged) {
  for (const double degrees : {45.0, 60.0, 75.0, 90.0, 110.0, 150.0}) {
    const double a = radians(degrees);
    const Vec3 normal(-std::sin(a), 0, std::cos(a));
    // A box, cut by a plane through its lower left corner.
    const Shape wedge = subtract(box2(0.5, 0.5, 1, 1), {make_plane(Vec3::Zero(), -normal)});
    const Shape cut = degrees < 90 ? wedge : subtract(box2(0.5, 0.5, 1, 1), {box2(1, 1, 0.4, 0.4)});
    EXPECT_EQ(thickened(cut, half, 2).shape, cut) << degrees;
  }
}

TEST(Thickened, ThinPlatesGrowLikeDilatedPlates) {
  for (const double thickness : {0.15, 0.05, 0.002, 1e-4})
    for (const double turn : {0.0, 0.35, 1.2})
      for (const int dimension : {2, 3}) {
        const Mat3 rotation = rotation_about_y(turn);
        const Vec3 size(1, dimension == 2 ? infinity : 0.7, thickness);
        const Shape plate = transform(make_box(Vec3::Zero(), size), rotation, {0.013, 0, 0.021});
        TriangleMesh mesh =
            box_mesh(Vec3(-0.5, -0.35, -thickness / 2), Vec3(0.5, 0.35, thickness / 2));
        for (Vec3& v : mesh.vertices) v = rotation * v + Vec3(0.013, 0, 0.021);
        const Shape given = make_mesh(dimension == 2 ? sections_at_y0({mesh}, "m").front() : mesh);
        const Shape expected = dilate(plate, half - thickness / 2);
        expect_thick(given, dimension, 1);
        const ThickSolid solid = thickened(given, half, dimension);
        EXPECT_NEAR(solid.thickening->thickness, thickness, 0.003 * half + 0.05 * thickness);
        // The rims are round.
        expect_same(*solid.shape, *expected, dimension, 1, 0.05 * half + 0.25 * thickness, 0.03);
      }
}

TEST(Thickened, ShellsGrowOnBothSides) {
  const double radius = 0.8, thickness = 0.02;
  const Shape shells[] = {
      subtract(make_sphere(Vec3::Zero(), radius + thickness / 2),
               {make_sphere(Vec3::Zero(), radius - thickness / 2)}),
      subtract(make_cylinder({0, -9, 0}, {0, 9, 0}, radius + thickness / 2),
               {make_cylinder({0, -10, 0}, {0, 10, 0}, radius - thickness / 2)})};
  const Shape grown[] = {subtract(make_sphere(Vec3::Zero(), radius + half),
                                  {make_sphere(Vec3::Zero(), radius - half)}),
                         subtract(make_cylinder({0, -9, 0}, {0, 9, 0}, radius + half),
                                  {make_cylinder({0, -10, 0}, {0, 10, 0}, radius - half)})};
  expect_same(*thickened(shells[0], half, 2).shape, *grown[0], 2, 1, 0.03 * half);
  expect_same(*thickened(shells[0], half, 3).shape, *grown[0], 3, 1, 0.06 * half);
  expect_same(*thickened(shells[1], half, 3).shape, *grown[1], 3, 1, 0.06 * half);
  expect_thick(shells[0], 2, 1);
}

TEST(Thickened, RodsAndBallsGrowEvenly) {
  const double thin = 0.03;
  const Shape rod = unite({make_cylinder({-1, 0, 0}, {1, 0, 0}, thin), make_sphere({0, 0, 5}, 1)});
  expect_same(*thickened(rod, half, 3).shape, *make_capsule({-1, 0, 0}, {1, 0, 0}, half), 3, 0.8,
              0.03 * half, 0.002);
  const Shape ball = make_mesh(sphere_mesh(thin, 8));
  expect_same(*thickened(ball, half, 3).shape, *make_sphere(Vec3::Zero(), half), 3, 0.3,
              0.05 * half);
  // A bar whose section is a triangle: no two faces are parallel.
  TriangleMesh bar;
  for (const double y : {-0.7, 0.7})
    for (int k = 0; k < 3; ++k)
      bar.vertices.emplace_back(thin * std::cos(2 * pi * k / 3), y,
                                thin * std::sin(2 * pi * k / 3));
  bar.triangles = {{0, 1, 2}, {3, 5, 4}, {0, 3, 1}, {1, 3, 4},
                   {1, 4, 2}, {2, 4, 5}, {2, 5, 0}, {0, 5, 3}};
  if (enclosed_volume(bar) < 0)
    for (Triangle& t : bar.triangles) std::swap(t[1], t[2]);
  const ThickSolid thick_bar = thickened(make_mesh(bar), half, 3);
  ASSERT_TRUE(thick_bar.thickening);
  for (double y = -0.65; y < 0.65; y += 0.01)
    for (double angle = 0; angle < 6.2; angle += 0.5)
      ASSERT_LT(thick_bar.shape->distance(
                    {0.9 * half * std::cos(angle), y, 0.9 * half * std::sin(angle)}),
                0);
}

TEST(Thickened, OnlyThinPartsGrow) {
  // A shelf on a post, a bin cut from a box, and a gutter of three plates.
  const double thin = 0.02;
  const Shape shelf = unite({box2(0, 0, 0.6, 1.6), box2(0.7, 0.3, 1, thin)});
  const ThickSolid solid = thickened(shelf, half, 2);
  ASSERT_TRUE(solid.thickening);
  EXPECT_NEAR(solid.thickening->thickness, thin, 0.003 * half);
  EXPECT_NEAR(solid.thickening->outward, half - thin / 2, 0.003 * half);
  EXPECT_NEAR(solid.thickening->thinnest.z(), 0.3, 2e-3 * half);
  const Shape expected =
      unite({box2(0, 0, 0.6, 1.6), dilate(box2(0.7, 0.3, 1, thin), half - thin / 2)});
  expect_same(*solid.shape, *expected, 2, 1.3, 0.03 * half, 0.005);
  // Snow on the shelf next to the post is held up, not pushed off the post.
  EXPECT_GT(solid.shape->normal({0.31, 0, 0.33}).z(), 0.99);
  expect_thick(shelf, 2, 1.3);

  const Shape bin = subtract(box2(0, 0, 1.6, 1), {box2(0, 0.5, 1.6 - 2 * thin, 2 - 2 * thin)});
  expect_thick(bin, 2, 1);
  const Shape wide = thickened(bin, half, 2).shape;
  EXPECT_NEAR(wide->distance({0, 0, -0.5 + thin / 2 + 1.5 * half}), 0.5 * half, 0.01 * half);
  EXPECT_NEAR(wide->distance({0.8 - thin / 2 - 1.5 * half, 0, 0.1}), 0.5 * half, 0.01 * half);
  EXPECT_GT(wide->distance({0, 0, 0.2}), 5 * half);

  const Shape gutter =
      unite({box2(0, 0, 1, thin), box2(-0.5, 0.25, thin, 0.5), box2(0.5, 0.25, thin, 0.5)});
  expect_thick(gutter, 2, 1);
}

TEST(Thickened, TouchingLayersCountAsOneThickPart) {
  std::vector<Shape> layers;
  for (int k = 0; k < 12; ++k) layers.push_back(box2(0, 0.05 * k, 2, 0.05));
  const Shape stack = unite(layers);
  EXPECT_EQ(thickened(stack, half, 2).shape, stack);
}

TEST(Thickened, ThinGridsAndLayersBetweenPlanesGrow) {
  const Shape plate = make_box(Vec3::Zero(), Vec3(1, 1, 0.06));
  GridSamples s{Vec3(-0.8, -0.8, -0.4), 0.02, {81, 81, 41}, {}};
  s.for_each([&](std::size_t i, std::size_t j, std::size_t k) {
    s.values.push_back(float(plate->distance(s.origin + s.spacing * Vec3(i, j, k))));
  });
  const Shape grid = thickened(make_sampled_grid(s, "g"), half, 3).shape;
  for (const double z : {-0.09, 0.05, 0.09}) EXPECT_LT(grid->distance({0.1, 0.2, z}), 0);
  EXPECT_GT(grid->distance({0.1, 0.2, 0.105}), 0);
  const Shape slab =
      subtract(make_plane({0, 0, 0.5}, Vec3::UnitZ()), {make_plane({0, 0, 0.48}, Vec3::UnitZ())});
  for (const int dimension : {2, 3}) {
    const Shape thick_slab = thickened(slab, half, dimension).shape;
    EXPECT_NEAR(thick_slab->distance({77, 0, 0.7}), 0.7 - 0.49 - half, 0.01 * half);
  }
}

TEST(Thickened, HalfThicknessDependsOnThePosition) {
  const Shape shelf =
      thickened(unite({box2(0, 0, 1, 1.6), box2(0.9, 0.3, 1, 0.02)}), half, 2).shape;
  EXPECT_DOUBLE_EQ(shelf->half_thickness({1, 0, 0.35}), half);
  EXPECT_DOUBLE_EQ(shelf->half_thickness({-0.3, 0, 0}), 0.5);
}

}  // namespace
}  // namespace snowshed::geometry
