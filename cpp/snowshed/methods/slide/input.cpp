#include "snowshed/methods/slide/input.hpp"

#include <string>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/message_format.hpp"
#include "snowshed/geometry/readers/ascii_grid.hpp"
#include "snowshed/io/fingerprint.hpp"
#include "snowshed/methods/slide/cliffs.hpp"

namespace snowshed::methods::slide {
namespace {

geometry::Ring relative_to_field(const geometry::Ring& ring, const geometry::HeightField& field) {
  geometry::Ring local;
  for (const geometry::Point2& p : ring) local.push_back({p[0] - field.west, p[1] - field.south});
  return local;
}

template <class Spec>
Area area_of(const Spec& spec, const geometry::HeightField& field) {
  Area area;
  area.name = spec.name;
  area.polygon.outline = relative_to_field(spec.outline, field);
  for (const HoleSpec& hole : spec.holes)
    area.polygon.holes.push_back(relative_to_field(hole.outline, field));
  return area;
}

std::vector<Area> areas_of(const std::vector<AreaSpec>& specs, const geometry::HeightField& field) {
  std::vector<Area> areas;
  for (const AreaSpec& spec : specs) {
    areas.push_back(area_of(spec, field));
    areas.back().thickness = spec.thickness;
  }
  return areas;
}

/// Throws InputError if `cliff` describes an impossible cliff.
void check_cliff(const std::string& where, const std::string& cliff, double max_slope) {
  if (cliff.empty()) return;
  throw InputError(where, "elevations of " + cliff + "; are some missing? At most " +
                              show(max_slope) + " degrees are accepted (terrain.max_slope)");
}

geometry::HeightField read_terrain(const TerrainSpec& terrain, const Settings& settings,
                                   const std::filesystem::path& base_dir) {
  geometry::HeightField field = geometry::read_ascii_grid(base_dir / terrain.file);
  check_cliff("/terrain/file", impossible_cliff(field, terrain.max_slope), terrain.max_slope);
  if (settings.mode == Mode::compatible && terrain.single_precision)
    for (double& height : field.heights) height = double(float(height));
  const double cell = settings.cell > 0 ? settings.cell : field.cell;
  try {
    return geometry::resampled(field, cell);
  } catch (const InputError& error) {
    throw InputError("/numerics/cell", error.what());
  }
}

/// The areas, in coordinates from the south-west node of the grid.
Areas read_areas(const TerrainSpec& terrain, const geometry::HeightField& field,
                 const std::filesystem::path& base_dir) {
  Areas areas;
  areas.release = areas_of(terrain.release, field);
  if (!terrain.thickness_file.empty()) {
    geometry::HeightField map = geometry::read_ascii_grid(base_dir / terrain.thickness_file);
    map.west -= field.west;
    map.south -= field.south;
    const auto shared = std::make_shared<const geometry::HeightField>(std::move(map));
    for (Area& area : areas.release) {
      area.map = shared;
      area.max_thickness = terrain.max_thickness;
    }
  }
  for (std::size_t i = 0; i < areas.release.size(); ++i)
    check_cliff("/terrain/release/" + std::to_string(i),
                cliff_under(areas.release[i].polygon, field, terrain.max_slope), terrain.max_slope);
  areas.release_speed = terrain.release_speed;
  areas.secondary_release = areas_of(terrain.secondary_release, field);
  for (const InflowSpec& spec : terrain.inflows) {
    areas.inflows.push_back({area_of(spec, field), spec.bonds, {}});
    for (const PulseSpec& pulse : spec.hydrograph)
      areas.inflows.back().pulses.push_back({pulse.time, pulse.thickness, pulse.speed});
  }
  areas.entrainment = areas_of(terrain.entrainment, field);
  for (const ResistanceSpec& spec : terrain.resistance)
    areas.resistance.push_back(area_of(spec, field));
  for (const DamSpec& spec : terrain.dams) {
    areas.dams.push_back({spec.name, {}, spec.slope, spec.restitution});
    for (const DamCornerSpec& c : spec.corners)
      areas.dams.back().corners.push_back({c.x - field.west, c.y - field.south, c.height});
  }
  return areas;
}

void add(const geometry::HeightField& f, io::Fingerprint& print) {
  const double place[] = {f.cell, f.west, f.south, double(f.columns), double(f.rows)};
  print.add(place, std::size(place));
  print.add(f.heights.data(), f.heights.size());
}

}  // namespace

Input::Input(const TerrainSpec& terrain, const Settings& settings,
             const std::filesystem::path& base_dir)
    : file_(terrain.file),
      thickness_file_(terrain.thickness_file),
      terrain_(read_terrain(terrain, settings, base_dir)),
      areas_(read_areas(terrain, terrain_, base_dir)) {}

std::vector<FileFingerprint> Input::files() const {
  io::Fingerprint terrain, thickness;
  add(terrain_, terrain);
  if (!areas_.release.empty() && areas_.release.front().map)
    add(*areas_.release.front().map, thickness);
  return {{file_, terrain.value()}, {thickness_file_, thickness.value()}};
}

}  // namespace snowshed::methods::slide
