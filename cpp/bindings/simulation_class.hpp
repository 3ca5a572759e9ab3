// The class Simulation in Python, to which the files of bindings add its methods.
#pragma once

#include <utility>

#include "field_arrays.hpp"
#include "simulation_handle.hpp"

namespace snowshed {

/// The class in Python; every call goes through the guard.
class SimulationClass {
 public:
  using Handle = SimulationHandle;

  explicit SimulationClass(pybind11::module_& m) : class_(m, "Simulation") {}

  pybind11::class_<Handle>& operator*() { return class_; }

  /// Adds a method that only reads: f(simulation, arguments...).
  template <class F, class... Extra>
  void reads(const char* name, F f, const Extra&... extra) {
    class_.def(name, guarded(name, Handle::Access::read, +f), extra...);
  }
  template <class F, class... Extra>
  void changes(const char* name, F f, const Extra&... extra) {
    class_.def(name, guarded(name, Handle::Access::change, +f), extra...);
  }
  template <class F>
  void property(const char* name, F f) {
    class_.def_property_readonly(name, guarded(name, Handle::Access::read, +f));
  }
  /// Adds a method that returns a field, ordered by id.
  void column(const char* name, const char* field) {
    class_.def(name, [name, field](Handle& handle) {
      return handle.use(name, Handle::Access::read, [field](const auto& simulation) {
        return array_by_id(simulation->method(), field);
      });
    });
  }

 private:
  template <class Result, class Sim, class... Arguments>
  static auto guarded(const char* name, Handle::Access access, Result (*f)(Sim&, Arguments...)) {
    return [name, access, f](Handle& handle, Arguments... arguments) -> Result {
      return handle.use(name, access, [&](const auto& simulation) -> Result {
        return f(*simulation, std::forward<Arguments>(arguments)...);
      });
    };
  }

  pybind11::class_<Handle> class_;
};

}  // namespace snowshed
