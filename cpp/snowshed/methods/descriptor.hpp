// Descriptors: all that the program needs to know about a method. A method has one such class, and
// one line in registry.cpp. Scenes, runs and programs ask descriptors, and name no method.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "snowshed/core/stop_request.hpp"
#include "snowshed/geometry/thickened.hpp"
#include "snowshed/methods/cost.hpp"
#include "snowshed/methods/method.hpp"
#include "snowshed/methods/quantities.hpp"
#include "snowshed/methods/scene_view.hpp"
#include "snowshed/methods/settings_visitor.hpp"
#include "snowshed/methods/surroundings.hpp"
#include "snowshed/methods/unused_settings.hpp"

namespace snowshed::methods {

/// The parts of a scene that only some methods take. `sample` includes its loading and its cone.
enum class Part { panel, slab, ground, obstacles, bodies, domain, terrain, sample, snow, seeding };

class Parts {
 public:
  Parts(std::initializer_list<Part> parts = {}) {
    for (const Part part : parts) bits_ |= bit(part);
  }
  bool has(Part part) const { return (bits_ & bit(part)) != 0; }

 private:
  static unsigned bit(Part part) { return 1u << unsigned(part); }

  unsigned bits_ = 0;
};

/// The constant properties of a method.
struct MethodInfo {
  const char* name;                     // as scenes give it
  const char* doc;                      // in the schema
  Parts takes;                          // parts of a scene that it takes
  const char* length_unit = "cells";    // plural name of `resolution` as a unit, for messages
  std::vector<std::string> energies{};  // names with units, as in tables; the last is the residual
  // Quantities of its particles beside those that all methods share.
  std::vector<Quantity> quantities{};
  bool records_forces = false;  // whether it can record the forces on obstacles
  bool takes_laws = false;      // whether it calls laws of the user
  bool holds_slipping = false;  // whether snow cannot leave surfaces with the condition slip
};

/// A method together with its settings. The registry holds one of each method with the default
/// settings; a scene holds a copy of one (method_choice.hpp).
class MethodDescriptor {
 public:
  virtual ~MethodDescriptor() = default;

  virtual const MethodInfo& info() const = 0;
  virtual std::unique_ptr<MethodDescriptor> clone() const = 0;

  // --- settings --------------------------------------------------------------------------------

  /// Shows a visitor each setting in turn.
  virtual void describe(SettingsVisitor&) = 0;
  /// The smallest length that the method resolves, m; 0 if a file determines it.
  virtual double resolution() const = 0;
  /// The threads that the method shall use; 0: all.
  virtual int threads() const = 0;
  /// Takes over from other settings with what the machine computes: threads and device.
  virtual void adopt_machine(const MethodDescriptor& other) = 0;
  /// Multiplies the cell size (or spacing) by `factor`, if it is a setting, for quick coarse copies
  /// of a scene.
  virtual void coarsen(double /*factor*/) {}
  /// The setting from which the length of a step follows, by its key.
  virtual std::string step_setting() const = 0;
  /// The floating-point type of the particles.
  virtual const char* scalar() const { return "double"; }
  /// The mean rate of numerical damping over `steps` steps in `time` (s), 1/s. Methods without
  /// damping return nothing.
  virtual std::optional<double> damping_rate(std::int64_t /*steps*/, double /*time*/) const {
    return std::nullopt;
  }

  // --- a scene ---------------------------------------------------------------------------------

  /// Throws InputError if settings or parts of the scene contradict each other. Callers have
  /// checked the range of each value, and that the method takes all parts of the scene.
  virtual void validate(const SceneView&) const {}
  /// Settings that other settings or parts of the scene leave without effect.
  virtual std::vector<UnusedSettings> unused_settings(const SceneView&) const { return {}; }
  /// Returns the solid with thin parts thickened to the method's resolution.
  virtual geometry::ThickSolid thickened(const geometry::Shape& shape, int /*dimension*/) const {
    return {shape, std::nullopt};
  }
  /// Reads the files that only this method takes; relative names are looked for in `base_dir`.
  /// Throws InputError.
  virtual std::shared_ptr<const MethodInput> read(const SceneView&,
                                                  const std::filesystem::path& /*base_dir*/) const {
    return nullptr;
  }
  /// Chooses the device for a scene of this cost, and opens it. Throws InputError if the settings
  /// ask for one that is missing or cannot compute the scene.
  virtual DeviceChoice choose_device(const SceneView&, const Surroundings&,
                                     const CostEstimate&) const {
    return {};
  }
  /// Builds the method, without snow, on the device of the surroundings.
  virtual std::unique_ptr<Method> build(const SceneView&, const Surroundings&) const = 0;

  // --- filling of bodies, for methods with their own seeding -------------------------------------

  /// The number of particles that `fill` will place. Throws as `fill`.
  virtual std::size_t count_particles(const geometry::LevelSet&, int dimension) const;
  /// Fills a solid with particles; adds a note if they do not resolve the solid. Throws InputError
  /// if the solid cannot be filled, and Stopped on request.
  virtual void fill(const geometry::LevelSet&, int dimension, const StopRequest&, ParticleBatch&,
                    std::vector<std::string>& notes) const;

  // --- cost ------------------------------------------------------------------------------------

  /// The cost of a scene from the number of new particles in each event, before anything is built.
  /// For methods that take bodies.
  virtual CostEstimate cost_of_bodies(const SceneView&, const SceneOutline&,
                                      std::vector<double> particles) const;
  /// The cost of a scene whose method was built without snow. For all other methods. Throws
  /// InputError if the scene cannot be run.
  virtual CostEstimate cost_of_method(const SceneView&, const Surroundings&, const Method&) const;
  /// Features that the method has, and whether the scene uses them.
  virtual std::vector<Feature> features(const SceneView&, const SceneOutline&) const = 0;
};

namespace detail {

/// Calls the `describe` of the settings' namespace.
template <class Settings>
void describe_settings(SettingsVisitor& visitor, Settings& settings) {
  describe(visitor, settings);
}

}  // namespace detail

/// A descriptor with settings of this type. Scenes find a method by the type of its settings.
template <class Settings>
class WithSettings : public MethodDescriptor {
 public:
  Settings& settings() { return settings_; }
  const Settings& settings() const { return settings_; }

 protected:
  Settings settings_;
};

/// Base of all descriptors; a method's descriptor, `Self`, derives from it.
template <class Self, class Settings>
class DescriptorBase : public WithSettings<Settings> {
 public:
  std::unique_ptr<MethodDescriptor> clone() const override {
    return std::make_unique<Self>(static_cast<const Self&>(*this));
  }
  void describe(SettingsVisitor& visitor) override {
    detail::describe_settings(visitor, settings_);
  }
  double resolution() const override { return settings_.resolution(); }
  int threads() const override { return settings_.threads; }
  void adopt_machine(const MethodDescriptor& other) override {
    settings_.threads = other.threads();
  }

 protected:
  using WithSettings<Settings>::settings_;
};

}  // namespace snowshed::methods
