#include "snowshed/io/film_file.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "snowshed/core/errors.hpp"
#include "snowshed/io/appended_file.hpp"
#include "snowshed/io/atomic_file.hpp"
#include "snowshed/io/file_bytes.hpp"

namespace snowshed {
namespace {

constexpr char film_magic[8] = {'S', 'N', 'O', 'W', 'F', 'I', 'L', 'M'};
constexpr std::size_t film_text_start = 24;  // of the JSON text
constexpr std::size_t most_header_bytes = 1u << 20;
constexpr std::uint32_t frame_tag = 0x4d415246;  // "FRAM"
constexpr std::size_t record_head = 40;
// Of a frame; the particles that runs record, with all their quantities, take a twentieth of it.
constexpr std::size_t most_raw_bytes = std::size_t{1} << 27;
constexpr std::uint32_t lists_flag = 1;

template <class T>
void put_bytes(std::vector<std::uint8_t>& bytes, T value) {
  const auto* begin = reinterpret_cast<const std::uint8_t*>(&value);
  bytes.insert(bytes.end(), begin, begin + sizeof value);
}

std::string header_text(const FilmHeader& h) {
  nlohmann::ordered_json json = {{"axes", h.axes == 2 ? "xz" : "xyz"},
                                 {"quantum_m", h.quantum},
                                 {"interval_s", h.interval},
                                 {"share", h.share},
                                 {"radius", h.has_radius}};
  json["quantities"] = nlohmann::ordered_json::array();
  for (const FilmQuantity& q : h.quantities)
    json["quantities"].push_back(
        {{"name", q.name}, {"unit", q.unit}, {"meaning", q.meaning}, {"step", q.step}});
  return json.dump();
}

FilmHeader parsed_header(const std::string& text, const std::string& where) {
  const auto require = [&where](bool sound, const char* what) {
    if (!sound) throw InputError(where, std::string("damaged: its header's ") + what);
  };
  const auto positive = [](double x) { return std::isfinite(x) && x > 1e-30 && x < 1e30; };
  FilmHeader h;
  try {
    const nlohmann::json json = nlohmann::json::parse(text);
    const auto axes = json.at("axes").get<std::string>();
    require(axes == "xz" || axes == "xyz", "axes are neither xz nor xyz");
    h.axes = int(axes.size());
    h.quantum = json.at("quantum_m").get<double>();
    h.interval = json.at("interval_s").get<double>();
    h.share = json.at("share").get<double>();
    h.has_radius = json.at("radius").get<bool>();
    for (const nlohmann::json& q : json.at("quantities"))
      h.quantities.push_back({q.at("name").get<std::string>(), q.at("unit").get<std::string>(),
                              q.at("meaning").get<std::string>(), q.at("step").get<double>()});
  } catch (const nlohmann::json::exception& error) {
    throw InputError(where, std::string("damaged: its header: ") + error.what());
  }
  require(positive(h.quantum), "quantum_m is not a length");
  require(positive(h.interval), "interval_s is not a time");
  require(h.share > 0 && h.share <= 1, "share is not between 0 and 1");
  require(h.quantities.size() <= 64, "quantities are more than 64");
  for (const FilmQuantity& q : h.quantities) require(positive(q.step), "step is not positive");
  return h;
}

}  // namespace

FilmReader::FilmReader(std::filesystem::path path)
    : path_(std::move(path)), bytes_(read_bytes(path_)) {
  read_header();
  std::size_t at = end_of_header_;
  while (read_record(at)) {
  }
  whole_ = at == bytes_.size();
  codec_ = FilmCodec(header_);
}

template <class T>
T FilmReader::read(std::size_t at) const {
  T value;
  std::memcpy(&value, bytes_.data() + at, sizeof value);
  return value;
}

std::string FilmReader::at_byte(std::size_t at) const {
  return path_.string() + ", byte " + std::to_string(at);
}

void FilmReader::read_header() {
  if (bytes_.size() < film_text_start ||
      std::memcmp(bytes_.data(), film_magic, sizeof film_magic) != 0)
    throw InputError(path_.string(), "not a film of snowshed");
  const auto version = read<std::uint32_t>(8);
  if (version != film_version)
    throw InputError(path_.string(), "a film of version " + std::to_string(version) +
                                         "; this program reads version " +
                                         std::to_string(film_version));
  const std::size_t length = read<std::uint32_t>(12);
  if (length > most_header_bytes || length > bytes_.size() - film_text_start)
    throw InputError(at_byte(12), "damaged: its header does not fit into the file");
  const char* text = bytes_.data() + film_text_start;
  if (crc32_of(text, length) != read<std::uint32_t>(16))
    throw InputError(at_byte(16), "damaged: its header has another checksum");
  header_ = parsed_header(std::string(text, length), path_.string());
  end_of_header_ = film_text_start + length;
}

/// Returns whether there is a whole record at `at`, which is moved behind it.
bool FilmReader::read_record(std::size_t& at) {
  if (bytes_.size() - at < record_head || read<std::uint32_t>(at) != frame_tag) return false;
  const FilmFrameFacts facts{read<double>(at + 8), read<std::uint32_t>(at + 16),
                             read<std::uint32_t>(at + 24)};
  const std::size_t raw = read<std::uint32_t>(at + 28), packed = read<std::uint32_t>(at + 32);
  if (packed > bytes_.size() - at - record_head) return false;
  const Record record{at + record_head, at + record_head + packed, packed, raw,
                      (read<std::uint32_t>(at + 20) & lists_flag) != 0};
  if (crc32_of(bytes_.data() + at + 8, record.end - at - 8) != read<std::uint32_t>(at + 4))
    return false;
  const FilmCodec codec(header_);
  if (!std::isfinite(facts.time) || raw > most_raw_bytes || !could_be_deflated(packed, raw) ||
      codec.least_bytes(facts.particles) > raw)
    throw InputError(at_byte(at), "damaged: the sizes of a frame do not fit together");
  records_.push_back(record);
  facts_.push_back(facts);
  at = record.end;
  return true;
}

FilmFrame FilmReader::next() {
  const Record& record = records_.at(next_);
  const std::string where = at_byte(record.payload - record_head);
  FilmFrame frame;
  frame.time = facts_[next_].time;
  frame.event = facts_[next_].event;
  const auto* payload = reinterpret_cast<const std::uint8_t*>(bytes_.data()) + record.payload;
  const auto raw = inflated(payload, record.packed, record.raw, where);
  codec_.decode(raw, record.lists, facts_[next_].particles, where, frame);
  ++next_;
  return frame;
}

FilmWriter::FilmWriter(std::filesystem::path path, const FilmHeader& header)
    : FilmWriter(std::move(path), header, FilmCodec(header)) {
  const std::string text = header_text(header);
  std::vector<std::uint8_t> bytes(film_magic, film_magic + sizeof film_magic);
  put_bytes(bytes, film_version);
  put_bytes(bytes, std::uint32_t(text.size()));
  put_bytes(bytes, crc32_of(text.data(), text.size()));
  put_bytes(bytes, std::uint32_t(0));
  bytes.insert(bytes.end(), text.begin(), text.end());
  write_atomic(path_, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::optional<FilmWriter> FilmWriter::reopen(
    const std::filesystem::path& path, const std::function<bool(const FilmFrameFacts&)>& keeps) {
  if (!std::filesystem::is_regular_file(path)) return std::nullopt;
  try {
    FilmReader reader(path);
    std::size_t end = reader.end_of_header();
    std::vector<FilmFrameFacts> kept;
    for (const FilmFrameFacts& facts : reader.frames()) {
      if (!keeps(facts)) break;
      reader.next();
      end = reader.end_of(kept.size());
      kept.push_back(facts);
    }
    truncate_file(path, end);
    const FilmHeader header = reader.header();
    FilmWriter writer(path, header, std::move(reader).release_codec());
    writer.facts_ = std::move(kept);
    return writer;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

void FilmWriter::append(const FilmFrame& frame) {
  FilmCodec after = codec_;
  const bool lists = codec_.lists_particles(frame);
  const std::vector<std::uint8_t> raw = after.encode(frame), packed = deflated(raw);
  std::vector<std::uint8_t> bytes;
  bytes.reserve(record_head + packed.size());
  put_bytes(bytes, frame_tag);
  put_bytes(bytes, std::uint32_t(0));
  put_bytes(bytes, frame.time);
  put_bytes(bytes, frame.event);
  put_bytes(bytes, std::uint32_t(lists ? lists_flag : 0));
  put_bytes(bytes, std::uint32_t(frame.ids.size()));
  put_bytes(bytes, std::uint32_t(raw.size()));
  put_bytes(bytes, std::uint32_t(packed.size()));
  put_bytes(bytes, std::uint32_t(0));
  bytes.insert(bytes.end(), packed.begin(), packed.end());
  const std::uint32_t sum = crc32_of(bytes.data() + 8, bytes.size() - 8);
  std::memcpy(bytes.data() + 4, &sum, sizeof sum);
  append_to_file(path_, bytes.data(), bytes.size());
  facts_.push_back({frame.time, frame.event, frame.ids.size()});
  codec_ = std::move(after);
}

}  // namespace snowshed
