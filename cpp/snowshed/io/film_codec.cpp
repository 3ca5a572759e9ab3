#include "snowshed/io/film_codec.hpp"

#include <zlib.h>

#include <limits>
#include <new>

#include "snowshed/core/errors.hpp"

namespace snowshed::io {
namespace {

std::uint32_t zigzag(std::int32_t n) { return (std::uint32_t(n) << 1) ^ std::uint32_t(n >> 31); }
std::int32_t unzigzag(std::uint32_t n) { return std::int32_t((n >> 1) ^ (0u - (n & 1u))); }

/// A sum that wraps around instead of overflowing.
std::int32_t plus(std::int32_t a, std::int32_t b) {
  return std::int32_t(std::uint32_t(a) + std::uint32_t(b));
}
std::int32_t minus(std::int32_t a, std::int32_t b) {
  return std::int32_t(std::uint32_t(a) - std::uint32_t(b));
}

/// Appends numbers as LEB128: seven bits per byte, the lowest first.
class NumberWriter {
 public:
  static constexpr bool reads = false;
  void number(std::uint32_t& n) {
    std::uint32_t left = n;
    for (; left >= 128; left >>= 7) bytes.push_back(std::uint8_t(left | 128));
    bytes.push_back(std::uint8_t(left));
  }
  void difference(std::int32_t& value, std::int32_t expected) {
    std::uint32_t n = zigzag(minus(value, expected));
    number(n);
  }
  std::vector<std::uint8_t> bytes;
};

/// Reads the numbers of a NumberWriter.
class NumberReader {
 public:
  static constexpr bool reads = true;
  NumberReader(const std::vector<std::uint8_t>& bytes, const std::string& where)
      : at_(bytes.data()), end_(at_ + bytes.size()), where_(where) {}
  void number(std::uint32_t& n) {
    n = 0;
    for (int shift = 0; shift < 35; shift += 7) {
      if (at_ == end_) fail("its numbers end too early");
      const std::uint8_t byte = *at_++;
      n |= std::uint32_t(byte & 127) << shift;
      if (byte < 128) return;
    }
    fail("a number has more than five bytes");
  }
  void difference(std::int32_t& value, std::int32_t expected) {
    std::uint32_t n;
    number(n);
    value = plus(unzigzag(n), expected);
  }
  void require_end() const {
    if (at_ != end_) fail("it holds more than its particles");
  }
  [[noreturn]] void fail(const char* what) const {
    throw InputError(where_, std::string("damaged: ") + what);
  }

 private:
  const std::uint8_t *at_, *end_;
  const std::string& where_;
};

/// Numbers, each predicted to equal the previous number.
template <class Stream, class T>
void transfer_list(Stream& stream, std::vector<T>& values) {
  std::int32_t before = 0;
  for (T& value : values) {
    std::int32_t wide = std::int32_t(value);
    stream.difference(wide, before);
    if (wide < 0 || wide > std::int32_t(std::numeric_limits<T>::max())) {
      if constexpr (Stream::reads) stream.fail("an event, snow or radius is out of range");
    }
    value = T(before = wide);
  }
}

template <class Stream>
void transfer_ids(Stream& stream, std::vector<std::uint32_t>& ids) {
  std::uint32_t before = 0;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    std::uint32_t step = ids[i] - before;
    stream.number(step);
    if constexpr (Stream::reads) {
      if ((i > 0 && step == 0) || step > std::numeric_limits<std::uint32_t>::max() - before)
        stream.fail("its ids do not rise");
      ids[i] = before + step;
    }
    before = ids[i];
  }
}

}  // namespace

/// Returns the indices of a frame's particles in the last frame; -1 for new particles.
std::vector<std::int64_t> FilmCodec::previous_indices(const FilmFrame& frame) const {
  std::vector<std::int64_t> before(frame.ids.size(), -1);
  std::size_t k = 0;
  for (std::size_t i = 0; i < frame.ids.size(); ++i) {
    while (k < last_.ids.size() && last_.ids[k] < frame.ids[i]) ++k;
    if (k < last_.ids.size() && last_.ids[k] == frame.ids[i]) before[i] = std::int64_t(k);
  }
  return before;
}

/// Reads or writes positions and values. A new particle is predicted to be like the particle before
/// it.
template <class Stream>
void FilmCodec::transfer(Stream& stream, FilmFrame& frame) {
  const std::vector<std::int64_t> before = previous_indices(frame);
  for (std::size_t axis = 0; axis < frame.positions.size(); ++axis) {
    std::int32_t neighbour = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      std::int32_t& x = frame.positions[axis][i];
      const std::int64_t k = before[i];
      stream.difference(x, k < 0 ? neighbour : plus(last_.positions[axis][k], steps_[axis][k]));
      neighbour = x;
    }
  }
  for (std::size_t q = 0; q < frame.values.size(); ++q) {
    std::int32_t neighbour = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      std::int32_t& v = frame.values[q][i];
      stream.difference(v, before[i] < 0 ? neighbour : last_.values[q][before[i]]);
      neighbour = v;
    }
  }
  keep(frame, before);
}

void FilmCodec::keep(const FilmFrame& frame, const std::vector<std::int64_t>& before) {
  std::vector<std::vector<std::int32_t>> steps(frame.positions.size());
  for (std::size_t axis = 0; axis < steps.size(); ++axis) {
    steps[axis].assign(before.size(), 0);
    for (std::size_t i = 0; i < before.size(); ++i)
      if (before[i] >= 0)
        steps[axis][i] = minus(frame.positions[axis][i], last_.positions[axis][before[i]]);
  }
  last_ = frame;
  steps_ = std::move(steps);
}

std::vector<std::uint8_t> FilmCodec::encode(const FilmFrame& given) {
  FilmFrame frame = given;
  NumberWriter stream;
  stream.bytes.reserve(2 * min_bytes(frame.ids.size()));
  if (lists_particles(frame)) {
    transfer_ids(stream, frame.ids);
    transfer_list(stream, frame.events);
    transfer_list(stream, frame.materials);
    transfer_list(stream, frame.radii);
  }
  transfer(stream, frame);
  return std::move(stream.bytes);
}

void FilmCodec::decode(const std::vector<std::uint8_t>& bytes, bool lists, std::size_t particles,
                       const std::string& where, FilmFrame& frame) {
  NumberReader stream(bytes, where);
  if (particles > bytes.size() / std::size_t(header_.axes)) stream.fail("too few bytes");
  if (lists) {
    frame.ids.resize(particles);
    frame.events.resize(particles);
    frame.materials.resize(particles);
    frame.radii.resize(header_.has_radius ? particles : 0);
    transfer_ids(stream, frame.ids);
    transfer_list(stream, frame.events);
    transfer_list(stream, frame.materials);
    transfer_list(stream, frame.radii);
  } else {
    if (particles != last_.ids.size()) stream.fail("another number of particles than before");
    frame.ids = last_.ids;
    frame.events = last_.events;
    frame.materials = last_.materials;
    frame.radii = last_.radii;
  }
  frame.positions.assign(std::size_t(header_.axes), std::vector<std::int32_t>(particles));
  frame.values.assign(header_.quantities.size(), std::vector<std::int32_t>(particles));
  transfer(stream, frame);
  stream.require_end();
}

std::vector<std::uint8_t> deflated(const std::vector<std::uint8_t>& bytes) {
  z_stream stream{};
  // Resting snow gives runs of zeros. Other matches are rare, and searching for them costs time.
  if (deflateInit2(&stream, 1, Z_DEFLATED, 15, 9, Z_RLE) != Z_OK) throw std::bad_alloc();
  std::vector<std::uint8_t> packed;
  try {
    packed.resize(deflateBound(&stream, uLong(bytes.size())));
  } catch (...) {
    deflateEnd(&stream);
    throw;
  }
  stream.next_in = const_cast<Bytef*>(bytes.data());
  stream.avail_in = uInt(bytes.size());
  stream.next_out = packed.data();
  stream.avail_out = uInt(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

bool could_be_deflated(std::size_t packed, std::size_t raw) { return raw / 1032 <= packed; }

std::vector<std::uint8_t> inflated(const std::uint8_t* packed, std::size_t packed_bytes,
                                   std::size_t raw, const std::string& where) {
  std::vector<std::uint8_t> bytes(raw + 1);  // one byte more shows whether there are more
  uLongf inflated_bytes = uLongf(bytes.size());
  if (uncompress(bytes.data(), &inflated_bytes, packed, uLong(packed_bytes)) != Z_OK ||
      inflated_bytes != raw)
    throw InputError(where, "damaged: cannot be inflated to its " + std::to_string(raw) + " bytes");
  bytes.resize(raw);
  return bytes;
}

std::uint32_t crc32_of(const void* data, std::size_t bytes, std::uint32_t before) {
  return std::uint32_t(crc32_z(before, static_cast<const Bytef*>(data), bytes));
}

}  // namespace snowshed::io
