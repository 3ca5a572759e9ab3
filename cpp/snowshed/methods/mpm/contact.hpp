// A node of the grid that an obstacle constrains. A graphics card compiles this file, too.
#pragma once

#include <cstdint>

namespace snowshed::methods::mpm {

/// Smallest mass of a node with snow, kg. The inverse of a smaller mass may overflow.
template <class T>
inline constexpr T min_node_mass = T(1e-30);

/// Rule by which a contact releases snow that is pulled off the obstacle.
enum class Release : std::uint8_t {
  never,  // slip
  // separate, on faces onto which gravity presses snow: once pulls exceed the stored impulse
  after_push,
  at_once  // separate elsewhere
};

/// A node that an obstacle constrains.
template <class T>
struct Contact {
  std::int32_t node;
  std::int32_t obstacle;
  T normal[3];            // normal of the face that snow touches; `outward` if it touches none
  T outward[3];           // normal of the obstacle at the node
  T velocity[3];          // velocity of the obstacle at the node
  T normal_impulse;       // stored normal impulse, N s, for which friction is still due;
                          // with slip, which holds against any pull, it may be negative
  T next_normal_impulse;  // the same after the step that is being tried
  Release release;
  bool acts = true;  // whether snow has come close enough
};

/// The force at a contact, where forces are recorded. The kernels write the impulse only.
template <class T>
struct ContactForce {
  T impulse[4];             // N s, on the snow in the step being tried, or just taken
  T sum[4];                 // N s, on the snow in the steps before, since the last collection
  T mean[3];                // N, running mean of the force on the snow
  T age;                    // s, time over which it is a mean
  std::int32_t patch = -1;  // index into the pressure map
};

}  // namespace snowshed::methods::mpm
