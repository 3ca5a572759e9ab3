// Time series of snapshots (.pvd), which ParaView opens as one animation.
#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace snowshed::io {

/// The list of snapshots of a run. The file is complete after every `append`.
class PvdSeries {
 public:
  struct Entry {
    double time;       // s
    std::string file;  // relative to the folder of the series
  };

  /// Starts a new series. No file is written before the first `append`.
  explicit PvdSeries(std::filesystem::path path) : path_(std::move(path)) {}

  /// Returns the series at `path` without its entries at or after the time `before`, which a
  /// resumed run writes again. The series is empty if there is no file. Throws InputError with the
  /// line if the file is not a .pvd series.
  static PvdSeries reopen(std::filesystem::path path,
                          double before = std::numeric_limits<double>::infinity());

  /// Adds a snapshot and rewrites the file atomically. Throws std::invalid_argument if the time is
  /// not finite or decreases.
  void append(double time, const std::string& file);

  const std::vector<Entry>& entries() const { return entries_; }

 private:
  void save() const;

  std::filesystem::path path_;
  std::vector<Entry> entries_;
};

}  // namespace snowshed::io
