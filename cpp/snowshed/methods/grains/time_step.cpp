#include "snowshed/methods/grains/time_step.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>

#include "snowshed/core/errors.hpp"
#include "snowshed/methods/grains/contacts.hpp"

namespace snowshed::methods::grains {
namespace {

/// Stiffness of a grain's pairs against its displacement and its rotation, in the grain's frame.
struct GrainStiffness {
  double against_moving = 0;
  Mat3 against_turning = Mat3::Zero();

  void add(double stiffness, const Vec3& arm) {
    against_moving += stiffness;
    against_turning += stiffness * (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose());
  }
};

}  // namespace

double max_step(const Model& model, const Boundary& boundary, const PairList& list,
                const std::vector<GrainPose>& poses) {
  const double k = std::max(model.law.normal_stiffness, model.law.shear_stiffness);
  std::vector<GrainStiffness> stiffness(poses.size());
  for_each_listed_pair(
      model, boundary, list, [&](std::uint32_t body) { return poses[body]; },
      [&](const PairGroup& g, std::size_t, const PairGeometry& pair) {
        stiffness[g.first].add(k, poses[g.first].orientation.conjugate() * pair.arm_a);
        if (g.second < poses.size())
          stiffness[g.second].add(k, poses[g.second].orientation.conjugate() * pair.arm_b);
      });
  double fastest = 0;  // 1/s2
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const GrainConstants& grain = model.grains[i];
    const Vec3 root = grain.inertia.cwiseSqrt().cwiseInverse();
    const Mat3 relative = root.asDiagonal() * stiffness[i].against_turning * root.asDiagonal();
    Eigen::SelfAdjointEigenSolver<Mat3> turning;
    turning.computeDirect(relative, Eigen::EigenvaluesOnly);
    fastest = std::max({fastest, std::max(k, stiffness[i].against_moving) / grain.inertial_mass,
                        turning.eigenvalues().maxCoeff()});
  }
  return model.settings.courant_factor / std::sqrt(fastest);
}

double choose_step(const Model& model, const State& state, double max_step) {
  double fastest = state.boundary.top_speed();
  if (state.loading.stage < int(model.loading.size()))
    fastest = std::max(fastest, model.loading[std::size_t(state.loading.stage)].speed);
  for (std::size_t i = 0; i < state.bodies.size(); ++i) {
    const GrainBody& body = state.bodies[i];
    const GrainConstants& grain = model.grains[i];
    const double spin = body.spin_momentum.norm() / grain.inertia.minCoeff();
    fastest = std::max(fastest, body.velocity.norm() + spin * (grain.reach + model.radius));
  }
  const double dt = fastest > 0 ? std::min(max_step, 0.2 * model.radius / fastest) : max_step;
  if (!(dt > 1e-18))
    throw SimulationError("the time step has fallen to " + std::to_string(dt) +
                          " s: a grain moves at " + std::to_string(fastest) + " m/s");
  return dt;
}

}  // namespace snowshed::methods::grains
