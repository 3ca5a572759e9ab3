#include "snowshed/methods/slide/energy.hpp"

#include <gtest/gtest.h>

#include <map>

#include "io/temporary_folder.hpp"
#include "methods/slide/slide_testing.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/io/binary_archive.hpp"

namespace snowshed::methods::slide {
namespace {

/// A slope of 36 degrees that runs out onto level ground.
geometry::HeightField run_out() {
  return geometry::terrain_of(100, 50, 2, [](double x, double) {
    const double slope = std::tan(radians(36)), bend = std::min(std::max(x - 70, 0.0), 40.0);
    return 100 - slope * (std::min(x, 70.0) + bend - bend * bend / 80);
  });
}

Options options_with_energy(geometry::HeightField terrain, Area release) {
  Options o = slide_on(std::move(terrain), std::move(release));
  o.energy = true;
  return o;
}

std::map<std::string, double> energies(const Method& method) {
  std::map<std::string, double> values;
  for (const auto& [name, joules] : capability<KeepsEnergy>(method)->energies())
    values[name] = joules;
  return values;
}

/// The residual of the energy balance, divided by the drop of potential energy.
double gap(const std::map<std::string, double>& e, double potential_before) {
  return std::abs(e.at("residual_j")) / (potential_before - e.at("potential_j"));
}

TEST(SlideEnergy, BalanceClosesWithAllDissipation) {
  Options o = options_with_energy(run_out(), rectangle(20.3, 30.3, 50.3, 64.3));
  o.areas.entrainment = {rectangle(60, 20, 90, 80, 0.2)};
  o.areas.resistance = {rectangle(90, 20, 120, 80)};
  o.settings.resistance = 0.05;
  o.settings.max_strain = 0.02;  // so that bonds break
  const auto slide = released_slide(o);
  const double before = energies(*slide).at("potential_j");
  EXPECT_NEAR(energies(*slide).at("residual_j") / before, 0, 1e-12);
  while (!*slide->at_rest() && slide->time() < 60) slide->step();
  const auto e = energies(*slide);
  EXPECT_LT(gap(e, before), 0.01);
  for (const char* part :
       {"coulomb_j", "turbulent_j", "resistance_j", "entrainment_j", "broken_bonds_j"})
    EXPECT_GT(e.at(part), 0) << part;
}

TEST(SlideEnergy, FrictionEnergyIsItsWorkOnABlock) {
  Options o = options_with_energy(inclined(35, 120, 40), rectangle(20.3, 18.3, 60.3, 58.3));
  o.settings.friction_law = FrictionLaw::coulomb;
  o.settings.friction = 0.4;
  const auto slide = released_slide(o);
  const double mass = total_mass(*slide);
  const Vec3 from = slide->state().positions[0];
  step(*slide, 200);
  const double distance = (slide->state().positions[0] - from).norm();
  const double work = 0.4 * mass * 9.81 * std::cos(radians(35)) * distance;
  EXPECT_NEAR(energies(*slide).at("coulomb_j") / work, 1, 0.02);
}

TEST(SlideEnergy, SpreadingTurnsThicknessIntoKineticEnergy) {
  Options o =
      options_with_energy(geometry::terrain_of(60, 60, 2, [](double, double) { return 0.0; }),
                          rectangle(40.3, 42.3, 70.3, 72.3));
  o.settings.friction = 0;
  o.settings.friction_law = FrictionLaw::coulomb;
  o.settings.bonds = false;
  o.settings.mixing_rate = 0;
  o.settings.layer_thickness = 0.05;
  const auto slide = released_slide(o);
  const double before = energies(*slide).at("potential_j");
  step(*slide, 200);
  const auto e = energies(*slide);
  EXPECT_GT(e.at("kinetic_j"), 0.1 * before);
  EXPECT_LT(gap(e, before), 0.01);
}

TEST(SlideEnergy, EnergyThatLeavesTheTerrainIsCounted) {
  const auto slide =
      released_slide(options_with_energy(inclined(40, 40, 30), rectangle(20.3, 18.3, 50.3, 40.3)));
  const double before = energies(*slide).at("potential_j");
  while (slide->size() > 0 && slide->time() < 60) slide->step();
  const auto e = energies(*slide);
  EXPECT_GT(e.at("left_terrain_j"), 0);
  EXPECT_LT(std::abs(e.at("residual_j")) / before, 0.01);
}

class SlideEnergyCheckpoint : public io::TemporaryFolder {};

TEST_F(SlideEnergyCheckpoint, ResumesToTheSameEnergies) {
  const Options o = options_with_energy(run_out(), rectangle(20.3, 30.3, 50.3, 64.3));
  const auto slide = released_slide(o);
  step(*slide, 100);
  const auto resumed = resumed_slide(o, *slide, path("c.bin"));
  step(*slide, 50);
  step(*resumed, 50);
  EXPECT_EQ(energies(*slide), energies(*resumed));
}

TEST(SlideEnergy, StiffBondsShortenTheStepAndStayStable) {
  Options o = options_with_energy(inclined(35), rectangle(20.3, 18.3, 40.3, 38.3));
  o.settings.bond_modulus = 5e7;
  const auto slide = released_slide(o);
  const double before = energies(*slide).at("potential_j");
  while (slide->time() < 1.0) slide->step();
  EXPECT_LT(slide->time_step(), 0.005);
  EXPECT_EQ(slide->bonds().size(), std::size_t(slide->bonds_made()));
  EXPECT_LT(gap(energies(*slide), before), 0.01);
}

TEST(SlideEnergy, BondsFarTooStiffForTheStepAreRefused) {
  Options o = slide_on(inclined(35), rectangle(20.3, 18.3, 40.3, 38.3));
  o.settings.bond_modulus = 1e12;
  const auto slide = make_solver(o);
  EXPECT_THROW(slide->add(slide->seed()), InputError);
  o.settings.mode = Mode::compatible;
  const auto compatible = make_solver(o);
  EXPECT_NO_THROW(compatible->add(compatible->seed()));
}

}  // namespace
}  // namespace snowshed::methods::slide
