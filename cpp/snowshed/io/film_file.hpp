// The file of a film: frames are appended while a run goes on, so that a killed run leaves all
// frames that it has written. docs/view.md describes the format.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "snowshed/io/film_codec.hpp"
#include "snowshed/io/film_frame.hpp"

namespace snowshed {

inline constexpr std::uint32_t film_version = 1;

/// What is known of a frame without its particles.
struct FilmFrameFacts {
  double time = 0;  // s
  std::uint32_t event = 0;
  std::size_t particles = 0;
};

/// Reads a film. The file is untrusted: sizes are checked before memory is taken for them, and
/// every fault is an InputError that names the file and the byte.
class FilmReader {
 public:
  /// Reads the header and where the frames are. A last frame that is not whole is left out: the run
  /// still writes it, or was killed.
  explicit FilmReader(std::filesystem::path path);

  const FilmHeader& header() const { return header_; }
  const std::vector<FilmFrameFacts>& frames() const { return facts_; }
  bool whole() const { return whole_; }  ///< nothing follows the last frame

  /// Where a frame ends, bytes from the start of the file.
  std::size_t end_of(std::size_t frame) const { return records_[frame].end; }
  std::size_t end_of_header() const { return end_of_header_; }

  /// Decodes the next frame. Throws InputError where it is damaged.
  FilmFrame next();
  std::size_t position() const { return next_; }  ///< number of the next frame
  /// The codec as it is after the frames that have been read.
  FilmCodec release_codec() && { return std::move(codec_); }

 private:
  struct Record {
    std::size_t payload, end, packed, raw;  // bytes
    bool lists;
  };
  void read_header();
  bool read_record(std::size_t& at);
  template <class T>
  T read(std::size_t at) const;
  std::string at_byte(std::size_t at) const;

  std::filesystem::path path_;
  std::string bytes_;
  FilmHeader header_;
  std::size_t end_of_header_ = 0, next_ = 0;
  std::vector<Record> records_;
  std::vector<FilmFrameFacts> facts_;
  bool whole_ = true;
  FilmCodec codec_{FilmHeader{}};
};

/// Writes a film, frame by frame. Throws FileError, naming the file; a frame is written whole or
/// taken back.
class FilmWriter {
 public:
  /// Begins a film in place of any other.
  FilmWriter(std::filesystem::path path, const FilmHeader& header);

  /// Goes on with a film behind the frames that `keeps` wants, from the first on; the others are
  /// removed. Empty where there is no sound film to go on with.
  static std::optional<FilmWriter> reopen(const std::filesystem::path& path,
                                          const std::function<bool(const FilmFrameFacts&)>& keeps);

  const FilmHeader& header() const { return header_; }
  const std::vector<FilmFrameFacts>& frames() const { return facts_; }

  void append(const FilmFrame&);

 private:
  FilmWriter(std::filesystem::path path, FilmHeader header, FilmCodec codec)
      : path_(std::move(path)), header_(std::move(header)), codec_(std::move(codec)) {}

  std::filesystem::path path_;
  FilmHeader header_;
  FilmCodec codec_;
  std::vector<FilmFrameFacts> facts_;
};

}  // namespace snowshed
