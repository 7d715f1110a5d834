// Chains of rods and spinning bodies that nothing drives: scenes whose energy and momenta theory knows.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "blem_sim/dynamics/world.h"

namespace blem_sim {

struct ChainLink {
  double mass, length;
};

/** Lengths and masses from one to the other, geometrically. */
inline std::vector<ChainLink> taper(int links, ChainLink first, ChainLink last) {
  std::vector<ChainLink> out;
  for (int i = 0; i < links; ++i) {
    const double share = links > 1 ? i / (links - 1.0) : 0;
    out.push_back({first.mass * std::pow(last.mass / first.mass, share), first.length * std::pow(last.length / first.length, share)});
  }
  return out;
}

/** A thin rod along x from the body frame's origin. */
inline dynamics::BodySpec rod(const ChainLink& link) {
  dynamics::BodySpec spec;
  spec.inertial.mass = link.mass;
  spec.inertial.com = {link.length / 2, 0, 0};
  const double across = link.mass * link.length * link.length / 12, radius = link.length / 20;
  spec.inertial.inertia = Vector3(0.5 * link.mass * radius * radius, across, across).asDiagonal();
  return spec;
}

struct ChainOptions {
  bool held = true;            ///< by the world, with a joint
  bool alternates = false;     ///< axes in turn y and z of the links, else all y
  double fold = 0;             ///< [rad] of every second link against the others
  double bend = 0;             ///< [rad] of each link against the one before
  int slider = -1;             ///< joint that is prismatic, along its link
  std::vector<int> followers;  ///< links whose joints follow the first one, and turn as much
  Vector3 gravity{0, 0, -9.81};
};

/** Hangs from the origin and lies along x, or is folded. */
class Chain {
 public:
  Chain(const std::vector<ChainLink>& links, const ChainOptions& options = {}, const dynamics::SolverSettings& settings = {})
      : world(options.gravity, settings) {
    Pose X_WL = Pose::Identity();
    for (std::size_t i = 0; i < links.size(); ++i) {
      dynamics::JointSpec joint;
      const bool grounded = i == 0;
      joint.axis = options.alternates && i % 2 == 1 ? Vector3::UnitZ() : Vector3::UnitY();
      const bool slides = static_cast<int>(i) == options.slider;
      if (slides) {
        joint.kind = dynamics::JointKind::PRISMATIC;
        joint.axis = Vector3::UnitX();
      }
      const double angle = slides ? 0 : i % 2 == 1 ? options.bend + options.fold : grounded ? 0 : options.bend - options.fold;
      if (!grounded) joint.X_PJ = makePose({links[i - 1].length, 0, 0});
      X_WL = X_WL * joint.X_PJ * Pose(Eigen::AngleAxisd(angle, joint.axis));
      dynamics::BodySpec spec = rod(links[i]);
      spec.X_WB = X_WL;
      if (std::count(options.followers.begin(), options.followers.end(), static_cast<int>(i)) > 0)
        joint.mimic_joint = 0, joint.mimic_offset = angle - world.jointState(0).position;
      joint.child = world.addBody(spec);
      joint.parent = grounded ? dynamics::WORLD_BODY : joint.child - 1;
      if (!grounded || options.held) world.addJoint(joint, angle);
    }
    drives.resize(world.jointCount());
    first_energy = energy();
  }
  const dynamics::SolveResult& step(double dt) {
    const dynamics::SolveResult& result = world.step(dt, {}, drives);
    too_fast += result.too_fast;
    return result;
  }
  double energy() const { return world.kineticEnergy() + world.potentialEnergy(); }
  Vector3 momentum() const {
    Vector3 sum = Vector3::Zero();
    for (int i = 0; i < world.bodyCount(); ++i) sum += world.bodySpec(i).inertial.mass * world.bodyState(i).v_WCom;
    return sum;
  }
  /** Angular momentum about the world's origin. */
  Vector3 angularMomentum() const {
    Vector3 sum = Vector3::Zero();
    for (int i = 0; i < world.bodyCount(); ++i) {
      const dynamics::BodyState s = world.bodyState(i);
      const geometry::MassProperties& body = world.bodySpec(i).inertial;
      const Matrix3 R = s.X_WB.linear();
      sum += R * body.inertia * R.transpose() * s.w_WB + body.mass * (s.X_WB * body.com).cross(s.v_WCom);
    }
    return sum;
  }
  /** [J] from here to where it all hangs down. */
  double energyAboveRest(const std::vector<ChainLink>& links) const {
    double depth = 0, lowest = 0;
    for (const ChainLink& link : links) {
      lowest -= link.mass * world.gravity().norm() * (depth + link.length / 2);
      depth += link.length;
    }
    return first_energy - lowest;
  }

  dynamics::World world;
  std::vector<dynamics::JointDrive> drives;
  double first_energy = 0;
  int too_fast = 0;
};

/** A body of inertia 1:2:3 that spins about one of its principal axes, slightly perturbed. */
class Spinner {
 public:
  Spinner(int axis, double spin, double perturbation = 1e-3) : world(Vector3::Zero(), {}) {
    dynamics::BodySpec spec;
    spec.inertial.mass = 1;
    spec.inertial.inertia = Vector3(0.01, 0.02, 0.03).asDiagonal();
    body = world.addBody(spec);
    dynamics::BodyState state;
    state.w_WB = Vector3::Constant(perturbation * spin);
    state.w_WB[axis] = spin;
    world.setBodyState(body, state);
  }
  Vector3 momentum() const {
    const dynamics::BodyState s = world.bodyState(body);
    const Matrix3 R = s.X_WB.linear();
    return R * world.bodySpec(body).inertial.inertia * R.transpose() * s.w_WB;
  }
  /** Spin in the body's axes. */
  Vector3 bodySpin() const { return world.bodyState(body).X_WB.linear().transpose() * world.bodyState(body).w_WB; }

  dynamics::World world;
  int body;
};

}  // namespace blem_sim
