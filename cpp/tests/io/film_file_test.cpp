#include "snowshed/io/film_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "io/temporary_folder.hpp"
#include "snowshed/core/errors.hpp"

namespace snowshed {
namespace {

using FilmFileTest = TemporaryFolder;

FilmHeader small_header() {
  FilmHeader header;
  header.axes = 2;
  header.quantum = 1.0 / 1024;
  header.interval = 0.1;
  header.has_radius = true;
  header.quantities = {{"speed", "m/s", "Speed", 0.05}};
  return header;
}

/// Particles come and go, and move in ways that nothing foretells.
FilmFrame some_frame(int number) {
  std::mt19937 random(std::uint32_t(number) + 1);
  FilmFrame frame;
  frame.time = 0.1 * number;
  frame.event = 1;
  frame.positions.resize(2);
  frame.values.resize(1);
  for (std::uint32_t id = 0; id < 50; ++id) {
    if (number % 3 == 2 && random() % 4 == 0) continue;
    frame.ids.push_back(id * id);
    frame.events.push_back(std::uint16_t(1 + id % 7));
    frame.materials.push_back(std::uint8_t(id % 2));
    frame.radii.push_back(std::int32_t(id));
    for (auto& axis : frame.positions) axis.push_back(std::int32_t(random()));
    frame.values[0].push_back(std::int32_t(random() % 1000) - 500);
  }
  return frame;
}

void expect_same(const FilmFrame& one, const FilmFrame& other) {
  EXPECT_EQ(one.time, other.time);
  EXPECT_EQ(one.ids, other.ids);
  EXPECT_EQ(one.events, other.events);
  EXPECT_EQ(one.materials, other.materials);
  EXPECT_EQ(one.radii, other.radii);
  EXPECT_EQ(one.positions, other.positions);
  EXPECT_EQ(one.values, other.values);
}

TEST_F(FilmFileTest, ReadsWhatWasWritten) {
  FilmWriter writer(path("film.bin"), small_header());
  for (int k = 0; k < 9; ++k) writer.append(some_frame(k));
  FilmReader reader(path("film.bin"));
  ASSERT_EQ(reader.frames().size(), 9u);
  for (int k = 0; k < 9; ++k) expect_same(reader.next(), some_frame(k));
}

TEST_F(FilmFileTest, GoesOnToTheSameBytes) {
  FilmWriter whole(path("whole.bin"), small_header());
  for (int k = 0; k < 9; ++k) whole.append(some_frame(k));
  FilmWriter begun(path("film.bin"), small_header());
  for (int k = 0; k < 7; ++k) begun.append(some_frame(k));
  auto later = FilmWriter::reopen(path("film.bin"),
                                  [](const FilmFrameFacts& frame) { return frame.time < 0.45; });
  ASSERT_TRUE(later.has_value());
  ASSERT_EQ(later->frames().size(), 5u);
  for (int k = 5; k < 9; ++k) later->append(some_frame(k));
  EXPECT_EQ(content(path("film.bin")), content(path("whole.bin")));
}

TEST_F(FilmFileTest, AFrameThatCannotBeWrittenChangesNothing) {
  FilmWriter writer(path("film.bin"), small_header());
  writer.append(some_frame(0));
  std::filesystem::rename(path("film.bin"), path("away.bin"));
  EXPECT_THROW(writer.append(some_frame(1)), FileError);
  std::filesystem::rename(path("away.bin"), path("film.bin"));
  writer.append(some_frame(1));
  FilmReader reader(path("film.bin"));
  ASSERT_EQ(reader.frames().size(), 2u);
  for (int k = 0; k < 2; ++k) expect_same(reader.next(), some_frame(k));
}

TEST_F(FilmFileTest, RefusesWhatIsNoFileOrTooLargeBeforeReadingIt) {
  EXPECT_THROW(FilmReader("/dev/zero"), InputError);
  EXPECT_THROW(FilmReader(path("nothing.bin")), InputError);
  FilmWriter(path("film.bin"), small_header());
  std::filesystem::resize_file(path("film.bin"), std::uintmax_t{10} << 30);  // mostly a hole
  EXPECT_THROW(FilmReader(path("film.bin")), InputError);
}

TEST(FilmCodec, RefusesOrReadsAnyBytes) {
  std::mt19937 random(3);
  for (int k = 0; k < 20000; ++k) {
    std::vector<std::uint8_t> bytes(random() % 60);
    for (auto& byte : bytes) byte = std::uint8_t(random() % (k % 2 ? 256 : 4));
    FilmCodec codec(small_header());
    FilmFrame frame;
    try {
      codec.decode(bytes, k % 3 != 0, random() % 8, "film", frame);
      for (std::size_t i = 1; i < frame.ids.size(); ++i) EXPECT_LT(frame.ids[i - 1], frame.ids[i]);
    } catch (const InputError&) {
    }
  }
}

TEST(FilmQuantity, IsExactToAStepOrToAHundredth) {
  const FilmQuantity quantity{"pressure", "Pa", "Pressure", 100.0};
  for (const double value : {0.0, 40.0, -3000.0, 2e5, 1e9})
    EXPECT_NEAR(quantity.value(quantity.code(value)), value, 51 + 0.009 * std::abs(value));
  EXPECT_EQ(quantity.code(std::numeric_limits<double>::quiet_NaN()), 0);
}

}  // namespace
}  // namespace snowshed
