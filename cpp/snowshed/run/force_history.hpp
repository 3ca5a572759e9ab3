// The forces on obstacles over time (forces.csv), and the loads of each event (loads.csv).
#pragma once

#include <string>
#include <vector>

#include "snowshed/methods/method.hpp"
#include "snowshed/methods/obstacle_forces.hpp"

namespace snowshed::run {

/// A table of numbers; in the column "obstacle" they are places in a list of names.
struct NumberTable {
  std::vector<std::string> columns;
  std::vector<double> values;  // row by row

  std::size_t rows() const { return values.size() / columns.size(); }
};

/// Rows of forces are means of impulses since the row before, so that nothing is lost between them.
/// They depend on the steps alone: neither on the number of threads nor on whether the run was
/// resumed.
class ForceHistory {
 public:
  /// The history of a method that keeps forces, with rows every `interval` seconds. In very long
  /// events they become fewer (record_times.hpp).
  ForceHistory(const methods::Method&, double interval);

  void begin_event(methods::Method&, int event);
  /// Adds the rows that are due, if any are.
  void record(methods::Method&);
  /// Adds the last rows of the event and its loads.
  void end_event(methods::Method&, bool at_rest);

  /// The names in the column "obstacle". The last one stands for the force that would explain the
  /// change of momentum that neither gravity nor an obstacle explains.
  const std::vector<std::string>& names() const { return names_; }
  const NumberTable& forces() const { return forces_; }
  const NumberTable& loads() const { return loads_; }
  std::string forces_csv() const;
  std::string loads_csv() const;
  /// Whether the last event ended at rest.
  bool ended_at_rest() const { return at_rest_; }

  void save(io::BinaryWriter&) const;
  /// Reads the tables. A checkpoint of a run without forces has none. Throws InputError.
  void load(const io::BinaryReader&);

 private:
  void add_rows(methods::Method&);
  void add_loads(const methods::KeepsForces&);
  template <class Archive, class Self>
  static void visit(Archive&, Self&);

  std::vector<std::string> names_;
  double interval_, patch_edge_;  // s, m
  NumberTable forces_, loads_;
  int event_ = 0;
  double first_ = 0, last_ = 0;  // s, begin of the event, and time of its last rows
  std::int64_t records_ = 0;     // times of this event that have rows, and its begin
  bool at_rest_ = false;
  std::vector<methods::ContactImpulse> before_, at_begin_;  // at the last rows, and of the event
};

}  // namespace snowshed::run
