#include "snowshed/methods/grains/check_options.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <sstream>
#include <string>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/message_format.hpp"
#include "snowshed/methods/grains/describe.hpp"

namespace snowshed::methods::grains {
namespace {

[[noreturn]] void refuse(const std::string& where, double value, const std::string& allowed) {
  std::ostringstream text;
  text << value << "; must be " << allowed;
  throw InputError(where, text.str());
}

void check_settings(const Settings& s) {
  const auto positive = [](const char* name, double value) {
    if (!(value > 0 && std::isfinite(value)))
      refuse(std::string("/numerics/") + name, value, "positive");
  };
  const auto not_negative = [](const char* name, double value) {
    if (!(value >= 0)) refuse(std::string("/numerics/") + name, value, "0 or more");
  };
  const auto finite = [](const char* name, double value) {
    if (!(value >= 0 && std::isfinite(value)))
      refuse(std::string("/numerics/") + name, value, "0 or more, and finite");
  };
  positive("elastic_modulus", s.elastic_modulus);
  finite("stiffness_ratio", s.stiffness_ratio);
  not_negative("tensile_strength", s.tensile_strength);
  not_negative("shear_strength", s.shear_strength);
  finite("friction", s.friction);
  positive("density", s.density);
  positive("density_scaling", s.density_scaling);
  if (!(s.damping >= 0 && s.damping < 1))
    refuse("/numerics/damping", s.damping, "from 0 to below 1");
  if (!(s.courant_factor > 0 && s.courant_factor <= 1))
    refuse("/numerics/courant_factor", s.courant_factor, "above 0, and 1 at most");
}

void check_clump(const Sample& sample, std::size_t c, std::size_t spheres) {
  const Clump& clump = sample.clumps[c];
  const std::string where = "grain " + std::to_string(c);
  if (clump.first_sphere != spheres)
    throw InputError(where, "its spheres do not follow those of the grain before");
  if (clump.spheres == 0) throw InputError(where, "it has no spheres");
  if (!(clump.volume > 0) || !std::isfinite(clump.volume) || !clump.center.allFinite())
    throw InputError(where, "its volume or centre is not sound");
  const Mat3& inertia = clump.inertia;
  if (!inertia.allFinite() || !inertia.isApprox(inertia.transpose(), 1e-9))
    throw InputError(where, "its inertia is not symmetric");
  const Vec3 moments = Eigen::SelfAdjointEigenSolver<Mat3>(inertia).eigenvalues();
  if (!(moments[0] > 1e-9 * moments[2])) throw InputError(where, "its inertia is not positive");
}

void check_sample(const Sample& sample) {
  if (!(sample.radius > 0 && std::isfinite(sample.radius)))
    throw InputError("sample", "the radius of its spheres must be positive");
  if (!sample.box.allFinite() || !(sample.box.minCoeff() >= 1.999 * sample.radius))
    throw InputError("sample", "its box must hold at least one sphere along each axis");
  if (!(sample.box.maxCoeff() <= 5e4 * sample.radius))
    throw InputError("sample", "its box is longer than 25000 spheres");
  if (sample.clumps.empty()) throw InputError("sample", "there is no grain");
  if (sample.clumps.size() > 0x7ffffff0 || sample.spheres.size() > 0x7ffffff0)
    throw InputError("sample", "more than 2^31 grains or spheres");
  std::size_t spheres = 0;
  for (std::size_t c = 0; c < sample.clumps.size(); ++c) {
    check_clump(sample, c, spheres);
    spheres += sample.clumps[c].spheres;
  }
  if (spheres != sample.spheres.size())
    throw InputError("sample", std::to_string(sample.spheres.size()) + " spheres given for " +
                                   std::to_string(spheres) + " of the grains");
  for (const Vec3& x : sample.spheres)
    if (!x.allFinite() || (x.array() < 0).any() || (x.array() > sample.box.array()).any())
      throw InputError("sample", "a sphere lies outside of the box");
}

void check_bonds(const Sample& sample) {
  std::vector<std::uint32_t> grain(sample.spheres.size());
  for (std::uint32_t c = 0; c < sample.clumps.size(); ++c)
    for (std::uint32_t s = 0; s < sample.clumps[c].spheres; ++s)
      grain[sample.clumps[c].first_sphere + s] = c;
  const double diameter = 2 * sample.radius;
  for (const BondedPair& bond : sample.bonds) {
    if (bond.first >= grain.size() || bond.second >= grain.size())
      throw InputError("sample", "a bond names a sphere that does not exist");
    if (grain[bond.first] == grain[bond.second])
      throw InputError("sample", "a bond lies within one grain");
    const double distance = (sample.spheres[bond.first] - sample.spheres[bond.second]).norm();
    if (!(std::abs(distance - diameter) <= 1e-6 * diameter))
      throw InputError("sample", "bonded spheres must touch without overlap");
  }
}

void check_stage(const LoadingStage& stage, const std::string& path, const Settings& settings) {
  const std::string kind = quote(name_of(stage.kind));
  if (stage.kind == LoadingKind::stretch && !settings.bonded_plates)
    throw InputError(path + "/kind", kind + " pulls at the plates; set /numerics/bonded_plates");
  const bool takes_stress = stage.kind != LoadingKind::stretch &&
                            stage.kind != LoadingKind::penetrate && stage.kind != LoadingKind::hold;
  if (stage.stress > 0 && !takes_stress)
    throw InputError(path + "/stress", kind + " takes no stress");
}

void check_loading(const Options& o) {
  bool penetrated = false;
  for (std::size_t i = 0; i < o.loading.size(); ++i) {
    const LoadingStage& stage = o.loading[i];
    const std::string where = "/loading/" + std::to_string(i);
    if (!(stage.speed > 0 && std::isfinite(stage.speed)))
      refuse(where + "/speed", stage.speed, "positive");
    if (!(stage.strain > 0 && std::isfinite(stage.strain)))
      refuse(where + "/strain", stage.strain, "positive");
    const bool shrinks =
        stage.kind == LoadingKind::compress || stage.kind == LoadingKind::isotropic;
    if (shrinks && stage.strain >= 1) refuse(where + "/strain", stage.strain, "below 1");
    if (!(stage.stress >= 0 && std::isfinite(stage.stress)))
      refuse(where + "/stress", stage.stress, "0 or more");
    penetrated = penetrated || stage.kind == LoadingKind::penetrate;
  }
  check_stages(o.loading, o.settings);
  if (!penetrated) return;
  if (!(o.cone.radius > 0 && std::isfinite(o.cone.radius)))
    refuse("/cone/radius", o.cone.radius, "positive");
  if (!(o.cone.half_angle > 0 && o.cone.half_angle <= 90))
    refuse("/cone/half_angle", o.cone.half_angle, "above 0, and 90 degrees at most");
}

}  // namespace

void check_stages(const std::vector<LoadingStage>& stages, const Settings& settings) {
  constexpr double max_shortening = 0.95;  // or nothing is left between the plates
  double shortening = 0;
  bool loaded = false, open = false;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const LoadingStage& stage = stages[i];
    const std::string path = "/loading/" + std::to_string(i);
    const bool compresses =
        stage.kind == LoadingKind::compress || stage.kind == LoadingKind::isotropic;
    if (compresses) shortening += stage.strain;
    if (shortening > max_shortening)
      throw InputError(path + "/strain",
                       "the sample would be compressed by " + show_rounded(shortening) +
                           " of its height in all; allowed: up to " + show(max_shortening));
    if (stage.kind == LoadingKind::unload && !loaded)
      throw InputError(path + "/kind", "there is nothing to unload; compress the sample before");
    if (open && stage.kind != LoadingKind::penetrate && stage.kind != LoadingKind::hold)
      throw InputError(path + "/kind",
                       "the stage \"penetrate\" has removed the top plate; allowed: penetrate, "
                       "hold");
    check_stage(stage, path, settings);
    loaded = loaded || compresses;
    open = open || stage.kind == LoadingKind::penetrate;
  }
}

void check_grains(const Options& o) {
  check_settings(o.settings);
  if (!std::isfinite(o.gravity)) refuse("gravity", o.gravity, "finite");
  check_sample(o.sample);
  check_bonds(o.sample);
  check_loading(o);
  if (o.settings.sides == Sides::periodic &&
      std::min(o.sample.box.x(), o.sample.box.y()) < 3 * (2 + 0.5) * o.sample.radius)
    throw InputError("sample", "a periodic sample must be at least four spheres wide");
}

}  // namespace snowshed::methods::grains
