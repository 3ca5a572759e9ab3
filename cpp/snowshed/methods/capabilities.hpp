// Capabilities that only some methods have. Such a method derives from the class of the capability,
// too, and callers ask for it with `capability`.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "snowshed/core/stop_request.hpp"
#include "snowshed/methods/energy_balance.hpp"
#include "snowshed/methods/method.hpp"

namespace snowshed::methods {

/// The method's capability, or null if it does not have it.
template <class Capability, class SomeMethod>
auto* capability(SomeMethod& method) {
  using Kind = std::conditional_t<std::is_const_v<SomeMethod>, const Capability, Capability>;
  return dynamic_cast<Kind*>(&method);
}

/// A method whose snow compacts between events.
class Settles {
 public:
  /// Lowers each particle, ordered by id, by a height (m) and adds to its volumetric plastic
  /// strain, if its law has one. Elastic strains and velocities stay. The energy balance counts the
  /// change as added. Throws as `Method::add_velocity`, and SimulationError if a particle would lie
  /// outside the space that the method can address.
  virtual void settle(const std::vector<double>& drops,
                      const std::vector<double>& plastic_changes) = 0;

 protected:
  ~Settles() = default;
};

/// A method that makes its particles itself, from parts of a scene that only this method takes.
class SeedsItself {
 public:
  /// The particles of an event, to be added. Throws InputError, and Stopped on request.
  virtual std::vector<ParticleBatch> seed(const StopRequest& stop) const = 0;
  std::vector<ParticleBatch> seed() const { return seed({}); }

 protected:
  ~SeedsItself() = default;
};

/// A method that can keep an energy balance.
class KeepsEnergy {
 public:
  /// The energies of the balance, named as in tables. All are zero unless the method was made to
  /// keep them.
  virtual NamedEnergies energies() const = 0;

 protected:
  ~KeepsEnergy() = default;
};

/// A method whose snow drops out of the steps while it is at rest.
class Sleeps {
 public:
  /// Number of particle updates that were saved by sleep.
  virtual std::int64_t slept_updates() const = 0;

 protected:
  ~Sleeps() = default;
};

inline std::int64_t slept_updates(const Method& method) {
  const auto* sleeping = capability<Sleeps>(method);
  return sleeping ? sleeping->slept_updates() : 0;
}

/// A table that grows with the steps.
class Curve {
 public:
  virtual ~Curve() = default;

  /// Adds a row if one is due. Callers call it at the beginning and after each step.
  virtual void record(const Method&) = 0;
  virtual const std::vector<std::string>& columns() const = 0;
  virtual const std::vector<double>& values() const = 0;  ///< row by row
  virtual void save(io::BinaryWriter&) const = 0;
  /// Throws InputError if the rows are not those of such a curve.
  virtual void load(const io::BinaryReader&) = 0;
};

/// A method that is measured after each step. If it keeps energies, its curve has them, too.
class HasCurve {
 public:
  virtual std::unique_ptr<Curve> empty_curve() const = 0;

 protected:
  ~HasCurve() = default;
};

/// A method that adds a section to run.json.
class ReportsRun {
 public:
  struct Section {
    std::string name;
    std::vector<std::pair<std::string, std::variant<std::int64_t, double>>> facts;
  };
  virtual Section run_section() const = 0;

 protected:
  ~ReportsRun() = default;
};

}  // namespace snowshed::methods
