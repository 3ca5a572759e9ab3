#include "snowshed/scene/distinct_snows.hpp"

#include <algorithm>
#include <tuple>

#include "snowshed/scene/event_bodies.hpp"

namespace snowshed::scene {
namespace {

bool are_same(const material::Snow& a, const material::Snow& b) {
  const auto values = [](const material::Snow& s) {
    return std::tie(s.model, s.density, s.youngs_modulus, s.poissons_ratio, s.critical_state_slope,
                    s.preconsolidation_pressure, s.cohesion, s.hardening_factor);
  };
  return values(a) == values(b);
}

}  // namespace

std::vector<material::Snow> distinct_snows(const Scene& scene) {
  std::vector<material::Snow> snows;
  const auto add = [&](const auto& part) {
    const material::Snow& snow = snow_of(scene, part);
    if (std::none_of(snows.begin(), snows.end(),
                     [&](const material::Snow& known) { return are_same(known, snow); }))
      snows.push_back(snow);
  };
  if (scene.slab)
    for (const Layer& layer : layers_of(*scene.slab)) add(layer);
  for (const BodySpec& body : scene.bodies) add(body);
  return snows;
}

int material_id_of(const material::Snow& snow, const std::vector<material::Snow>& snows) {
  const auto same = std::find_if(snows.begin(), snows.end(), [&](const material::Snow& known) {
    return are_same(known, snow);
  });
  return int(same - snows.begin());
}

}  // namespace snowshed::scene
