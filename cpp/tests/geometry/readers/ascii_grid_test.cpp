#include "snowshed/geometry/readers/ascii_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "io/temporary_folder.hpp"
#include "snowshed/core/errors.hpp"

namespace snowshed::geometry {
namespace {

const std::string good =
    "NCOLS 3\nnrows 2\nxllcorner 1000\nyllcorner 2000\ncellsize 10\nnodata_value -9\n"
    "1 2 3\n4 5 -9\n";

class AsciiGrid : public io::TemporaryFolder {
 protected:
  HeightField read(const std::string& text) {
    write_plainly(path("a.asc"), text);
    return read_ascii_grid(path("a.asc"));
  }
};

std::string replaced(std::string text, const std::string& old, const std::string& by) {
  return text.replace(text.find(old), old.size(), by);
}

TEST_F(AsciiGrid, NodesAreCellCentersAndTheFirstRowIsTheSouthernmost) {
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

TEST_F(AsciiGrid, NanIsMissingWhateverTheHeaderSays) {
  const HeightField f = read(replaced(replaced(good, "value -9", "value nan"), "5 -9", "NaN -9"));
  EXPECT_TRUE(std::isnan(f.height(1, 0)));
  EXPECT_DOUBLE_EQ(f.height(2, 0), -9);
  for (const char* word : {"nan", "-nan", "NaN", "nan(ind)", "1.#QNAN", "-1.#IND"})
    EXPECT_TRUE(std::isnan(read(replaced(good, "4 5", std::string(word) + " 5")).height(0, 0)));
}

TEST_F(AsciiGrid, MissingValuesAreComparedInSinglePrecisionAsGdalDoes) {
  for (const auto& [header, word] : std::vector<std::pair<std::string, std::string>>{
           {"-3.4028234663852886e+38", "-3.40282346638529e+38"},
           {"-3.4028234663852886e+38", "-3.402823e+38"},
           {"-340282346638528859811704183484516925440", "-3.4028235e38"},
           {"-32767.1", "-32767.0996"},
           {"0", "0.0"}}) {
    const HeightField f =
        read(replaced(replaced(good, "value -9", "value " + header), "4 5", word + " 5"));
    EXPECT_TRUE(std::isnan(f.height(0, 0))) << word;
    EXPECT_DOUBLE_EQ(f.height(1, 0), 5);
  }
}

TEST_F(AsciiGrid, CellSizesMayBeGivenPerAxis) {
  EXPECT_DOUBLE_EQ(read(replaced(good, "cellsize 10", "dx 10\nDY 10.0")).cell, 10);
}

TEST_F(AsciiGrid, AssumedValuesAreCounted) {
  write_plainly(path("a.asc"),
                "ncols 2\nnrows 2\nxllcorner 0,5\nyllcorner 0\ncellsize 1\n"
                "1,25 2\n3 -9999\n");
  GridAssumptions assumptions;
  const HeightField f = read_ascii_grid(path("a.asc"), &assumptions);
  EXPECT_DOUBLE_EQ(f.height(0, 1), 1.25);
  EXPECT_DOUBLE_EQ(f.west, 1);
  EXPECT_EQ(assumptions.decimal_commas, 2u);
  EXPECT_EQ(assumptions.undeclared_missing, 1u);
}

TEST_F(AsciiGrid, LinesMayBreakAnywhere) {
  EXPECT_EQ(read(replaced(good, "1 2 3\n4", "1\n2 3 4")).heights.size(), 6u);
}

TEST_F(AsciiGrid, RefusesInvalidGrids) {
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
           {"4 5", "4, 5"},
           {"4 5", "4,5,6 5"},
           {"4 5", "inf 5"},
           {"NCOLS 3", "ncols 49999\nnrows 49999"},
           {"cellsize 10", "dx 10"},
           {"cellsize 10", "dx 10\ndy 11"},
           {"cellsize 10", "cellsize 10\ndx 10\ndy 10"},
           {"4 5", "4 5 6"},
           {"4 5 -9", "4"}})
    EXPECT_THROW(read(replaced(good, old, by)), InputError) << by;
}

}  // namespace
}  // namespace snowshed::geometry
