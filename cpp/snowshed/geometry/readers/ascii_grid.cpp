#include "snowshed/geometry/readers/ascii_grid.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "snowshed/core/errors.hpp"
#include "snowshed/geometry/readers/text_scanner.hpp"
#include "snowshed/io/file_bytes.hpp"

namespace snowshed::geometry {
namespace {

// Equal to MAX_RASTER_CELLS in python/snowshed/base/limits.py, which gives the reason.
constexpr double max_raster_nodes = 25e6;
constexpr double max_side = 50'000;     // nodes
constexpr double max_coordinate = 1e8;  // m
constexpr double max_elevation = 1e5;   // m
constexpr double unknown_height = std::numeric_limits<double>::quiet_NaN();

struct Header {
  std::map<std::string, double> values;

  bool has(const std::string& key) const { return values.count(key) > 0; }
  double at(const std::string& key) const { return values.at(key); }
};

std::string lower(std::string_view word) {
  std::string text(word.substr(0, 20));
  for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// Returns whether a word is one of the spellings of "not a number" in old and new C libraries.
bool is_nan(std::string_view word) {
  if (!word.empty() && (word[0] == '-' || word[0] == '+')) word.remove_prefix(1);
  const std::string text = lower(word);
  return text.compare(0, 3, "nan") == 0 || text.compare(0, 3, "1.#") == 0;
}

/// Reads a number as GDAL does: its decimals may follow a comma. `commas` counts such numbers.
double number_of(std::string_view word, const TextScanner& scanner, std::size_t& commas) {
  if (is_nan(word)) return unknown_height;
  const std::size_t comma = word.find(',');
  if (comma == std::string_view::npos) return scanner.parse<double>(word);
  if (comma + 1 == word.size()) scanner.fail("values are separated by blanks, not by commas");
  std::string text(word.substr(0, 40));
  if (comma < text.size()) text[comma] = '.';
  ++commas;
  return scanner.parse<double>(text);
}

/// Returns the key of the header that a word stands for; an empty text if there is none.
std::string header_key(std::string_view word) {
  static const char* const keys[] = {"ncols",     "nrows",       "xllcenter", "yllcenter",
                                     "xllcorner", "yllcorner",   "cellsize",  "dx",
                                     "dy",        "nodata_value"};
  const std::string key = lower(word);
  if (key == "nodata") return "nodata_value";
  const bool known =
      std::any_of(std::begin(keys), std::end(keys), [&](const char* name) { return key == name; });
  return known ? key : "";
}

/// Reads the lines of the header; the scanner is then at the first line of values.
Header read_header(TextScanner& scanner, std::size_t& commas) {
  Header header;
  while (scanner.next_line()) {
    const std::string key = header_key(scanner.words()[0]);
    if (key.empty()) break;
    if (scanner.words().size() != 2) scanner.fail("a line of the header has a key and a value");
    if (header.has(key)) scanner.fail(key + " is given twice");
    header.values[key] = number_of(scanner.words()[1], scanner, commas);
    if (std::isnan(header.at(key)) && key != "nodata_value")
      scanner.fail("'nan' is not a valid number");
  }
  if (header.values.empty())
    scanner.fail("neither an ESRI ASCII grid, which begins with ncols, nor a GeoTIFF");
  return header;
}

/// Returns the size of the square cells.
double cell_of(const Header& header, const TextScanner& scanner) {
  const bool two = header.has("dx") || header.has("dy");
  if (header.has("cellsize") == two || (two && !(header.has("dx") && header.has("dy"))))
    scanner.fail("the header must have one of cellsize and both dx and dy");
  const double cell = header.at(two ? "dx" : "cellsize");
  if (!(cell > 0 && cell <= 1e5))
    scanner.fail(std::string(two ? "dx" : "cellsize") + " must be above 0 and at most 1e5 m");
  if (two && !(std::abs(header.at("dy") - cell) <= 1e-6 * cell))
    scanner.fail("dx and dy differ; resample the raster to square cells");
  return cell;
}

/// Returns whether a value marks a missing height. GDAL compares in single precision; some programs
/// write the largest single-precision number with fewer digits than it needs.
bool is_missing(double value, double nodata) {
  if (std::isnan(value) || value == nodata) return true;
  if (std::abs(nodata) > max_elevation) return std::abs(value - nodata) <= 1e-6 * std::abs(nodata);
  return float(value) == float(nodata);
}

int count_of(const Header& header, const std::string& key, const TextScanner& scanner) {
  if (!header.has(key)) scanner.fail("the header has no " + key);
  const double count = header.at(key);
  if (!(count >= 2 && count <= max_side) || count != std::floor(count))
    scanner.fail(key + " must be a whole number from 2 to 50000");
  return int(count);
}

/// The coordinate of the first node, given by its centre or by the corner of its cell.
double first_node(const Header& header, const std::string& axis, double cell,
                  const TextScanner& scanner) {
  const std::string center = axis + "llcenter", corner = axis + "llcorner";
  if (header.has(center) == header.has(corner))
    scanner.fail("the header must have one of " + center + " and " + corner);
  const double value = header.has(center) ? header.at(center) : header.at(corner) + cell / 2;
  if (std::abs(value) > max_coordinate) scanner.fail(axis + "ll... lies beyond 1e8 m");
  return value;
}

}  // namespace

HeightField read_ascii_grid(const std::filesystem::path& file, GridAssumptions* assumptions) {
  const std::string text = io::read_bytes(file);
  const std::string_view mark = "\xEF\xBB\xBF";
  TextScanner scanner(file,
                      std::string_view(text).substr(text.rfind(mark, 0) == 0 ? mark.size() : 0));
  GridAssumptions assumed;
  const Header header = read_header(scanner, assumed.decimal_commas);
  HeightField field;
  field.columns = count_of(header, "ncols", scanner);
  field.rows = count_of(header, "nrows", scanner);
  field.cell = cell_of(header, scanner);
  field.west = first_node(header, "x", field.cell, scanner);
  field.south = first_node(header, "y", field.cell, scanner);
  const bool declared = header.has("nodata_value");
  const double nodata = declared ? header.at("nodata_value") : -9999;
  const std::size_t nodes = std::size_t(field.columns) * std::size_t(field.rows);
  if (double(nodes) > max_raster_nodes)
    scanner.fail("the header announces " + std::to_string(nodes) + " cells; at most " +
                 std::to_string(std::size_t(max_raster_nodes)) + " are allowed; crop it first");
  // A value takes two bytes at least: a short file cannot ask for much memory.
  if (nodes > text.size())
    scanner.fail("the header announces " + std::to_string(nodes) +
                 " values; the file is too short");
  field.heights.resize(nodes);
  std::size_t read = 0;
  for (bool more = !scanner.words().empty(); more; more = scanner.next_line())
    for (const std::string_view word : scanner.words()) {
      if (read == nodes) scanner.fail("more values than the header announces");
      const double value = number_of(word, scanner, assumed.decimal_commas);
      const bool missing = is_missing(value, nodata);
      if (!missing && std::abs(value) > max_elevation)
        scanner.fail("'" + std::string(word.substr(0, 40)) + "' is beyond 1e5 m" +
                     (declared ? "" : "; the header has no nodata_value"));
      if (missing && !declared && !std::isnan(value)) ++assumed.undeclared_missing;
      const int row = field.rows - 1 - int(read / std::size_t(field.columns));
      const int column = int(read++ % std::size_t(field.columns));
      field.heights[field.index(column, row)] = missing ? unknown_height : value;
    }
  if (read != nodes)
    scanner.fail(std::to_string(read) + " values; the header announces " + std::to_string(nodes));
  if (assumptions) *assumptions = assumed;
  return field;
}

}  // namespace snowshed::geometry
