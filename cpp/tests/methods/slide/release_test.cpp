#include "snowshed/methods/slide/release.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "methods/slide/slide_testing.hpp"
#include "snowshed/core/errors.hpp"

namespace snowshed::methods::slide {
namespace {

double mass_of(const std::vector<ParticleBatch>& batches) {
  double mass = 0;
  for (const ParticleBatch& batch : batches) mass += batch.total_mass();
  return mass;
}

std::size_t count(const std::vector<ParticleBatch>& batches) {
  std::size_t n = 0;
  for (const ParticleBatch& batch : batches) n += batch.positions.size();
  return n;
}

std::vector<ParticleBatch> seed_on_slope(Settings settings, const Area& area, double degrees = 35) {
  const bool compatible = settings.mode == Mode::compatible;
  const Terrain terrain(inclined(degrees),
                        compatible ? BorderSlope::level_in_the_south_west : BorderSlope::one_sided);
  return seed_release(settings, terrain, {area});
}

TEST(SlideRelease, MassIsDensityTimesThicknessTimesSlopingArea) {
  const double sloping = 30.0 * 24.0 / std::cos(radians(35));
  for (const double thickness : {0.01, 0.2, 0.5, 3.0}) {
    const auto batches = seed_on_slope({}, rectangle(20.3, 18.3, 50.3, 42.3, thickness));
    EXPECT_NEAR(mass_of(batches) / (sloping * thickness * 300), 1, 1e-12) << thickness;
  }
}

TEST(SlideRelease, CompatibleModeRoundsTheMassAndRefusesThinLayers) {
  Settings s;
  s.mode = Mode::compatible;
  const double exact = 30.0 * 24.0 / std::cos(radians(35)) * 0.5 * 300;
  EXPECT_NEAR(mass_of(seed_on_slope(s, rectangle(20.3, 18.3, 50.3, 42.3))) / exact, 1, 0.1);
  EXPECT_THROW(seed_on_slope(s, rectangle(20.3, 18.3, 50.3, 42.3, 0.15)), InputError);
}

TEST(SlideRelease, ParticlesLieOnTheGroundWithinTheArea) {
  const Area area = rectangle(20.3, 18.3, 50.3, 42.3);
  for (const ParticleBatch& batch : seed_on_slope({}, area))
    for (const Vec3& x : batch.positions) {
      EXPECT_TRUE(geometry::contains(area.polygon, {x.x(), x.y()}));
      EXPECT_NEAR(x.z(), 200 - std::tan(radians(35)) * x.x(), 1e-9);
    }
}

TEST(SlideRelease, StoppingLeavesTheSlideUnchanged) {
  for (const Mode mode : {Mode::improved, Mode::compatible}) {
    Options options = slide_on(inclined(35), rectangle(20.3, 18.3, 50.3, 42.3));
    options.settings.layer_thickness = 0.01;
    options.settings.mode = mode;
    const auto slide = make_solver(options);
    const StopRequest always = [] { return true; };
    EXPECT_THROW(slide->seed(always), Stopped);
    const std::vector<ParticleBatch> snow = slide->seed();
    EXPECT_THROW(slide->add(snow, always), Stopped);
    EXPECT_EQ(slide->size(), 0u);
    slide->add(snow, {});
    EXPECT_EQ(slide->size(), count(snow));
  }
}

TEST(SlideRelease, TooManyParticlesAreRefusedBeforeSeeding) {
  Options options = slide_on(inclined(35), rectangle(20.3, 18.3, 50.3, 42.3));
  options.settings.layer_thickness = 1e-12;
  EXPECT_THROW(make_solver(options), InputError);
  options.settings.layer_thickness = 2e-4;  // some 450 000 particles
  EXPECT_NO_THROW(make_solver(options));
  geometry::Ring& outline = options.areas.release[0].polygon.outline;
  outline.clear();
  for (int i = 0; i < 20000; ++i) {
    const double turn = radians(360) * i / 20000;
    outline.push_back({40 + 15 * std::cos(turn), 30 + 15 * std::sin(turn)});
  }
  EXPECT_THROW(make_solver(options), InputError);
  options.settings.layer_thickness = 0.25;
  EXPECT_NO_THROW(make_solver(options));
}

TEST(SlideRelease, FinerLayersMakeMoreParticles) {
  Settings fine;
  fine.layer_thickness = 0.05;
  const Area area = rectangle(20, 18, 50, 42);
  EXPECT_NEAR(double(count(seed_on_slope(fine, area))) / double(count(seed_on_slope({}, area))), 6,
              0.3);
}

TEST(SlideRelease, AreasWithoutAParticleAreRefused) {
  // A small area has a particle at its centre. A ring has none, because its centre lies in the
  // hole.
  Area ring = rectangle(20, 20, 20.2, 20.2);
  ring.polygon.holes = {{{20.01, 20.01}, {20.19, 20.01}, {20.19, 20.19}, {20.01, 20.19}}};
  EXPECT_THROW(seed_on_slope({}, ring), InputError);
}

/// Gives an area a raster of thickness with cells of 4 m, which begins at (20, 20) m.
Area with_thickness_raster(Area area, std::vector<double> heights, int columns = 4) {
  geometry::HeightField map;
  map.columns = columns;
  map.rows = int(heights.size()) / columns;
  map.cell = 4;
  map.west = map.south = 22;  // the middle of the first cell
  map.heights = std::move(heights);
  area.map = std::make_shared<const geometry::HeightField>(std::move(map));
  return area;
}

TEST(SlideRelease, AThicknessRasterGivesEachCellItsSnow) {
  // The raster has two rows of four cells; the area covers only half of the western column.
  const Area area =
      with_thickness_raster(rectangle(22, 20, 36, 28), {0.2, 0.4, 0.6, 0.8, 1.0, 0.8, 0.6, 0.4});
  const double volume = 4 * (2 * 0.2 + 4 * (0.4 + 0.6 + 0.8) + 2 * 1.0 + 4 * (0.8 + 0.6 + 0.4));
  const auto batches = seed_on_slope({}, area);
  EXPECT_NEAR(mass_of(batches) / (volume / std::cos(radians(35)) * 300), 1, 1e-12);
  // The mass of a particle is proportional to the thickness.
  double thin = 0, thick = 0;
  for (std::size_t k = 0; k < batches[0].positions.size(); ++k) {
    const Vec3& x = batches[0].positions[k];
    if (x.x() > 24.1 && x.x() < 27.9) (x.y() < 24 ? thin : thick) = batches[0].mass_of(k);
  }
  EXPECT_NEAR(thick / thin, 2, 1e-9);
}

TEST(SlideRelease, InvalidThicknessRastersAreRefused) {
  const Area area = rectangle(22, 20, 36, 28);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {nan, 0.0, -0.5, 1e4})
    EXPECT_THROW(seed_on_slope({}, with_thickness_raster(area, {1, 1, bad, 1, 1, 1, 1, 1})),
                 InputError)
        << bad;
  EXPECT_THROW(seed_on_slope({}, with_thickness_raster(area, {1, 1, 1, 1, 1, 1}, 3)), InputError);
}

/// A raster of thickness on the nodes of `inclined`, from (20, 18) m.
Area with_nodal_thickness(std::vector<double> heights, double cell = 2) {
  geometry::HeightField map{3, 2, cell, 20, 18, std::move(heights)};
  Area area = rectangle(19, 17, 25, 21);  // the edges of its cells
  area.map = std::make_shared<const geometry::HeightField>(std::move(map));
  return area;
}

Options compatible_slide(const Area& area) {
  Options o = slide_on(inclined(35), area);
  o.settings.mode = Mode::compatible;
  o.settings.bonds = false;
  o.settings.layer_thickness = 0.05;
  return o;
}

TEST(SlideRelease, InTheCompatibleModeTheCellsAroundNodesAreFilledByTheirThickness) {
  const std::vector<double> snow = {0.2, 0.4, 0.6, 0.3, 0.5, 0.1};
  const Options o = compatible_slide(with_nodal_thickness(snow));
  const ParticleBatch batch = make_solver(o)->seed().at(0);
  std::vector<double> mass(6), count(6);
  for (std::size_t k = 0; k < batch.positions.size(); ++k) {
    const int column = int(std::floor((batch.positions[k].x() - 19) / 2));
    const int row = int(std::floor((batch.positions[k].y() - 17) / 2));
    ASSERT_TRUE(column >= 0 && column < 3 && row >= 0 && row < 2);
    mass[std::size_t(row * 3 + column)] = batch.mass_of(k);
    count[std::size_t(row * 3 + column)] += 1;
  }
  for (std::size_t i = 0; i < 6; ++i) {
    const double stretch = 1 / std::cos(radians(35));
    const double points = std::floor(snow[i] * stretch / o.settings.layer_thickness);
    EXPECT_NEAR(mass[i], snow[i] * 4 * stretch * 300 / points, 1e-9) << i;
    EXPECT_NEAR(count[i], points, 0.3 * points + 2) << i;
  }
}

TEST(SlideRelease, InTheCompatibleModeARasterNeedsTheNodesOfTheTerrainAndSnowAtAllWithin) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(
      make_solver(compatible_slide(with_nodal_thickness({1, 1, 1, 1, 1, 1}, 2.01)))->seed(),
      InputError);
  for (const double bad : {nan, 0.0, -0.5, 1e4})
    EXPECT_THROW(make_solver(compatible_slide(with_nodal_thickness({1, 1, 1, 1, bad, 1})))->seed(),
                 InputError)
        << bad;
  Area beyond = with_nodal_thickness({1, 1, 1, 1, 1, 1});
  beyond.polygon = rectangle(19, 17, 29, 21).polygon;
  EXPECT_THROW(make_solver(compatible_slide(beyond))->seed(), InputError);
}

TEST(SlideRelease, AreasMayTouchButNotOverlap) {
  const Terrain terrain(inclined(35));
  const auto seed = [&](double west, Mode mode) {
    Settings settings;
    settings.mode = mode;
    return seed_release(settings, terrain,
                        {rectangle(20, 18, 30, 42, 1.0), rectangle(west, 18, 44, 42, 1.0)});
  };
  for (const Mode mode : {Mode::improved, Mode::compatible}) {
    EXPECT_NO_THROW(seed(30, mode));
    try {
      seed(27, mode);
      FAIL() << "overlapping areas were seeded";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("/terrain/release/1"), std::string::npos);
      EXPECT_NE(std::string(error.what()).find("overlaps /terrain/release/0"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace snowshed::methods::slide
