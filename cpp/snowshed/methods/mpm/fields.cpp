// The fields of a solver's particles. Stored quantities are views; the others are computed.
#include <array>
#include <cmath>

#include "snowshed/methods/field_sources.hpp"
#include "snowshed/methods/mpm/solver_impl.hpp"

namespace snowshed::methods::mpm {
namespace {

/// One component of a vector or tensor, such as velocity_x.
particles::FieldInfo component_of(const Quantity& q, const std::string& axes,
                                  particles::FieldType type) {
  return {q.name + "_" + axes, q.unit, q.meaning + "; component " + axes, 1, type, true};
}

template <int D>
constexpr const char* axis_names() {
  return D == 2 ? "xz" : "xyz";
}

/// The axes of the component k of a symmetric tensor, as `Sym` orders them.
template <int D>
std::string symmetric_axes(int k) {
  for (int i = 0; i < D; ++i)
    for (int j = i; j < D; ++j)
      if (material::Sym<double, D>::index(i, j) == k)
        return {axis_names<D>()[i], axis_names<D>()[j]};
  return {};
}

}  // namespace

template <class T, int D>
material::Sym<double, D> SolverImpl<T, D>::elastic_strain(std::size_t i) const {
  material::Sym<double, D> a;
  for (int k = 0; k < a.size; ++k) a.c[k] = double(state_.particles.be_minus_identity[k][i]);
  return material::hencky_strain(a);
}

template <class T, int D>
double SolverImpl<T, D>::elastic_volumetric_strain(std::size_t i) const {
  return material::trace(elastic_strain(i));
}

template <class T, int D>
double SolverImpl<T, D>::plastic_strain(std::size_t i) const {
  return state_.particles.has_plastic ? double(state_.particles.plastic[i]) : 0.0;
}

template <class T, int D>
double SolverImpl<T, D>::volume_ratio(std::size_t i) const {
  return state_.volume_ratio(model_, i);
}

template <class T, int D>
double SolverImpl<T, D>::density(std::size_t i) const {
  return state_.material_of(model_, i).density / volume_ratio(i);
}

/// Kirchhoff's stress by the constitutive law of the user, Pa, positive in tension.
template <class T, int D>
material::Sym<double, D> SolverImpl<T, D>::stress_by_law(std::size_t i) const {
  const Particles<T, D>& p = state_.particles;
  const material::Sym<double, D> e = elastic_strain(i);
  material::Sym<T, D> strain, stress;
  for (int k = 0; k < e.size; ++k) strain.c[k] = T(e.c[k]);
  T plastic = p.plastic[i], own[max_own_numbers];
  for (int k = 0; k < p.own_numbers; ++k) own[k] = p.own[std::size_t(k)][i];
  const std::uint8_t snow = p.has_material_id ? p.material_id[i] : std::uint8_t(0);
  reinterpret_cast<ConstitutiveLaw<T>>(model_.options.laws.constitutive)(1, strain.c, stress.c,
                                                                         &plastic, own, &snow, 0.0);
  material::Sym<double, D> result;
  for (int k = 0; k < e.size; ++k) result.c[k] = double(stress.c[k]);
  return result;
}

template <class T, int D>
double SolverImpl<T, D>::pressure(std::size_t i) const {
  if (model_.options.laws.constitutive) return -material::trace(stress_by_law(i)) / D;
  return -state_.material_of(model_, i).elastic.bulk * elastic_volumetric_strain(i);
}

template <class T, int D>
double SolverImpl<T, D>::deviatoric_stress(std::size_t i) const {
  const bool by_law = model_.options.laws.constitutive;
  material::Sym<double, D> deviator = by_law ? stress_by_law(i) : elastic_strain(i);
  const double mean = material::trace(deviator) / D;
  for (int k = 0; k < D; ++k) deviator.c[k] -= mean;
  if (by_law) return std::sqrt(1.5 * material::norm_squared(deviator));
  return state_.material_of(model_, i).elastic.mu * std::sqrt(6 * material::norm_squared(deviator));
}

template <class T, int D>
double SolverImpl<T, D>::preconsolidation_pressure(std::size_t i) const {
  return state_.material_of(model_, i).law.preconsolidation(plastic_strain(i));
}

template <class T, int D>
Vec3 SolverImpl<T, D>::velocity(std::size_t i) const {
  VecD<D> v;
  for (int d = 0; d < D; ++d) v[d] = double(state_.particles.velocity[d][i]);
  return embed(v);
}

/// The affine matrix in (x, y, z); in 2D the row and the column of y are zero.
template <class T, int D>
Mat3 SolverImpl<T, D>::affine(std::size_t i) const {
  const auto axis = [](int d) { return d == D - 1 ? 2 : d; };
  Mat3 c = Mat3::Zero();
  for (int r = 0; r < D; ++r)
    for (int k = 0; k < D; ++k) c(axis(r), axis(k)) = double(state_.particles.affine[r * D + k][i]);
  return c;
}

template <class T, int D>
std::vector<double> SolverImpl<T, D>::positions() const {
  std::vector<double> values(3 * state_.particles.size());
  parallel_for_dynamic(
      std::ptrdiff_t(state_.layout.particle_blocks.size()), model_.max_threads, 64,
      [&](std::ptrdiff_t b) {
        for (std::int32_t i = state_.layout.first[b]; i < state_.layout.first[b + 1]; ++i)
          Vec3::Map(&values[3 * std::size_t(i)]) =
              embed(position_of(state_.particles, std::size_t(i), state_.layout.particle_blocks[b],
                                model_.options.settings.dx, model_.options.settings.basis));
      });
  return values;
}

/// Calls visit(info, view) for each field; view() returns its view.
template <class T, int D>
template <class Visit>
void SolverImpl<T, D>::visit_fields(Visit visit) const {
  const FieldSources show(visit, state_.particles.size(), model_.max_threads);
  const auto components = [&show](const char* name, const auto& arrays, auto axes) {
    for (int k = 0; k < int(arrays.size()); ++k)
      show.stored(component_of(quantity(name), axes(k), particles::field_type<T>()), arrays[k]);
  };

  show.computed("position", [this] { return positions(); });
  show.of_each("velocity", [this](std::size_t i) { return velocity(i); });
  components("velocity", state_.particles.velocity,
             [](int d) { return std::string(1, axis_names<D>()[d]); });
  show.column("mass", state_.particles.mass);
  show.of_each("density", [this](std::size_t i) { return density(i); });
  show.of_each("volume_ratio", [this](std::size_t i) { return volume_ratio(i); });
  show.of_each("pressure", [this](std::size_t i) { return pressure(i); });
  show.of_each("deviatoric_stress", [this](std::size_t i) { return deviatoric_stress(i); });
  if (state_.particles.has_plastic) {
    show.of_each("preconsolidation_pressure",
                 [this](std::size_t i) { return preconsolidation_pressure(i); });
    show.column("volumetric_plastic_strain", state_.particles.plastic);
  } else
    show.of_each("volumetric_plastic_strain", [](std::size_t) { return 0.0; });
  components("be_minus_identity", state_.particles.be_minus_identity, symmetric_axes<D>);
  for (int k = 0; k < state_.particles.own_numbers; ++k)
    show.stored({"own_" + std::to_string(k), "", "Number of the user's constitutive law", 1,
                 particles::field_type<T>(), true},
                state_.particles.own[std::size_t(k)]);
  if (state_.particles.has_affine) {
    show.of_each("affine", [this](std::size_t i) { return affine(i); });
    components("affine", state_.particles.affine,
               [](int k) { return std::string{axis_names<D>()[k / D], axis_names<D>()[k % D]}; });
  }
  show.column("id", state_.particles.id);
  show.column("event", state_.particles.event);
  if (state_.particles.has_material_id)
    show.column("material_id", state_.particles.material_id);
  else
    show.computed("material_id",
                  [this] { return std::vector<std::uint8_t>(state_.particles.size()); });
}

template <class T, int D>
std::vector<particles::FieldInfo> SolverImpl<T, D>::fields() const {
  return list_fields([this](const auto& visit) { visit_fields(visit); });
}

template <class T, int D>
particles::FieldView SolverImpl<T, D>::field(const std::string& name) const {
  return find_field(name, [this](const auto& visit) { visit_fields(visit); });
}

template <class T, int D>
ParticleState SolverImpl<T, D>::state() const {
  const std::vector<std::uint32_t>& at = order_by_id();
  const std::vector<double> x = positions();
  const auto by_id = [&](auto& values, auto value) {
    values.resize(at.size());
    parallel_for_static(std::ptrdiff_t(at.size()), model_.max_threads,
                        [&](std::ptrdiff_t k) { values[k] = value(at[k]); });
  };
  ParticleState s;
  by_id(s.positions, [&](std::size_t i) { return Vec3::Map(&x[3 * i]); });
  by_id(s.velocities, [this](std::size_t i) { return velocity(i); });
  by_id(s.masses, [this](std::size_t i) { return double(state_.particles.mass[i]); });
  by_id(s.densities, [this](std::size_t i) { return density(i); });
  by_id(s.ids, [this](std::size_t i) { return state_.particles.id[i]; });
  by_id(s.events, [this](std::size_t i) { return state_.particles.event[i]; });
  if (model_.options.snows.size() > 1)
    by_id(s.material_ids, [this](std::size_t i) { return state_.particles.material_id[i]; });
  return s;
}

template <class T, int D>
MotionSummary SolverImpl<T, D>::motion(double speed) const {
  const Particles<T, D>& p = state_.particles;
  return motion_of(
      p.size(), speed, [&p](std::size_t i) { return double(p.mass[i]); },
      [&p](std::size_t i) {
        double v2 = 0;
        for (const auto& v : p.velocity) v2 += double(v[i]) * double(v[i]);
        return v2;
      });
}

template <class T, int D>
std::size_t SolverImpl<T, D>::bytes() const {
  std::size_t total =
      workspace_.grid.bytes() + (workspace_.average ? workspace_.average->bytes() : 0);
  state_.particles.for_each_array(
      [&total](const char*, const auto& array) { total += bytes_of(array); });
  return total;
}

template class SolverImpl<float, 2>;
template class SolverImpl<float, 3>;
template class SolverImpl<double, 2>;
template class SolverImpl<double, 3>;

}  // namespace snowshed::methods::mpm
