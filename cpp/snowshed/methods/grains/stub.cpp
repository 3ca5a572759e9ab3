// A stand-in until the solver is merged.
#include <cmath>
#include <map>
#include "snowshed/core/errors.hpp"
#include "snowshed/io/binary_archive.hpp"
#include "snowshed/methods/grains/solver.hpp"
#include "snowshed/particles/field_sources.hpp"
#include "snowshed/particles/quantities.hpp"

namespace snowshed {
namespace {
bool surface(const LabelImage& im, std::size_t i, std::size_t j, std::size_t k) {
  const int l = im.at(i, j, k);
  if (i == 0 || j == 0 || k == 0 || i + 1 == im.size[0] || j + 1 == im.size[1] || k + 1 == im.size[2]) return true;
  return im.at(i - 1, j, k) != l || im.at(i + 1, j, k) != l || im.at(i, j - 1, k) != l ||
         im.at(i, j + 1, k) != l || im.at(i, j, k - 1) != l || im.at(i, j, k + 1) != l;
}
class Stub : public GrainsMethod {
 public:
  explicit Stub(GrainsOptions o) : o_(std::move(o)) {}
  std::vector<ParticleBatch> seed() const override {
    ParticleBatch b;
    for (const Clump& c : o_.sample.clumps) {
      b.positions.push_back(c.centre);
      b.masses.push_back(c.volume * 917);
    }
    return {b};
  }
  std::size_t count_spheres() const override { return o_.sample.spheres.size(); }
  int stage() const override { return stage_; }
  LoadingMeasures measures() const override {
    LoadingMeasures m;
    m.stage = stage_;
    m.strain = strain_;
    m.axial_strain = axial_;
    m.top_stress = 1e6 * axial_;
    m.bottom_stress = m.top_stress;
    m.bonds = std::int64_t(o_.sample.bonds.size());
    m.broken_in_tension = std::int64_t(100 * std::max(0.0, axial_ - 0.01));
    m.bonds -= m.broken_in_tension;
    m.contacts = m.bonds;
    m.coordination = 3;
    m.solid_fraction = 0.3;
    return m;
  }
  std::vector<GrainContact> grain_contacts() const override {
    std::map<std::pair<std::uint32_t, std::uint32_t>, GrainContact> all;
    const auto of = sphere_grains();
    for (const BondedPair& b : o_.sample.bonds) {
      auto key = std::make_pair(of[b.first], of[b.second]);
      auto& c = all[key];
      c = {key.first, key.second, o_.sample.spheres[b.first], Vec3(0, 0, 1e-3 * axial_), true};
    }
    std::vector<GrainContact> out;
    for (auto& [k, c] : all) out.push_back(c);
    return out;
  }
  std::vector<Vec3> sphere_positions() const override { return o_.sample.spheres; }
  std::vector<std::uint32_t> sphere_grains() const override {
    std::vector<std::uint32_t> of;
    for (std::uint32_t g = 0; g < o_.sample.clumps.size(); ++g)
      of.insert(of.end(), o_.sample.clumps[g].spheres, g);
    return of;
  }
  void add(const std::vector<ParticleBatch>&) override { n_ = o_.sample.clumps.size(); order_.clear(); for (std::uint32_t i = 0; i < n_; ++i) order_.push_back(i); }
  void replace(const std::vector<ParticleBatch>&) override {}
  void add_velocity(const std::vector<Vec3>&) override {}
  void settle(const std::vector<double>&, const std::vector<double>&) override {}
  void step() override {
    if (std::size_t(stage_) >= o_.loading.size()) return;
    const auto& s = o_.loading[std::size_t(stage_)];
    const double h = o_.sample.box.z();
    time_ += dt_;
    ++c_.steps;
    c_.particle_updates += std::int64_t(o_.sample.spheres.size());
    if (s.kind == LoadingKind::hold) { strain_ += 1e-3; } else strain_ += s.speed * dt_ / h;
    if (s.kind == LoadingKind::compress) axial_ += s.speed * dt_ / h;
    if (strain_ >= s.strain || (s.stress > 0 && s.kind == LoadingKind::compress && 1e6 * axial_ >= s.stress)) ++stage_, strain_ = 0;
  }
  bool at_safe_point() const override { return true; }
  std::optional<bool> at_rest() const override { return std::size_t(stage_) >= o_.loading.size(); }
  double time() const override { return time_; }
  double time_step() const override { return dt_; }
  const StepCounters& counters() const override { return c_; }
  std::vector<FieldInfo> fields() const override { return {}; }
  FieldView field(const std::string& name) const override { throw InputError(name, "no field"); }
  const std::vector<std::uint32_t>& order_by_id() const override { return order_; }
  std::size_t size() const override { return n_; }
  ParticleState state() const override {
    ParticleState s;
    for (std::size_t i = 0; i < n_; ++i) {
      s.positions.push_back(o_.sample.clumps[i].centre);
      s.velocities.push_back(Vec3::Zero());
      s.masses.push_back(o_.sample.clumps[i].volume * 917);
      s.ids.push_back(std::uint32_t(i));
      s.events.push_back(1);
      s.volume_ratios.push_back(1); s.densities.push_back(917); s.plastic_strains.push_back(0); s.pressures.push_back(0);
    }
    return s;
  }
  MotionSummary motion(double) const override { return {}; }
  EnergyBalance energy() const override { return {}; }
  std::size_t bytes() const override { return o_.sample.spheres.size() * 300; }
  void save(BinaryWriter& out) const override {
    out.add("stub", std::vector<double>{time_, strain_, axial_, double(stage_), double(c_.steps), double(n_)});
  }
  void load(const BinaryReader& in) override {
    auto v = in.get<double>("stub", 6);
    time_ = v[0]; strain_ = v[1]; axial_ = v[2]; stage_ = int(v[3]); c_.steps = std::int64_t(v[4]);
    add({});
  }
  GrainsOptions o_;
  std::size_t n_ = 0;
  double time_ = 0, dt_ = 2e-6, strain_ = 0, axial_ = 0;
  int stage_ = 0;
  StepCounters c_;
  std::vector<std::uint32_t> order_;
};
}  // namespace

GrainSample make_sample(const LabelImage& im) {
  GrainSample s;
  for (int a = 0; a < 3; ++a) s.box[a] = double(im.size[std::size_t(a)]) * im.voxel_size;
  s.radius = im.voxel_size / 2;
  std::map<int, std::vector<std::array<std::size_t, 3>>> voxels;
  for (std::size_t k = 0; k < im.size[2]; ++k)
    for (std::size_t j = 0; j < im.size[1]; ++j)
      for (std::size_t i = 0; i < im.size[0]; ++i)
        if (im.at(i, j, k) > 0) voxels[im.at(i, j, k)].push_back({i, j, k});
  std::map<std::size_t, std::uint32_t> number;
  for (auto& [label, list] : voxels) {
    Clump c;
    c.first_sphere = std::uint32_t(s.spheres.size());
    for (auto& [i, j, k] : list) {
      const Vec3 x = im.voxel_size * Vec3(double(i) + .5, double(j) + .5, double(k) + .5);
      c.centre += x / double(list.size());
      if (surface(im, i, j, k)) {
        number[(k * im.size[1] + j) * im.size[0] + i] = std::uint32_t(s.spheres.size());
        s.spheres.push_back(x);
      }
    }
    c.spheres = std::uint32_t(s.spheres.size()) - c.first_sphere;
    c.volume = double(list.size()) * std::pow(im.voxel_size, 3);
    s.clumps.push_back(c);
  }
  const std::size_t steps[] = {1, im.size[0], im.size[0] * im.size[1]};
  for (auto& [at, n] : number)
    for (std::size_t st : steps) {
      auto other = number.find(at + st);
      if (other != number.end() && im.labels[at] != im.labels[at + st]) s.bonds.push_back({n, other->second});
    }
  return s;
}
SampleSize measure_sample(const LabelImage& im) {
  const GrainSample s = make_sample(im);
  return {s.clumps.size(), s.spheres.size(), s.bonds.size(), s.spheres.size() * 400};
}
std::unique_ptr<GrainsMethod> make_grains(GrainsOptions o) { return std::make_unique<Stub>(std::move(o)); }
}  // namespace snowshed
