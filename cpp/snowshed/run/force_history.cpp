#include "snowshed/run/force_history.hpp"

#include <cstdio>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/message_format.hpp"
#include "snowshed/methods/archive.hpp"
#include "snowshed/methods/capabilities.hpp"
#include "snowshed/run/record_times.hpp"

namespace snowshed::run {
namespace {

constexpr const char* unbalanced = "unbalanced";

methods::KeepsForces& keeping(methods::Method& method) {
  return *methods::capability<methods::KeepsForces>(method);
}

/// Columns of a force and of its place, with a prefix.
std::vector<std::string> force_columns(const std::string& prefix) {
  std::vector<std::string> columns;
  for (const char* name : {"fx_n", "fy_n", "fz_n", "normal_n", "tangential_n", "mx_nm", "my_nm",
                           "mz_nm", "cx_m", "cy_m", "cz_m", "area_m2", "pressure_pa"})
    columns.push_back(prefix + name);
  return columns;
}

void append(std::vector<double>& row, const Vec3& v) { row.insert(row.end(), {v[0], v[1], v[2]}); }

/// The numbers of `force_columns`.
void append(std::vector<double>& row, const methods::ContactImpulse& force,
            const methods::Pressed& pressed) {
  append(row, force.total());
  row.insert(row.end(), {force.push, force.tangential.norm()});
  append(row, force.moment);
  append(row, force.center());
  row.insert(row.end(), {pressed.area, pressed.pressure});
}

/// "peak_10ms_" for a window of 0.01 s.
std::string peak_prefix(double window) {
  char name[32];
  std::snprintf(name, sizeof name, "peak_%gms_", 1000 * window);
  return name;
}

/// A name as a cell. A spreadsheet would compute a name that begins like a formula.
std::string csv_cell(const std::string& given) {
  std::string name = printable(given);
  if (!name.empty() && std::string("=+-@\t\r").find(name.front()) != std::string::npos)
    name = "'" + name;
  if (name.find_first_of(",\"\n\r") == std::string::npos) return name;
  std::string text = "\"";
  for (const char c : name) text += c == '"' ? std::string("\"\"") : std::string(1, c);
  return text + "\"";
}

std::string csv_of(const NumberTable& table, const std::vector<std::string>& names) {
  std::string csv;
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    csv += (c > 0 ? "," : "") + table.columns[c];
  csv += "\n";
  for (std::size_t i = 0; i < table.values.size(); ++i) {
    const std::size_t c = i % table.columns.size();
    if (c > 0) csv += ",";
    if (table.columns[c] == "obstacle") {
      csv += csv_cell(names[std::size_t(table.values[i])]);
    } else {
      char number[32];
      std::snprintf(number, sizeof number, "%.9g", table.values[i]);
      csv += number;
    }
    if (c + 1 == table.columns.size()) csv += "\n";
  }
  return csv;
}

}  // namespace

ForceHistory::ForceHistory(const methods::Method& method, double interval) : interval_(interval) {
  const auto* forces = methods::capability<methods::KeepsForces>(method)->forces();
  names_ = forces->names();
  names_.push_back(unbalanced);
  patch_edge_ = forces->pressures().edge();
  forces_.columns = {"event", "time_s", "duration_s", "obstacle"};
  for (std::string& column : force_columns("")) forces_.columns.push_back(std::move(column));
  loads_.columns = {"event", "obstacle", "at_rest"};
  for (std::string& column : force_columns("rest_")) loads_.columns.push_back(std::move(column));
  for (std::size_t k = 0; k < methods::RunningMeans::windows.size(); ++k)
    for (const char* name : {"n", "fx_n", "fy_n", "fz_n", "time_s"})
      loads_.columns.push_back(peak_prefix(methods::RunningMeans::window(k)) + name);
  for (const char* name : {"impulse_x_ns", "impulse_y_ns", "impulse_z_ns", "peak_pressure_pa",
                           "peak_pressure_time_s", "patch_m"})
    loads_.columns.emplace_back(name);
  before_.resize(names_.size());
  at_begin_.resize(names_.size());
}

void ForceHistory::begin_event(methods::Method& method, int event) {
  keeping(method).begin_force_event();
  event_ = event;
  first_ = last_ = method.time();
  records_ = 1;
  at_rest_ = false;
  at_begin_ = before_;
}

void ForceHistory::record(methods::Method& method) {
  if (records_ > 0 &&
      method.time() >= next_record_time(first_, last_, std::size_t(records_), interval_))
    add_rows(method);
}

void ForceHistory::end_event(methods::Method& method, bool at_rest) {
  add_rows(method);
  at_rest_ = at_rest;
  add_loads(keeping(method));
}

void ForceHistory::add_rows(methods::Method& method) {
  const double duration = method.time() - last_;
  if (!(duration > 0)) return;
  std::vector<methods::ForceSample> samples = keeping(method).sample_forces(duration);
  methods::ForceSample left;  // on the snow, as if an obstacle had received the opposite
  left.impulse.tangential = -keeping(method).forces()->unbalanced();
  samples.push_back(left);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    std::vector<double> row{double(event_), method.time(), duration, double(i)};
    append(row, 1 / duration * (samples[i].impulse - before_[i]), samples[i].pressed);
    forces_.values.insert(forces_.values.end(), row.begin(), row.end());
    before_[i] = samples[i].impulse;
  }
  last_ = method.time();
  ++records_;
}

void ForceHistory::add_loads(const methods::KeepsForces& method) {
  const methods::ObstacleForces& record = *method.forces();
  const methods::RestingForces resting = method.resting_forces(at_rest_);
  std::vector<const methods::Patch*> highest(record.names().size(), nullptr);
  for (const methods::Patch& patch : record.pressures().patches()) {
    const methods::Patch*& known = highest[record.name_of(patch.obstacle())];
    if (!known || patch.peak > known->peak) known = &patch;
  }
  for (std::size_t i = 0; i < record.names().size(); ++i) {
    std::vector<double> row{double(event_), double(i), double(at_rest_)};
    append(row, resting.forces[i].force, resting.forces[i].pressed);
    const methods::RunningMeans& means = record.forces()[i].means;
    for (std::size_t k = 0; k < means.windows.size(); ++k) {
      row.push_back(means.peak(k).norm());
      append(row, means.peak(k));
      row.push_back(means.peak_time(k));
    }
    append(row, (before_[i] - at_begin_[i]).total());
    row.insert(row.end(), {highest[i] ? highest[i]->peak : 0.0,
                           highest[i] ? highest[i]->peak_time : 0.0, patch_edge_});
    loads_.values.insert(loads_.values.end(), row.begin(), row.end());
  }
}

std::string ForceHistory::forces_csv() const { return csv_of(forces_, names_); }
std::string ForceHistory::loads_csv() const { return csv_of(loads_, names_); }

template <class Archive, class Self>
void ForceHistory::visit(Archive& archive, Self& self) {
  archive.array("force_history/forces", self.forces_.values,
                archive.size("force_history/forces", self.forces_.values));
  archive.array("force_history/loads", self.loads_.values,
                archive.size("force_history/loads", self.loads_.values));
  archive.counts("force_history/event", self.event_, self.records_, self.at_rest_);
  archive.numbers("force_history/times", self.first_, self.last_);
  const auto visit_numbers = [](auto& impulse, const auto& number) {
    methods::ContactImpulse::for_each_number(impulse, number);
  };
  archive.packed("force_history/before", self.before_, self.names_.size(), visit_numbers);
  archive.packed("force_history/at_begin", self.at_begin_, self.names_.size(), visit_numbers);
}

void ForceHistory::save(io::BinaryWriter& out) const {
  methods::StateWriter archive(out);
  visit(archive, *this);
}

void ForceHistory::load(const io::BinaryReader& in) {
  if (!in.has("force_history/forces")) return;
  const methods::StateReader archive(in);
  visit(archive, *this);
  for (const NumberTable* table : {&forces_, &loads_}) {
    if (table->values.size() % table->columns.size() != 0)
      archive.refuse("the forces over time are not whole rows");
    for (std::size_t i = 0; i < table->values.size(); ++i)
      if (table->columns[i % table->columns.size()] == "obstacle" &&
          !(table->values[i] >= 0 && table->values[i] < double(names_.size())))
        archive.refuse("the forces over time are of other obstacles");
  }
}

}  // namespace snowshed::run
