// Mutations that keep the checksums of a film valid and its frames deflated. The reader would
// refuse nearly all random bytes before it looks at the content.
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "mutation.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/io/film_codec.hpp"

namespace snowshed {
namespace {

// The layout of docs/reference/film.md. None of the values need be valid.
constexpr std::size_t text_length_at = 12, text_at = 24, record_head = 40, facts_at = 8;
constexpr std::size_t raw_at = 28, packed_at = 32;

struct FilmParts {
  std::string text;
  struct Record {
    std::string facts;  // time, event, flags and particles
    std::string raw;
  };
  std::vector<Record> records;
};

/// Returns the parts before the first one that does not lie within the bytes.
FilmParts parts_of(const std::string& bytes) {
  FilmParts parts;
  if (bytes.size() < text_at) return parts;
  const std::size_t length = number_at<std::uint32_t>(bytes, text_length_at);
  if (length > bytes.size() - text_at) return parts;
  parts.text = bytes.substr(text_at, length);
  for (std::size_t at = text_at + length; bytes.size() - at >= record_head;) {
    const std::size_t raw = number_at<std::uint32_t>(bytes, at + raw_at),
                      packed = number_at<std::uint32_t>(bytes, at + packed_at);
    if (packed > bytes.size() - at - record_head || !io::could_be_deflated(packed, raw)) break;
    const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data()) + at + record_head;
    try {
      const auto content = io::inflated(data, packed, raw, "film");
      parts.records.push_back({bytes.substr(at + facts_at, raw_at - facts_at),
                               std::string(content.begin(), content.end())});
    } catch (const InputError&) {
      break;
    }
    at += record_head + packed;
  }
  return parts;
}

/// Returns the header of a film; the checksum of version 1 covers the text alone.
std::string header_of(const std::string& text, std::uint32_t version) {
  const std::string fixed = "SNOWFILM" + bytes_of(version) + bytes_of(std::uint32_t(text.size()));
  const std::uint32_t before = version == 1 ? 0 : io::crc32_of(fixed.data(), fixed.size());
  return fixed + bytes_of(io::crc32_of(text.data(), text.size(), before)) + bytes_of(0) + text;
}

/// Returns a record that follows one with the checksum `before`; `before` becomes its own checksum.
std::string record_of(const std::string& tag, std::string facts, std::size_t raw,
                      const std::vector<std::uint8_t>& packed, std::uint32_t& before) {
  facts += bytes_of(std::uint32_t(raw)) + bytes_of(std::uint32_t(packed.size())) +
           bytes_of(io::crc32_of(packed.data(), packed.size()));
  before = io::crc32_of(facts.data(), facts.size(), before);
  return tag + bytes_of(before) + facts + std::string(packed.begin(), packed.end());
}

std::string record_of_version_1(std::string facts, std::size_t raw,
                                const std::vector<std::uint8_t>& packed) {
  facts += bytes_of(std::uint32_t(raw)) + bytes_of(std::uint32_t(packed.size())) + bytes_of(0);
  facts.append(packed.begin(), packed.end());
  return "FRAM" + bytes_of(io::crc32_of(facts.data(), facts.size())) + facts;
}

/// Returns a film of these parts with matching lengths and checksums, with its end if `closed`.
std::string film_of(const FilmParts& parts, std::uint32_t version, bool closed) {
  std::string bytes = header_of(parts.text, version);
  auto sum = number_at<std::uint32_t>(bytes, text_at - 8);
  for (const auto& record : parts.records) {
    const auto packed = io::deflated({record.raw.begin(), record.raw.end()});
    bytes += version == 1 ? record_of_version_1(record.facts, record.raw.size(), packed)
                          : record_of("FRAM", record.facts, record.raw.size(), packed, sum);
  }
  if (closed && version != 1)
    bytes += record_of("ENDS", std::string(raw_at - facts_at, '\0'), 0, {}, sum);
  return bytes;
}

/// Changes the header or a frame, or removes or repeats one.
void mutate_part(FilmParts& parts, std::mt19937& random) {
  if (parts.records.empty() || random() % 8 == 0) {
    parts.text = mutate(parts.text, parts.text.size() + max_part_growth);
    return;
  }
  const std::size_t i = random() % parts.records.size();
  FilmParts::Record& record = parts.records[i];
  switch (random() % 16) {
    case 0:
      parts.records.erase(parts.records.begin() + std::ptrdiff_t(i));
      break;
    case 1:
      parts.records.push_back(record);
      break;
    case 2:
    case 3:
      record.facts = mutate(record.facts, record.facts.size());
      record.facts.resize(raw_at - facts_at);
      break;
    default:
      record.raw = mutate(record.raw, record.raw.size() + max_part_growth);
  }
}

}  // namespace
}  // namespace snowshed

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  using namespace snowshed;
  const auto mutated = [max_size](const std::string& bytes, std::mt19937& random) {
    FilmParts parts = parts_of(bytes);
    if (parts.text.empty() || random() % 8 == 0) return mutate(bytes, max_size);
    mutate_part(parts, random);
    return film_of(parts, random() % 4 == 0 ? 1 : 2, random() % 2 == 0);
  };
  return replace_data(data, size, max_size, seed, mutated);
}
