// Features and cost of a scene on this machine, before it runs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "snowshed/run/cost_estimate.hpp"

namespace snowshed::run {

struct CostReport {
  std::vector<std::string> used, left_out;  // names of features
  methods::CostEstimate cost;
  double updates_per_s = 0;  // particle updates, measured here and now on a small copy
  double wall_time = 0;      // s, expected
  int threads = 0;
  std::string kernels;  // instruction set
  std::string device;   // name of the card, or "cpu"
};

/// Expected work of a run in particle updates of unbroken snow; updates of spread and yielding snow
/// count more. Nothing is measured. Throws InputError as a run would.
double expected_work(const scene::Scene& scene, const std::filesystem::path& base_dir = ".");

/// Reports the cost; throws InputError as a run would. It takes a fraction of a second: the speed
/// is measured on the scene itself, coarsened to at most 50 000 particles.
CostReport report_cost(const scene::Scene& scene, const std::filesystem::path& base_dir = ".");

}  // namespace snowshed::run
