// Named, typed arrays in one file with a checksum: the container of checkpoints.
//
// Layout, little-endian; names and data are padded with zeros to a multiple of eight bytes:
//   header   magic[8], version u32, sections u32, length of the file u64
//   section  type u32, length of the name u32, elements u64, bytes u64, name, data
//   trailer  checksum u64 of all the above
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace snowshed::io {

/// Element types. Their numbers are part of the file format.
enum class ElementType : std::uint32_t {
  text = 1,
  float32 = 2,
  float64 = 3,
  int32 = 4,
  int64 = 5,
  uint8 = 6,
  uint16 = 7,
  uint32 = 8,
  uint64 = 9,
};

/// Returns the element type that stores T. It is a compile error if there is none.
template <class T>
constexpr ElementType element_type() {
  if constexpr (std::is_same_v<T, char>)
    return ElementType::text;
  else if constexpr (std::is_same_v<T, float>)
    return ElementType::float32;
  else if constexpr (std::is_same_v<T, double>)
    return ElementType::float64;
  else if constexpr (std::is_same_v<T, std::int32_t>)
    return ElementType::int32;
  else if constexpr (std::is_same_v<T, std::int64_t>)
    return ElementType::int64;
  else if constexpr (std::is_same_v<T, std::uint8_t>)
    return ElementType::uint8;
  else if constexpr (std::is_same_v<T, std::uint16_t>)
    return ElementType::uint16;
  else if constexpr (std::is_same_v<T, std::uint32_t>)
    return ElementType::uint32;
  else {
    static_assert(std::is_same_v<T, std::uint64_t>, "not an element type of BinaryArchive");
    return ElementType::uint64;
  }
}

/// Collects sections and writes them together. Arrays given by reference or pointer are not copied;
/// they must stay alive and unchanged until `save`. Each name may be used once.
class BinaryWriter {
 public:
  template <class T>
  void add(const std::string& name, const T* data, std::size_t count) {
    add_section({name, element_type<T>(), count, count * sizeof(T), data, nullptr});
  }

  template <class T, class Allocator>
  void add(const std::string& name, const std::vector<T, Allocator>& values) {
    add(name, values.data(), values.size());
  }

  /// Adds an array and takes ownership of it.
  template <class T, class Allocator>
  void add(const std::string& name, std::vector<T, Allocator>&& values) {
    own(name, std::make_shared<std::vector<T, Allocator>>(std::move(values)));
  }

  template <class T>
  void add_value(const std::string& name, T value) {
    add(name, std::vector<T>{value});
  }

  void add_text(const std::string& name, std::string text);

  /// Writes the file atomically. Throws FileError if that fails. May be called again. `check`, if
  /// given, is called with the path of the new file before that file replaces an older one.
  void save(const std::filesystem::path& path,
            const std::function<void(const std::filesystem::path&)>& check = {}) const;

 private:
  struct Section {
    std::string name;
    ElementType type;
    std::uint64_t count;
    std::uint64_t bytes;
    const void* data;
    std::shared_ptr<const void> owner;  // owner of `data`, if the writer holds it
  };

  template <class Container>
  void own(const std::string& name, const std::shared_ptr<Container>& values) {
    using T = typename Container::value_type;
    const std::size_t count = values->size();
    add_section({name, element_type<T>(), count, count * sizeof(T), values->data(), values});
  }
  void add_section(Section section);

  std::vector<Section> sections_;
};

/// An array inside a loaded archive; valid as long as its BinaryReader.
template <class T>
struct ArrayView {
  const T* data;
  std::size_t size;
  const T* begin() const { return data; }
  const T* end() const { return data + size; }
  const T& operator[](std::size_t i) const { return data[i]; }
};

struct ArchiveHeader;

/// A loaded archive. The file is untrusted. Every fault gives an InputError that names the file,
/// the byte and the fault. Counts are checked before memory is allocated for them.
class BinaryReader {
 public:
  /// Loads and checks an archive. Throws FileError if the file cannot be read at all.
  static BinaryReader load(const std::filesystem::path& path);

  bool has(std::string_view name) const { return find(name) != nullptr; }
  std::vector<std::string> names() const;

  /// Returns the array called `name` without a copy. Throws InputError if it is absent or of
  /// another type.
  template <class T>
  ArrayView<T> view(std::string_view name) const {
    const Section& section = require(name, element_type<T>());
    return {reinterpret_cast<const T*>(bytes() + section.offset), section.count};
  }

  /// The same; also throws InputError unless the array has `count` elements.
  template <class T>
  ArrayView<T> view(std::string_view name, std::size_t count) const {
    require_count(name, count);
    return view<T>(name);
  }

  /// Returns a copy of the array called `name`.
  template <class T>
  std::vector<T> get(std::string_view name) const {
    const ArrayView<T> values = view<T>(name);
    return std::vector<T>(values.begin(), values.end());
  }

  /// Returns a copy of the array called `name`. Throws InputError unless it has `count` elements.
  template <class T>
  std::vector<T> get(std::string_view name, std::size_t count) const {
    require_count(name, count);
    return get<T>(name);
  }

  template <class T>
  T value(std::string_view name) const {
    require_count(name, 1);
    return view<T>(name)[0];
  }

  std::string text(std::string_view name) const;

  /// Throws InputError at the first infinity or NaN of any array.
  void require_finite() const;

  const std::filesystem::path& path() const { return path_; }

 private:
  struct Section {
    std::string name;
    ElementType type;
    std::size_t count;
    std::size_t start;   // start of the section, bytes from the start of the file
    std::size_t offset;  // offset of its data
  };

  explicit BinaryReader(std::filesystem::path path) : path_(std::move(path)) {}
  void read_file();
  void check(const ArchiveHeader&) const;
  void check_sum() const;
  void read_sections();
  Section read_section(std::size_t start, std::size_t& end) const;

  const char* bytes() const { return reinterpret_cast<const char*>(words_.get()); }
  template <class T>
  T read(std::size_t offset) const;
  template <class T>
  void require_finite(const Section& section) const;
  const Section* find(std::string_view name) const;
  const Section& require(std::string_view name) const;
  const Section& require(std::string_view name, ElementType type) const;
  void require_count(std::string_view name, std::size_t count) const;
  [[noreturn]] void fail(std::size_t byte, const std::string& what) const;

  std::filesystem::path path_;
  std::unique_ptr<std::uint64_t[]> words_;  // the whole file, aligned for any element type
  std::size_t size_ = 0;                    // bytes in the file
  std::vector<Section> sections_;
};

}  // namespace snowshed::io
