// Times at which a run's film and energies are recorded.
#pragma once

#include <cstddef>

#include "snowshed/run/cost_estimate.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed::run {

/// Simulated time between two records, s. It is the scene's output.film_interval; by default an
/// event has 40 records, and fewer if there are more than ten events.
double record_interval(const scene::Scene&, const methods::CostEstimate&);

/// Time of an event's next record, s, after `count` records since `first`, the last one at `last`.
/// The interval doubles with every 240 records, so that records of endless events stay small. It
/// depends on the records alone, so that a resumed run makes the same records.
double next_record_time(double first, double last, std::size_t count, double interval);

}  // namespace snowshed::run
