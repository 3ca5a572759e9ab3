// Mutations that keep the checksums of a film valid and its frames deflated. Random bytes hardly
// ever do, so the reader would refuse them before it looks at the content.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "snowshed/core/errors.hpp"
#include "snowshed/io/film_codec.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

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

std::uint32_t number_at(const std::string& bytes, std::size_t offset) {
  std::uint32_t value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

std::string bytes_of(std::uint32_t value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

/// Returns the parts, from the first on, as long as they lie within the bytes.
FilmParts parts_of(const std::string& bytes) {
  FilmParts parts;
  if (bytes.size() < text_at) return parts;
  const std::size_t length = number_at(bytes, text_length_at);
  if (length > bytes.size() - text_at) return parts;
  parts.text = bytes.substr(text_at, length);
  for (std::size_t at = text_at + length; bytes.size() - at >= record_head;) {
    const std::size_t raw = number_at(bytes, at + raw_at),
                      packed = number_at(bytes, at + packed_at);
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

std::string mutate(std::string bytes, std::size_t max_size) {
  const std::size_t size = bytes.size();
  bytes.resize(std::max(size, max_size));
  bytes.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(bytes.data()), size, max_size));
  return bytes;
}

/// Changes the header or a frame, or removes or repeats one.
void mutate_part(FilmParts& parts, std::mt19937& random) {
  constexpr std::size_t growth = 64;
  if (parts.records.empty() || random() % 8 == 0) {
    parts.text = mutate(parts.text, parts.text.size() + growth);
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
      record.raw = mutate(record.raw, record.raw.size() + growth);
  }
}

}  // namespace
}  // namespace snowshed

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  using namespace snowshed;
  std::mt19937 random(seed);
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  FilmParts parts = parts_of(bytes);
  std::string mutated;
  if (parts.text.empty() || random() % 8 == 0) {
    mutated = mutate(bytes, max_size);
  } else {
    mutate_part(parts, random);
    mutated = film_of(parts);
  }
  if (mutated.size() > max_size) return size;
  std::copy(mutated.begin(), mutated.end(), data);
  return mutated.size();
}
