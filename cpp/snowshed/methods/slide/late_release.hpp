// Snow that is released during a slide: secondary releases, and the pulses of inflows.
#pragma once

#include <string>
#include <vector>

#include "snowshed/methods/method.hpp"
#include "snowshed/methods/slide/areas.hpp"
#include "snowshed/methods/slide/settings.hpp"

namespace snowshed::methods::slide {

struct Model;
struct State;
struct Workspace;

/// Cause of a release during a slide.
enum class Trigger { time, contact };

/// The snow of one release, prepared before the slide begins.
struct LateRelease {
  Trigger trigger;
  double time;  // s; unused for a release by contact
  Area area;
  std::vector<std::size_t> nodes;  // compatible mode: where flowing snow releases the area
  ParticleBatch snow;
  bool bonds;
};

/// States of a release that has not happened; afterwards its state is its time, s.
inline constexpr double waiting = -1, due = -2;

/// A release during a slide, for reports.
struct LateReleaseFact {
  std::string name;
  Trigger trigger;
  double planned, time;  // s; `planned` is 0 for a release by contact, `time` is `waiting` if none
  double mass;           // kg
};

/// Prepares all releases of the areas. Throws InputError if an area holds no particle, overlaps
/// another, or, in the compatible mode, has a time that is no multiple of the time step.
std::vector<LateRelease> prepare_late_releases(const Settings&, const Terrain&, const Areas&);

/// The areas of all releases during the slide, each as often as snow enters it.
std::vector<Area> late_areas(const Areas&);

/// Marks the releases by contact whose areas contain snow.
void mark_contacts(const Model&, State&, const Workspace&);

/// The states of the releases with those marked whose time has come in the step that begins now.
std::vector<double> with_timed_marked(const Model&, const State&);

/// Whether a release with this trigger is due in the given states of the releases.
bool any_due(const Model&, const std::vector<double>& states, Trigger);

/// Whether a release waits for its time.
bool awaits_time(const Model&, const State&);

/// Compatible mode: throws SimulationError if snow lies where a pulse is due, as AvaFrame does.
void refuse_snow_in_inflows(const Model&, const State&);

/// The number of particles of the releases that are due.
std::size_t due_particles(const Model&, const State&);

}  // namespace snowshed::methods::slide
