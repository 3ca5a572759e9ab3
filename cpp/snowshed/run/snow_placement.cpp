#include "snowshed/run/snow_placement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <optional>

#include "snowshed/core/angles.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/particles/point_grid.hpp"

namespace snowshed::run {
namespace {

/// Number of particles that share a bounding box; consecutive particles are close to each other.
constexpr std::size_t particles_in_box = 64;

constexpr double depth_over_resolution = 1e-3;  // less is rounding of files, not an overlap

/// Old snow surrounds a point if the ball of this radius around it, in particle distances, has
/// enough old particles, and their centre is near to the point.
constexpr double reach = 2.2;
constexpr double min_filling = 0.4;  // number of particles over that in unbroken snow
/// Distance of their centre over the reach. On a flat surface it is 0.38 (3D) and 0.42 (2D).
constexpr double max_offset = 0.28;

constexpr std::size_t max_notes = 10;  // notes on the bodies of an event
constexpr std::size_t max_parts = 3;   // parts in a sentence

struct PointBox {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;

  void extend(const Vec3& x) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  bool meets(const Vec3& other_low, const Vec3& other_high, int dimension) const {
    for (const int axis : {0, 1, 2}) {
      if (axis == 1 && dimension == 2) continue;
      if (other_low[axis] > high[axis] || other_high[axis] < low[axis]) return false;
    }
    return true;
  }
};

PointBox box_around(const std::vector<Vec3>& points, std::size_t begin, std::size_t end) {
  PointBox box;
  for (std::size_t i = begin; i < end; ++i) box.extend(points[i]);
  return box;
}

/// The particles of a body that lie in one obstacle or body.
struct Part {
  std::string where;
  std::size_t count = 0;
  Vec3 example = Vec3::Zero();
};

/// The particles of a body, and which of them are misplaced.
class Particles {
 public:
  Particles(const std::vector<Vec3>& positions, int dimension)
      : positions_(positions), dimension_(dimension), part_of_(positions.size(), 0) {
    for (std::size_t begin = 0; begin < positions.size(); begin += particles_in_box) {
      const std::size_t end = std::min(begin + particles_in_box, positions.size());
      boxes_.push_back(box_around(positions, begin, end));
      box_.extend(boxes_.back().low);
      box_.extend(boxes_.back().high);
    }
  }

  const PointBox& box() const { return box_; }

  /// Marks the particles where `distance` is below `-depth`, and counts them under a name.
  template <class Distance>
  void find_within(const std::string& where, double depth, const Distance& distance) {
    for_each_near(distance, depth, [&](std::size_t i) { count(where, i); });
  }

  /// Returns the number of such particles that have no mark yet; marks none.
  template <class Distance>
  std::size_t count_others_within(double depth, const Distance& distance) const {
    std::size_t others = 0;
    for_each_near(distance, depth, [&](std::size_t i) { others += part_of_[i] == 0; });
    return others;
  }

  /// Marks the particles for which `is_there(x)` holds; searches only boxes that meet another box.
  template <class Test>
  void find_where(const std::string& where, const PointBox& other, const Test& is_there) {
    for (std::size_t b = 0; b < boxes_.size(); ++b) {
      if (!boxes_[b].meets(other.low, other.high, dimension_)) continue;
      for (std::size_t i = b * particles_in_box; i < end_of(b); ++i)
        if (is_there(positions_[i])) count(where, i);
    }
  }

  double share() const {
    return share_of(part_of_.size() -
                    std::size_t(std::count(part_of_.begin(), part_of_.end(), 0u)));
  }
  double share_of(std::size_t count) const { return double(count) / double(positions_.size()); }
  const std::vector<Part>& parts() const { return parts_; }

 private:
  std::size_t end_of(std::size_t box) const {
    return std::min((box + 1) * particles_in_box, positions_.size());
  }

  template <class Distance, class Visit>
  void for_each_near(const Distance& distance, double depth, const Visit& visit) const {
    for (std::size_t b = 0; b < boxes_.size(); ++b) {
      const double middle = distance(Vec3(0.5 * (boxes_[b].low + boxes_[b].high)));
      const double radius = 0.5 * (boxes_[b].high - boxes_[b].low).norm();
      if (middle - radius >= -depth) continue;
      const bool all = middle + radius < -depth;
      for (std::size_t i = b * particles_in_box; i < end_of(b); ++i)
        if (all || distance(positions_[i]) < -depth) visit(i);
    }
  }

  void count(const std::string& where, std::size_t i) {
    if (parts_.empty() || parts_.back().where != where) parts_.push_back({where, 0, positions_[i]});
    const auto part = std::uint32_t(parts_.size());
    if (part_of_[i] == part) return;  // a corner of the domain is beyond two of its sides
    part_of_[i] = part;
    ++parts_.back().count;
  }

  const std::vector<Vec3>& positions_;
  const int dimension_;
  // One per particle: the last part that it is in, from 1; 0: none.
  std::vector<std::uint32_t> part_of_;
  std::vector<PointBox> boxes_;
  PointBox box_;
  std::vector<Part> parts_;
};

/// Decides whether a point is surrounded by particles of old snow.
class OldSnow {
 public:
  OldSnow(const OccupiedSpace& space, const PointBox& new_snow, int dimension)
      : radius_(reach * space.particle_distance) {
    const Vec3 around = Vec3::Constant(radius_);
    for (const Vec3& x : space.particles)
      if (new_snow.meets(x - around, x + around, dimension)) {
        near_.push_back(x);
        box_.extend(x - around);
        box_.extend(x + around);
      }
    if (!near_.empty()) grid_.emplace(near_, radius_);
    const double ball = dimension == 2 ? pi * reach * reach : 4.0 / 3.0 * pi * std::pow(reach, 3);
    min_count_ = min_filling * ball;
  }

  const PointBox& box() const { return box_; }
  bool empty() const { return near_.empty(); }

  bool surrounds(const Vec3& x) const {
    Vec3 sum = Vec3::Zero();
    double count = 0;
    grid_->for_each_near(x, [&](std::size_t, const Vec3& y) {
      if ((y - x).squaredNorm() > radius_ * radius_) return;
      sum += y - x;
      ++count;
    });
    return count >= min_count_ && sum.norm() < max_offset * radius_ * count;
  }

 private:
  double radius_, min_count_;
  std::vector<Vec3> near_;
  PointBox box_;
  std::optional<particles::PointGrid> grid_;
};

std::string position_text(const Vec3& x, int dimension) {
  char text[100];
  if (dimension == 2)
    std::snprintf(text, sizeof text, "(%.4g, %.4g) m", x.x(), x.z());
  else
    std::snprintf(text, sizeof text, "(%.4g, %.4g, %.4g) m", x.x(), x.y(), x.z());
  return text;
}

/// The obstacles, and texts for positions inside them.
class Obstacles {
 public:
  Obstacles(const scene::Scene& scene, const OccupiedSpace& space)
      : scene_(scene), space_(space), depth_(depth_over_resolution * scene.numerics->resolution()) {
    const std::size_t standing = std::size_t(scene.ground.has_value()) + scene.panel.has_value();
    for (std::size_t k = 0; k < space.obstacles.size(); ++k) {
      const methods::Obstacle& o = space.obstacles[k];
      bounds_.push_back(o.shape->bounds());
      if (o.name == "domain" && k >= standing + scene.obstacles.size())
        words_.push_back("outside the domain");
      else if (scene.ground && k == 0)
        words_.push_back("below the ground");
      else if (k < standing)
        words_.push_back("inside the panel");
      else
        words_.push_back(o.name.empty() ? "inside /obstacles/" + std::to_string(k - standing)
                                        : "inside the obstacle \"" + o.name + "\"");
    }
  }

  void find(Particles& snow) const {
    for_each_near(snow, 0, [&](std::size_t k, const auto& to_body) {
      const geometry::LevelSet& shape = *space_.obstacles[k].shape;
      snow.find_within(words_[k], depth_,
                       [&](const Vec3& x) { return shape.distance(to_body(x)); });
    });
  }

  /// Adds sentences on particles that lie only where obstacles are made thicker.
  void find_in_thickening(const Particles& snow, std::vector<std::string>& sentences) const {
    for_each_near(snow, scene_.numerics->resolution(), [&](std::size_t k, const auto& to_body) {
      const geometry::Shape& seen = space_.resolved[k].shape;
      if (seen == space_.obstacles[k].shape) return;
      const std::size_t count = snow.count_others_within(
          depth_, [&](const Vec3& x) { return seen->distance(to_body(x)); });
      if (count == 0) return;
      const std::string name = words_[k].substr(std::string("inside ").size());
      sentences.push_back(percent(snow.share_of(count)) + " of its particles lie beside " + name +
                          ", where it is thickened to the resolution, and are pushed out");
    });
  }

 private:
  /// Calls visit(number, to_body) for the obstacles within `margin` (m) of the snow.
  template <class Visit>
  void for_each_near(const Particles& snow, double margin, const Visit& visit) const {
    for (std::size_t k = 0; k < space_.obstacles.size(); ++k) {
      const methods::Obstacle& o = space_.obstacles[k];
      if (o.motion) {
        const geometry::RigidPose pose = o.motion->at(space_.time);
        visit(k, [&](const Vec3& x) { return pose.to_body(x); });
        continue;
      }
      const Vec3 around = Vec3::Constant(margin);
      if (snow.box().meets(bounds_[k].min - around, bounds_[k].max + around, scene_.dimension))
        visit(k, [](const Vec3& x) { return x; });
    }
  }

  const scene::Scene& scene_;
  const OccupiedSpace& space_;
  const double depth_;
  std::vector<geometry::Bounds> bounds_;
  std::vector<std::string> words_;
};

/// "/bodies/0" of "/bodies/0/shape".
std::string body_of(const std::string& path) {
  const std::string ending = "/shape";
  const std::size_t length = path.size() < ending.size() ? 0 : path.size() - ending.size();
  return path.compare(length, std::string::npos, ending) == 0 ? path.substr(0, length) : path;
}

std::string sentence_of(const Particles& snow, int dimension, int event) {
  std::string text;
  for (std::size_t i = 0; i < std::min(max_parts, snow.parts().size()); ++i) {
    const Part& part = snow.parts()[i];
    const std::string share = percent(snow.share_of(part.count));
    text += text.empty() ? share + " of its particles lie " : " and " + share + " ";
    text += part.where + ", such as at " + position_text(part.example, dimension);
  }
  if (snow.parts().size() > max_parts) text += ", and others elsewhere";
  return event > 1 ? "in event " + std::to_string(event) + ", " + text : text;
}

/// Limits the number of notes.
std::vector<std::string> shortened(std::vector<std::string> notes) {
  if (notes.size() <= max_notes) return notes;
  const std::size_t more = notes.size() - max_notes + 1;
  notes.resize(max_notes - 1);
  notes.push_back(std::to_string(more) +
                  " further bodies of snow lie where snow may not be, or "
                  "where an obstacle is thickened");
  return notes;
}

}  // namespace

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, share < 0.1 ? "%.2g %%" : "%.0f %%", 100 * share);
  return text;
}

std::vector<std::string> check_placement(const scene::Scene& scene,
                                         const std::vector<PlacedBody>& bodies,
                                         const OccupiedSpace& space) {
  const Obstacles obstacles(scene, space);
  const double depth = depth_over_resolution * scene.numerics->resolution();
  std::vector<geometry::Bounds> bounds;
  for (const PlacedBody& body : bodies)
    bounds.push_back(body.shape ? body.shape->bounds() : geometry::Bounds{});
  std::vector<std::string> notes;
  for (const PlacedBody& body : bodies) {
    if (body.positions->empty()) continue;
    Particles snow(*body.positions, scene.dimension);
    obstacles.find(snow);
    for (std::size_t other = 0; other < bodies.size(); ++other) {
      if (&bodies[other] == &body || !bodies[other].shape) continue;
      if (!snow.box().meets(bounds[other].min, bounds[other].max, scene.dimension)) continue;
      snow.find_within("within the snow of " + body_of(bodies[other].path), depth,
                       [&](const Vec3& x) { return bodies[other].shape->distance(x); });
    }
    if (!space.particles.empty()) {
      const OldSnow old(space, snow.box(), scene.dimension);
      if (!old.empty())
        snow.find_where("within snow that is already there", old.box(),
                        [&](const Vec3& x) { return old.surrounds(x); });
    }
    std::vector<std::string> sentences;
    obstacles.find_in_thickening(snow, sentences);
    for (const std::string& sentence : sentences) notes.push_back(body.path + ": " + sentence);
    if (snow.parts().empty()) continue;
    const std::string sentence = sentence_of(snow, scene.dimension, space.event);
    if (snow.share() > max_misplaced && !body.is_only_noted &&
        scene.misplaced_snow == scene::MisplacedSnow::refuse)
      throw InputError(body.path, sentence + "; move it, or set /misplaced_snow to \"allow\"");
    notes.push_back(body.path + ": " + sentence);
  }
  return shortened(std::move(notes));
}

}  // namespace snowshed::run
