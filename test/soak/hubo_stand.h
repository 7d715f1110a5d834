// The Hubo of the shared data on a plane, its contacts written down: points of the soles, or corners of every link.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "build/simulated_world.h"
#include "dynamics/analytic_contacts.h"
#include "support/shared_data.h"

namespace blem_sim {

constexpr const char* HUBO_FOLDER = "robots/klampt/huboplus";
constexpr const char* HUBO_SWAY = "motions/hubo_sway_path_opt.csv";

struct HuboOptions {
  dynamics::SolverSettings settings;
  int sole_contacts = 50;     ///< on both soles together: 0, 4 (outer corners), 8, 20, 50 or 100
  bool link_corners = false;  ///< eight corners of every link's bounding box touch too
  bool compliant = false;     ///< the shared data's stiffness and damping of feet on ground, else rigid
  double drop = 5e-4;         ///< [m] of the lowest contact point above the ground at the start
  double margin = dynamics::CONTACT_MARGIN;
  double effort_scale = 1;
  bool joint_friction = true;
  std::optional<double> stiffness;         ///< of every joint, without damping and effort limit, instead of the servo's
  std::optional<double> finger_stiffness;  ///< of the fingers alone
  std::string start_at;                    ///< motion (CSV file) whose first row is the start, else the posture of worlds/hubo_plane
};

/** A point of a body that may touch the ground. */
struct GroundPoint {
  int body;
  Vector3 p_B;
  std::uint64_t id;
};

/**
 * Built by the simulation's own robot builder: real masses, joints, limits, dry and viscous friction; the servo is the implicit PD with
 * the robot's servoP and servoD (its servoI makes joints with dry friction hunt). Gravity and friction as in worlds/hubo_plane.
 */
class HuboStand {
 public:
  explicit HuboStand(const HuboOptions& options);

  /** Contacts and drives of the coming step. */
  void prepare();
  /** The step alone, for timing. */
  const dynamics::SolveResult& solve() { return sim_.world.step(DT, contacts_, drives_); }
  const dynamics::SolveResult& step() {
    prepare();
    return solve();
  }
  /** Joint targets from a motion of the shared data, from now on. @return [s] its length */
  double follow(const std::string& motion);
  /** Takes over another stand's bodies, joint positions and time. Precondition: same options but for the stepper. */
  void copyState(const HuboStand& other);

  dynamics::World& world() { return sim_.world; }
  const dynamics::World& world() const { return sim_.world; }
  const std::vector<int>& bodies() const { return sim_.models[0].bodies; }
  std::vector<sim::JointMotor>& motors() { return sim_.motors; }
  const std::vector<dynamics::ContactConstraint>& contacts() const { return contacts_; }
  const std::vector<dynamics::JointDrive>& drives() const { return drives_; }
  /** Drives of the joints, which may be changed between prepare() and solve(). */
  std::vector<dynamics::JointDrive>& drives() { return drives_; }
  int leftFoot() const { return feet_[0]; }
  double time() const { return static_cast<double>(steps_) * DT; }
  double weight() const { return weight_; }  ///< [N]
  /** [N] upwards on all bodies, or on one. */
  double groundForce(const dynamics::SolveResult& result, int body = dynamics::WORLD_BODY) const;

  static constexpr double DT = 1e-3;

 private:
  void addSolePoints(int foot_index, int count);
  void addLinkCorners();

  HuboOptions options_;
  sim::SimulatedWorld sim_;
  dynamics::Surface surface_;
  int feet_[2];
  double ground_ = 0, weight_ = 0;
  long steps_ = 0;
  std::vector<GroundPoint> points_;
  std::vector<dynamics::ContactConstraint> contacts_;
  std::vector<dynamics::JointDrive> drives_;
};

}  // namespace blem_sim
