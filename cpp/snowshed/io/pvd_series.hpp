// A time series of snapshots (.pvd) that ParaView opens as one animation.
#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace snowshed {

/// The list of snapshots of a run. The file is whole after every `append`.
class PvdSeries {
 public:
  struct Entry {
    double time;       // s
    std::string file;  // relative to the folder of the series
  };

  /// A new series; no file is written before the first `append`.
  explicit PvdSeries(std::filesystem::path path) : path_(std::move(path)) {}

  /// Goes on with the series at `path`, without its entries at or after the time `before`: a
  /// resumed run writes those again. A series without a file is empty; one that is not such a
  /// file is an InputError with its line.
  static PvdSeries reopen(std::filesystem::path path,
                          double before = std::numeric_limits<double>::infinity());

  /// Adds a snapshot and rewrites the file atomically. Times must be finite and not decrease
  /// (std::invalid_argument).
  void append(double time, const std::string& file);

  const std::vector<Entry>& entries() const { return entries_; }

 private:
  void save() const;

  std::filesystem::path path_;
  std::vector<Entry> entries_;
};

}  // namespace snowshed
