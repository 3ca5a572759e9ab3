#include "snowshed/run/energy_history.hpp"

#include <limits>

#include "snowshed/core/errors.hpp"
#include "snowshed/io/binary_archive.hpp"
#include "snowshed/methods/capabilities.hpp"
#include "snowshed/run/record_times.hpp"

namespace snowshed::run {
namespace {

constexpr double never = -std::numeric_limits<double>::infinity();

}  // namespace

EnergyHistory::EnergyHistory(const std::vector<std::string>& energies, double interval)
    : columns_{"event", "time_s"}, interval_(interval) {
  columns_.insert(columns_.end(), energies.begin(), energies.end());
}

/// The time of the event's last record, s.
double EnergyHistory::last_time(int event) const {
  return values_.empty() || event_of(rows() - 1) != event ? never : time_of(rows() - 1);
}

double EnergyHistory::next_time(int event) const {
  if (last_time(event) == never) return never;
  std::size_t first = rows() - 1;
  while (first > 0 && event_of(first - 1) == event) --first;
  return next_record_time(time_of(first), last_time(event), rows() - first, interval_);
}

void EnergyHistory::record(const methods::Method& method, int event) {
  if (method.time() >= next_time(event)) add_row(method, event);
}

void EnergyHistory::record_end(const methods::Method& method, int event) {
  if (last_time(event) < method.time()) add_row(method, event);
}

void EnergyHistory::add_row(const methods::Method& method, int event) {
  std::vector<double> row{double(event), method.time()};
  for (const auto& energy : methods::capability<methods::KeepsEnergy>(method)->energies())
    row.push_back(energy.second);
  values_.insert(values_.end(), row.begin(), row.end());
}

void EnergyHistory::save(io::BinaryWriter& out) const { out.add("energy_history", values_); }

void EnergyHistory::load(const io::BinaryReader& in) {
  values_.clear();
  if (!in.has("energy_history")) return;
  const auto values = in.view<double>("energy_history");
  if (values.size % columns_.size() != 0)
    throw InputError(in.path().string(), "the energies over time belong to another method");
  values_.assign(values.begin(), values.end());
}

}  // namespace snowshed::run
