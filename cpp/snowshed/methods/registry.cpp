#include "snowshed/methods/registry.hpp"

#include <algorithm>
#include <stdexcept>

#include "snowshed/methods/method_choice.hpp"

/// One line for each method, whose folder defines `const MethodDescriptor& descriptor()`.
// clang-format off
#define SNOWSHED_METHODS(add) \
  add(mpm)                    \
  add(slide)                  \
  add(grains)                 \
  add(mps)
// clang-format on

namespace snowshed {

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
  for (const MethodDescriptor* method : all_methods()) names.emplace_back(method->facts().name);
  return names;
}

RegisteredMethod::RegisteredMethod(const MethodDescriptor& method) {
  registered().push_back(&method);
}

RegisteredMethod::~RegisteredMethod() { registered().pop_back(); }

MethodChoice::MethodChoice() : MethodChoice(*all_methods().front()) {}

bool MethodChoice::is_default() const {
  return descriptor_->facts().name == all_methods().front()->facts().name;
}

const MethodDescriptor& MethodChoice::method_with(const std::type_info& settings) {
  for (const MethodDescriptor* method : all_methods())
    if (method->clone()->settings(settings)) return *method;
  throw std::logic_error("settings of no method");
}

std::size_t MethodDescriptor::count_particles(const LevelSet&, int) const {
  throw std::logic_error("the method does not fill solids itself");
}

void MethodDescriptor::fill(const LevelSet&, int, const StopRequest&, ParticleBatch&,
                            std::vector<std::string>&) const {
  throw std::logic_error("the method does not fill solids itself");
}

}  // namespace snowshed
