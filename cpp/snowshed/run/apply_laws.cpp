#include "snowshed/run/apply_laws.hpp"

#include <algorithm>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/message_format.hpp"

namespace snowshed::run {
namespace {

/// Calls f(obstacle) for the obstacles of a name, as they are given and as they are resolved.
template <class F>
void for_each_named(methods::Surroundings& surroundings, const std::string& name, F f) {
  bool known = false;
  for (std::vector<methods::Obstacle>* list : {&surroundings.obstacles, &surroundings.resolved})
    for (methods::Obstacle& obstacle : *list)
      if (obstacle.name == name) {
        known = true;
        f(obstacle);
      }
  if (known) return;
  std::vector<std::string> names;
  for (const methods::Obstacle& obstacle : surroundings.obstacles) names.push_back(obstacle.name);
  throw InputError("laws", "no obstacle is called " + quote(name) + "; the scene has " +
                               quoted_list(names) + suggestion(name, names));
}

}  // namespace

void apply_laws(const methods::UserLaws& laws, const scene::Scene& scene,
                methods::Surroundings& surroundings) {
  if (!laws.any()) return;
  const methods::MethodInfo& info = scene.numerics->info();
  if (!info.takes_laws)
    throw InputError("laws", "the method " + quote(info.name) + " takes no laws of the user");
  if (laws.material && laws.constitutive)
    throw InputError("laws", "a law of the material and a constitutive law; give one of them");
  if (laws.own_numbers < 0 || laws.own_numbers > methods::max_own_numbers ||
      (laws.own_numbers && !laws.constitutive))
    throw InputError(
        "laws", std::to_string(laws.own_numbers) + " numbers of its own; allowed: 0 to " +
                    std::to_string(methods::max_own_numbers) + ", with a constitutive law only");
  if ((laws.material || laws.constitutive) && scene.snow.model == material::SnowModel::elastic)
    throw InputError("/snow/model",
                     "\"elastic\" has no law that the user could replace; leave the "
                     "model out");
  if (scene.output.energy && (laws.constitutive || laws.body_force || !laws.motion.empty()))
    throw InputError("/output/energy",
                     "a constitutive law, a body force or a motion of the user is not in the "
                     "energy balance; leave the balance or the law out");
  for (const auto& [name, law] : laws.friction) {
    bool sticky = false;
    for_each_named(surroundings, name, [&, law = law](methods::Obstacle& o) {
      o.law.coefficient = law;
      sticky = o.law.condition == methods::Condition::sticky;
    });
    if (sticky)
      surroundings.notes.push_back("the friction of " + quote(name) +
                                   " is not used, because snow sticks to it");
  }
  for (const auto& [name, law] : laws.motion)
    for_each_named(surroundings, name, [law = law](methods::Obstacle& o) {
      o.motion.emplace(geometry::RigidMotion(law));
    });
  surroundings.laws = laws;
  surroundings.notes.push_back("laws of the user: " + laws.name +
                               "; neither the scene nor a checkpoint holds them");
}

}  // namespace snowshed::run
