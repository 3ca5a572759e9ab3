#include "snowshed/io/film_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <random>

#include "io/temporary_folder.hpp"
#include "snowshed/core/errors.hpp"

namespace snowshed::io {
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

/// Returns a frame in which particles come, go and move unpredictably.
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

void expect_same(const FilmFrame& frame, const FilmFrame& expected) {
  EXPECT_EQ(frame.time, expected.time);
  EXPECT_EQ(frame.ids, expected.ids);
  EXPECT_EQ(frame.events, expected.events);
  EXPECT_EQ(frame.materials, expected.materials);
  EXPECT_EQ(frame.radii, expected.radii);
  EXPECT_EQ(frame.positions, expected.positions);
  EXPECT_EQ(frame.values, expected.values);
}

TEST_F(FilmFileTest, ReadsTheWrittenFrames) {
  FilmWriter writer(path("film.bin"), small_header());
  for (int k = 0; k < 9; ++k) writer.append(some_frame(k));
  FilmReader reader(path("film.bin"));
  ASSERT_EQ(reader.frames().size(), 9u);
  for (int k = 0; k < 9; ++k) expect_same(reader.next(), some_frame(k));
}

TEST_F(FilmFileTest, AReopenedFilmGetsTheSameBytes) {
  FilmWriter reference(path("reference.bin"), small_header());
  for (int k = 0; k < 9; ++k) reference.append(some_frame(k));
  FilmWriter interrupted(path("film.bin"), small_header());
  for (int k = 0; k < 7; ++k) interrupted.append(some_frame(k));
  auto reopened = FilmWriter::reopen(path("film.bin"),
                                     [](const FilmFrameInfo& frame) { return frame.time < 0.45; });
  ASSERT_EQ(reopened.frames().size(), 5u);
  for (int k = 5; k < 9; ++k) reopened.append(some_frame(k));
  EXPECT_EQ(content(path("film.bin")), content(path("reference.bin")));
}

bool all(const FilmFrameInfo&) { return true; }

FilmWriter write_film(const std::filesystem::path& file, int frames) {
  FilmWriter writer(file, small_header());
  for (int k = 0; k < frames; ++k) writer.append(some_frame(k));
  return writer;
}

void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

TEST_F(FilmFileTest, AClosedFilmCanBeExtendedAndClosedAgain) {
  write_film(path("a.bin"), 4).close();
  const std::string closed = content(path("a.bin"));
  FilmWriter again = FilmWriter::reopen(path("a.bin"), all);
  again.close();
  EXPECT_EQ(content(path("a.bin")), closed);
  again.append(some_frame(4));
  again.close();
  write_film(path("b.bin"), 5).close();
  EXPECT_EQ(content(path("a.bin")), content(path("b.bin")));
  EXPECT_TRUE(FilmReader(path("a.bin")).closed());
}

TEST_F(FilmFileTest, ReopeningChangesNothingUntilAFrameIsWritten) {
  write_film(path("a.bin"), 4).close();
  const std::string before = content(path("a.bin"));
  FilmWriter::reopen(path("a.bin"), [](const FilmFrameInfo&) { return false; });
  EXPECT_EQ(content(path("a.bin")), before);
}

TEST_F(FilmFileTest, RefusesAnyChangedByte) {
  write_film(path("a.bin"), 3).close();
  const std::string intact = content(path("a.bin"));
  for (std::size_t at = 0; at < intact.size(); ++at) {
    std::string bytes = intact;
    bytes[at] = char(bytes[at] ^ (1 << at % 8));
    write_bytes(path("b.bin"), bytes);
    EXPECT_THROW(FilmReader(path("b.bin")), InputError) << at;
  }
}

TEST_F(FilmFileTest, ATruncatedFilmIsNotClosed) {
  write_film(path("a.bin"), 2).close();
  const std::string intact = content(path("a.bin"));
  for (std::size_t size = FilmReader(path("a.bin")).end_of(0); size < intact.size(); ++size) {
    write_bytes(path("b.bin"), intact.substr(0, size));
    const FilmReader reader(path("b.bin"));
    EXPECT_FALSE(reader.closed());
    EXPECT_EQ(reader.is_complete(), reader.end_of(reader.frames().size()) == size) << size;
  }
}

TEST_F(FilmFileTest, ReopensAtTheMarkWhateverFollowsIt) {
  const FilmMark mark = write_film(path("a.bin"), 3).mark();
  const std::string interrupted = content(path("a.bin"));
  write_bytes(path("a.bin"), interrupted + std::string(500, '\0'));
  EXPECT_THROW(FilmReader(path("a.bin")), InputError);
  EXPECT_THROW(FilmWriter::reopen(path("a.bin"), all), InputError);
  FilmWriter::reopen(path("a.bin"), all, mark).append(some_frame(3));
  write_film(path("b.bin"), 4);
  EXPECT_EQ(content(path("a.bin")), content(path("b.bin")));
}

TEST_F(FilmFileTest, RefusesAFilmThatDoesNotMatchTheMark) {
  const FilmMark mark = write_film(path("a.bin"), 3).mark();
  write_film(path("b.bin"), 2);
  EXPECT_THROW(FilmWriter::reopen(path("b.bin"), all, mark), InputError);
  FilmWriter other(path("b.bin"), small_header());
  for (int k = 1; k < 5; ++k) other.append(some_frame(k));
  EXPECT_THROW(FilmWriter::reopen(path("b.bin"), all, mark), InputError);
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

TEST_F(FilmFileTest, RefusesDevicesMissingFilesAndHugeFiles) {
  EXPECT_THROW(FilmReader("/dev/zero"), InputError);
  EXPECT_THROW(FilmReader(path("nothing.bin")), InputError);
  FilmWriter(path("film.bin"), small_header());
  std::filesystem::resize_file(path("film.bin"), std::uintmax_t{10} << 30);  // mostly a hole
  EXPECT_THROW(FilmReader(path("film.bin")), InputError);
}

TEST(FilmCodec, DecodesOrRefusesAnyBytes) {
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

TEST(FilmQuantity, IsAccurateToAStepOrOnePercent) {
  const FilmQuantity quantity{"pressure", "Pa", "Pressure", 100.0};
  for (const double value : {0.0, 40.0, -3000.0, 2e5, 1e9})
    EXPECT_NEAR(quantity.value(quantity.code(value)), value, 51 + 0.009 * std::abs(value));
  EXPECT_EQ(quantity.code(std::numeric_limits<double>::quiet_NaN()), 0);
}

}  // namespace
}  // namespace snowshed::io
