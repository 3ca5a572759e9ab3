// The file of a film: frames are appended while a run goes on, so that a killed run leaves all
// frames that it has written. docs/reference/film.md describes the format.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "snowshed/io/film_codec.hpp"
#include "snowshed/io/film_frame.hpp"

namespace snowshed::io {

inline constexpr std::uint32_t film_version = 2;  // written; version 1 is read, too

/// Facts about a frame without its particles.
struct FilmFrameInfo {
  double time = 0;  // s
  std::uint32_t event = 0;
  std::size_t particles = 0;
};

/// Identifies the header and the first frames of a film, independent of later frames.
struct FilmMark {
  std::size_t frames = 0;
  std::uint32_t checksum = 0;  // checksum of the last of them, which depends on all before it
};

/// Reads a film. The file is untrusted: sizes are checked before memory is taken for them, and
/// every fault is an InputError that names the file and the byte.
class FilmReader {
 public:
  /// Reads the header and the first frames, all of them by default, and checks their checksums. A
  /// last frame that is cut off is left out: the run still writes it, or was killed.
  explicit FilmReader(std::filesystem::path path, std::size_t max_frames = std::size_t(-1));

  std::uint32_t version() const { return version_; }
  const FilmHeader& header() const { return header_; }
  const std::vector<FilmFrameInfo>& frames() const { return frames_; }
  bool is_complete() const { return is_complete_; }  ///< no frame is cut off
  bool closed() const { return closed_; }  ///< the run came to its end; false in version 1

  /// End of the first `frames` frames, bytes from the start of the file, and their checksum.
  std::size_t end_of(std::size_t frames) const {
    return frames ? records_[frames - 1].end : end_of_header_;
  }
  std::uint32_t checksum(std::size_t frames) const {
    return frames ? records_[frames - 1].checksum : header_checksum_;
  }

  /// The bytes of the header and the first `frames` frames in the present version.
  std::string in_present_version(std::size_t frames) const;

  /// Decodes the next frame. Throws InputError if it is damaged.
  FilmFrame next();
  std::size_t position() const { return next_; }  ///< number of the next frame
  /// The codec as it is after the frames that have been read.
  FilmCodec release_codec() && { return std::move(codec_); }

 private:
  struct Record {
    std::size_t payload, end, packed, raw;  // bytes
    bool lists;
    std::uint32_t checksum;
  };
  void read_header();
  bool read_record(std::size_t& at);
  bool is_cut_off(std::size_t at) const;
  bool a_frame_follows(std::size_t at) const;
  std::uint32_t checked_sum(std::size_t at, std::size_t packed) const;
  void add_record(std::size_t at, std::uint32_t checksum);
  void read_close(std::size_t& at);
  template <class T>
  T read(std::size_t at) const;
  [[noreturn]] void fail(std::size_t at, const std::string& what) const;
  std::string at_byte(std::size_t at) const;

  std::filesystem::path path_;
  std::string bytes_;
  std::uint32_t version_ = 0, header_checksum_ = 0;
  FilmHeader header_;
  std::size_t end_of_header_ = 0, next_ = 0;
  std::vector<Record> records_;
  std::vector<FilmFrameInfo> frames_;
  bool is_complete_ = true, closed_ = false;
  FilmCodec codec_{FilmHeader{}};
};

/// Writes a film, frame by frame. Throws FileError, naming the file; an incomplete frame is
/// removed.
class FilmWriter {
 public:
  /// Begins a film in place of any other.
  FilmWriter(std::filesystem::path path, const FilmHeader& header);

  /// Continues a film behind the first frames for which `keeps` is true; the others are removed
  /// with the next change. With a `mark` only the frames that it names are read. A film of version
  /// 1 becomes one of the present version. Throws InputError if the film is damaged, or is not
  /// the one that was marked.
  static FilmWriter reopen(const std::filesystem::path& path,
                           const std::function<bool(const FilmFrameInfo&)>& keeps,
                           const std::optional<FilmMark>& mark = {});

  const FilmHeader& header() const { return header_; }
  const std::vector<FilmFrameInfo>& frames() const { return frames_; }
  FilmMark mark() const { return {frames_.size(), checksum_}; }

  void append(const FilmFrame&);
  /// Marks the film as complete. A further frame removes the mark.
  void close();

 private:
  void write(const std::vector<std::uint8_t>& bytes);
  FilmWriter(std::filesystem::path path, FilmHeader header, FilmCodec codec)
      : path_(std::move(path)), header_(std::move(header)), codec_(std::move(codec)) {}

  std::filesystem::path path_;
  FilmHeader header_;
  FilmCodec codec_;
  std::vector<FilmFrameInfo> frames_;
  std::uint32_t checksum_ = 0;  // checksum of the last frame, or of the header if there is none
  std::size_t end_ = 0;         // size of the frames that are kept, bytes
  bool more_follows_ = false;   // behind them in the file
  bool closed_ = false;
};

}  // namespace snowshed::io
