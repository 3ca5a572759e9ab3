#include "snowshed/io/vtp_writer.hpp"

#include <cinttypes>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <type_traits>

#include "snowshed/io/atomic_file.hpp"
#include "snowshed/io/checksum.hpp"
#include "snowshed/io/xml_text.hpp"

namespace snowshed::io {
namespace {

template <class T>
constexpr const char* vtk_type() {
  if constexpr (std::is_same_v<T, float>) return "Float32";
  if constexpr (std::is_same_v<T, double>) return "Float64";
  if constexpr (std::is_same_v<T, std::int32_t>) return "Int32";
  if constexpr (std::is_same_v<T, std::int64_t>) return "Int64";
  if constexpr (std::is_same_v<T, std::uint16_t>) return "UInt16";
  if constexpr (std::is_same_v<T, std::uint8_t>) return "UInt8";
}

/// A file that ends with the checksum of all bytes before, in a comment, so that programs that show
/// the file can ignore it.
class ChecksummedXml {
 public:
  explicit ChecksummedXml(const std::filesystem::path& path) : file_(path) {}

  void write(const void* data, std::size_t bytes) {
    sum_.update(data, bytes);
    file_.write(data, bytes);
  }
  void write(std::string_view text) { write(text.data(), text.size()); }

  void finish() {
    char comment[32];
    std::snprintf(comment, sizeof comment, "  <!-- crc32 %08" PRIx32 " -->\n", sum_.value());
    file_.write(std::string(comment) + "</VTKFile>\n");
    file_.commit();
  }

 private:
  AtomicFile file_;
  Crc32 sum_;
};

/// The raw data that follow the XML. Each block is preceded by its length.
class AppendedData {
 public:
  /// Adds a block and returns the XML element that refers to it.
  template <class T>
  std::string add(const std::string& name, int components, const T* data, std::size_t count) {
    blocks_.push_back({data, count * sizeof(T)});
    const std::string element = std::string("        <DataArray type=\"") + vtk_type<T>() +
                                "\" Name=\"" + xml_escape(name) + "\" NumberOfComponents=\"" +
                                std::to_string(components) + "\" format=\"appended\" offset=\"" +
                                std::to_string(offset_) + "\"/>\n";
    offset_ += sizeof(std::uint64_t) + count * sizeof(T);
    return element;
  }

  void write(ChecksummedXml& file) const {
    for (const Block& block : blocks_) {
      file.write(&block.bytes, sizeof block.bytes);
      file.write(block.data, block.bytes);
    }
  }

 private:
  struct Block {
    const void* data;
    std::uint64_t bytes;
  };
  std::vector<Block> blocks_;
  std::uint64_t offset_ = 0;
};

/// The arrays of points, or of cells.
std::string data_of(const std::vector<PointArray>& arrays, std::size_t points,
                    AppendedData& appended) {
  std::string xml;
  for (const PointArray& array : arrays)
    std::visit(
        [&](const auto& values) {
          if (array.components < 1 || values.size() != points * std::size_t(array.components))
            throw std::invalid_argument("point array '" + array.name + "' has " +
                                        std::to_string(values.size()) + " values for " +
                                        std::to_string(points) + " points of " +
                                        std::to_string(array.components) + " components");
          xml += appended.add(array.name, array.components, values.data(), values.size());
        },
        array.values);
  return xml;
}

/// The beginning of a file with these numbers of cells.
std::string head(std::size_t points, std::size_t vertices, std::size_t lines,
                 std::size_t polygons) {
  const auto number = [](const char* name, std::size_t count) {
    return std::string(" NumberOf") + name + "=\"" + std::to_string(count) + "\"";
  };
  return "<?xml version=\"1.0\"?>\n"
         "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
         "header_type=\"UInt64\">\n"
         "  <PolyData>\n"
         "    <Piece" +
         number("Points", points) + number("Verts", vertices) + number("Lines", lines) +
         number("Strips", 0) + number("Polys", polygons) + ">\n";
}

/// Ends the XML and writes the file.
void finish(const std::filesystem::path& path, std::string xml, const AppendedData& appended) {
  xml +=
      "    </Piece>\n"
      "  </PolyData>\n"
      "  <AppendedData encoding=\"raw\">\n_";
  ChecksummedXml file(path);
  file.write(xml);
  appended.write(file);
  file.write("\n  </AppendedData>\n");
  file.finish();
}

/// Writes the file. Every point is a cell, so that filters on cells (threshold, clip) see
/// particles.
template <class Index, class Real>
void write(const std::filesystem::path& path, const std::vector<std::array<Real, 3>>& points,
           const std::vector<PointArray>& arrays, const PointPairs& lines) {
  const std::size_t count = points.size();
  std::vector<Index> index(count + 1);  // 0, 1, …: connectivity; from 1 on: ends of the cells
  std::iota(index.begin(), index.end(), Index{0});

  std::vector<Index> line_points, line_ends;
  line_points.reserve(2 * lines.size());
  line_ends.reserve(lines.size());
  for (const auto& line : lines) {
    line_points.insert(line_points.end(), {Index(line[0]), Index(line[1])});
    line_ends.push_back(Index(line_points.size()));
  }

  AppendedData appended;
  const Real* coordinates = points.empty() ? nullptr : points.front().data();
  std::string xml = head(count, count, lines.size(), 0);
  xml += "      <Points>\n" + appended.add("position", 3, coordinates, 3 * count) +
         "      </Points>\n";
  xml += "      <PointData>\n" + data_of(arrays, count, appended) + "      </PointData>\n";
  xml += "      <Verts>\n" + appended.add("connectivity", 1, index.data(), count) +
         appended.add("offsets", 1, index.data() + 1, count) + "      </Verts>\n";
  if (!lines.empty())
    xml += "      <Lines>\n" +
           appended.add("connectivity", 1, line_points.data(), line_points.size()) +
           appended.add("offsets", 1, line_ends.data(), line_ends.size()) + "      </Lines>\n";
  finish(path, xml, appended);
}

template <class Real>
void write_with_smallest_index(const std::filesystem::path& path,
                               const std::vector<std::array<Real, 3>>& points,
                               const std::vector<PointArray>& arrays,
                               const PointPairs& lines = {}) {
  if (points.size() < std::size_t(std::numeric_limits<std::int32_t>::max()))
    write<std::int32_t>(path, points, arrays, lines);
  else
    write<std::int64_t>(path, points, arrays, lines);
}

}  // namespace

void write_vtp(const std::filesystem::path& path, const std::vector<std::array<float, 3>>& points,
               const std::vector<PointArray>& arrays, const PointPairs& lines) {
  write_with_smallest_index(path, points, arrays, lines);
}

void write_vtp(const std::filesystem::path& path, const std::vector<std::array<double, 3>>& points,
               const std::vector<PointArray>& arrays) {
  write_with_smallest_index(path, points, arrays);
}

void write_faces_vtp(const std::filesystem::path& path,
                     const std::vector<std::array<double, 3>>& corners, std::size_t per_face,
                     const std::vector<PointArray>& arrays) {
  const std::size_t faces = corners.size() / per_face;
  const bool lines = per_face == 2;
  std::vector<std::int64_t> index(corners.size()), ends(faces);
  std::iota(index.begin(), index.end(), 0);
  for (std::size_t i = 0; i < faces; ++i) ends[i] = std::int64_t((i + 1) * per_face);
  AppendedData appended;
  const char* kind = lines ? "Lines" : "Polys";
  const double* coordinates = corners.empty() ? nullptr : corners.front().data();
  std::string xml = head(corners.size(), 0, lines ? faces : 0, lines ? 0 : faces);
  xml += "      <Points>\n" + appended.add("position", 3, coordinates, 3 * corners.size()) +
         "      </Points>\n";
  xml += "      <CellData>\n" + data_of(arrays, faces, appended) + "      </CellData>\n";
  xml += std::string("      <") + kind + ">\n" +
         appended.add("connectivity", 1, index.data(), index.size()) +
         appended.add("offsets", 1, ends.data(), ends.size()) + "      </" + kind + ">\n";
  finish(path, xml, appended);
}

}  // namespace snowshed::io
