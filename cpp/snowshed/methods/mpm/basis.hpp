// The splines of the grid. A graphics card compiles this file, too.
#pragma once

namespace snowshed::methods::mpm {

enum class Basis { quadratic, cubic };

/// Nodes that a particle touches along one direction.
constexpr int support(Basis basis) { return basis == Basis::quadratic ? 3 : 4; }

/// The smallest distance (in cells) from a particle's lowest node to the particle. The fraction of
/// the particle's `cell` is added to it.
constexpr double base_offset(Basis basis) { return basis == Basis::quadratic ? 0.5 : 1.0; }

/// Inverse of APIC's inertia D = sum_i w_i (x_i - x)^2, per cell squared.
constexpr double apic_inverse_inertia(Basis basis) { return basis == Basis::quadratic ? 4.0 : 3.0; }

}  // namespace snowshed::methods::mpm
