#include "snowshed/io/binary_archive.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <set>
#include <stdexcept>
#include <system_error>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/memory.hpp"
#include "snowshed/io/atomic_file.hpp"
#include "snowshed/io/checksum.hpp"

#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "archives are written in the byte order of the machine, which must be little-endian"
#endif

namespace snowshed::io {

/// The beginning of an archive.
struct ArchiveHeader {
  char magic[8];
  std::uint32_t version;
  std::uint32_t sections;
  std::uint64_t length;
};

namespace {

constexpr std::uint32_t format_version = 1;
// These bytes are not text, and any conversion of line ends damages them.
constexpr char magic[8] = {'\x89', 'S', 'N', 'O', 'W', '\r', '\n', '\x1a'};

constexpr std::size_t word = sizeof(std::uint64_t);
constexpr std::size_t max_name_length = 255;

struct SectionHeader {
  std::uint32_t type;
  std::uint32_t name_length;
  std::uint64_t count;
  std::uint64_t bytes;
};

constexpr std::size_t min_file_size = sizeof(ArchiveHeader) + word;

constexpr std::uint64_t padded(std::uint64_t bytes) { return (bytes + word - 1) / word * word; }

/// Returns the bytes of one element; 0 for an unknown type.
std::size_t element_size(ElementType type) {
  switch (type) {
    case ElementType::text:
    case ElementType::uint8:
      return 1;
    case ElementType::uint16:
      return 2;
    case ElementType::float32:
    case ElementType::int32:
    case ElementType::uint32:
      return 4;
    case ElementType::float64:
    case ElementType::int64:
    case ElementType::uint64:
      return 8;
  }
  return 0;
}

const char* type_name(ElementType type) {
  static const char* const names[] = {"text",  "float32", "float64", "int32", "int64",
                                      "uint8", "uint16",  "uint32",  "uint64"};
  return names[static_cast<std::uint32_t>(type) - 1];
}

/// A file that pads sections and adds a checksum.
class ChecksummedFile {
 public:
  explicit ChecksummedFile(const std::filesystem::path& path) : file_(path) {}

  void write(const void* data, std::size_t bytes) {
    const std::size_t full_words = bytes / word * word;
    pass(data, full_words);
    if (full_words == bytes) return;
    char rest[word] = {};
    std::memcpy(rest, static_cast<const char*>(data) + full_words, bytes - full_words);
    pass(rest, word);
  }

  void finish(const std::function<void(const std::filesystem::path&)>& check) {
    const std::uint64_t sum = sum_.value();
    file_.write(&sum, sizeof sum);
    file_.commit(check);
  }

 private:
  void pass(const void* data, std::size_t bytes) {
    sum_.update(data, bytes);
    file_.write(data, bytes);
  }

  AtomicFile file_;
  Checksum sum_;
};

}  // namespace

void BinaryWriter::add_text(const std::string& name, std::string text) {
  own(name, std::make_shared<std::string>(std::move(text)));
}

void BinaryWriter::add_section(Section section) {
  if (section.name.empty() || section.name.size() > max_name_length)
    throw std::invalid_argument("archive section name '" + section.name +
                                "' must have 1 to 255 characters");
  for (const Section& other : sections_)
    if (other.name == section.name)
      throw std::invalid_argument("archive section '" + section.name + "' is added twice");
  sections_.push_back(std::move(section));
}

void BinaryWriter::save(const std::filesystem::path& path,
                        const std::function<void(const std::filesystem::path&)>& check) const {
  ArchiveHeader header{
      {}, format_version, static_cast<std::uint32_t>(sections_.size()), min_file_size};
  std::copy(std::begin(magic), std::end(magic), header.magic);
  for (const Section& s : sections_)
    header.length += sizeof(SectionHeader) + padded(s.name.size()) + padded(s.bytes);

  ChecksummedFile file(path);
  file.write(&header, sizeof header);
  for (const Section& s : sections_) {
    const SectionHeader section{static_cast<std::uint32_t>(s.type),
                                static_cast<std::uint32_t>(s.name.size()), s.count, s.bytes};
    file.write(&section, sizeof section);
    file.write(s.name.data(), s.name.size());
    file.write(s.data, s.bytes);
  }
  file.finish(check);
}

BinaryReader BinaryReader::load(const std::filesystem::path& path) {
  BinaryReader reader(path);
  reader.read_file();
  reader.check_sum();
  reader.read_sections();
  return reader;
}

std::vector<std::string> BinaryReader::names() const {
  std::vector<std::string> names;
  for (const Section& section : sections_) names.push_back(section.name);
  return names;
}

void BinaryReader::require_finite() const {
  for (const Section& section : sections_) {
    if (section.type == ElementType::float32) require_finite<float>(section);
    if (section.type == ElementType::float64) require_finite<double>(section);
  }
}

template <class T>
void BinaryReader::require_finite(const Section& section) const {
  for (std::size_t i = 0; i < section.count; ++i) {
    const std::size_t at = section.offset + i * sizeof(T);
    if (!std::isfinite(read<T>(at)))
      fail(at, "element " + std::to_string(i) + " of section '" + section.name +
                   "' is not a finite number");
  }
}

std::string BinaryReader::text(std::string_view name) const {
  const ArrayView<char> characters = view<char>(name);
  return std::string(characters.begin(), characters.end());
}

void BinaryReader::read_file() {
  std::ifstream file;
  std::error_code error;
  errno = 0;
  const auto status = std::filesystem::status(path_, error);
  if (std::filesystem::is_directory(status))
    error = std::make_error_code(std::errc::is_a_directory);
  else if (std::filesystem::is_other(status))  // opening a pipe could block for ever
    error = std::make_error_code(std::errc::not_supported);
  else if (file.open(path_, std::ios::binary); !file)
    error = std::error_code(errno, std::generic_category());
  if (!error) size_ = std::filesystem::file_size(path_, error);
  if (error)
    throw FileError(path_.string(), "cannot read the file: " + error.message(), error.value());

  ArchiveHeader header{};
  file.read(reinterpret_cast<char*>(&header), sizeof header);
  file.clear();
  file.seekg(0);
  check(header);  // before memory is taken for a large file
  if (size_ > available_memory_bytes())
    throw InputError(path_.string(),
                     "the archive of " + std::to_string(size_) + " bytes does not fit into memory");
  words_.reset(new std::uint64_t[padded(size_) / word]);
  file.read(reinterpret_cast<char*>(words_.get()), static_cast<std::streamsize>(size_));
  if (!file) size_ = static_cast<std::size_t>(file.gcount());
  check(header);  // the file may have become shorter meanwhile
}

void BinaryReader::check(const ArchiveHeader& header) const {
  if (std::memcmp(header.magic, magic, std::min(size_, sizeof magic)) != 0)
    fail(0, "not a snowshed archive");
  if (size_ < sizeof(ArchiveHeader)) fail(size_, "truncated inside the header");
  if (header.version != format_version)
    fail(offsetof(ArchiveHeader, version), "format version " + std::to_string(header.version) +
                                               ", this program reads version " +
                                               std::to_string(format_version));
  if (size_ < header.length)
    fail(size_, "truncated: " + std::to_string(header.length) + " bytes were written");
  if (size_ != header.length || size_ < min_file_size || size_ % word != 0)
    fail(offsetof(ArchiveHeader, length),
         "corrupted: a length of " + std::to_string(header.length) +
             " bytes is recorded, the file has " + std::to_string(size_));
}

void BinaryReader::check_sum() const {
  Checksum sum;
  sum.update(bytes(), size_ - word);
  if (sum.value() != read<std::uint64_t>(size_ - word))
    fail(size_ - word, "corrupted: the checksum does not match the content");
}

void BinaryReader::read_sections() {
  const auto header = read<ArchiveHeader>(0);
  std::set<std::string_view> names;
  std::size_t position = sizeof(ArchiveHeader);
  for (std::uint32_t i = 0; i < header.sections; ++i) {
    const std::size_t start = position;
    Section section = read_section(start, position);
    if (!names.emplace(bytes() + start + sizeof(SectionHeader), section.name.size()).second)
      fail(start, "section '" + section.name + "' occurs twice");
    sections_.push_back(std::move(section));
  }
  if (position != size_ - word) fail(position, "bytes follow the last section");
}

/// Reads a section. Every length is checked against the rest of the file before it is used.
BinaryReader::Section BinaryReader::read_section(std::size_t start, std::size_t& end) const {
  const std::size_t limit = size_ - word;
  if (limit - start < sizeof(SectionHeader)) fail(start, "a section is cut off");
  const auto header = read<SectionHeader>(start);

  const std::size_t element = element_size(static_cast<ElementType>(header.type));
  if (element == 0) fail(start, "unknown element type " + std::to_string(header.type));
  const std::size_t name_start = start + sizeof(SectionHeader);
  if (header.name_length == 0 || header.name_length > max_name_length ||
      padded(header.name_length) > limit - name_start)
    fail(start, "a section name of " + std::to_string(header.name_length) + " characters");
  const std::size_t offset = name_start + padded(header.name_length);
  // These comparisons use no padding and no products, which could overflow.
  if (header.bytes > limit - offset || header.bytes % element != 0 ||
      header.count != header.bytes / element)
    fail(start, "a section of " + std::to_string(header.count) + " elements in " +
                    std::to_string(header.bytes) + " bytes, " + std::to_string(limit - offset) +
                    " bytes are left");
  end = offset + padded(header.bytes);
  return {std::string(bytes() + name_start, header.name_length),
          static_cast<ElementType>(header.type), static_cast<std::size_t>(header.count), start,
          offset};
}

template <class T>
T BinaryReader::read(std::size_t offset) const {
  T value;
  std::memcpy(&value, bytes() + offset, sizeof value);
  return value;
}

const BinaryReader::Section* BinaryReader::find(std::string_view name) const {
  const auto match = std::find_if(sections_.begin(), sections_.end(),
                                  [&](const Section& section) { return section.name == name; });
  return match == sections_.end() ? nullptr : &*match;
}

const BinaryReader::Section& BinaryReader::require(std::string_view name) const {
  const Section* section = find(name);
  if (!section) fail(size_, "section '" + std::string(name) + "' is missing");
  return *section;
}

const BinaryReader::Section& BinaryReader::require(std::string_view name, ElementType type) const {
  const Section& section = require(name);
  if (section.type != type)
    fail(section.start, "section '" + section.name + "' holds " + type_name(section.type) +
                            ", expected " + type_name(type));
  return section;
}

void BinaryReader::require_count(std::string_view name, std::size_t count) const {
  const Section& section = require(name);
  if (section.count != count)
    fail(section.start, "section '" + section.name + "' has " + std::to_string(section.count) +
                            " elements, expected " + std::to_string(count));
}

void BinaryReader::fail(std::size_t byte, const std::string& what) const {
  throw InputError(path_.string(), "byte " + std::to_string(byte) + ": " + what);
}

}  // namespace snowshed::io
