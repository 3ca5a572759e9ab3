// Collision objects on the grid: which nodes an obstacle constrains, and how.
//
// The conditions are the thesis's (section 1.2.3; see Condition). Two things are ours:
// - Friction acts on the running mean of the net normal impulse (see push_and_rub), so the
//   contacts have a memory that outlives a step.
// - Where gravity presses snow onto an obstacle, `separate` releases the snow only when pulls have
//   used up the stored push. A vibrating slab thus stays on its panel. Elsewhere `separate`
//   releases snow at once, so that snow never hangs from a panel's back.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "snowshed/geometry/thickened.hpp"
#include "snowshed/methods/mpm/block_layout.hpp"
#include "snowshed/methods/obstacle.hpp"
#include "snowshed/methods/pressure_map.hpp"

namespace snowshed::methods::mpm {

/// Returns a solid as the grid must see it. Parts thinner than two cells would slip between the
/// nodes. Their surface is moved out until they are two cells thick.
geometry::ThickSolid thickened_for_grid(geometry::Shape shape, double dx, int dimension);
Obstacle thickened_obstacle(Obstacle obstacle, double dx, int dimension);

/// Returns the unit vector along the projection of a normal onto the section, or the upward
/// direction if the projection is zero. In 2D the section is the x-z plane; in 3D it is the whole
/// space.
template <int D>
VecD<D> normal_in_section(const Vec3& normal) {
  const VecD<D> n = section<D>(normal);
  return n.norm() > 1e-9 ? VecD<D>(n.normalized()) : VecD<D>(VecD<D>::Unit(D - 1));
}

/// Returns the rule by which an obstacle releases snow. `upward` is the vertical component of its
/// outward normal.
inline Release release(Condition condition, double upward) {
  if (condition == Condition::slip) return Release::never;
  return upward > 0 ? Release::after_push : Release::at_once;
}

/// The obstacles as the grid sees them. An object of this class never changes.
template <class T, int D>
class Boundary {
 public:
  /// `surfaces` are the shapes of the obstacles before thin parts were made thicker. If the list is
  /// empty, the shapes of `obstacles` are used. Nodes outside a surface have contacts, too, if they
  /// are within `margin` (m) of it.
  /// `records_forces`: contacts have the data to record forces.
  Boundary(std::vector<Obstacle> obstacles, double dx, std::vector<geometry::Shape> surfaces = {},
           double margin = 0, bool records_forces = false);

  const std::vector<ContactLaw>& laws() const { return laws_; }
  bool any_motion() const { return any_motion_; }
  std::size_t size() const { return obstacles_.size(); }
  bool any_slip() const {
    return std::any_of(laws_.begin(), laws_.end(),
                       [](const ContactLaw& law) { return law.condition == Condition::slip; });
  }
  bool is_moving(const Contact<T>& c) const { return obstacles_[c.obstacle].motion.has_value(); }
  bool records_forces() const { return records_forces_; }

  /// The surface of an obstacle, not thickened, at a time.
  class Surface {
   public:
    Surface(const geometry::LevelSet& shape, const std::optional<geometry::RigidMotion>& motion,
            double time)
        : shape_(shape) {
      if (motion) pose_ = motion->at(time);
    }
    /// Returns the signed distance, m.
    double distance(const Vec3& x) const { return shape_.distance(pose_ ? pose_->to_body(x) : x); }
    /// Returns the outward unit normal in the section.
    VecD<D> normal(const Vec3& x) const {
      return normal_in_section<D>(pose_ ? pose_->normal_to_world(shape_.normal(pose_->to_body(x)))
                                        : shape_.normal(x));
    }

   private:
    const geometry::LevelSet& shape_;
    std::optional<geometry::RigidPose> pose_;
  };
  Surface surface(std::int32_t obstacle, double time) const {
    return {*surfaces_[obstacle], obstacles_[obstacle].motion, time};
  }

  /// Appends the contacts of a block at a time, either with the moving obstacles or with those at
  /// rest.
  void find(BlockKey block, double time, bool moving, std::vector<Contact<T>>& contacts) const;

  /// The point of an obstacle's surface that is nearest to a contact's node, and its outward
  /// normal, in the frame of the obstacle.
  struct FacePoint {
    Vec3 point, normal;
  };
  FacePoint face_point(BlockKey block, const Contact<T>& contact, double time) const;

 private:
  std::vector<Obstacle> obstacles_;
  std::vector<geometry::Shape> surfaces_;  // shapes of the obstacles, not thickened
  std::vector<ContactLaw> laws_;
  double dx_, margin_;
  bool any_motion_ = false, records_forces_;
};

/// Position of a node of a block, m.
template <int D>
VecD<D> node_position(const BlockCoord<D>& block, int node, double dx) {
  constexpr int B = block_edge<D>;
  VecD<D> x;
  for (int d = D - 1; d >= 0; --d, node /= B) x[d] = (block[d] * B + node % B) * dx;
  return x;
}

/// The share of friction that remains and the sum of the positive impulses (N s) of each obstacle,
/// see Contacts::find_friction_shares.
template <class T>
struct FrictionShares {
  explicit FrictionShares(std::size_t obstacles)
      : shares(obstacles, T(1)), positive_impulses(obstacles) {}

  std::vector<T> shares, positive_impulses;
};

/// All contacts of a layout's grid blocks, with their stored impulses.
template <class T, int D>
class Contacts {
 public:
  /// Returns the contacts of another list of grid blocks at a time. Blocks in both lists keep their
  /// contacts.
  Contacts relocated(const Boundary<T, D>& boundary, const std::vector<BlockKey>& grid_blocks,
                     double time, int threads = 1) const;

  /// Updates the contacts with moving obstacles to `time`. If this throws, nothing has changed.
  void follow(const Boundary<T, D>& boundary, double time, int threads = 1);

  Contact<T>* of_block(std::size_t block) { return contacts_.data() + first_[block]; }
  const Contact<T>* of_block(std::size_t block) const { return contacts_.data() + first_[block]; }
  int count(std::size_t block) const { return int(first_[block + 1] - first_[block]); }

  /// The forces at a block's contacts; null if they are not recorded.
  ContactForce<T>* forces_of(std::size_t block) {
    return forces_.empty() ? nullptr : forces_.data() + first_[block];
  }
  const ContactForce<T>* forces_of(std::size_t block) const {
    return forces_.empty() ? nullptr : forces_.data() + first_[block];
  }
  /// The forces of all contacts, block by block.
  std::vector<ContactForce<T>>& all_forces() { return forces_; }
  /// Finds the patch of each contact that has none.
  void find_patches(const Boundary<T, D>& boundary, double time, PressureMap& pressures);
  /// Adds the impulses of the step that was just taken to the sums of a block's contacts.
  void sum_impulses(std::size_t block) noexcept {
    if (forces_.empty()) return;
    for (std::size_t i = first_[block]; i < first_[block + 1]; ++i) sum_impulse(forces_[i]);
  }
  /// The only obstacle with contacts in a block; -1 if there is none, and -2 if there are several.
  std::int32_t only_obstacle(std::size_t block) const { return only_[block]; }

  std::size_t size() const { return contacts_.size(); }
  /// All contacts, block by block.
  std::vector<Contact<T>>& all() { return contacts_; }

  /// Returns whether a block has a contact with an obstacle that moves at present.
  bool moves(std::size_t block) const;

  /// Accepts the stored impulses of the step that was just taken.
  void commit(std::size_t block) {
    for (std::size_t i = first_[block]; i < first_[block + 1]; ++i)
      contacts_[i].normal_impulse = contacts_[i].next_normal_impulse;
  }

  /// Restores the stored impulses from before a step that failed.
  void reject(std::size_t block) {
    for (std::size_t i = first_[block]; i < first_[block + 1]; ++i)
      contacts_[i].next_normal_impulse = contacts_[i].normal_impulse;
    if (forces_.empty()) return;
    for (std::size_t i = first_[block]; i < first_[block + 1]; ++i)
      std::fill_n(forces_[i].impulse, 4, T(0));
  }

  /// Finds the share of friction that remains for each obstacle: the sum of its stored impulses
  /// over the sum of the positive ones. The share is 1 for obstacles that release snow. Slip holds
  /// some nodes of a body against pull, while internal forces press other nodes more strongly onto
  /// the obstacle. Friction on the pushed nodes alone would be too large.
  void find_friction_shares(FrictionShares<T>& result) const;

  /// A contact with stored impulse (N s), for checkpoints.
  struct StoredImpulse {
    BlockKey block;
    std::int32_t node, obstacle;
    double amount;
  };
  std::vector<StoredImpulse> stored_impulses() const;
  void restore(const std::vector<StoredImpulse>& stored_impulses);

  /// The same for the recorded forces.
  struct StoredForce {
    BlockKey block;
    std::int32_t node, obstacle;
    std::array<double, 3> sum, mean;
    double age;
  };
  std::vector<StoredForce> stored_forces() const;
  void restore(const std::vector<StoredForce>& stored_forces);

 private:
  struct OfBlock {
    std::vector<Contact<T>> contacts;
    std::vector<ContactForce<T>> forces;
  };

  /// Collects the contacts of `blocks`. `find(index, of_block)` appends the contacts of the block
  /// with that index.
  template <class Find>
  static Contacts gathered(const Boundary<T, D>& boundary, const std::vector<BlockKey>& blocks,
                           int threads, Find find);

  /// Calls f(contact index, stored) for each stored item whose contact exists.
  template <class Stored, class F>
  void for_each_stored(const std::vector<Stored>& stored, const F& f);

  std::vector<BlockKey> blocks_;
  std::vector<std::size_t> first_{0};
  std::vector<Contact<T>> contacts_;
  std::vector<ContactForce<T>> forces_;  // one for each contact; empty if they are not recorded
  std::vector<std::int32_t> only_;       // see `only_obstacle`; empty if forces are not recorded
};

}  // namespace snowshed::methods::mpm
