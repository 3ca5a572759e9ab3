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

namespace snowshed::io {
namespace {

constexpr char film_magic[8] = {'S', 'N', 'O', 'W', 'F', 'I', 'L', 'M'};
constexpr std::size_t film_text_start = 24;  // start of the JSON text
constexpr std::size_t max_header_bytes = 1u << 20;
constexpr std::size_t header_sum_at = 16;
constexpr std::uint32_t frame_tag = 0x4d415246;  // "FRAM"
constexpr std::uint32_t close_tag = 0x53444e45;  // "ENDS"
constexpr std::size_t record_head = 40, facts_at = 8, content_sum_at = 36;
// Largest frame. The particles that runs record, with all their quantities, take a twentieth of it.
constexpr std::size_t max_raw_bytes = std::size_t{1} << 27;
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

/// The checksum of a header; in version 1 it covers the text alone.
std::uint32_t header_sum(std::uint32_t version, const char* text, std::size_t length) {
  if (version == 1) return crc32_of(text, length);
  std::vector<std::uint8_t> fixed(film_magic, film_magic + sizeof film_magic);
  put_bytes(fixed, version);
  put_bytes(fixed, std::uint32_t(length));
  return crc32_of(text, length, crc32_of(fixed.data(), fixed.size()));
}

/// The checksum of the head of a frame, which continues that of the frame before.
std::uint32_t head_sum(const char* head, std::uint32_t before) {
  return crc32_of(head + facts_at, record_head - facts_at, before);
}

std::string header_bytes(const FilmHeader& header) {
  const std::string text = header_text(header);
  std::vector<std::uint8_t> bytes(film_magic, film_magic + sizeof film_magic);
  put_bytes(bytes, film_version);
  put_bytes(bytes, std::uint32_t(text.size()));
  put_bytes(bytes, header_sum(film_version, text.data(), text.size()));
  put_bytes(bytes, std::uint32_t(0));
  return std::string(bytes.begin(), bytes.end()) + text;
}

/// Contents of the head of a record, without its checksums.
struct RecordInfo {
  double time;
  std::uint32_t event, flags, particles, raw, packed;
};

/// The head of a record that follows one with the checksum `before`; `before` becomes its checksum.
std::vector<std::uint8_t> record_bytes(std::uint32_t tag, const RecordInfo& info,
                                       std::uint32_t content_sum, std::uint32_t& before) {
  std::vector<std::uint8_t> bytes;
  put_bytes(bytes, tag);
  put_bytes(bytes, std::uint32_t(0));
  put_bytes(bytes, info.time);
  for (const std::uint32_t number :
       {info.event, info.flags, info.particles, info.raw, info.packed, content_sum})
    put_bytes(bytes, number);
  before = head_sum(reinterpret_cast<const char*>(bytes.data()), before);
  std::memcpy(bytes.data() + 4, &before, sizeof before);
  return bytes;
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

FilmReader::FilmReader(std::filesystem::path path, std::size_t max_frames)
    : path_(std::move(path)), bytes_(read_bytes(path_)) {
  read_header();
  std::size_t at = end_of_header_;
  while (records_.size() < max_frames && read_record(at)) {
  }
  if (records_.size() < max_frames) read_close(at);
  is_complete_ = at == bytes_.size() || records_.size() == max_frames;
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

void FilmReader::fail(std::size_t at, const std::string& what) const {
  throw InputError(at_byte(at), "damaged: " + what);
}

void FilmReader::read_header() {
  if (bytes_.size() < film_text_start ||
      std::memcmp(bytes_.data(), film_magic, sizeof film_magic) != 0)
    throw InputError(path_.string(), "not a film of snowshed");
  version_ = read<std::uint32_t>(8);
  if (version_ != film_version && version_ != 1)
    throw InputError(path_.string(), "a film of version " + std::to_string(version_) +
                                         "; this program reads the versions 1 to " +
                                         std::to_string(film_version));
  const std::size_t length = read<std::uint32_t>(12);
  if (length > max_header_bytes || length > bytes_.size() - film_text_start)
    fail(12, "its header does not fit into the file");
  const char* text = bytes_.data() + film_text_start;
  header_checksum_ = header_sum(version_, text, length);
  if (header_checksum_ != read<std::uint32_t>(header_sum_at))
    fail(header_sum_at, "its header has another checksum");
  if (read<std::uint32_t>(header_sum_at + 4) != 0) fail(header_sum_at + 4, "this is not zero");
  header_ = parsed_header(std::string(text, length), path_.string());
  end_of_header_ = film_text_start + length;
}

/// Whether a killed run may have left the frame at `at`: its beginning is present, and all present
/// bytes are right.
bool FilmReader::is_cut_off(std::size_t at) const {
  const std::size_t left = bytes_.size() - at;
  if (std::memcmp(bytes_.data() + at, &frame_tag, std::min(left, sizeof frame_tag)) == 0)
    return left < record_head ||
           read<std::uint32_t>(at + 32) > left - record_head;  // bytes of the packed content
  return left < record_head &&
         std::memcmp(bytes_.data() + at, &close_tag, std::min(left, sizeof close_tag)) == 0;
}

/// Whether a sound frame of version 1 follows anywhere behind `at`; the frame at `at` is then
/// damaged.
bool FilmReader::a_frame_follows(std::size_t at) const {
  const std::string tag(reinterpret_cast<const char*>(&frame_tag), sizeof frame_tag);
  for (at = bytes_.find(tag, at + 1); at != std::string::npos; at = bytes_.find(tag, at + 1)) {
    if (bytes_.size() - at < record_head) return false;
    const std::size_t packed = read<std::uint32_t>(at + 32);
    if (packed <= bytes_.size() - at - record_head &&
        crc32_of(bytes_.data() + at + facts_at, record_head - facts_at + packed) ==
            read<std::uint32_t>(at + 4))
      return true;
  }
  return false;
}

/// Returns the checksum of the frame at `at`, which must be complete.
std::uint32_t FilmReader::checked_sum(std::size_t at, std::size_t packed) const {
  const auto sum = read<std::uint32_t>(at + 4);
  const char* content = bytes_.data() + at + record_head;
  const bool sound =
      version_ == 1
          ? crc32_of(bytes_.data() + at + facts_at, record_head - facts_at + packed) == sum
          : crc32_of(content, packed) == read<std::uint32_t>(at + content_sum_at);
  if (!sound) fail(at, "a frame has another checksum");
  return sum;
}

/// Returns whether there is a complete frame at `at`; moves `at` behind it.
bool FilmReader::read_record(std::size_t& at) {
  if (at == bytes_.size()) return false;
  const std::size_t left = bytes_.size() - at;
  const bool cut_off = is_cut_off(at);
  if (left < record_head && !cut_off) fail(at, "the next bytes are not a frame");
  if (left < record_head) return false;
  if (read<std::uint32_t>(at) == close_tag && version_ != 1) return false;
  if (read<std::uint32_t>(at) != frame_tag) fail(at, "the next bytes are not a frame");
  if (version_ != 1 &&
      head_sum(bytes_.data() + at, checksum(records_.size())) != read<std::uint32_t>(at + 4))
    fail(at, "the head of a frame has another checksum, or the frame before it is missing");
  if (version_ == 1 && cut_off && a_frame_follows(at)) fail(at, "the length of a frame is wrong");
  if (cut_off) return false;
  const std::size_t packed = read<std::uint32_t>(at + 32);
  add_record(at, checked_sum(at, packed));
  at += record_head + packed;
  return true;
}

void FilmReader::add_record(std::size_t at, std::uint32_t checksum) {
  const FilmFrameInfo info{read<double>(at + 8), read<std::uint32_t>(at + 16),
                           read<std::uint32_t>(at + 24)};
  const std::size_t raw = read<std::uint32_t>(at + 28), packed = read<std::uint32_t>(at + 32);
  if (!std::isfinite(info.time) || raw > max_raw_bytes || !could_be_deflated(packed, raw) ||
      FilmCodec(header_).min_bytes(info.particles) > raw)
    fail(at, "the sizes of a frame do not fit together");
  const bool lists = (read<std::uint32_t>(at + 20) & lists_flag) != 0;
  const std::size_t payload = at + record_head;
  records_.push_back({payload, payload + packed, packed, raw, lists, checksum});
  frames_.push_back(info);
}

/// Reads the record that closes a film, if there is one at `at`; moves `at` behind it.
void FilmReader::read_close(std::size_t& at) {
  if (bytes_.size() - at < record_head || read<std::uint32_t>(at) != close_tag) return;
  if (head_sum(bytes_.data() + at, checksum(records_.size())) != read<std::uint32_t>(at + 4))
    fail(at, "the end has another checksum, or the frame before it is missing");
  at += record_head;
  if (at != bytes_.size()) fail(at, "something follows its end");
  closed_ = true;
}

FilmFrame FilmReader::next() {
  const Record& record = records_.at(next_);
  const std::string where = at_byte(record.payload - record_head);
  FilmFrame frame;
  frame.time = frames_[next_].time;
  frame.event = frames_[next_].event;
  const auto* payload = reinterpret_cast<const std::uint8_t*>(bytes_.data()) + record.payload;
  const auto raw = inflated(payload, record.packed, record.raw, where);
  codec_.decode(raw, record.lists, frames_[next_].particles, where, frame);
  ++next_;
  return frame;
}

/// The header and the first frames in the format of the present version.
std::string FilmReader::in_present_version(std::size_t frames) const {
  std::string bytes = header_bytes(header_);
  std::uint32_t sum = 0;
  std::memcpy(&sum, bytes.data() + header_sum_at, sizeof sum);
  for (std::size_t k = 0; k < frames; ++k) {
    const Record& r = records_[k];
    const RecordInfo info{frames_[k].time,          frames_[k].event,
                          r.lists ? lists_flag : 0, std::uint32_t(frames_[k].particles),
                          std::uint32_t(r.raw),     std::uint32_t(r.packed)};
    const char* content = bytes_.data() + r.payload;
    const auto head = record_bytes(frame_tag, info, crc32_of(content, r.packed), sum);
    bytes.append(head.begin(), head.end()).append(content, r.packed);
  }
  return bytes;
}

FilmWriter::FilmWriter(std::filesystem::path path, const FilmHeader& header)
    : FilmWriter(std::move(path), header, FilmCodec(header)) {
  const std::string bytes = header_bytes(header);
  write_atomic(path_, bytes);
  end_ = bytes.size();
  std::memcpy(&checksum_, bytes.data() + header_sum_at, sizeof checksum_);
}

FilmWriter FilmWriter::reopen(const std::filesystem::path& path,
                              const std::function<bool(const FilmFrameInfo&)>& keeps,
                              const std::optional<FilmMark>& mark) {
  FilmReader reader = mark ? FilmReader(path, mark->frames) : FilmReader(path);
  if (mark &&
      (reader.frames().size() < mark->frames || reader.checksum(mark->frames) != mark->checksum))
    throw InputError(path.string(), "damaged: its first " + std::to_string(mark->frames) +
                                        " frames are not those that the run recorded");
  std::size_t count = 0;
  while (count < reader.frames().size() && keeps(reader.frames()[count])) {
    reader.next();
    ++count;
  }
  if (reader.version() != film_version) {
    write_atomic(path, reader.in_present_version(count));
    return reopen(path, [](const FilmFrameInfo&) { return true; });
  }
  FilmWriter writer(path, reader.header(), FilmCodec(reader.header()));
  writer.frames_.assign(reader.frames().begin(), reader.frames().begin() + std::ptrdiff_t(count));
  writer.checksum_ = reader.checksum(count);
  writer.end_ = reader.end_of(count);
  writer.closed_ = reader.closed() && count == reader.frames().size();
  writer.more_follows_ = std::filesystem::file_size(path) > writer.end_;
  writer.codec_ = std::move(reader).release_codec();
  return writer;
}

void FilmWriter::append(const FilmFrame& frame) {
  FilmCodec after = codec_;
  const bool lists = codec_.lists_particles(frame);
  const std::vector<std::uint8_t> raw = after.encode(frame), packed = deflated(raw);
  const RecordInfo info{frame.time,
                        frame.event,
                        lists ? lists_flag : 0,
                        std::uint32_t(frame.ids.size()),
                        std::uint32_t(raw.size()),
                        std::uint32_t(packed.size())};
  std::uint32_t sum = checksum_;
  std::vector<std::uint8_t> bytes =
      record_bytes(frame_tag, info, crc32_of(packed.data(), packed.size()), sum);
  bytes.insert(bytes.end(), packed.begin(), packed.end());
  write(bytes);
  end_ += bytes.size();
  closed_ = false;
  frames_.push_back({frame.time, frame.event, frame.ids.size()});
  codec_ = std::move(after);
  checksum_ = sum;
}

/// Writes behind the frames that are kept.
void FilmWriter::write(const std::vector<std::uint8_t>& bytes) {
  if (more_follows_) truncate_file(path_, end_);
  more_follows_ = false;
  append_to_file(path_, bytes.data(), bytes.size());
}

void FilmWriter::close() {
  if (closed_) return;
  const FilmFrameInfo last = frames_.empty() ? FilmFrameInfo{} : frames_.back();
  std::uint32_t sum = checksum_;
  const auto bytes = record_bytes(
      close_tag, {last.time, last.event, 0, std::uint32_t(frames_.size()), 0, 0}, 0, sum);
  write(bytes);
  closed_ = more_follows_ = true;
}

}  // namespace snowshed::io
