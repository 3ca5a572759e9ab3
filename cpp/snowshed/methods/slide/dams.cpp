#include "snowshed/methods/slide/dams.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "snowshed/core/angles.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/methods/slide/state.hpp"

namespace snowshed::methods::slide {
namespace {

Vec3 on_ground(const Terrain& terrain, double x, double y, const std::string& path) {
  const geometry::CellPosition position = terrain.cell_position(x, y);
  if (!position.inside() || std::isnan(terrain.height(position)))
    throw InputError(path, "the dam reaches beyond the terrain or into a hole of it");
  return {x, y, terrain.height(position)};
}

/// The tangents of the sections of a line.
std::vector<Vec3> tangents_of(const std::vector<Vec3>& line) {
  std::vector<Vec3> tangents;
  for (std::size_t i = 0; i + 1 < line.size(); ++i)
    tangents.push_back((line[i + 1] - line[i]).normalized());
  return tangents;
}

/// The foot, on the left of the line, of a face with a slope, at one corner.
geometry::Point2 foot_at(const Terrain& terrain, const Vec3& corner, const Vec3& tangent,
                         double height, double slope) {
  const Vec3 n = terrain.normal(terrain.cell_position(corner.x(), corner.y()));
  const double left_x = -tangent.y(), left_y = tangent.x();
  const double fall = -std::tan(radians(slope)) * std::hypot(left_x, left_y);
  const double reach = -height * n.z() / (left_x * n.x() + left_y * n.y() + fall * n.z());
  return {corner.x() + reach * left_x, corner.y() + reach * left_y};
}

DamFoot foot_of(const Dam& dam, const Terrain& terrain, bool compatible, const std::string& path) {
  std::vector<Vec3> line;
  for (const Dam::Corner& c : dam.corners) line.push_back(on_ground(terrain, c.x, c.y, path));
  DamFoot foot{{}, tangents_of(line), dam.restitution};
  for (std::size_t i = 0; i < line.size(); ++i) {
    Vec3 along = Vec3::Zero();
    if (i > 0) along += foot.tangents[i - 1];
    if (i + 1 < line.size()) along += foot.tangents[i];
    const double height = dam.corners[i].height;
    geometry::Point2 at{line[i].x(), line[i].y()};
    if (compatible) at = foot_at(terrain, line[i], along.normalized(), height, dam.slope);
    on_ground(terrain, at[0], at[1], path);
    foot.points.push_back({at[0], at[1], line[i] + Vec3(0, 0, height), height});
  }
  return foot;
}

}  // namespace

DamFeet::DamFeet(const std::vector<Dam>& dams, const Terrain& terrain, bool compatible) {
  if (dams.empty()) return;
  near_.assign(std::size_t(terrain.columns()) * std::size_t(terrain.rows()), 0);
  for (std::size_t i = 0; i < dams.size(); ++i) {
    feet_.push_back(foot_of(dams[i], terrain, compatible, "/terrain/dams/" + std::to_string(i)));
    mark_near(feet_.back(), terrain);
  }
}

std::size_t DamFeet::sections() const {
  std::size_t count = 0;
  for (const DamFoot& foot : feet_) count += foot.tangents.size();
  return count;
}

void DamFeet::mark_near(const DamFoot& foot, const Terrain& terrain) {
  const double c = terrain.cell();
  for (std::size_t i = 0; i + 1 < foot.points.size(); ++i) {
    const DamFoot::Point &a = foot.points[i], &b = foot.points[i + 1];
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    const int steps = int(std::ceil(2 * length / c)) + 1;  // half a cell apart
    for (int k = 0; k <= steps; ++k) {
      const double share = double(k) / steps;
      const int column = int((a.x + share * (b.x - a.x)) / c);
      const int row = int((a.y + share * (b.y - a.y)) / c);
      for (int j = std::max(0, row - 1); j <= std::min(terrain.rows() - 1, row + 1); ++j)
        for (int m = std::max(0, column - 1); m <= std::min(terrain.columns() - 1, column + 1); ++m)
          near_[terrain.index(m, j)] = 1;
    }
  }
}

namespace {

/// Whether a path crosses a section, touching included.
bool crosses(const Vec3& from, const Vec3& to, const DamFoot::Point& a, const DamFoot::Point& b,
             DamCrossing& crossing) {
  const double ex = b.x - a.x, ey = b.y - a.y;
  const double dx = to.x() - from.x(), dy = to.y() - from.y();
  const double ox = from.x() - a.x, oy = from.y() - a.y;
  const double det = ex * dy - ey * dx;
  if (det == 0) return false;
  crossing.along_section = (ox * dy - oy * dx) / det;
  crossing.along_path = (ox * ey - oy * ex) / det;
  return crossing.along_section >= 0 && crossing.along_section <= 1 && crossing.along_path >= 0 &&
         crossing.along_path <= 1;
}

/// Calls visit(crossing) for all crossings of a path, in the order of dams and sections, until it
/// returns true.
template <class Visit>
void for_each_crossing(const DamFeet& feet, const Vec3& from, const Vec3& to, Visit visit) {
  DamCrossing crossing;
  for (crossing.dam = 0; crossing.dam < feet.size(); ++crossing.dam) {
    const std::vector<DamFoot::Point>& points = feet[crossing.dam].points;
    for (crossing.section = 0; crossing.section + 1 < points.size(); ++crossing.section)
      if (crosses(from, to, points[crossing.section], points[crossing.section + 1], crossing) &&
          visit(crossing))
        return;
  }
}

/// A particle that meets dams.
struct Passage {
  Vec3 from, to, velocity;                        // m and m/s: start and end of the step
  Vec3 normal;                                    // the ground at the end of the step
  double thickness;                               // m, of the snow at the particle before the step
  double kinetic = 0.5 * velocity.squaredNorm();  // J/kg, that counts for the stop of the slide
  bool changed = false;
};

// --- improved -----------------------------------------------------------------------------------

/// The first crossing of a path that is not the last one passed.
bool first_crossing(const DamFeet& feet, const Vec3& from, const Vec3& to,
                    const std::vector<DamCrossing>& passed, DamCrossing& first) {
  double nearest = std::numeric_limits<double>::infinity();
  for_each_crossing(feet, from, to, [&](const DamCrossing& c) {
    const bool is_passed = std::any_of(passed.begin(), passed.end(), [&](const DamCrossing& p) {
      return p.dam == c.dam && p.section == c.section;
    });
    if (!is_passed && c.along_path < nearest) {
      nearest = c.along_path;
      first = c;
    }
    return false;
  });
  return nearest <= 1;
}

/// The wall where a path meets it.
struct Wall {
  Vec3 toward_snow;  // unit vector along the ground
  double height;     // m, of the crown above the snow's surface
  double restitution;
};

Wall wall_at(const Model& model, const Terrain& terrain, const DamCrossing& c,
             const Passage& snow) {
  const DamFoot& foot = model.dams[c.dam];
  const DamFoot::Point &a = foot.points[c.section], &b = foot.points[c.section + 1];
  const double r = c.along_section;
  const Vec3 at = snow.from + c.along_path * (snow.to - snow.from);
  const geometry::CellPosition position = terrain.cell_position(at.x(), at.y());
  const Vec3 n = terrain.normal(position);
  const double tx = b.x - a.x, ty = b.y - a.y;
  const Vec3 trace = Vec3(tx, ty, -(n.x() * tx + n.y() * ty) / n.z()).normalized();
  Vec3 across = n.cross(trace);
  const double side = tx * (snow.from.y() - a.y) - ty * (snow.from.x() - a.x);
  if (side < 0) across = -across;
  // The crown stays where it is when the ground changes.
  const double risen = terrain.height(position) - model.terrain.height(position);
  const double height = (1 - r) * a.height + r * b.height - risen;
  return {across, height - snow.thickness / n.z(), foot.restitution};
}

/// Follows a particle through all dams on its path; `passed` receives those that it passes.
void follow(const Model& model, const Terrain& terrain, Passage& snow,
            std::vector<DamCrossing>& passed) {
  constexpr int max_contacts = 4;
  constexpr double margin = 1e-6;  // share of the path by which snow stays before a wall
  constexpr double gap = 1e-7;     // m, between snow and wall
  const Vec3 start = snow.from;
  for (int contact = 0; contact < max_contacts;) {
    DamCrossing c;
    if (!first_crossing(model.dams, snow.from, snow.to, passed, c)) return;
    snow.changed = true;
    const Wall wall = wall_at(model, terrain, c, snow);
    const double toward = -snow.velocity.dot(wall.toward_snow);
    const double climb = 2 * model.gravity * std::max(0.0, wall.height);
    if (wall.height <= 0 || (toward > 0 && toward * toward > climb)) {
      if (toward > 0)
        snow.velocity += (toward - std::sqrt(toward * toward - climb)) * wall.toward_snow;
      passed.push_back(c);
      continue;
    }
    ++contact;
    snow.velocity += (1 + wall.restitution) * std::max(0.0, toward) * wall.toward_snow;
    const Vec3 path = snow.to - snow.from;
    const Vec3 before = snow.from + std::max(0.0, c.along_path - margin) * path;
    Vec3 rest = (1 - c.along_path) * path;
    const Vec3 level(wall.toward_snow.x(), wall.toward_snow.y(), 0);
    const DamFoot::Point &a = model.dams[c.dam].points[c.section],
                         &b = model.dams[c.dam].points[c.section + 1];
    Vec3 normal = Vec3(a.y - b.y, b.x - a.x, 0).normalized();
    if (normal.dot(level) < 0) normal = -normal;
    rest -= (1 + wall.restitution) * rest.dot(normal) / level.dot(normal) * level;
    snow.from = before + gap * normal;
    snow.to = snow.from + rest;
  }
  snow.to = start;  // in a corner between walls
}

/// Turns a velocity along the ground, with the same speed.
void turn_along(const Vec3& normal, Passage& snow) {
  const double speed = snow.velocity.norm();
  const Vec3 along = snow.velocity - snow.velocity.dot(normal) * normal;
  const double length = along.norm();
  snow.velocity = length > 0 ? Vec3(along * (speed / length)) : Vec3(Vec3::Zero());
  snow.kinetic = 0.5 * snow.velocity.squaredNorm();
}

// --- as AvaFrame does it ------------------------------------------------------------------------

/// Value of the fields at a point, bilinear between the nodes: the thickness of the snow, m.
double thickness_at(const GridFields& fields, const geometry::CellPosition& p) {
  const auto at = [&](int i, int j) { return fields.thickness_at(p.column + i, p.row + j); };
  return (1 - p.east) * (1 - p.north) * at(0, 0) + p.east * (1 - p.north) * at(1, 0) +
         (1 - p.east) * p.north * at(0, 1) + p.east * p.north * at(1, 1);
}

void reflect_as_avaframe(const Model& model, const Terrain& terrain, const GridFields& fields,
                         Passage& snow, std::vector<DamCrossing>& passed) {
  constexpr double added_speed = 1e-6;  // m/s
  DamCrossing c;
  bool meets = false;
  for_each_crossing(model.dams, snow.from, snow.to, [&](const DamCrossing& first) {
    c = first;
    return meets = true;
  });
  if (!meets) return;
  snow.changed = true;
  const DamFoot& foot = model.dams[c.dam];
  const DamFoot::Point &a = foot.points[c.section], &b = foot.points[c.section + 1];
  const Vec3& tangent = foot.tangents[c.section];
  const double r = c.along_section, e = foot.restitution;
  const double x = (1 - r) * a.x + r * b.x, y = (1 - r) * a.y + r * b.y;
  const geometry::CellPosition position = terrain.cell_position(x, y);
  const Vec3 at(x, y, terrain.height(position));
  const Vec3 crown = (1 - r) * a.crown + r * b.crown;
  const double depth = thickness_at(fields, position) / terrain.normal(position).z();
  const Vec3 wall = (crown - at - Vec3(0, 0, 0.5 * depth)).cross(tangent).normalized();

  const double beyond = wall.dot(snow.to - at);
  snow.to = (1 - e) * at + e * snow.to - 2 * e * beyond * wall;
  snow.velocity = e * (snow.velocity - 2 * snow.velocity.dot(wall) * wall);
  const double side_before =
      (b.x - a.x) * (snow.from.y() - a.y) - (b.y - a.y) * (snow.from.x() - a.x);
  const double side_after = (b.x - a.x) * (snow.to.y() - a.y) - (b.y - a.y) * (snow.to.x() - a.x);
  if (side_before * side_after < 0) passed.push_back(c);

  const double height = crown.z() - at.z();
  if (!(height > 0)) return;
  // Snow that flows over a dam loses the energy of its height, normal to the foot.
  const Vec3 across = snow.normal.cross(tangent).normalized();
  const double lost = std::min(-snow.velocity.dot(across), std::sqrt(2 * model.gravity * height));
  if (!(lost > 0)) return;
  snow.velocity += lost * across;
  const double speed = snow.velocity.norm();
  snow.kinetic = 0.5 * speed * speed;
  const Vec3 tangential = snow.velocity - snow.velocity.dot(snow.normal) * snow.normal;
  snow.velocity = speed / (tangential.norm() + added_speed) * tangential;
}

}  // namespace

void apply_dams(const Model& model, State& state, Workspace& work) {
  Particles& p = state.particles;
  const CellPositions& now = work.cell_positions;
  std::vector<DamCrossing>& passed = work.passed_dams;
  const Terrain& terrain = present_terrain(model, state);
  double kinetic = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (work.removed[i]) continue;
    const Vec3& from = work.positions_before[i];
    Passage snow{from,
                 {p.x[i], p.y[i], p.z[i]},
                 {p.ux[i], p.uy[i], p.uz[i]},
                 now.normal(i),
                 work.thickness[i]};
    const geometry::CellPosition start = model.terrain.cell_position(from.x(), from.y());
    const bool is_near = model.dams.is_near(model.terrain.index(now.column[i], now.row[i])) ||
                         model.dams.is_near(model.terrain.index(start.column, start.row));
    if (!is_near && (snow.to - from).head<2>().norm() < model.terrain.cell()) continue;
    const double before = snow.kinetic;
    passed.clear();
    if (model.compatible())
      reflect_as_avaframe(model, terrain, work.fields, snow, passed);
    else
      follow(model, terrain, snow, passed);
    if (!snow.changed) continue;
    for (const DamCrossing& c : passed) state.over_dams[c.dam] += p.mass[i];
    const geometry::CellPosition end = terrain.cell_position(snow.to.x(), snow.to.y());
    if (!end.inside() || !terrain.known(end)) {
      work.removed[i] = left_terrain;
      kinetic -= p.mass[i] * before;
      state.energy.left_terrain += p.mass[i] * (before + model.gravity * p.z[i]);
      continue;
    }
    if (!model.compatible()) turn_along(terrain.normal(end), snow);
    p.x[i] = snow.to.x();
    p.y[i] = snow.to.y();
    p.z[i] = terrain.height(end);
    p.ux[i] = snow.velocity.x();
    p.uy[i] = snow.velocity.y();
    p.uz[i] = snow.velocity.z();
    refresh_cell_positions(model, state, work, i, i + 1);
    state.energy.dams += p.mass[i] * (before - 0.5 * snow.velocity.squaredNorm());
    kinetic += p.mass[i] * (snow.kinetic - before);
  }
  state.kinetic_energy += kinetic;
}

}  // namespace snowshed::methods::slide
