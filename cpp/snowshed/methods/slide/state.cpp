#include "snowshed/methods/slide/state.hpp"

namespace snowshed {
namespace {

BorderSlope border_slope(const SlideSettings& s) {
  return s.mode == SlideMode::compatible ? BorderSlope::level_in_the_south_west
                                         : BorderSlope::one_sided;
}

std::vector<double> resistance_at_nodes(const SlideSettings& s, const SlideAreas& areas,
                                        const Terrain& terrain) {
  if (areas.resistance.empty()) return {};
  std::vector<SlideArea> covered = areas.resistance;
  for (SlideArea& area : covered) area.thickness = 1;
  std::vector<double> values = thickness_at_nodes(covered, terrain, Reach::edge);
  for (double& value : values) value = value > 0 ? s.resistance : 0.0;
  return values;
}

/// Where snow is released, none is entrained.
std::vector<double> erodible_at_nodes(const SlideModel& model) {
  if (model.areas.entrainment.empty()) return {};
  std::vector<double> values =
      thickness_at_nodes(model.areas.entrainment, model.terrain, Reach::edge);
  const Reach reach = model.compatible() ? Reach::one_cell : Reach::edge;
  const std::vector<double> released =
      thickness_at_nodes(model.areas.release, model.terrain, reach);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = released[i] > 0 ? 0.0 : values[i] * model.settings.entrained_density;
  return values;
}

}  // namespace

SlideModel::SlideModel(const SlideSettings& s, double g, const HeightField& field, SlideAreas a,
                       bool keeps)
    : settings(s),
      gravity(g),
      terrain(field, border_slope(s)),
      areas(std::move(a)),
      friction(BasalFriction::from(s, g)),
      resistance(resistance_at_nodes(s, areas, terrain)),
      threads(threads_to_use(s.threads)),
      keeps_energy(keeps) {}

SlideState::SlideState(const SlideModel& model)
    : peaks(std::size_t(model.terrain.columns()) * std::size_t(model.terrain.rows())),
      erodible(erodible_at_nodes(model)),
      step(model.settings.time_step) {}

void SlideWork::make_room(const SlideModel& model, SlideState& state) {
  // Each particle may split.
  const std::size_t now = state.particles.size(), most = state.erodible.empty() ? now : 2 * now;
  state.particles.for_each_array([most](const char*, auto& array) { array.reserve(most); });
  places.reserve(most);
  normals.reserve(most);
  thickness.reserve(most);
  loads.resize(now);
  predicted.resize(now);
  entrained.resize(state.erodible.empty() ? 0 : now);
  removed.resize(now);
  new_places.reserve(most);
  piece_sums.resize(now / std::size_t(particles_in_piece) + 1);
  bond_forces.resize(state.bonds.size());
  broken.resize(state.bonds.size());
  bond_lists.reserve(most, state.bonds.size());
  cells.reserve(most, model.terrain);
  entry_z.reserve(most);
  entry_nz.reserve(most);
  fields.reserve(model.terrain);
  if (model.keeps_energy) audit.reserve(now);
}

void refresh(const SlideModel& model, const SlideState& state, SlideWork& work) {
  const SlideParticles& p = state.particles;
  work.places.resize(p.size());
  work.normals.resize(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    work.places[i] = model.terrain.place(p.x[i], p.y[i]);
    work.normals[i] = model.terrain.normal(work.places[i]);
  }
  work.bond_lists.update(state.bonds, p.size());
  refresh_fields(model, state, work);
}

void refresh_fields(const SlideModel& model, const SlideState& state, SlideWork& work) {
  const SlideParticles& p = state.particles;
  work.cells.update(p, work.places, model.threads);
  work.fields.update(model.terrain, p, work.places, work.cells, model.settings.density,
                     model.threads);
  work.thickness.resize(p.size());
  parallel_pieces(std::ptrdiff_t(p.size()), model.threads, particles_in_piece,
                  [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                    for (std::ptrdiff_t i = begin; i < end; ++i)
                      work.thickness[i] = work.fields.thickness(work.places[i]);
                  });
}

}  // namespace snowshed
