#include <gtest/gtest.h>

#include "io/temporary_folder.hpp"
#include "methods/grains/grains_testing.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/io/binary_archive.hpp"

namespace snowshed::methods::grains {
namespace {

class GrainsCheckpoint : public io::TemporaryFolder {
 protected:
  void save(const Solver& grains) const {
    io::BinaryWriter out;
    grains.save(out);
    out.save(path("c.bin"));
  }
  io::BinaryReader saved() const { return io::BinaryReader::load(path("c.bin")); }
};

Options three_stage_options(Sides sides) {
  Options o = grains_of(random_snow(15, 5));
  o.settings.density_scaling = 1e3;
  o.settings.damping = 0.2;
  o.settings.sides = sides;
  o.energy = true;
  o.cone = {2e-4, 30};
  o.loading = {{LoadingKind::compress, 2, 0.05, 0},
               {LoadingKind::shear, 2, 0.02, 1e5},
               {LoadingKind::penetrate, 2, 0.1, 0}};
  return o;
}

TEST_F(GrainsCheckpoint, ResumesToTheSameBits) {
  for (const Sides sides : {Sides::walls, Sides::periodic})
    for (const double strength : {1e6, 3e8}) {
      Options o = three_stage_options(sides);
      o.settings.tensile_strength = o.settings.shear_strength =
          strength;  // also bonds of distant spheres
      const auto reference = filled_solver(o);
      for (int part = 0; part < 4; ++part) {
        take_steps(*reference, 57);
        save(*reference);
        const auto resumed = make_solver(o);
        resumed->load(saved());
        EXPECT_EQ(resumed->measures().contacts, reference->measures().contacts);
        take_steps(*resumed, 120);
        take_steps(*reference, 120);
        ASSERT_EQ(reference->time(), resumed->time());
        ASSERT_EQ(reference->state().positions, resumed->state().positions);
        ASSERT_EQ(reference->state().velocities, resumed->state().velocities);
        ASSERT_EQ(reference->energies(), resumed->energies());
        ASSERT_EQ(reference->measures().bonds, resumed->measures().bonds);
        ASSERT_EQ(reference->measures().stage, resumed->measures().stage);
        ASSERT_EQ(reference->measures().top_stress, resumed->measures().top_stress);
      }
    }
}

TEST_F(GrainsCheckpoint, ResumesToTheSameBitsInEveryKindOfStage) {
  Options o = all_stages_options();
  for (const Sides sides : {Sides::walls, Sides::periodic}) {
    o.settings.sides = sides;
    const auto reference = filled_solver(o);
    std::vector<bool> covered(o.loading.size());
    while (!*reference->at_rest()) {
      take_steps(*reference, 3);
      if (*reference->at_rest()) break;
      const int stage = reference->stage();
      covered[std::size_t(stage)] = true;
      save(*reference);
      const auto resumed = make_solver(o);
      resumed->load(saved());
      for (int i = 0; i < 2000 && reference->stage() == stage; ++i) reference->step();
      for (int i = 0; i < 2000 && resumed->stage() == stage; ++i) resumed->step();
      ASSERT_GT(reference->stage(), stage);
      ASSERT_EQ(reference->time(), resumed->time()) << "stage " << stage;
      ASSERT_EQ(reference->sphere_positions(), resumed->sphere_positions()) << "stage " << stage;
      ASSERT_EQ(reference->state().velocities, resumed->state().velocities) << "stage " << stage;
      ASSERT_EQ(reference->energies(), resumed->energies()) << "stage " << stage;
      ASSERT_EQ(reference->measures().bonds, resumed->measures().bonds) << "stage " << stage;
    }
    for (std::size_t i = 0; i < covered.size(); ++i) EXPECT_TRUE(covered[i]) << "stage " << i;
  }
}

TEST_F(GrainsCheckpoint, RestoresASolverWithoutGrains) {
  const Options o = three_stage_options(Sides::walls);
  save(*make_solver(o));
  const auto other = filled_solver(o);
  other->load(saved());
  EXPECT_EQ(other->size(), 0u);
  other->add(other->seed());
  take_steps(*other, 3);
}

TEST_F(GrainsCheckpoint, AnotherSampleIsRefusedWithoutChanges) {
  save(*filled_solver(three_stage_options(Sides::walls)));
  Options o = three_stage_options(Sides::walls);
  o.sample = make_sample(random_snow(12, 4));
  const auto other = filled_solver(o);
  const ParticleState before = other->state();
  EXPECT_THROW(other->load(saved()), InputError);
  EXPECT_EQ(other->state().positions, before.positions);
  take_steps(*other, 3);
}

/// Copies an archive with a changed number in a section.
template <class T>
void forge(const io::BinaryReader& in, const std::string& section, std::size_t at, T value,
           const std::filesystem::path& to) {
  io::BinaryWriter out;
  const auto copy = [&](const char* name, auto zero) {
    auto values = in.get<decltype(zero)>(name);
    if constexpr (std::is_same_v<decltype(zero), T>)
      if (section == name) values.at(at) = value;
    out.add(name, std::move(values));
  };
  for (const char* name : {"grains/bodies", "grains/listed", "pairs/shear", "boundary/now",
                           "boundary/listed", "clock"})
    copy(name, double());
  copy("grains/event", std::uint16_t());
  copy("pairs/keys", std::uint32_t());
  copy("pairs/shifts", std::int32_t());
  copy("pairs/bonded", std::uint8_t());
  copy("counters", std::int64_t());
  out.save(to);
}

TEST_F(GrainsCheckpoint, ForgedFilesAreRefused) {
  const Options o = three_stage_options(Sides::walls);
  const auto grains = filled_solver(o);
  take_steps(*grains, 50);
  save(*grains);
  const io::BinaryReader intact = saved();
  const double nan = std::nan("");
  const auto refused = [&](const std::string& section, std::size_t at, auto value) {
    forge(intact, section, at, value, path("forged.bin"));
    const auto other = make_solver(o);
    EXPECT_THROW(other->load(io::BinaryReader::load(path("forged.bin"))), InputError)
        << section << " " << at;
    EXPECT_EQ(other->size(), 0u);
  };
  refused("grains/bodies", 0, nan);
  refused("grains/bodies", 0, 1e9);
  refused("grains/bodies", 6, 0.1);   // the orientation
  refused("grains/listed", 0, 1e-5);  // then other pairs are near
  refused("grains/listed", 3, 0.7);
  refused("pairs/keys", 0, std::uint32_t(4000000000));
  refused("pairs/keys", 1, std::uint32_t(4000000000));
  refused("pairs/keys", 2, std::uint32_t(4000000000));
  refused("pairs/shifts", 0, std::int32_t(3));
  refused("pairs/shear", 0, nan);
  refused("pairs/bonded", 0, std::uint8_t(7));
  refused("boundary/now", 2, 1e300);
  refused("boundary/listed", 2, nan);
  refused("clock", 0, nan);
  refused("counters", 0, std::int64_t(1) << 60);
  refused("counters", 4, std::int64_t(1));
  refused("counters", 9, std::int64_t(99));
}

}  // namespace
}  // namespace snowshed::methods::grains
