#include "snowshed/io/binary_archive.hpp"

#include <sys/stat.h>

#include <cstring>
#include <limits>
#include <stdexcept>

#include "io/forged_archive.hpp"
#include "io/temporary_folder.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/core/memory.hpp"

namespace snowshed::io {
namespace {

class BinaryArchiveTest : public TemporaryFolder {
 protected:
  /// Writes a small archive: text of 3 bytes, 3 floats, 2 integers of 64 bits, an empty array.
  std::string write_sample() const {
    const std::vector<float> speed = {1.5f, -2.0f, 0.25f};
    BinaryWriter writer;
    writer.add_text("scene", "{ }");
    writer.add("speed", speed);
    writer.add("index", std::vector<std::int64_t>{7, -9});
    writer.add("none", std::vector<double>{});
    writer.save(path("sample"));
    return content(path("sample"));
  }

  std::string sample() const { return sample_; }

  BinaryReader load(const std::string& bytes) const {
    write_plainly(path("damaged"), bytes);
    return BinaryReader::load(path("damaged"));
  }

  std::string load_error(const std::string& bytes) const {
    return message_of<InputError>([&] { load(bytes); });
  }

  /// Returns the sample with a number replaced and a valid checksum, as if it were manipulated.
  template <class T>
  std::string forged(std::size_t offset, T value) const {
    return snowshed::io::forged(sample(), offset, value);
  }

 private:
  const std::string sample_ = write_sample();
};

// Offsets in the sample. The first section follows the header of 24 bytes. Its own header has type,
// name length, count and bytes.
constexpr std::size_t sections_at = 12, length_at = 16, type_at = 24, name_length_at = 28,
                      count_at = 32, bytes_at = 40, name_at = 48;

TEST_F(BinaryArchiveTest, ReturnsTheAddedSections) {
  const BinaryReader reader = load(sample());
  EXPECT_EQ(reader.names(), (std::vector<std::string>{"scene", "speed", "index", "none"}));
  EXPECT_EQ(reader.text("scene"), "{ }");
  EXPECT_EQ(reader.get<float>("speed"), (std::vector<float>{1.5f, -2.0f, 0.25f}));
  EXPECT_EQ(reader.get<std::int64_t>("index", 2), (std::vector<std::int64_t>{7, -9}));
  EXPECT_TRUE(reader.get<double>("none").empty());
  EXPECT_TRUE(reader.has("speed"));
  EXPECT_FALSE(reader.has("spee"));
}

template <class T>
void add_extremes(BinaryWriter& writer, const std::string& name) {
  writer.add(name, std::vector<T>{std::numeric_limits<T>::lowest(), std::numeric_limits<T>::max(),
                                  std::numeric_limits<T>::min()});
}

template <class T>
void expect_extremes(const BinaryReader& reader, const std::string& name) {
  EXPECT_EQ(reader.get<T>(name),
            (std::vector<T>{std::numeric_limits<T>::lowest(), std::numeric_limits<T>::max(),
                            std::numeric_limits<T>::min()}));
  const auto address = reinterpret_cast<std::uintptr_t>(reader.view<T>(name).data);
  EXPECT_EQ(address % alignof(T), 0u);
}

TEST_F(BinaryArchiveTest, KeepsEveryTypeExactly) {
  BinaryWriter writer;
  add_extremes<float>(writer, "f");
  add_extremes<double>(writer, "d");
  add_extremes<std::int32_t>(writer, "i");
  add_extremes<std::int64_t>(writer, "l");
  add_extremes<std::uint8_t>(writer, "b");
  add_extremes<std::uint16_t>(writer, "h");
  add_extremes<std::uint32_t>(writer, "u");
  add_extremes<std::uint64_t>(writer, "m");
  writer.save(path("a"));
  const BinaryReader reader = BinaryReader::load(path("a"));
  expect_extremes<float>(reader, "f");
  expect_extremes<double>(reader, "d");
  expect_extremes<std::int32_t>(reader, "i");
  expect_extremes<std::int64_t>(reader, "l");
  expect_extremes<std::uint8_t>(reader, "b");
  expect_extremes<std::uint16_t>(reader, "h");
  expect_extremes<std::uint32_t>(reader, "u");
  expect_extremes<std::uint64_t>(reader, "m");
}

TEST_F(BinaryArchiveTest, KeepsSingleValuesAndRawArrays) {
  const double raw[] = {1.0, 2.0};
  BinaryWriter writer;
  writer.add_value("time", 0.1);
  writer.add_value("step", std::uint64_t{1} << 60);
  writer.add("raw", raw, 2);
  writer.save(path("a"));
  const BinaryReader reader = BinaryReader::load(path("a"));
  EXPECT_EQ(reader.value<double>("time"), 0.1);
  EXPECT_EQ(reader.value<std::uint64_t>("step"), std::uint64_t{1} << 60);
  EXPECT_EQ(reader.view<double>("raw")[1], 2.0);
  EXPECT_THROW(reader.value<double>("raw"), InputError);
}

TEST_F(BinaryArchiveTest, KeepsAnEmptyArchive) {
  BinaryWriter().save(path("a"));
  EXPECT_TRUE(BinaryReader::load(path("a")).names().empty());
}

TEST_F(BinaryArchiveTest, EqualContentGivesEqualBytes) { EXPECT_EQ(write_sample(), sample()); }

TEST_F(BinaryArchiveTest, RefusesRepeatedAndEmptyNames) {
  BinaryWriter writer;
  writer.add_value("a", 1.0);
  EXPECT_THROW(writer.add_value("a", 2.0), std::invalid_argument);
  EXPECT_THROW(writer.add_value("", 2.0), std::invalid_argument);
}

TEST_F(BinaryArchiveTest, DetectsTruncationAtEveryByte) {
  const std::string bytes = sample();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const std::string message = load_error(bytes.substr(0, size));
    EXPECT_NE(message.find("truncated"), std::string::npos) << size << ": " << message;
    EXPECT_NE(message.find("byte " + std::to_string(size) + ":"), std::string::npos) << message;
  }
}

TEST_F(BinaryArchiveTest, DetectsEveryFlippedBit) {
  const std::string bytes = sample();
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    std::string flipped = bytes;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
    EXPECT_THROW(load(flipped), InputError) << "bit " << bit;
  }
}

TEST_F(BinaryArchiveTest, DetectsExcessBytes) {
  EXPECT_NE(load_error(sample() + "12345678").find("corrupted"), std::string::npos);
}

TEST_F(BinaryArchiveTest, ErrorsNameOffsetAndCause) {
  const std::string file = path("damaged").string();
  EXPECT_EQ(load_error("solid snow, not an archive"), file + ": byte 0: not a snowshed archive");
  EXPECT_EQ(load_error(forged(8, std::uint32_t{9})),
            file + ": byte 8: format version 9, this program reads version 1");
  std::string damaged = sample();
  damaged[name_at] = 'S';
  EXPECT_EQ(load_error(damaged), file + ": byte " + std::to_string(damaged.size() - 8) +
                                     ": corrupted: the checksum does not match the content");
}

TEST_F(BinaryArchiveTest, RefusesForgedCounts) {
  const auto huge = std::numeric_limits<std::uint64_t>::max();
  for (const std::uint64_t count : {huge, huge - 7, huge / 2, std::uint64_t{1} << 40})
    for (const std::size_t at : {count_at, bytes_at})
      EXPECT_NE(load_error(forged(at, count)).find("byte 24: a section of"), std::string::npos);
  EXPECT_THROW(load(forged(length_at, huge)), InputError);  // the length of the file
  for (const std::uint32_t count : {0u, 3u, 5u, ~0u})
    EXPECT_THROW(load(forged(sections_at, count)), InputError);
}

TEST_F(BinaryArchiveTest, RefusesForgedTypesAndNames) {
  for (const std::uint32_t type : {0u, 10u, ~0u})
    EXPECT_NE(load_error(forged(type_at, type)).find("unknown element type"), std::string::npos);
  for (const std::uint32_t length : {0u, 256u, ~0u})
    EXPECT_NE(load_error(forged(name_length_at, length)).find("section name"), std::string::npos);
}

TEST_F(BinaryArchiveTest, RefusesRepeatedSections) {
  std::string bytes = sample();
  bytes.replace(name_at, 5, "speed");
  EXPECT_NE(load_error(with_valid_sum(bytes)).find("'speed' occurs twice"), std::string::npos);
}

TEST_F(BinaryArchiveTest, ReadingTimeIsProportionalToTheSections) {
  constexpr std::uint32_t sections = 100'000;  // comparing all pairs would take minutes
  std::string bytes = sample().substr(0, type_at);
  for (std::uint32_t i = 0; i < sections; ++i) {
    const std::uint32_t header[] = {6, 8, 0, 0, 0, 0};  // a section of bytes without elements
    bytes.append(reinterpret_cast<const char*>(header), sizeof header);
    bytes.append(std::to_string(10'000'000 + i));
  }
  const std::uint64_t length = bytes.size() + 8;
  std::memcpy(&bytes[sections_at], &sections, sizeof sections);
  std::memcpy(&bytes[length_at], &length, sizeof length);
  EXPECT_EQ(load(with_valid_sum(bytes + "checksum")).names().size(), sections);
}

TEST_F(BinaryArchiveTest, DetectsNonFiniteNumbers) {
  load(sample()).require_finite();
  BinaryWriter writer;
  writer.add("count", std::vector<std::uint64_t>(2, ~std::uint64_t{0}));  // NaN if read as a double
  writer.add("time", std::vector<double>{1.0, 2.0, -std::numeric_limits<double>::infinity()});
  writer.save(path("double"));
  EXPECT_EQ(
      message_of<InputError>([&] { BinaryReader::load(path("double")).require_finite(); }),
      path("double").string() + ": byte 120: element 2 of section 'time' is not a finite number");
  writer = {};
  writer.add("speed", std::vector<float>{std::numeric_limits<float>::quiet_NaN()});
  writer.save(path("float"));
  EXPECT_THROW(BinaryReader::load(path("float")).require_finite(), InputError);
}

TEST_F(BinaryArchiveTest, SurvivesEveryForgedByte) {
  const std::string bytes = sample();
  for (std::size_t i = 0; i + 8 < bytes.size(); ++i)
    for (const char value : {'\x00', '\x01', '\x7f', '\xff'}) {
      try {
        const BinaryReader reader = load(forged(i, value));
        for (const std::string& name : reader.names()) reader.has(name);
      } catch (const InputError&) {
      }
    }
}

TEST_F(BinaryArchiveTest, NamesWrongTypesAndMissingSections) {
  const BinaryReader reader = load(sample());
  EXPECT_NE(message_of<InputError>([&] {
              reader.get<double>("speed");
            }).find("section 'speed' holds float32, expected float64"),
            std::string::npos);
  EXPECT_NE(
      message_of<InputError>([&] { reader.get<float>("mass"); }).find("section 'mass' is missing"),
      std::string::npos);
  EXPECT_NE(message_of<InputError>([&] {
              reader.get<float>("speed", 4);
            }).find("section 'speed' has 3 elements, expected 4"),
            std::string::npos);
  EXPECT_THROW(reader.text("speed"), InputError);
}

TEST_F(BinaryArchiveTest, AbsentFilesAndFoldersAreFileErrors) {
  EXPECT_EQ(message_of<FileError>([&] { BinaryReader::load(path("absent")); }),
            path("absent").string() + ": cannot read the file: No such file or directory");
  EXPECT_THROW(BinaryReader::load(path("")), FileError);
}

TEST_F(BinaryArchiveTest, DoesNotWaitForPipes) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  EXPECT_THROW(BinaryReader::load(path("pipe")), FileError);
  EXPECT_THROW(BinaryReader::load("/dev/zero"), FileError);
}

TEST_F(BinaryArchiveTest, RefusesFilesLargerThanMemory) {
  write_plainly(path("sparse"), sample());
  std::error_code error;
  std::filesystem::resize_file(path("sparse"), std::uintmax_t{1} << 43, error);
  if (error) GTEST_SKIP() << "the folder holds no sparse files";
  EXPECT_THROW(BinaryReader::load(path("sparse")), InputError);
}

TEST_F(BinaryArchiveTest, ReadsOnlyTheHeaderOfAFileOfWrongLength) {
  write_plainly(path("sparse"), sample());
  std::error_code error;
  std::filesystem::resize_file(path("sparse"), std::uintmax_t{1} << 30, error);
  if (error) GTEST_SKIP() << "the folder holds no sparse files";
  const std::size_t before = peak_resident_bytes();
  EXPECT_THROW(BinaryReader::load(path("sparse")), InputError);
  EXPECT_LT(peak_resident_bytes(), before + (std::size_t{1} << 28));
}

TEST_F(BinaryArchiveTest, SavingToAFullDiskIsAFileError) {
  if (!std::filesystem::is_character_file("/dev/full")) GTEST_SKIP() << "needs /dev/full";
  BinaryWriter writer;
  writer.add("speed", std::vector<float>(100'000, 1.0f));
  EXPECT_THROW(writer.save("/dev/full"), FileError);
}

}  // namespace
}  // namespace snowshed::io
