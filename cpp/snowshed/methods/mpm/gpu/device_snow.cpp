#include "snowshed/methods/mpm/gpu/device_snow.hpp"

#include <algorithm>
#include <cmath>

#include "snowshed/methods/mpm/gpu/device_sort.hpp"

namespace snowshed::methods::mpm::gpu {
namespace {

/// Thread blocks and threads of the kernel of the strays, of which there are few.
constexpr unsigned max_stray_blocks = 64, stray_threads = 64;

double power_of_two_above(double x) {
  int exponent;
  std::frexp(x, &exponent);
  return std::ldexp(1.0, exponent);
}

/// An upper bound of the norm of the Kirchhoff stress of snow that is sound, Pa.
double largest_stress(const material::Elasticity<double>& e) {
  return elastic_strain_limit * (2 * e.mu + 3 * e.bulk);
}

}  // namespace

DeviceSnow::DeviceSnow(snowshed::gpu::Device& device, const Model<float, 3>& model)
    : device_(device),
      model_(model),
      particles_(device),
      forces_(device, model.options.forces ? model.boundary.size() : 0),
      average_(device, model.options.settings),
      events_(device, model),
      energy_(device, model.options.energy),
      first_(device),
      around_(device),
      order_(device),
      strays_(device),
      fastest_(device),
      awake_(device),
      asleep_blocks_(device),
      active_(device),
      idle_(device),
      listed_(device),
      integers_(device),
      asleep_(device),
      carried_(device),
      force_(device),
      velocity_(device),
      change_(device),
      ranges_(device),
      friction_(device),
      friction_shares_(device),
      first_contact_(device),
      conditions_(device),
      contacts_(device),
      snows_(device),
      motions_(device),
      cell_ranges_(device),
      control_(device) {
  const Settings& n = model.options.settings;
  constants_.courant_factor = n.courant_factor;
  constants_.strain_limit = n.strain_limit;
  constants_.dx = n.dx;
  constants_.friction_reach = friction_reach * n.dx;
  constants_.gravity = float(model.options.gravity);
  constants_.relaxation_time = n.relaxation_time;
  constants_.event_tolerance = contact_tolerance * n.dx;
  constants_.average_rate = n.damping_rate.value_or(0.0);
  constants_.average_share = average_.share_of_length();
  // The share of FLIP does not depend on the step, unless there is a rate.
  const bool has_rate = n.damping_rate && !n.damps_over_length() && n.transfer != Transfer::apic;
  constants_.damping_rate = float(has_rate ? *n.damping_rate : -1.0);
  constants_.flip_ratio = float(n.transfer == Transfer::apic ? 0.0 : n.flip_share(0.0));
  constants_.snow = model.constants.front();
  snows_.upload(model.constants);
  constants_.snows = snows_.data();
  std::vector<float> friction, shares;
  std::vector<std::int32_t> conditions;
  for (const ContactLaw& law : model.boundary.laws()) {
    friction.push_back(float(law.friction));
    conditions.push_back(std::int32_t(law.condition));
  }
  shares.assign(friction.size(), 1.0f);
  friction_.upload(friction);
  friction_shares_.upload(shares);
  conditions_.upload(conditions);
  control_.resize(1);
}

void DeviceSnow::upload(HostState& state) {
  particles_.upload(state.particles);
  strays_.resize(particles_.size());
  find_units(state);
  upload_layout(state);
}

/// Units large enough for every sound particle, see `unit_bits`.
void DeviceSnow::find_units(const HostState& state) {
  const auto& mass = state.particles.mass;
  const double largest = double(*std::max_element(mass.begin(), mass.end()));
  double force = 0;
  for (const Material& snow : model_.materials)
    force = std::max(
        force, largest / snow.density / model_.options.settings.dx * largest_stress(snow.elastic));
  constants_.mass_unit = float(power_of_two_above(largest));
  constants_.force_unit = float(power_of_two_above(force));
  constants_.elastic_limit = state.elastic_limit;
  constants_.friction_memory = state.friction_memory;
}

void DeviceSnow::upload_layout(HostState& state) {
  const BlockLayout<3>& layout = state.layout;
  blocks_ = std::int32_t(layout.particle_blocks.size());
  first_.upload(layout.first);
  around_.upload(layout.around_particles.front().data(), std::size_t(blocks_) * neighbours);
  const std::size_t grid_blocks = layout.grid_blocks.size(), nodes = grid_blocks * nodes_of_block;
  integers_.resize(nodes * node_stride);
  if (state.sleep.allowed()) asleep_.resize(nodes * node_stride);
  for (DeviceArray<Quad>* values : {&carried_, &force_, &velocity_}) values->resize(nodes);
  change_.resize(nodes);
  ranges_.resize(grid_blocks * 6);
  motions_.resize(std::size_t(blocks_));
  fastest_.resize(std::size_t(blocks_));
  fastest_.clear();
  average_.connect(state);
  events_.connect(state);
  energy_.connect(state);
  upload_contacts(state);
  upload_sleep(state);
}

void DeviceSnow::upload_contacts(HostState& state) {
  std::vector<std::int32_t> first{0};
  std::vector<Contact<float>> all;
  for (std::size_t g = 0; g < state.layout.grid_blocks.size(); ++g) {
    const Contact<float>* begin = state.contacts.of_block(g);
    all.insert(all.end(), begin, begin + state.contacts.count(g));
    first.push_back(std::int32_t(all.size()));
  }
  first_contact_.upload(first);
  contacts_.upload(all);
  forces_.upload(state);
}

void DeviceSnow::upload_sleep(const HostState& state) {
  awake_.upload(state.sleep.awake());
  active_.upload(state.sleep.active());
  idle_.upload(state.sleep.idle());
  events_.follow_sleep(state);
  std::vector<std::int32_t> asleep;
  for (std::int32_t b = 0; b < blocks_; ++b)
    if (state.sleep.states()[std::size_t(b)].asleep) asleep.push_back(b);
  asleep_blocks_.upload(asleep);
  launch(device_, "clear_nodes", {unsigned(idle_.size()), node_threads}, grid(), idle_.data());
}

void DeviceSnow::download(HostState& state) const {
  particles_.download(state.particles);
  events_.download(state);
  download_contacts(state);
}

void DeviceSnow::download_blocks(HostState& state, const std::vector<std::int32_t>& blocks) {
  std::vector<std::int32_t> particles;
  for (const std::int32_t b : blocks)
    for (std::int32_t i = state.layout.first[b]; i < state.layout.first[b + 1]; ++i)
      particles.push_back(i);
  particles_.download(state.particles, particles);
}

void DeviceSnow::download_contacts(HostState& state) const {
  contacts_.download(state.contacts.all().data());
  forces_.download(state);
}

void DeviceSnow::sort(HostState& state) {
  events_.download(state);
  download_contacts(state);
  launch_moves(device_, particles_.view(), {first_.data(), around_.data()}, blocks_, listed_);
  SortPlan plan = plan_sort(state.layout, listed_.download());
  BlockLayout<3> next =
      state.layout.rearranged(std::move(plan.blocks), std::move(plan.first), model_.max_threads);
  state.adopt(model_, std::move(next), model_.max_threads, [&] {
    if (!plan.any_moves) return;
    listed_.upload(plan.starts);
    order_.resize(particles_.size());
    launch(device_, "find_order", {unsigned(blocks_), particle_threads}, particles_.view(),
           BlockTable{first_.data(), around_.data()},
           static_cast<const std::int32_t*>(listed_.data()), order_.data());
    particles_.permute(order_);
  });
  upload_layout(state);
}

void DeviceSnow::scatter(Control& control) {
  if (model_.has_affine()) find_spin(control);
  const double speed = 2 * std::sqrt(double(control.speed_squared));
  const double bound = std::max(speed + arm * double(control.spin) * constants_.dx, 1e-12);
  control.momentum_unit = constants_.mass_unit * float(power_of_two_above(bound));
  control.strays = 0;
  control_.upload(&control, 1);
  integers_.clear();
  launch_particles("scatter", awake_, integers_.data());
  launch_strays("scatter_strays", integers_.data());
  energy_.add_particles(awake_, first_, nullptr);
  if (asleep_.size() == 0) return;
  asleep_.clear();
  launch_particles("scatter", asleep_blocks_, asleep_.data());
  energy_.add_particles(asleep_blocks_, first_, nullptr);
  if (!average_.exists()) return;
  average_.clear_asleep();
  launch_average(asleep_blocks_, true);
}

void DeviceSnow::launch_average(const DeviceArray<std::int32_t>& list, bool asleep) {
  launch(device_, "scatter_average", {unsigned(list.size()), particle_threads},
         launch_of(list, integers_.data()), std::int32_t(asleep),
         static_cast<const Control*>(control_.data()), constants_);
}

void DeviceSnow::find_event_contacts() {
  events_.find_all_contacts(launch_of(awake_, integers_.data()), particles_.size(), constants_);
}

void DeviceSnow::find_spin(Control& control) {
  constexpr unsigned threads = 256;
  control.spin = 0;
  control_.upload(&control, 1);
  launch(device_, "find_spin", {(unsigned(particles_.size()) + threads - 1) / threads, threads},
         particles_.view(), std::int32_t(particles_.size()), control_.data());
  control_.download(&control);
}

void DeviceSnow::run(Control& control, int rounds) {
  control_.upload(&control, 1);
  launch(device_, "next_step", {1, 1}, control_.data(), constants_);
  for (int i = 0; i < rounds; ++i) launch_round();
  control_.download(&control);
}

/// Takes one step, or finds that it must be shorter; if the host is waited for, does nothing.
void DeviceSnow::launch_round() {
  if (model_.boundary.any_slip())
    launch(device_, "find_friction_shares", {unsigned(conditions_.size()), particle_threads},
           contacts(), std::int32_t(contacts_.size()), friction_shares_.data(),
           static_cast<const Control*>(control_.data()));
  events_.search(launch_of(awake_, integers_.data()), control_.data(), constants_);
  const DeviceArray<std::int32_t>& lone = events_.meet() ? events_.lone_blocks() : active_;
  launch(device_, energy_.is_kept() ? "node_step_energy" : "node_step",
         {unsigned(lone.size()), node_threads}, grid(),
         static_cast<const std::int32_t*>(lone.data()), contacts(), forces_.view(), energy_.view(),
         control_.data(), constants_);
  events_.launch_step(grid(), contacts(), forces_.view(), energy_.view(), control_.data(),
                      constants_);
  launch(device_, "probe", {unsigned(awake_.size()), particle_threads},
         launch_of(awake_, integers_.data()), control_.data(), constants_);
  launch(device_, "judge_step", {1, 1}, control_.data(), constants_);
  launch(device_, "record_forces", {forces_.obstacles(), particle_threads},
         static_cast<const std::int32_t*>(active_.data()), std::int32_t(active_.size()), contacts(),
         forces_.view(), static_cast<const Control*>(control_.data()));
  if (average_.exists()) {
    launch_average(awake_, false);
    launch(device_, "average_nodes", {average_.coarse_blocks(), node_threads}, average_.view(),
           static_cast<const Control*>(control_.data()), constants_);
  }
  launch_particles("particle_step", awake_, integers_.data());
  launch_strays("stray_step", integers_.data());
  energy_.add_particles(awake_, first_, control_.data());
  energy_.record(active_, control_.data());
  launch(device_, "next_step", {1, 1}, control_.data(), constants_);
}

std::string DeviceSnow::named(const char* kernel) const {
  return std::string(kernel) + (model_.material_per_particle ? "_several" : "") +
         (model_.has_affine() ? "_affine" : "") + (energy_.is_kept() ? "_energy" : "");
}

void DeviceSnow::launch_particles(const char* kernel, const DeviceArray<std::int32_t>& list,
                                  unsigned long long* integers) {
  launch(device_, named(kernel).c_str(), {unsigned(list.size()), particle_threads},
         launch_of(list, integers), control_.data(), constants_);
}

void DeviceSnow::launch_strays(const char* kernel, unsigned long long* integers) {
  const unsigned blocks =
      std::min(max_stray_blocks, unsigned(particles_.size() / (stray_threads * 64)) + 1);
  launch(device_, named(kernel).c_str(), {blocks, stray_threads}, launch_of(awake_, integers),
         blocks_, control_.data(), constants_);
}

void DeviceSnow::stop(const std::vector<std::int32_t>& blocks) {
  listed_.upload(blocks);
  launch(device_, "stop_blocks", {unsigned(blocks.size()), node_threads},
         launch_of(listed_, integers_.data()));
}

std::vector<BlockMotion> DeviceSnow::motions(const Sleep<3>& sleep) {
  std::vector<std::int32_t> blocks = sleep.awake();
  blocks.insert(blocks.end(), sleep.border().begin(), sleep.border().end());
  listed_.upload(blocks);
  launch(device_, "measure_motion", {unsigned(blocks.size()), node_threads},
         launch_of(listed_, integers_.data()), motions_.data());
  return motions_.download();
}

std::vector<CellRange> DeviceSnow::cell_ranges(const DeviceArray<std::int32_t>& blocks) {
  cell_ranges_.resize(std::size_t(blocks_));
  launch(device_, "find_cell_ranges", {unsigned(blocks.size()), node_threads},
         launch_of(blocks, integers_.data()), cell_ranges_.data());
  return cell_ranges_.download();
}

ParticleLaunch DeviceSnow::launch_of(const DeviceArray<std::int32_t>& list,
                                     unsigned long long* integers) const {
  return {particles_.view(), {first_.data(), around_.data()},
          list.data(),       grid(),
          strays_.data(),    integers,
          average_.view(),   fastest_.data(),
          energy_.view()};
}

GridArrays DeviceSnow::grid() const {
  return {integers_.data(), asleep_.size() > 0 ? asleep_.data() : nullptr,
          carried_.data(),  force_.data(),
          velocity_.data(), change_.data(),
          ranges_.data()};
}

ContactArrays DeviceSnow::contacts() const {
  return {first_contact_.data(), contacts_.data(), conditions_.data(), friction_.data(),
          friction_shares_.data()};
}

std::size_t DeviceSnow::bytes() const {
  std::size_t sum =
      particles_.bytes() + forces_.bytes() + average_.bytes() + events_.bytes() + energy_.bytes();
  const auto add = [&](const auto&... arrays) { sum += (std::size_t(0) + ... + arrays.bytes()); };
  add(first_, around_, order_, strays_, awake_, asleep_blocks_, active_, idle_, listed_, integers_,
      asleep_, carried_, force_, velocity_, change_, ranges_, first_contact_, contacts_, motions_,
      cell_ranges_, fastest_);
  return sum;
}

}  // namespace snowshed::methods::mpm::gpu
