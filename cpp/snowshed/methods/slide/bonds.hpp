// Bonds between particles: elastic up to a largest strain, beyond which they break for good.
#pragma once

#include <cstdint>
#include <vector>

#include "snowshed/core/stop_request.hpp"
#include "snowshed/methods/slide/areas.hpp"
#include "snowshed/methods/slide/particles.hpp"
#include "snowshed/methods/slide/settings.hpp"

namespace snowshed::methods::slide {

/// The bonds that hold, each between two particles, given by their storage indices.
struct Bonds {
  std::vector<std::uint32_t> first, second;
  std::vector<double> rest_length;  // m

  std::size_t size() const { return first.size(); }
  void reserve(std::size_t n) {
    first.reserve(n);
    second.reserve(n);
    rest_length.reserve(n);
  }
  void add(std::uint32_t a, std::uint32_t b, double length) {
    first.push_back(a);
    second.push_back(b);
    rest_length.push_back(length);
  }
};

/// Returns bonds along the edges of the Delaunay triangulation of the particles from `begin` on, as
/// seen from above. Triangles count if their longest side is at most 1.1 times the smallest
/// longest side of all triangles. With `areas`, bonds that cross the outline of one of them are
/// left out. Throws Stopped on request.
Bonds bonds_between(const Particles& particles, std::size_t begin, double spacing,
                    const std::vector<Area>* areas, const StopRequest& stop = {});

/// Removes the bonds of removed particles and renumbers the others: `new_index[i]` is the new
/// storage index of particle i, or `removed_particle`.
inline constexpr std::uint32_t removed_particle = 0xffffffff;
void renumber(Bonds& bonds, const std::vector<std::uint32_t>& new_index);

/// Returns the longest step in which the vibration of bonds does not grow, s; infinite without
/// bonds. A bond has the stiffness k = E h / sqrt(3). A particle of mass m whose bonds have the
/// total stiffness K vibrates with omega^2 <= 2 K / m (Gershgorin). Forces are evaluated at the
/// positions to which the velocities before the step lead, which is stable if omega dt <= sqrt(2).
/// `thinned`: whether bonds weaken with the mass that forest takes.
double max_bond_step(const Bonds& bonds, const Particles& particles,
                     const AlignedVector<double>& thickness, double modulus, bool thinned);

/// The share of its strength that a bond has where forest takes snow: that of the fresh mass which
/// is left in the lighter of its two columns. Force over mass then never exceeds that of fresh
/// snow. Without `thinned` it is 1.
double bond_share(bool thinned, const double* mass, const double* fresh_mass, std::uint32_t first,
                  std::uint32_t second);

/// Removes the bonds that are marked.
void remove_bonds(Bonds& bonds, const std::vector<char>& marked);

/// The bonds of each particle, for sums over them.
class BondLists {
 public:
  void reserve(std::size_t particles, std::size_t bonds) {
    begin_.reserve(particles + 1);
    entry_.reserve(2 * bonds);
  }
  void update(const Bonds& bonds, std::size_t particles);

  /// The bonds of particle i are entries [begins()[i], begins()[i + 1]): coded as 2 · bond + (1 if
  /// the particle is its second).
  const std::uint32_t* begins() const { return begin_.data(); }
  const std::uint32_t* entries() const { return entry_.data(); }

  std::size_t bytes() const {
    return (begin_.capacity() + entry_.capacity()) * sizeof(std::uint32_t);
  }

 private:
  std::vector<std::uint32_t> begin_, entry_;
};

}  // namespace snowshed::methods::slide
