#include "snowshed/geometry/readers/ascii_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "io/temporary_folder.hpp"
#include "snowshed/core/errors.hpp"

namespace snowshed {
namespace {

const std::string good =
    "NCOLS 3\nnrows 2\nxllcorner 1000\nyllcorner 2000\ncellsize 10\nnodata_value -9\n"
    "1 2 3\n4 5 -9\n";

class AsciiGrid : public TemporaryFolder {
 protected:
  HeightField read(const std::string& text) {
    write_plainly(path("a.asc"), text);
    return read_ascii_grid(path("a.asc"));
  }
};

std::string replaced(std::string text, const std::string& old, const std::string& by) {
  return text.replace(text.find(old), old.size(), by);
}

TEST_F(AsciiGrid, nodes_are_the_middles_of_cells_and_the_first_row_is_the_southern_one) {
  const HeightField f = read(good);
  EXPECT_EQ(f.columns, 3);
  EXPECT_EQ(f.rows, 2);
  EXPECT_DOUBLE_EQ(f.west, 1005);
  EXPECT_DOUBLE_EQ(f.south, 2005);
  EXPECT_DOUBLE_EQ(f.height(0, 0), 4);
  EXPECT_DOUBLE_EQ(f.height(2, 1), 3);
  EXPECT_TRUE(std::isnan(f.height(2, 0)));
  EXPECT_DOUBLE_EQ(read(replaced(good, "xllcorner", "xllcenter")).west, 1000);
}

TEST_F(AsciiGrid, a_missing_value_may_be_nan_where_the_header_says_so) {
  const HeightField f = read(replaced(replaced(good, "value -9", "value nan"), "5 -9", "NaN -9"));
  EXPECT_TRUE(std::isnan(f.height(1, 0)));
  EXPECT_DOUBLE_EQ(f.height(2, 0), -9);
  EXPECT_THROW(read(replaced(good, "5 -9", "nan -9")), InputError);
}

TEST_F(AsciiGrid, lines_may_break_anywhere) {
  EXPECT_EQ(read(replaced(good, "1 2 3\n4", "1\n2 3 4")).heights.size(), 6u);
}

TEST_F(AsciiGrid, refuses_what_is_no_grid) {
  for (const auto& [old, by] : std::vector<std::pair<std::string, std::string>>{
           {"NCOLS 3", "ncols 1"},
           {"NCOLS 3", "ncols 1e300"},
           {"NCOLS 3", "ncols 40000\nncols 2"},
           {"nrows 2", "nrows 49999"},  // would ask for memory that the file cannot fill
           {"cellsize 10", "cellsize 0"},
           {"xllcorner 1000", "xllcorner nan"},
           {"xllcorner 1000\n", ""},
           {"4 5", "4 five"},
           {"4 5", "4 1e9"},
           {"4 5", "4 5 6"},
           {"4 5 -9", "4"}})
    EXPECT_THROW(read(replaced(good, old, by)), InputError) << by;
}

}  // namespace
}  // namespace snowshed
