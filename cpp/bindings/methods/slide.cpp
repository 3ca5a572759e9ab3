// Properties of a simulation of a slide.
#include <pybind11/numpy.h>

#include "array_copies.hpp"
#include "method_bindings.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/methods/slide/cliffs.hpp"
#include "snowshed/methods/slide/solver.hpp"

namespace py = pybind11;

namespace snowshed::methods::slide {
namespace {

/// The solver as a slide; throws InputError if the scene's method is another.
const Solver& slide_of(const run::Simulation& sim) {
  const auto* slide = dynamic_cast<const Solver*>(&sim.method());
  if (!slide) throw InputError("/method", "is not \"slide\", and has no maps");
  return *slide;
}

py::dict slide_maps(const run::Simulation& sim) {
  const Solver& slide = slide_of(sim);
  const Terrain& t = slide.terrain();
  const auto map = [&](const std::vector<double>& values) {
    return map_of(values, t.rows(), t.columns());
  };
  std::vector<double> heights;
  for (int i = 0; i < t.rows() * t.columns(); ++i) heights.push_back(t.nodes()[i].height);
  py::dict d;
  d["terrain"] = map(heights);
  d["peak_thickness"] = map(slide.peaks().thickness);
  d["peak_speed"] = map(slide.peaks().speed);
  d["thickness"] = map(slide.flow().thickness_everywhere(t));
  d["speed"] = map(slide.flow().speed_everywhere(t));
  d["west"] = t.west();
  d["south"] = t.south();
  d["cell"] = t.cell();
  d["density"] = sim.scene().numerics.as<Settings>().density;
  if (const ChangingGround* ground = slide.ground()) {
    d["ground_change"] = map(ground->change());
    d["stopped_depth"] = map(ground->stopped);
  }
  return d;
}

py::dict slide_facts(const run::Simulation& sim) {
  const Solver& slide = slide_of(sim);
  const MassBalance& m = slide.mass_balance();
  py::dict d;
  d["bonds_made"] = slide.bonds_made();
  d["bonds"] = slide.bonds().size();
  d["released_kg"] = m.released;
  d["entrained_kg"] = m.entrained;
  d["left_terrain_kg"] = m.left_terrain;
  d["left_terrain"] = m.particles_left;
  d["secondary_kg"] = m.secondary;
  d["inflow_kg"] = m.inflow;
  d["detrained_kg"] = m.detrained;
  d["bonds_in_ground"] = slide.bonds_in_ground();
  if (const ChangingGround* ground = slide.ground()) {
    d["stopped_kg"] = m.stopped;
    d["ground_gained_m3"] = ground->volume();
  }
  py::list releases, dams;
  for (const LateReleaseFact& fact : slide.late_releases()) {
    py::dict release;
    release["name"] = fact.name;
    release["by_contact"] = fact.trigger == Trigger::contact;
    release["planned_s"] = fact.planned;
    release["time_s"] = fact.time < 0 ? py::object(py::none()) : py::object(py::float_(fact.time));
    release["mass_kg"] = fact.mass;
    releases.append(release);
  }
  for (const DamFact& fact : slide.dams()) {
    py::dict dam;
    dam["name"] = fact.name;
    dam["passed_kg"] = fact.passed;
    dams.append(dam);
  }
  d["late_releases"] = releases;
  d["dams"] = dams;
  return d;
}

/// The intact bonds: ids of their particles (n, 2), and rest lengths (n), m.
py::tuple slide_bonds(const run::Simulation& sim) {
  const Solver& slide = slide_of(sim);
  const Bonds& bonds = slide.bonds();
  const particles::FieldView ids = slide.field("id");
  py::array_t<std::int64_t> pairs({py::ssize_t(bonds.size()), py::ssize_t(2)});
  auto out = pairs.mutable_unchecked<2>();
  for (std::size_t b = 0; b < bonds.size(); ++b) {
    out(py::ssize_t(b), 0) = *ids.at<std::uint32_t>(bonds.first[b]);
    out(py::ssize_t(b), 1) = *ids.at<std::uint32_t>(bonds.second[b]);
  }
  return py::make_tuple(pairs, column<double>(bonds.rest_length));
}

std::string cliff(const py::array_t<double, py::array::c_style | py::array::forcecast>& heights,
                  double west, double south, double cell, double max_slope) {
  geometry::HeightField f;
  f.rows = int(heights.shape(0));
  f.columns = int(heights.shape(1));
  f.west = west;
  f.south = south;
  f.cell = cell;
  f.heights.assign(heights.data(), heights.data() + heights.size());
  return impossible_cliff(f, max_slope);
}

void bind_terrain(py::module_& m) {
  using namespace py::literals;
  m.def("impossible_cliff", &cliff, "heights"_a, "west"_a, "south"_a, "cell"_a, "max_slope"_a,
        "Describes the first step between neighbouring nodes that is impossible on ground; empty "
        "if there is none.");
}

const AddedBindings added{{&bind_terrain, [](SimulationClass& c) {
                             c.reads("slide_maps", &slide_maps);
                             c.reads("slide_facts", &slide_facts);
                             c.reads("slide_bonds", &slide_bonds);
                           }}};

}  // namespace
}  // namespace snowshed::methods::slide
