#include "snowshed/geometry/readers/ascii_grid.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <string>

#include "snowshed/core/errors.hpp"
#include "snowshed/geometry/readers/text_scanner.hpp"
#include "snowshed/io/file_bytes.hpp"

namespace snowshed {
namespace {

constexpr double largest_side = 50'000;  // nodes
constexpr double most_nodes = 2e8;
constexpr double largest_coordinate = 1e8;  // m

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

/// As GDAL writes a missing value where the header says nodata_value nan.
bool is_nan(std::string_view word) { return lower(word) == "nan"; }

bool is_header_key(const std::string& word) {
  static const char* const keys[] = {"ncols",     "nrows",     "xllcenter", "yllcenter",
                                     "xllcorner", "yllcorner", "cellsize",  "nodata_value"};
  return std::any_of(std::begin(keys), std::end(keys),
                     [&](const char* key) { return word == key; });
}

/// Reads the lines of the header; the scanner is then at the first line of values.
Header read_header(TextScanner& scanner) {
  Header header;
  while (scanner.next_line() && is_header_key(lower(scanner.words()[0]))) {
    if (scanner.words().size() != 2) scanner.fail("a line of the header has a key and a value");
    const std::string key = lower(scanner.words()[0]);
    if (header.has(key)) scanner.fail(key + " is given twice");
    header.values[key] = key == "nodata_value" && is_nan(scanner.words()[1])
                             ? std::numeric_limits<double>::quiet_NaN()
                             : scanner.number<double>(1);
  }
  return header;
}

int count_of(const Header& header, const std::string& key, const TextScanner& scanner) {
  if (!header.has(key)) scanner.fail("the header has no " + key);
  const double count = header.at(key);
  if (!(count >= 2 && count <= largest_side) || count != std::floor(count))
    scanner.fail(key + " must be a whole number from 2 to 50000");
  return int(count);
}

/// The coordinate of the first node, given by its centre or by the corner of its cell.
double first_node(const Header& header, const std::string& axis, double cell,
                  const TextScanner& scanner) {
  const std::string centre = axis + "llcenter", corner = axis + "llcorner";
  if (header.has(centre) == header.has(corner))
    scanner.fail("the header must have one of " + centre + " and " + corner);
  const double value = header.has(centre) ? header.at(centre) : header.at(corner) + cell / 2;
  if (std::abs(value) > largest_coordinate) scanner.fail(axis + "ll... lies beyond 1e8 m");
  return value;
}

}  // namespace

HeightField read_ascii_grid(const std::filesystem::path& file) {
  const std::string text = read_bytes(file);
  TextScanner scanner(file, text);
  const Header header = read_header(scanner);
  HeightField field;
  field.columns = count_of(header, "ncols", scanner);
  field.rows = count_of(header, "nrows", scanner);
  if (!header.has("cellsize")) scanner.fail("the header has no cellsize");
  field.cell = header.at("cellsize");
  if (!(field.cell > 0 && field.cell <= 1e5))
    scanner.fail("cellsize must be above 0 and at most 1e5 m");
  field.west = first_node(header, "x", field.cell, scanner);
  field.south = first_node(header, "y", field.cell, scanner);
  const double nodata = header.has("nodata_value") ? header.at("nodata_value") : -9999;
  const std::size_t nodes = std::size_t(field.columns) * std::size_t(field.rows);
  // A value takes two bytes at least: a short file cannot ask for much memory.
  if (double(nodes) > most_nodes || nodes > text.size())
    scanner.fail("the header tells of " + std::to_string(nodes) + " values; the file is too short");
  field.heights.resize(nodes);
  std::size_t read = 0;
  for (bool more = !scanner.words().empty(); more; more = scanner.next_line())
    for (std::size_t i = 0; i < scanner.words().size(); ++i) {
      if (read == nodes) scanner.fail("more values than the header tells of");
      const bool missing = std::isnan(nodata) && is_nan(scanner.words()[i]);
      const double value = missing ? nodata : scanner.number<double>(i);
      if (std::abs(value) > 1e5 && value != nodata) scanner.fail("an elevation beyond 1e5 m");
      const int row = field.rows - 1 - int(read / std::size_t(field.columns));
      const int column = int(read++ % std::size_t(field.columns));
      field.heights[field.index(column, row)] =
          value == nodata ? std::numeric_limits<double>::quiet_NaN() : value;
    }
  if (read != nodes)
    scanner.fail(std::to_string(read) + " values; the header tells of " + std::to_string(nodes));
  return field;
}

}  // namespace snowshed
