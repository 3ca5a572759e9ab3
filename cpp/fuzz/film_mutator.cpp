// Mutations that keep the checksums of a film valid and its frames deflated. Random bytes hardly
// ever do, so the reader would refuse them before it looks at the content.
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "mutation.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/io/film_codec.hpp"

namespace snowshed {
namespace {

// The layout of docs/view.md. None of the values need be valid.
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

/// Returns the parts, from the first on, as long as they lie within the bytes.
FilmParts parts_of(const std::string& bytes) {
  FilmParts parts;
  if (bytes.size() < text_at) return parts;
  const std::size_t length = number_at<std::uint32_t>(bytes, text_length_at);
  if (length > bytes.size() - text_at) return parts;
  parts.text = bytes.substr(text_at, length);
  for (std::size_t at = text_at + length; bytes.size() - at >= record_head;) {
    const std::size_t raw = number_at<std::uint32_t>(bytes, at + raw_at),
                      packed = number_at<std::uint32_t>(bytes, at + packed_at);
    if (packed > bytes.size() - at - record_head || !could_be_deflated(packed, raw)) break;
    const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data()) + at + record_head;
    try {
      const auto content = inflated(data, packed, raw, "film");
      parts.records.push_back({bytes.substr(at + facts_at, raw_at - facts_at),
                               std::string(content.begin(), content.end())});
    } catch (const InputError&) {
      break;
    }
    at += record_head + packed;
  }
  return parts;
}

/// Returns a film of these parts with matching lengths and checksums.
std::string film_of(const FilmParts& parts) {
  std::string bytes = "SNOWFILM" + bytes_of(1) + bytes_of(std::uint32_t(parts.text.size())) +
                      bytes_of(crc32_of(parts.text.data(), parts.text.size())) + bytes_of(0) +
                      parts.text;
  for (const auto& record : parts.records) {
    const auto packed = deflated({record.raw.begin(), record.raw.end()});
    std::string summed = record.facts + bytes_of(std::uint32_t(record.raw.size())) +
                         bytes_of(std::uint32_t(packed.size())) + bytes_of(0);
    summed.append(packed.begin(), packed.end());
    bytes += "FRAM" + bytes_of(crc32_of(summed.data(), summed.size())) + summed;
  }
  return bytes;
}

/// Changes the header or a frame, or removes or repeats one.
void mutate_part(FilmParts& parts, std::mt19937& random) {
  if (parts.records.empty() || random() % 8 == 0) {
    parts.text = mutate(parts.text, parts.text.size() + part_growth);
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
      record.raw = mutate(record.raw, record.raw.size() + part_growth);
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
    return film_of(parts);
  };
  return replace_data(data, size, max_size, seed, mutated);
}
