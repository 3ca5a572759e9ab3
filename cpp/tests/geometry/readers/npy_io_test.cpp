#include "snowshed/geometry/readers/npy_io.hpp"

#include "geometry/geometry_testing.hpp"
#include "geometry/readers/npy_testing.hpp"

namespace snowshed::geometry {
namespace {

using namespace geometry_testing;

class NpyIo : public ::testing::Test {
 protected:
  NpyArray read(const std::string& content) { return read_npy(dir.write("a.npy", content)); }
  void expect_refused(const std::string& content, const std::string& expected) {
    expect_input_error([&] { read(content); }, expected);
    expect_input_error([&] { read(content); }, "a.npy");
  }
  const std::vector<double> numbers = {0, 1, 2, 3, 4, -5.5};
  TempDir dir;
};

TEST_F(NpyIo, ReadsEveryVersionAndType) {
  const std::vector<float> expected(numbers.begin(), numbers.end());
  for (int major = 1; major <= 3; ++major) {
    const NpyArray wide = read(npy_file(major, npy_header("<f8", "(2, 3)"), npy_data(numbers)));
    EXPECT_EQ(wide.shape, (std::vector<std::size_t>{2, 3}));
    EXPECT_EQ(wide.values, expected);
    const NpyArray narrow =
        read(npy_file(major, npy_header("<f4", "(1,3,2,)"), npy_data(expected)));
    EXPECT_EQ(narrow.shape, (std::vector<std::size_t>{1, 3, 2}));
    EXPECT_EQ(narrow.values, expected);
  }
}

TEST_F(NpyIo, RefusesOtherArrays) {
  const std::string data = npy_data(numbers);
  expect_refused(npy_file(1, npy_header(">f8", "(2, 3)"), data), "descr");
  expect_refused(npy_file(1, npy_header("<i8", "(2, 3)"), data), "descr");
  expect_refused(npy_file(1, npy_header("|O", "(2, 3)"), data), "descr");
  expect_refused(npy_file(1, npy_header("<f8", "(6,)"), data), "shape");
  expect_refused(npy_file(1, npy_header("<f8", "(1, 1, 2, 3)"), data), "shape");
  expect_refused(npy_file(1, npy_header("<f8", "(-2, 3)"), data), "shape");
  expect_refused(npy_file(1, "{'descr': '<f8', 'fortran_order': True, 'shape': (2, 3), }", data),
                 "C order");
  expect_refused(npy_file(4, npy_header("<f8", "(2, 3)"), data), "version 4");
}

TEST_F(NpyIo, RefusesDamagedFiles) {
  const std::string good = npy_file(1, npy_header("<f8", "(2, 3)"), npy_data(numbers));
  expect_refused("", "not a .npy");
  expect_refused("\x93NUMPY", "byte");
  expect_refused(good.substr(0, 30), "header");
  expect_refused(good.substr(0, good.size() - 1), "there are 47");
  expect_refused(good + "x", "there are 49");
  expect_refused(
      npy_file(1, npy_header("<f8", "(999999999, 999999999, 999999999)"), npy_data(numbers)),
      "the shape asks for");
  expect_refused(npy_file(1, npy_header("<f8", "(99999999999999999999, 3)"), npy_data(numbers)),
                 "shape");
  expect_refused(npy_file(1, npy_header("<f8", "(1, 2)"), npy_data<double>({1, std::nan("")})),
                 "finite");
  std::string long_header = good;
  long_header.replace(8, 2, "\xff\xff");
  expect_refused(long_header, "header of 65535");
}

TEST_F(NpyIo, SurvivesDamage) {
  const std::string good = npy_file(1, npy_header("<f8", "(2, 3)"), npy_data(numbers));
  Random random(16);
  int refused = 0;
  for (int n = 0; n < 500; ++n) {
    std::string damaged = good;
    for (int hit = 0; hit < 3; ++hit)
      damaged[random.next() % damaged.size()] = static_cast<char>(random.next());
    try {
      read(damaged);
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 50);
}

/// Every integer type gives the same labels.
template <class Integer>
void expect_labels(const TempDir& dir, const std::string& type) {
  const std::vector<Integer> values = {0, 1, 2, 127, 0, 3};
  const std::string content = npy_file(1, npy_header(type, "(1, 2, 3)"), npy_data(values));
  const NpyLabels labels = read_npy_labels(dir.write("a.npy", content));
  EXPECT_EQ(labels.shape, (std::vector<std::size_t>{1, 2, 3})) << type;
  EXPECT_EQ(labels.values, (std::vector<std::int32_t>{0, 1, 2, 127, 0, 3})) << type;
}

TEST_F(NpyIo, ReadsLabelsOfEveryType) {
  expect_labels<std::int8_t>(dir, "|i1");
  expect_labels<std::uint8_t>(dir, "|u1");
  expect_labels<std::int16_t>(dir, "<i2");
  expect_labels<std::uint16_t>(dir, "<u2");
  expect_labels<std::int32_t>(dir, "<i4");
  expect_labels<std::uint32_t>(dir, "<u4");
  expect_labels<std::int64_t>(dir, "<i8");
  expect_labels<std::uint64_t>(dir, "<u8");
}

TEST_F(NpyIo, RefusesInvalidLabels) {
  const auto expect_no_labels = [&](const std::string& content, const std::string& expected) {
    expect_input_error([&] { read_npy_labels(dir.write("a.npy", content)); }, expected);
  };
  const std::vector<std::int64_t> labels = {1, 2};
  const auto file_of = [&](const std::string& type, const std::string& shape, std::int64_t last) {
    return npy_file(1, npy_header(type, shape), npy_data<std::int64_t>({1, last}));
  };
  expect_no_labels(file_of("<f8", "(1, 1, 2)", 2), "allowed: integers of 1 to 8 bytes");
  expect_no_labels(file_of(">i8", "(1, 1, 2)", 2), "descr");
  expect_no_labels(file_of("<i8", "(1, 2)", 2), "three counts");
  expect_no_labels(file_of("<i8", "(1, 1, 2)", -1), "negative or above");
  expect_no_labels(file_of("<i8", "(1, 1, 2)", std::int64_t(1) << 31), "negative or above");
  expect_no_labels(file_of("<u8", "(1, 1, 2)", -1), "negative or above");  // 2^64 - 1
  expect_no_labels(file_of("<i8", "(999999999, 999999999, 999999999)", 1), "the shape asks for");
  expect_no_labels(file_of("<i8", "(1, 1, 3)", 1), "the shape asks for");
  expect_no_labels(npy_file(2, std::string(100000, ' '), npy_data(labels)), "a header of");
}

}  // namespace
}  // namespace snowshed::geometry
