#include "snowshed/methods/mpm/state.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "snowshed/core/errors.hpp"
#include "snowshed/geometry/bounds.hpp"
#include "snowshed/material/sym_tensor.hpp"
#include "snowshed/methods/mpm/contact_radius.hpp"

namespace snowshed::methods::mpm {
namespace {

/// Memory of the contacts' friction, in elastic time steps of the slowest snow: longer than the
/// vibration of a slab a few cells thick.
constexpr double friction_memory_steps = 40;

/// Largest number of velocity fields. If there are more events, the oldest ones share a field.
constexpr int fields_at_once = 8;

}  // namespace

template <class T, int D>
State<T, D>::State(const Model<T, D>& model)
    : sleep(model.options.settings.sleep_speed, model.options.settings.sleep_time,
            model.options.gravity) {
  particles.has_affine = model.has_affine();
  particles.has_material_id = model.material_per_particle;
  particles.has_plastic = model.has_plastic();
  particles.own_numbers = model.options.laws.own_numbers;
  find_elastic_limits(model);
  totals.counters.smallest_dt = elastic_limit;
  if (!model.options.forces) return;
  forces.emplace(
      ForceRecord{ObstacleForces(model.options.obstacles, D, model.options.settings.dx), {}});
  forces->held.resize(forces->forces.names().size());
}

template <class T, int D>
void State<T, D>::find_elastic_limits(const Model<T, D>& model) {
  const std::vector<Material>& materials = model.materials;
  std::vector<bool> present(materials.size(), !particles.has_material_id || particles.size() == 0);
  for (const std::uint8_t material_id : particles.material_id) present[material_id] = true;
  double shortest = geometry::infinity, longest = 0;
  for (std::size_t k = 0; k < materials.size(); ++k) {
    if (!present[k]) continue;
    shortest = std::min(shortest, materials[k].elastic_time_step);
    longest = std::max(longest, materials[k].elastic_time_step);
  }
  elastic_limit = shortest;
  friction_memory = friction_memory_steps * longest;
}

template <class T, int D>
void State<T, D>::append(const Model<T, D>& model, const ParticleBatch& batch,
                         std::vector<BlockKey>& blocks) {
  check_batch(batch, model.materials.size());
  const std::size_t old = particles.size();
  particles.resize(old + batch.positions.size());
  particles.for_each_array([old](const char*, auto& array) {
    using Value = typename std::remove_reference_t<decltype(array)>::value_type;
    std::fill(array.begin() + std::ptrdiff_t(old), array.end(), Value(0));
  });
  const int field =
      model.options.settings.fields == Fields::events ? field_of_event(batch.event, blocks) : 0;
  const VecD<D> velocity = section<D>(batch.velocity);
  const T plastic = T(model.materials[std::size_t(batch.material_id)].initial_plastic_strain);
  for (std::size_t k = 0; k < batch.positions.size(); ++k) {
    const std::size_t i = old + k;
    blocks.push_back(put(model, i, section<D>(batch.positions[k]), field));
    for (int d = 0; d < D; ++d) particles.velocity[d][i] = T(velocity[d]);
    if (particles.has_plastic) particles.plastic[i] = plastic;
    particles.mass[i] = T(batch.mass_of(k));
    particles.id[i] = totals.next_id++;
    particles.event[i] = std::uint16_t(batch.event);
    if (particles.has_material_id) particles.material_id[i] = std::uint8_t(batch.material_id);
  }
  totals.speed = std::max(totals.speed, velocity.norm());
}

template <class T, int D>
BlockKey State<T, D>::put(const Model<T, D>& model, std::size_t particle, const VecD<D>& position,
                          int field) {
  const Settings& n = model.options.settings;
  const auto placement = Placement<D>::of(position, n.dx, n.basis, field);
  for (int d = 0; d < D; ++d) particles.cell[d][particle] = T(placement.cell[d]);
  return block_key<D>(placement.block, field);
}

template <class T, int D>
int State<T, D>::field_of_event(int event, std::vector<BlockKey>& blocks) {
  const auto known = event_fields.find(event);
  if (known != event_fields.end()) return known->second;
  const auto is_taken = [&](int field) {
    return std::any_of(event_fields.begin(), event_fields.end(),
                       [&](const auto& of_event) { return of_event.second == field; });
  };
  int field = 0;
  while (field < fields_at_once && is_taken(field)) ++field;
  if (field == fields_at_once) {
    // The two oldest fields become one.
    const int oldest_field = event_fields.begin()->second;
    const auto other =
        std::find_if(event_fields.begin(), event_fields.end(),
                     [&](const auto& of_event) { return of_event.second != oldest_field; });
    field = other->second;
    for (auto& of_event : event_fields)
      if (of_event.second == field) of_event.second = oldest_field;
    for (BlockKey& key : blocks)
      if (field_of(key) == field) key = block_key<D>(block_coord<D>(key), oldest_field);
  }
  event_fields[event] = field;
  return field;
}

template <class T, int D>
void State<T, D>::find_event_fields() {
  event_fields.clear();
  for (std::size_t b = 0; b < layout.particle_blocks.size(); ++b)
    for (std::int32_t i = layout.first[b]; i < layout.first[b + 1]; ++i)
      event_fields[particles.event[i]] = field_of(layout.particle_blocks[b]);
}

template <class T, int D>
void State<T, D>::arrange(const Model<T, D>& model, std::vector<BlockKey> blocks) {
  const int threads = model.threads(sleep.awake_particles());
  ParticleSort<T, D> sort(particles, std::move(blocks), layout, threads);
  BlockLayout<D> next = std::move(sort.layout);
  adopt(model, std::move(next), threads, [&] { sort.apply(particles); });
}

template <class T, int D>
void State<T, D>::adopt(const Model<T, D>& model, BlockLayout<D> next, int threads,
                        const std::function<void()>& sort) {
  std::optional<Contacts<T, D>> relocated;
  if (forces) {
    if (sleep.idle().empty())
      collect_vanishing_forces(model, next.grid_blocks);
    else
      collect_forces(model);  // snow may wake
  }
  if (next.grid_blocks != layout.grid_blocks) {
    relocated = contacts.relocated(model.boundary, next.grid_blocks, totals.time, threads);
    if (forces) relocated->find_patches(model.boundary, totals.time, forces->forces.pressures());
  }
  Sleep<D> sleep_after = sleep.relocated(next, totals.time);
  sort();  // all memory is reserved: nothing fails from here on
  layout = std::move(next);
  if (relocated) contacts = std::move(*relocated);
  sleep = std::move(sleep_after);
}

template <class T, int D>
double State<T, D>::volume_ratio(const Model<T, D>& model, std::size_t i) const {
  material::Sym<double, D> a;
  for (int k = 0; k < a.size; ++k) a.c[k] = double(particles.be_minus_identity[k][i]);
  const double plastic = particles.has_plastic ? double(particles.plastic[i]) : 0.0;
  return mpm::volume_ratio<D>(a, plastic, material_of(model, i).initial_plastic_strain);
}

template <class T, int D>
double State<T, D>::contact_radius(const Model<T, D>& model, std::size_t i) const {
  return mpm::contact_radius<D>(model.options.settings.contact_radius,
                                double(particles.mass[i]) / material_of(model, i).density,
                                volume_ratio(model, i));
}

template <class T, int D>
double State<T, D>::largest_contact_radius(const Model<T, D>& model) const {
  double volume = 0;
  for (std::size_t i = 0; i < particles.size(); ++i)
    volume = std::max(volume, double(particles.mass[i]) / material_of(model, i).density);
  return mpm::contact_radius<D>(model.options.settings.contact_radius, volume, max_expansion);
}

template <class T, int D>
double State<T, D>::gravitational_energy(const Model<T, D>& model) const {
  const Settings& n = model.options.settings;
  double sum = 0;
  for (std::size_t b = 0; b < layout.particle_blocks.size(); ++b)
    for (std::int32_t i = layout.first[b]; i < layout.first[b + 1]; ++i)
      sum +=
          double(particles.mass[i]) *
          position_of(particles, std::size_t(i), layout.particle_blocks[b], n.dx, n.basis)[D - 1];
  return sum * model.options.gravity;
}

template <class T, int D>
double State<T, D>::kinetic_energy(const Model<T, D>& model) const {
  const Settings& n = model.options.settings;
  const double inertia = n.dx * n.dx / apic_inverse_inertia(n.basis);
  double sum = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    double v2 = 0;
    for (const auto& v : particles.velocity) v2 += double(v[i]) * double(v[i]);
    if (particles.has_affine)
      for (const auto& c : particles.affine) v2 += inertia * double(c[i]) * double(c[i]);
    sum += 0.5 * double(particles.mass[i]) * v2;
  }
  return sum;
}

template <class T, int D>
double State<T, D>::elastic_energy(const Model<T, D>& model) const {
  double sum = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Material& snow = material_of(model, i);
    const material::Elasticity<double>& el = snow.elastic;
    material::Sym<double, D> a;
    for (int k = 0; k < a.size; ++k) a.c[k] = double(particles.be_minus_identity[k][i]);
    const material::Sym<double, D> e = material::hencky_strain(a);
    const double volumetric = material::trace(e);
    sum +=
        double(particles.mass[i]) / snow.density *
        (el.mu * material::norm_squared(e) + 0.5 * el.lambda * volumetric * volumetric);  // (1.2.5)
  }
  return sum;
}

template <class T, int D>
EnergyBalance State<T, D>::energy(const Model<T, D>& model) const {
  EnergyBalance balance = totals.energy;
  balance.gravitational = gravitational_energy(model);
  return balance;
}

template <class T, int D>
void State<T, D>::record_added(const Model<T, D>& model, double before) {
  EnergyBalance& balance = totals.energy;
  balance.gravitational = gravitational_energy(model);
  balance.kinetic = kinetic_energy(model);
  balance.elastic = elastic_energy(model);
  balance.added += balance.stored() - before;
}

template struct State<float, 2>;
template struct State<float, 3>;
template struct State<double, 2>;
template struct State<double, 3>;

}  // namespace snowshed::methods::mpm
