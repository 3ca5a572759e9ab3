#include "snowshed/run/record_times.hpp"

#include <algorithm>
#include <cmath>

namespace snowshed::run {
namespace {

constexpr double records_of_all_events = 400;
// Limits for one event that lasts as long as expected.
constexpr double min_records = 12, max_records = 40;
constexpr std::size_t records_before_longer = 240;

}  // namespace

double record_interval(const scene::Scene& scene, const methods::CostEstimate& cost) {
  if (scene.output.film_interval > 0) return scene.output.film_interval;
  const double records =
      std::clamp(records_of_all_events / scene.events.count, min_records, max_records);
  return std::max(cost.event_time, 1e-9) / records;
}

double next_record_time(double first, double last, std::size_t count, double interval) {
  const double longer = interval * std::exp2(double((count - 1) / records_before_longer));
  const double passed = (last - first) / longer;
  return first + (std::floor(passed + 1e-9) + 1) * longer;
}

}  // namespace snowshed::run
