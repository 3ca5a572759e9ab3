#include "snowshed/methods/slide/release.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

#include "snowshed/core/errors.hpp"

namespace snowshed::methods::slide {
namespace {

/// Distance of rows in a triangular lattice of side 1.
const double row_distance = std::sqrt(3.0) / 2;

/// The side of a triangular lattice with this number of points per area.
double lattice_side(double area, double points) { return std::sqrt(area / points / row_distance); }

[[noreturn]] void refuse_area(const std::string& path, const std::string& name,
                              const std::string& why) {
  throw InputError(path, (name.empty() ? "" : "\"" + name + "\" ") + why);
}

void place_on_ground(const Terrain& terrain, double x, double y, double mass,
                     ParticleBatch& batch) {
  const geometry::CellPosition position = terrain.cell_position(x, y);
  batch.positions.push_back({x, y, terrain.height(position)});
  batch.masses.push_back(mass);
}

// --- as AvaFrame does it ------------------------------------------------------------------------

/// Calls visit(x, y) for the points of the lattice from the origin that lie in the square around a
/// node.
template <class Visit>
void for_lattice_points_near(int column, int row, double cell, double side, Visit visit) {
  const double height = side * row_distance;
  const double west = (column - 0.5) * cell, south = (row - 0.5) * cell;
  const double east = (column + 0.5) * cell, north = (row + 0.5) * cell;
  // Rounding toward zero leaves out points west or south of the origin.
  const auto first = [](double edge, double step) {
    const int i = int(edge / step);
    return i * step < edge ? i + 1 : i;
  };
  const int first_i = first(west, side);
  for (int j = first(south, height); j * height < north; ++j)
    for (double i = first_i - std::fmod(0.5 * j, 2.0); i * side < east; i += 1)
      if (i * side >= west && j * height >= south) visit(i * side, j * height);
}

/// The area of the nodes with snow on the map, over the area of their sloping ground.
double projected_share(const Terrain& terrain, const std::vector<double>& thickness) {
  double sloping = 0, projected = 0;
  for (std::size_t i = 0; i < thickness.size(); ++i)
    if (thickness[i] > 0) {
      sloping += terrain.nodes()[i].area;
      projected += terrain.cell() * terrain.cell();
    }
  return projected / sloping;
}

// --- improved -----------------------------------------------------------------------------------

double map_area(const geometry::Polygon& polygon) {
  double area = std::abs(geometry::twice_signed_area(polygon.outline));
  for (const geometry::Ring& hole : polygon.holes)
    area -= std::abs(geometry::twice_signed_area(hole));
  return area / 2;
}

/// The node in whose cell a point lies.
int node_of(double x, double first, double cell) {
  return int(std::floor((x - first) / cell + 0.5));
}

double thickness_at(const Area& area, double x, double y) {
  if (!area.map) return area.thickness;
  const geometry::HeightField& m = *area.map;
  const int column = std::clamp(node_of(x, m.west, m.cell), 0, m.columns - 1);
  const int row = std::clamp(node_of(y, m.south, m.cell), 0, m.rows - 1);
  return m.height(column, row);
}

/// The largest thickness (m) and the volume (m3) of the snow of a thickness raster.
struct SnowOfMap {
  double thickest = 0, volume = 0;
};

SnowOfMap snow_of(const geometry::HeightField& map) {
  SnowOfMap snow;
  for (const double h : map.heights)
    if (h > 0) {
      snow.thickest = std::max(snow.thickest, h);
      snow.volume += h * map.cell * map.cell;
    }
  return snow;
}

/// The mean thickness over an area, m. Throws InputError if the area's map does not cover all of
/// it.
double mean_thickness(const Area& area, const Terrain& terrain, const std::string& path) {
  if (!area.map) return area.thickness;
  const geometry::HeightField& m = *area.map;
  const geometry::RingBounds b = geometry::bounds_of(area.polygon.outline);
  const double half = m.cell / 2, rounding = 1e-6 * m.cell;
  const int west = node_of(b.low[0] + rounding, m.west, m.cell);
  const int east = node_of(b.high[0] - rounding, m.west, m.cell);
  const int south = node_of(b.low[1] + rounding, m.south, m.cell);
  const int north = node_of(b.high[1] - rounding, m.south, m.cell);
  if (west < 0 || south < 0 || east >= m.columns || north >= m.rows)
    refuse_area(path, area.name, "reaches beyond the thickness raster");
  double volume = 0, covered = 0;
  for (int row = south; row <= north; ++row)
    for (int column = west; column <= east; ++column) {
      const double x = m.west + column * m.cell, y = m.south + row * m.cell;
      const double part =
          geometry::area_within(area.polygon, {x - half, y - half}, {x + half, y + half});
      if (part <= rounding * m.cell) continue;
      volume += part * thickness_in_cell(area, terrain, column, row, path);
      covered += part;
    }
  return volume / covered;
}

geometry::Point2 centroid(const geometry::Ring& ring) {
  double x = 0, y = 0, sum = 0;
  const geometry::Point2& o = ring[0];
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    const geometry::Point2 &a = ring[i], &b = ring[i + 1];
    const double w = (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
    x += w * (a[0] + b[0] - 2 * o[0]) / 3;
    y += w * (a[1] + b[1] - 2 * o[1]) / 3;
    sum += w;
  }
  return {o[0] + x / sum, o[1] + y / sum};
}

/// Properties of the ground under an area, from points half a cell apart.
struct Ground {
  double stretch = 0;          // sloping over projected area, mean
  double east = 1, north = 0;  // unit vector of the mean fall line
  std::size_t points = 0;
};

Ground ground_under(const Terrain& terrain, const geometry::Polygon& polygon) {
  Ground g;
  double fall[2] = {0, 0};
  const geometry::RingBounds b = geometry::bounds_of(polygon.outline);
  const double step = terrain.cell() / 2;
  const auto look_at = [&](double x, double y) {
    const geometry::CellPosition p = terrain.cell_position(x, y);
    if (!p.inside()) return;
    const Vec3 n = terrain.normal(p);
    g.stretch += 1 / n.z();
    fall[0] += n.x();
    fall[1] += n.y();
    ++g.points;
  };
  for (double y = b.low[1] + step / 2; y < b.high[1]; y += step)
    for (double x = b.low[0] + step / 2; x < b.high[0]; x += step)
      if (geometry::contains(polygon, {x, y})) look_at(x, y);
  // Areas narrower than the distance of the points may contain none.
  if (g.points == 0)
    for (const geometry::Point2& corner : polygon.outline) look_at(corner[0], corner[1]);
  if (g.points == 0) return Ground{1.0, 1.0, 0.0, 0};
  g.stretch /= double(g.points);
  const double length = std::hypot(fall[0], fall[1]);
  if (length > 1e-6 * double(g.points)) {
    g.east = fall[0] / length;
    g.north = fall[1] / length;
  }
  return g;
}

/// Calls visit(x, y) for the points of a lattice within a ring's bounds, row by row. The lattice
/// begins at `origin`, and its rows run along the fall line.
template <class Visit>
void for_lattice_points(const geometry::Ring& ring, const geometry::Point2& origin,
                        const Ground& along, double side, Visit visit) {
  double reach = 0;
  for (const geometry::Point2& p : ring)
    reach = std::max(reach, std::hypot(p[0] - origin[0], p[1] - origin[1]));
  const double height = side * row_distance;
  const int rows = int(std::ceil(reach / height)), columns = int(std::ceil(reach / side)) + 1;
  for (int j = -rows; j <= rows; ++j)
    for (int i = -columns; i <= columns; ++i) {
      const double u = (i + (j % 2 != 0 ? 0.5 : 0.0)) * side, v = j * height;
      visit(origin[0] + u * along.east - v * along.north,
            origin[1] + u * along.north + v * along.east);
    }
}

}  // namespace

ParticleBatch seed_nodes(const Settings& s, const Terrain& terrain, const std::vector<Area>& areas,
                         const std::vector<double>& thickness, const std::string& path,
                         const StopRequest& stop) {
  StopCheck give_up(stop);
  const double cell = terrain.cell();
  const double share = projected_share(terrain, thickness);
  // AvaFrame fills the cells around the nodes of a raster, and keeps to polygons otherwise.
  const bool fills_cells = !areas.empty() && areas.front().map;
  std::vector<geometry::Ring> outlines;
  for (const Area& area : areas)
    outlines.push_back(widened_as_avaframe(area.polygon.outline, 1e-3));

  ParticleBatch batch;
  for (int row = 0; row < terrain.rows(); ++row)
    for (int column = 0; column < terrain.columns(); ++column) {
      const double h = thickness[terrain.index(column, row)];
      if (h == 0) continue;
      const double wanted = h * (cell * cell / share) * s.density / nominal_particle_mass(s, cell);
      const double points = std::floor(wanted);
      if (points < 1)
        refuse_area(path, areas[0].name,
                    "is too thin: " + std::to_string(h) + " m at (" +
                        std::to_string(terrain.west() + column * cell) + ", " +
                        std::to_string(terrain.south() + row * cell) + ") make no particle of " +
                        std::to_string(nominal_particle_mass(s, cell)) +
                        " kg; allowed in compatible mode: at least " + std::to_string(h / wanted) +
                        " m");
      const double mass = terrain.node(column, row).area * h * s.density / points;
      for_lattice_points_near(
          column, row, cell, lattice_side(cell * cell, points), [&](double x, double y) {
            give_up();
            const bool is_inside =
                fills_cells ||
                std::any_of(outlines.begin(), outlines.end(), [&](const geometry::Ring& ring) {
                  return geometry::contains(ring, {x, y});
                });
            if (is_inside) place_on_ground(terrain, x, y, mass, batch);
          });
    }
  if (batch.positions.empty()) refuse_area(path, areas[0].name, "holds no particle");
  return batch;
}

ParticleBatch seed_polygon(const Settings& s, const Terrain& terrain, const Area& area,
                           const std::string& path, const StopRequest& stop) {
  StopCheck give_up(stop);
  const double cell = terrain.cell();
  const Ground ground = ground_under(terrain, area.polygon);
  const double thickness = mean_thickness(area, terrain, path);
  const double mass = thickness * ground.stretch * map_area(area.polygon) * s.density;
  const double cell_mass = thickness * ground.stretch * cell * cell * s.density;
  const double points = std::max(1.0, std::floor(cell_mass / nominal_particle_mass(s, cell)));
  ParticleBatch batch;
  double seeded = 0;
  for_lattice_points(area.polygon.outline, centroid(area.polygon.outline), ground,
                     lattice_side(cell * cell, points), [&](double x, double y) {
                       give_up();
                       const geometry::CellPosition p = terrain.cell_position(x, y);
                       if (!p.inside() || !geometry::contains(area.polygon, {x, y})) return;
                       const double share = thickness_at(area, x, y) / terrain.normal(p).z();
                       place_on_ground(terrain, x, y, share, batch);
                       seeded += share;
                     });
  if (batch.positions.empty())
    refuse_area(path, area.name, "holds no particle: it is smaller than the area of one particle");
  for (double& share : batch.masses) share *= mass / seeded;
  return batch;
}

std::vector<NamedArea> named_areas(const std::vector<Area>& areas, const std::string& list) {
  std::vector<NamedArea> named;
  for (std::size_t i = 0; i < areas.size(); ++i)
    named.push_back({&areas[i], "/terrain/" + list + "/" + std::to_string(i)});
  return named;
}

void refuse_overlap(const Terrain& terrain, const std::vector<NamedArea>& areas, std::size_t last,
                    const ParticleBatch& batch) {
  const double margin = 1e-6 * terrain.cell();
  const auto well_within = [&](const geometry::Polygon& polygon, double x, double y) {
    return geometry::contains(polygon, {x - margin, y}) &&
           geometry::contains(polygon, {x + margin, y}) &&
           geometry::contains(polygon, {x, y - margin}) &&
           geometry::contains(polygon, {x, y + margin});
  };
  const NamedArea& own = areas[last];
  for (std::size_t other = 0; other < last; ++other) {
    const geometry::RingBounds b = geometry::bounds_of(areas[other].area->polygon.outline);
    for (const Vec3& p : batch.positions) {
      if (!b.contain({p.x(), p.y()}) || !well_within(areas[other].area->polygon, p.x(), p.y()) ||
          !well_within(own.area->polygon, p.x(), p.y()))
        continue;
      refuse_area(own.path, own.area->name,
                  "overlaps " + areas[other].path + " at (" +
                      std::to_string(terrain.west() + p.x()) + ", " +
                      std::to_string(terrain.south() + p.y()) +
                      "); cut one of them, or make them one area");
    }
  }
}

double nominal_particle_mass(const Settings& s, double cell) {
  return s.density * cell * cell * s.layer_thickness;
}

void check_effort(const Settings& s, const Terrain& terrain, const std::vector<Area>& areas) {
  constexpr double max_particles = 2e6;    // they take a gigabyte and some seconds
  constexpr double max_comparisons = 3e9;  // comparisons of a particle with a corner: some seconds
  const double cell = terrain.cell();
  double particles = 0, corners = 0;
  const geometry::HeightField* map = nullptr;  // all areas share one
  SnowOfMap snow;
  for (const Area& area : areas) {
    const double on_map = map_area(area.polygon);
    double volume = on_map * area.thickness;
    if (area.map) {
      if (area.map.get() != map) snow = snow_of(*area.map);
      map = area.map.get();
      volume = std::min(on_map * snow.thickest, snow.volume);
    }
    particles += std::max(on_map, volume / s.layer_thickness) / (cell * cell);
    corners += double(area.polygon.outline.size());
    for (const geometry::Ring& hole : area.polygon.holes) corners += double(hole.size());
  }
  std::ostringstream text;
  if (particles > max_particles) {
    text << s.layer_thickness << " m makes " << particles << " particles; at most " << max_particles
         << " are allowed: give thicker layers";
    throw InputError("/numerics/layer_thickness", text.str());
  }
  if (particles * corners > max_comparisons) {
    text << corners << " corners and " << particles << " particles; their product may be at most "
         << max_comparisons << ": simplify the outlines";
    throw InputError("/terrain/release", text.str());
  }
}

double lattice_spacing(const ParticleBatch& batch) {
  const std::size_t n = batch.positions.size();
  const std::size_t samples = std::min<std::size_t>(n, 64);
  std::vector<double> nearest;
  for (std::size_t s = 0; s < samples; ++s) {
    const std::size_t i = s * n / samples;
    double min_square = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < n; ++j)
      if (j != i)
        min_square =
            std::min(min_square, (batch.positions[j] - batch.positions[i]).head<2>().squaredNorm());
    nearest.push_back(std::sqrt(min_square));
  }
  if (n < 2) return 0;
  std::nth_element(nearest.begin(), nearest.begin() + std::ptrdiff_t(samples / 2), nearest.end());
  return nearest[samples / 2];
}

std::vector<ParticleBatch> seed_release(const Settings& settings, const Terrain& terrain,
                                        const std::vector<Area>& areas, const StopRequest& stop) {
  if (areas.empty()) throw InputError("/terrain/release", "names no area");
  std::vector<ParticleBatch> batches;
  const std::vector<NamedArea> all = named_areas(areas, "release");
  if (settings.mode == Mode::compatible) {
    const std::vector<double> thickness = released_at_nodes(areas, terrain, settings.mode);
    batches = {seed_nodes(settings, terrain, areas, thickness, all[0].path, stop)};
    for (std::size_t i = 1; i < areas.size(); ++i) refuse_overlap(terrain, all, i, batches.front());
    return batches;
  }
  for (std::size_t i = 0; i < areas.size(); ++i) {
    batches.push_back(seed_polygon(settings, terrain, areas[i], all[i].path, stop));
    refuse_overlap(terrain, all, i, batches.back());
  }
  return batches;
}

}  // namespace snowshed::methods::slide
