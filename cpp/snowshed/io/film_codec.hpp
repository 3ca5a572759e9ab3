// Frames of a film as bytes: differences to a prediction from the frames before, as variable-length
// numbers, deflated.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "snowshed/io/film_frame.hpp"

namespace snowshed::io {

/// Turns frames into bytes and back, one after the other: both sides must have seen the same frames
/// before. A position is predicted from the two before it, a value from the one before.
class FilmCodec {
 public:
  explicit FilmCodec(const FilmHeader& header) : header_(header) {}

  /// Whether a frame has other particles than the one before, so that its bytes list them.
  bool lists_particles(const FilmFrame& frame) const { return frame.ids != last_.ids; }

  std::vector<std::uint8_t> encode(const FilmFrame&);

  /// Fills a frame of this number of particles. Throws InputError at `where` if the bytes are not
  /// those of such a frame; the codec must not be used after that.
  void decode(const std::vector<std::uint8_t>& bytes, bool lists_particles, std::size_t particles,
              const std::string& where, FilmFrame& frame);

  /// The least number of bytes of a frame.
  std::size_t min_bytes(std::size_t particles) const {
    return particles * (std::size_t(header_.axes) + header_.quantities.size());
  }

 private:
  std::vector<std::int64_t> previous_indices(const FilmFrame&) const;
  template <class Stream>
  void transfer(Stream&, FilmFrame&);
  void keep(const FilmFrame&, const std::vector<std::int64_t>& before);

  FilmHeader header_;
  FilmFrame last_;
  // The last displacement of each particle, one list per axis, in quanta.
  std::vector<std::vector<std::int32_t>> steps_;
};

/// Deflated bytes (zlib format, RFC 1950); throws std::bad_alloc if memory runs out.
std::vector<std::uint8_t> deflated(const std::vector<std::uint8_t>& bytes);

/// Whether deflate can reach this ratio of bytes: it is at most 1032 to 1.
bool could_be_deflated(std::size_t packed, std::size_t raw);

/// Returns the bytes before deflation. Throws InputError at `where` unless their number is `raw`.
std::vector<std::uint8_t> inflated(const std::uint8_t* packed, std::size_t packed_bytes,
                                   std::size_t raw, const std::string& where);

/// CRC-32 (RFC 1952) of bytes; `before` is the checksum of the bytes that precede them.
std::uint32_t crc32_of(const void* data, std::size_t bytes, std::uint32_t before = 0);

}  // namespace snowshed::io
