#include "snowshed/methods/registry.hpp"

#include <algorithm>
#include <stdexcept>

#include "snowshed/core/message_format.hpp"
#include "snowshed/methods/method_choice.hpp"

/// One line for each method, whose folder defines `const MethodDescriptor& descriptor()`.
// clang-format off
#define SNOWSHED_METHODS(add) \
  add(mpm)                    \
  add(slide)                  \
  add(grains)                 \
  add(mps)
// clang-format on

namespace snowshed::methods {

#define SNOWSHED_DECLARE(name)          \
  namespace name {                      \
  const MethodDescriptor& descriptor(); \
  }
SNOWSHED_METHODS(SNOWSHED_DECLARE)
#undef SNOWSHED_DECLARE

namespace {

std::vector<const MethodDescriptor*>& registered() {
#define SNOWSHED_ADD(name) &name::descriptor(),
  static std::vector<const MethodDescriptor*> all{SNOWSHED_METHODS(SNOWSHED_ADD)};
#undef SNOWSHED_ADD
  return all;
}

}  // namespace

const std::vector<const MethodDescriptor*>& all_methods() { return registered(); }

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const MethodDescriptor* method : all_methods()) names.emplace_back(method->info().name);
  return names;
}

std::string takes_no_part(const MethodInfo& method, Part part) {
  std::string others;
  for (const MethodDescriptor* other : all_methods())
    if (other->info().takes.has(part))
      others += (others.empty() ? "; methods that do: " : ", ") + std::string(other->info().name);
  return "the method " + quote(method.name) + " takes no such part" + others;
}

RegisteredMethod::RegisteredMethod(const MethodDescriptor& method) {
  registered().push_back(&method);
}

RegisteredMethod::~RegisteredMethod() { registered().pop_back(); }

MethodChoice::MethodChoice() : MethodChoice(*all_methods().front()) {}

bool MethodChoice::is_default() const {
  return descriptor_->info().name == all_methods().front()->info().name;
}

MethodChoice MethodChoice::usual() const {
  for (const MethodDescriptor* method : all_methods())
    if (&method->info() == &descriptor_->info()) return MethodChoice(*method);
  throw std::logic_error("a method that is not registered");
}

std::size_t MethodDescriptor::count_particles(const geometry::LevelSet&, int) const {
  throw std::logic_error("the method does not fill solids itself");
}

CostEstimate MethodDescriptor::cost_of_bodies(const SceneView&, const SceneOutline&,
                                              std::vector<double>) const {
  throw std::logic_error("the method takes no bodies");
}

CostEstimate MethodDescriptor::cost_of_method(const SceneView&, const Surroundings&,
                                              const Method&) const {
  throw std::logic_error("the cost of a method that takes bodies needs no built simulation");
}

void MethodDescriptor::fill(const geometry::LevelSet&, int, const StopRequest&, ParticleBatch&,
                            std::vector<std::string>&) const {
  throw std::logic_error("the method does not fill solids itself");
}

}  // namespace snowshed::methods
