// The energy balance over time, as a table that grows during a run.
#pragma once

#include <string>
#include <vector>

#include "snowshed/methods/method.hpp"

namespace snowshed::io {
class BinaryReader;
class BinaryWriter;
}  // namespace snowshed::io

namespace snowshed::run {

/// Rows at the beginning and the end of each event, and between them when a record is due
/// (`record_times.hpp`). They depend on the steps alone: neither on the number of threads nor on
/// whether the run was resumed.
class EnergyHistory {
 public:
  /// A history of energies with these names, one row per `interval` seconds.
  EnergyHistory(const std::vector<std::string>& energies, double interval);

  /// Adds the row that is due, if one is.
  void record(const methods::Method&, int event);
  /// Adds the last row of an event, unless it has been added.
  void record_end(const methods::Method&, int event);

  /// Event, time through all events (s), and the energies (J).
  const std::vector<std::string>& columns() const { return columns_; }
  const std::vector<double>& values() const { return values_; }  ///< row by row

  void save(io::BinaryWriter&) const;
  /// Reads the rows; an archive of an earlier version may have none. Throws InputError if the rows
  /// are not of these energies.
  void load(const io::BinaryReader&);

 private:
  std::size_t rows() const { return values_.size() / columns_.size(); }
  double event_of(std::size_t row) const { return values_[row * columns_.size()]; }
  double time_of(std::size_t row) const { return values_[row * columns_.size() + 1]; }
  double last_time(int event) const;
  double next_time(int event) const;
  void add_row(const methods::Method&, int event);

  std::vector<std::string> columns_;
  double interval_;
  std::vector<double> values_;
};

}  // namespace snowshed::run
