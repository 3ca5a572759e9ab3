// The methods a scene may choose: their names, their settings, and the parts of a scene they take.
//
// A further method is a further alternative of `MethodSettings`, a `method_info` of its own below,
// and a `describe` of its settings (describe.hpp).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "snowshed/methods/grains/settings.hpp"
#include "snowshed/methods/mpm/settings.hpp"
#include "snowshed/methods/mps/settings.hpp"
#include "snowshed/methods/slide/settings.hpp"

namespace snowshed {

/// The settings of the method that a scene has chosen; the first is the default.
using MethodSettings = std::variant<MpmSettings, SlideSettings, GrainsSettings, MpsSettings>;

/// The parts of a scene that a method can use.
struct TakenParts {
  bool panel = false;
  bool slab = false;
  bool ground = false;
  bool obstacles = false;
  bool bodies = false;
  bool domain = false;
  bool terrain = false;
  bool sample = false;  // with its loading and its cone
  bool snow = false;
  bool seeding = false;
};

struct MethodInfo {
  const char* name;  // as scenes give it
  const char* doc;
  TakenParts takes;
};

/// What is known of the method with these settings.
template <class Settings>
inline constexpr MethodInfo method_info{};

template <>
inline constexpr MethodInfo method_info<MpmSettings>{
    "mpm",
    "The material point method",
    {true, true, true, true, true, true, false, false, true, true}};

template <>
inline constexpr MethodInfo method_info<SlideSettings>{
    "slide",
    "The snow slide: depth-averaged particles with cohesive bonds on terrain",
    {false, false, false, false, false, false, true, false, false, false}};

template <>
inline constexpr MethodInfo method_info<GrainsSettings>{
    "grains",
    "Discrete elements of snow: rigid clumps of spheres with bonds that break",
    {false, false, false, false, false, false, false, true, false, false}};

template <>
inline constexpr MethodInfo method_info<MpsSettings>{
    "mps",
    "The moving particle semi-implicit method: snow as a Bingham and dilatant fluid",
    {true, true, true, true, true, true, false, false, false, false}};

/// The method that has been chosen.
inline const MethodInfo& info_of(const MethodSettings& settings) {
  return std::visit(
      [](const auto& own) -> const MethodInfo& { return method_info<std::decay_t<decltype(own)>>; },
      settings);
}

/// Calls `visit` with the default settings of every method in turn.
template <std::size_t I = 0, class F>
void for_each_method(const F& visit) {
  visit(std::variant_alternative_t<I, MethodSettings>{});
  if constexpr (I + 1 < std::variant_size_v<MethodSettings>) for_each_method<I + 1>(visit);
}

/// The default settings of all methods.
inline std::vector<MethodSettings> all_methods() {
  std::vector<MethodSettings> methods;
  for_each_method([&](const auto& settings) { methods.push_back(settings); });
  return methods;
}

/// Their names.
inline std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const auto& settings : all_methods()) names.push_back(info_of(settings).name);
  return names;
}

/// The size of the smallest thing the method resolves: its cell or particle, m; 0 where a file that
/// the scene names decides it.
inline double resolution(const MethodSettings& settings) {
  return std::visit([](const auto& own) { return own.resolution(); }, settings);
}

/// The threads that the method shall use; 0: all.
inline int wanted_threads(const MethodSettings& settings) {
  return std::visit([](const auto& own) { return own.threads; }, settings);
}

/// The mean rate (1/s) at which PIC damped over so many steps in so much time (s), see
/// MpmSettings::mean_damping_rate; nothing for methods without it.
inline std::optional<double> mean_damping_rate(const MethodSettings& settings, std::int64_t steps,
                                               double time) {
  const auto* mpm = std::get_if<MpmSettings>(&settings);
  return mpm ? mpm->mean_damping_rate(steps, time) : std::nullopt;
}

}  // namespace snowshed
