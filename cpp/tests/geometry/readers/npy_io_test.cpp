#include "snowshed/geometry/readers/npy_io.hpp"

#include "geometry/geometry_testing.hpp"
#include "geometry/readers/npy_testing.hpp"

namespace snowshed {
namespace {

using namespace geometry_testing;

class NpyIo : public ::testing::Test {
 protected:
  NpyArray read(const std::string& content) { return read_npy(dir.write("a.npy", content)); }
  void expect_refused(const std::string& content, const std::string& expected) {
    expect_input_error([&] { read(content); }, expected);
    expect_input_error([&] { read(content); }, "a.npy");
  }
  const std::vector<double> six = {0, 1, 2, 3, 4, -5.5};
  TempDir dir;
};

TEST_F(NpyIo, ReadsEveryVersionAndType) {
  const std::vector<float> expected(six.begin(), six.end());
  for (int major = 1; major <= 3; ++major) {
    const NpyArray wide = read(npy_file(major, npy_header("<f8", "(2, 3)"), npy_data(six)));
    EXPECT_EQ(wide.shape, (std::vector<std::size_t>{2, 3}));
    EXPECT_EQ(wide.values, expected);
    const NpyArray narrow =
        read(npy_file(major, npy_header("<f4", "(1,3,2,)"), npy_data(expected)));
    EXPECT_EQ(narrow.shape, (std::vector<std::size_t>{1, 3, 2}));
    EXPECT_EQ(narrow.values, expected);
  }
}

TEST_F(NpyIo, RefusesOtherArrays) {
  const std::string data = npy_data(six);
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
  const std::string good = npy_file(1, npy_header("<f8", "(2, 3)"), npy_data(six));
  expect_refused("", "not a .npy");
  expect_refused("\x93NUMPY", "byte");
  expect_refused(good.substr(0, 30), "header");
  expect_refused(good.substr(0, good.size() - 1), "there are 47");
  expect_refused(good + "x", "there are 49");
  expect_refused(npy_file(1, npy_header("<f8", "(999999999, 999999999, 999999999)"), npy_data(six)),
                 "the shape asks for");
  expect_refused(npy_file(1, npy_header("<f8", "(99999999999999999999, 3)"), npy_data(six)),
                 "shape");
  expect_refused(npy_file(1, npy_header("<f8", "(1, 2)"), npy_data<double>({1, std::nan("")})),
                 "finite");
  std::string long_header = good;
  long_header.replace(8, 2, "\xff\xff");
  expect_refused(long_header, "header of 65535");
}

TEST_F(NpyIo, SurvivesDamage) {
  const std::string good = npy_file(1, npy_header("<f8", "(2, 3)"), npy_data(six));
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

}  // namespace
}  // namespace snowshed
