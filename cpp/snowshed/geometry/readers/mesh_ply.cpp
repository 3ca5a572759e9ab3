#include <cmath>
#include <map>
#include <memory>
#include <optional>

#include "snowshed/geometry/polygon_faces.hpp"
#include "snowshed/geometry/readers/byte_reader.hpp"
#include "snowshed/geometry/readers/mesh_formats.hpp"
#include "snowshed/geometry/readers/text_scanner.hpp"

namespace snowshed::geometry {
namespace {

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::optional<Type> type_named(std::string_view name) {
  static const std::map<std::string_view, Type> types = {
      {"char", Type::int8},      {"int8", Type::int8},       {"uchar", Type::uint8},
      {"uint8", Type::uint8},    {"short", Type::int16},     {"int16", Type::int16},
      {"ushort", Type::uint16},  {"uint16", Type::uint16},   {"int", Type::int32},
      {"int32", Type::int32},    {"uint", Type::uint32},     {"uint32", Type::uint32},
      {"float", Type::float32},  {"float32", Type::float32}, {"double", Type::float64},
      {"float64", Type::float64}};
  const auto entry = types.find(name);
  return entry == types.end() ? std::nullopt : std::optional<Type>(entry->second);
}

struct Property {
  std::string name;
  Type type;
  std::optional<Type> count_type;  // type of a list's length
};

struct Element {
  std::string name;
  std::uint64_t count;
  std::vector<Property> properties;
};

/// The values after the header, row by row.
class Rows {
 public:
  virtual ~Rows() = default;
  virtual void begin_row() {}
  virtual void end_row() {}
  virtual double value(Type type) = 0;
  virtual std::size_t remaining_bytes() const = 0;
  [[noreturn]] virtual void fail(const std::string& what) const = 0;

  /// Reads a count or an index, which must be a whole number below `below`.
  std::uint64_t integer(Type type, std::uint64_t below, const char* what) {
    const double v = value(type);
    if (!(v >= 0 && v < static_cast<double>(below)) || v != std::floor(v))
      fail(std::string(what) + " must be a whole number below " + std::to_string(below));
    return static_cast<std::uint64_t>(v);
  }
};

class BinaryRows final : public Rows {
 public:
  explicit BinaryRows(ByteReader reader) : reader_(reader) {}
  std::size_t remaining_bytes() const override { return reader_.remaining(); }
  [[noreturn]] void fail(const std::string& what) const override { reader_.fail(what); }

  double value(Type type) override {
    switch (type) {
      case Type::int8:
        return reader_.read<std::int8_t>();
      case Type::uint8:
        return reader_.read<std::uint8_t>();
      case Type::int16:
        return reader_.read<std::int16_t>();
      case Type::uint16:
        return reader_.read<std::uint16_t>();
      case Type::int32:
        return reader_.read<std::int32_t>();
      case Type::uint32:
        return reader_.read<std::uint32_t>();
      case Type::float32:
        return reader_.read<float>();
      case Type::float64:
        return reader_.read<double>();
    }
    fail("unknown type");
  }

 private:
  ByteReader reader_;
};

class AsciiRows final : public Rows {
 public:
  AsciiRows(TextScanner scanner, std::size_t size) : scanner_(std::move(scanner)), size_(size) {}
  std::size_t remaining_bytes() const override { return size_ - scanner_.offset(); }
  [[noreturn]] void fail(const std::string& what) const override { scanner_.fail(what); }
  double value(Type) override { return scanner_.number<double>(next_++); }

  void begin_row() override {
    if (!scanner_.next_line()) fail("the file ends before all declared elements");
    next_ = 0;
  }
  void end_row() override {
    if (next_ != scanner_.words().size()) fail("more values than declared");
  }

 private:
  TextScanner scanner_;
  std::size_t size_, next_ = 0;
};

Property parse_property(const TextScanner& scanner) {
  const auto& words = scanner.words();
  const bool list = words.size() == 5 && words[1] == "list";
  const auto type = words.size() < 3 ? std::nullopt : type_named(words[list ? 3 : 1]);
  const auto count_type = list ? type_named(words[2]) : std::nullopt;
  if ((!list && words.size() != 3) || !type || (list && !count_type))
    scanner.fail("expected 'property TYPE NAME' or 'property list TYPE TYPE NAME'");
  return {std::string(words.back()), *type, count_type};
}

struct PlyHeader {
  std::string format;
  std::vector<Element> elements;
};

PlyHeader parse_header(TextScanner& scanner) {
  PlyHeader header;
  if (!scanner.next_line() || scanner.words()[0] != "ply") scanner.fail("not a PLY file");
  while (scanner.next_line()) {
    const auto& words = scanner.words();
    if (words[0] == "end_header") return header;
    if (words[0] == "format") {
      header.format = words.size() == 3 ? std::string(words[1]) : "";
    } else if (words[0] == "element") {
      if (words.size() != 3) scanner.fail("expected 'element NAME COUNT'");
      header.elements.push_back(
          {std::string(words[1]), scanner.parse<std::uint64_t>(words[2]), {}});
    } else if (words[0] == "property") {
      if (header.elements.empty()) scanner.fail("a property before the first element");
      header.elements.back().properties.push_back(parse_property(scanner));
    } else if (words[0] != "comment" && words[0] != "obj_info") {
      scanner.fail("'" + std::string(words[0].substr(0, 40)) + "' does not belong in a PLY header");
    }
  }
  scanner.fail("the file ends before 'end_header'");
}

std::unique_ptr<Rows> open_rows(const std::filesystem::path& path, std::string_view bytes,
                                const std::string& format, TextScanner& scanner) {
  if (format == "ascii") return std::make_unique<AsciiRows>(scanner, bytes.size());
  if (format != "binary_little_endian" && format != "binary_big_endian")
    scanner.fail("format '" + format.substr(0, 40) +
                 "'; allowed: ascii, binary_little_endian, binary_big_endian");
  const ByteOrder order = format == "binary_little_endian" ? ByteOrder::little : ByteOrder::big;
  return std::make_unique<BinaryRows>(ByteReader(path, bytes, scanner.offset(), order));
}

class MeshBuilder {
 public:
  MeshBuilder(Rows& rows, const std::vector<Element>& elements, const std::string& where)
      : rows_(rows), cutter_(where) {
    for (const Element& element : elements)
      if (element.name == "vertex") vertex_count_ = element.count;
  }

  void read(const Element& element) {
    // Every row takes at least a byte. A larger count is wrong, and reading it would never end.
    if (element.count > rows_.remaining_bytes() || element.count > max_mesh_items ||
        (element.count > 0 && element.properties.empty()))
      rows_.fail(std::to_string(element.count) + " of element '" + element.name.substr(0, 40) +
                 "' declared; the file has " + std::to_string(rows_.remaining_bytes()) +
                 " bytes left, and at most 2e7 are read");
    for (std::uint64_t n = 0; n < element.count; ++n) {
      rows_.begin_row();
      Vec3 vertex = Vec3::Zero();
      for (const Property& property : element.properties)
        if (property.count_type)
          read_list(property, element.name == "face");
        else
          read_scalar(property, vertex);
      if (!vertex.allFinite()) rows_.fail("a coordinate is not finite");
      rows_.end_row();
      if (element.name == "vertex") mesh_.vertices.push_back(vertex);
    }
  }

  TriangleMesh take() {
    for (const Face& face : waiting_) cutter_.append(face, mesh_);
    return std::move(mesh_);
  }

 private:
  void read_scalar(const Property& property, Vec3& vertex) {
    const double value = rows_.value(property.type);
    for (int axis = 0; axis < 3; ++axis)
      if (property.name.size() == 1 && property.name[0] == "xyz"[axis]) vertex[axis] = value;
  }

  void read_list(const Property& property, bool of_face) {
    const std::uint64_t count =
        rows_.integer(*property.count_type, std::uint64_t(1) << 32, "the length of a list");
    const bool polygon =
        of_face && (property.name == "vertex_indices" || property.name == "vertex_index");
    if (polygon && count < 3) rows_.fail("a face with fewer than three vertices");
    face_.clear();
    for (std::uint64_t i = 0; i < count; ++i) {
      if (!polygon)
        rows_.value(property.type);
      else
        face_.push_back(static_cast<std::uint32_t>(
            rows_.integer(property.type, vertex_count_, "the vertex of a face")));
    }
    if (!polygon) return;
    corners_ += count;
    if (corners_ > 3 * max_mesh_items) rows_.fail("more than 2e7 triangles");
    if (mesh_.vertices.size() == vertex_count_)
      cutter_.append(face_, mesh_);
    else
      waiting_.push_back(face_);
  }

  Rows& rows_;
  FaceCutter cutter_;
  std::uint64_t vertex_count_ = 0, corners_ = 0;
  TriangleMesh mesh_;
  Face face_;
  std::vector<Face> waiting_;  // for the vertices, which come later in the file
};

}  // namespace

TriangleMesh parse_ply(const std::filesystem::path& path, std::string_view bytes) {
  TextScanner scanner(path, bytes);
  const PlyHeader header = parse_header(scanner);
  const auto rows = open_rows(path, bytes, header.format, scanner);
  MeshBuilder builder(*rows, header.elements, path.string());
  for (const Element& element : header.elements) builder.read(element);
  return builder.take();
}

}  // namespace snowshed::geometry
