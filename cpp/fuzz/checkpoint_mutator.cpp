// Mutations that keep the container of a checkpoint valid. Random bytes hardly ever have the right
// lengths and checksum, so the reader would refuse them before it looks at the content.
#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "mutation.hpp"
#include "snowshed/io/checksum.hpp"

namespace snowshed {
namespace {

/// A section in the layout of binary_archive.hpp. None of its values need be valid.
struct ArchiveSection {
  std::uint32_t type;
  std::uint64_t element;  // bytes of an element
  std::string name, data;
};

constexpr std::size_t archive_header = 24, section_header = 24, archive_trailer = 8;

std::size_t padded(std::size_t bytes) { return (bytes + 7) / 8 * 8; }

/// Returns the sections before the first one that does not lie within the bytes.
std::vector<ArchiveSection> sections_of(const std::string& bytes) {
  std::vector<ArchiveSection> sections;
  if (bytes.size() < archive_header + archive_trailer) return sections;
  const std::size_t end = bytes.size() - archive_trailer;
  for (std::size_t at = archive_header; at + section_header <= end;) {
    const std::size_t name_length = number_at<std::uint32_t>(bytes, at + 4);
    const auto count = number_at<std::uint64_t>(bytes, at + 8);
    const auto length = number_at<std::uint64_t>(bytes, at + 16);
    const std::size_t name = at + section_header, data = name + padded(name_length);
    if (name_length > end - name || data > end || length > end - data) break;
    sections.push_back({number_at<std::uint32_t>(bytes, at), count > 0 ? length / count : 0,
                        bytes.substr(name, name_length), bytes.substr(data, length)});
    at = data + padded(length);
  }
  return sections;
}

/// Returns an archive of these sections with matching lengths and checksum.
std::string archive_of(const std::vector<ArchiveSection>& sections) {
  const auto pad = [](std::string text) {
    text.resize(padded(text.size()));
    return text;
  };
  std::string body;
  for (const ArchiveSection& s : sections) {
    body += bytes_of(s.type) + bytes_of(std::uint32_t(s.name.size()));
    body += bytes_of(std::uint64_t(s.element > 0 ? s.data.size() / s.element : 0));
    body += bytes_of(std::uint64_t(s.data.size())) + pad(s.name) + pad(s.data);
  }
  std::string bytes = "\x89SNOW\r\n\x1a" + bytes_of(std::uint32_t(1));
  bytes += bytes_of(std::uint32_t(sections.size()));
  bytes += bytes_of(std::uint64_t(archive_header + body.size() + archive_trailer)) + body;
  io::Checksum sum;
  sum.update(bytes.data(), bytes.size());
  return bytes + bytes_of(sum.value());
}

/// Returns the bytes with their own length and a matching checksum.
std::string with_valid_frame(std::string bytes) {
  bytes.resize(padded(std::max(bytes.size(), archive_header + archive_trailer)));
  const auto length = bytes_of(std::uint64_t(bytes.size()));
  bytes.replace(16, length.size(), length);
  io::Checksum sum;
  sum.update(bytes.data(), bytes.size() - archive_trailer);
  return bytes.replace(bytes.size() - archive_trailer, archive_trailer, bytes_of(sum.value()));
}

/// Changes the content, name or type of one section, or removes or repeats it.
void mutate_section(std::vector<ArchiveSection>& sections, std::mt19937& random) {
  const std::size_t i = random() % sections.size();
  ArchiveSection& section = sections[i];
  switch (random() % 20) {
    case 0:
      section.name = mutate(section.name, 40);
      break;
    case 1:
      section.type = random() % 11;
      break;
    case 2:
      sections.erase(sections.begin() + std::ptrdiff_t(i));
      break;
    case 3:
      sections.push_back(section);
      break;
    default:
      section.data = mutate(section.data, section.data.size() + max_part_growth);
  }
}

}  // namespace
}  // namespace snowshed

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  using namespace snowshed;
  const auto mutated = [max_size](const std::string& bytes, std::mt19937& random) {
    std::vector<ArchiveSection> sections = sections_of(bytes);
    if (sections.empty() || random() % 8 == 0) {
      const std::string changed = mutate(bytes, max_size);
      return random() % 4 != 0 ? with_valid_frame(changed) : changed;
    }
    mutate_section(sections, random);
    return archive_of(sections);
  };
  return replace_data(data, size, max_size, seed, mutated);
}
