// What users do to a simulation while it runs: one random call of a Simulator after the other, sound ones and ones that it must refuse.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/sim/named_parts.h"
#include "sim/simulation_scene.h"
#include "support/random/random_robot.h"

namespace blem_sim {

/** A call that was made. */
struct Event {
  std::string name;      ///< in words
  bool refused = false;  ///< as InputError
  bool passive = false;  ///< it gives nothing energy later on: no motor, load or model came
};

/** Draws calls from a seed. Models that it spawns are about as large as the scene's. */
class RandomEvents {
 public:
  /** @param size [m] of a body, typically */
  RandomEvents(std::uint64_t seed, double size) : numbers_(seed), size_(size) {}

  /** Makes one call. */
  Event happen(sim::Simulator* simulator) {
    simulator_ = simulator;
    struct Row {
      const char* name;
      bool passive;
      std::function<void()> call;
    };
    const std::vector<Row> rows{
        {"moved", true, [this] { moveModel(); }},
        {"moved onto another", true, [this] { moveOnto(); }},
        {"pushed", false, [this] { push(); }},
        {"effort", false, [this] { effort(); }},
        {"spawned", false, [this] { spawn(); }},
        {"removed", true, [this] { simulator_->removeModel(anyModel()); }},
        {"attached", false, [this] { attach(); }},
        {"detached", false, [this] { simulator_->detach(anyModel()); }},
        {"physics", true, [this] { setPhysics(); }},
        {"inertial", false, [this] { setInertial(); }},
        {"joint", false, [this] { setJoint(); }},
        {"friction", true, [this] { simulator_->setFriction(anyModelIndex(), numbers_.chance(0.1) ? NAN : numbers_.uniform(0, 2)); }},
        {"joint positions", false, [this] { setPositions(); }},
        {"commanded", false, [this] { command(); }},
        {"environment", false, [this] { loadEnvironment(); }},
        {"unloaded", false, [this] { simulator_->unloadEnvironment(anyModel()); }},
        {"model reset", true, [this] { simulator_->resetModel(anyModelIndex()); }},
        {"world reset", false, [this] { simulator_->resetWorld(); }},
        {"simulation reset", false, [this] { simulator_->resetSimulation(); }},
    };
    const Row& row = rows[numbers_.count(0, static_cast<int>(rows.size()) - 1)];
    try {
      row.call();
    } catch (const InputError&) {
      return {row.name, true, row.passive};
    }
    return {row.name, false, row.passive};
  }

  /** The robot that was spawned last, with its gains, which a watcher is not told. */
  const sim::RobotConfig& lastSpawned() const { return last_spawned_; }

 private:
  int anyModelIndex() { return numbers_.count(0, static_cast<int>(simulator_->models().size()) - 1); }
  std::string anyModel() { return simulator_->models()[anyModelIndex()].name; }
  /** A body that is alive; WORLD_BODY if there is none. */
  int anyBody() {
    for (int tries = 0; tries < 20; ++tries) {
      const sim::ModelInfo& model = simulator_->models()[anyModelIndex()];
      if (!model.alive || model.bodies.empty()) continue;
      return model.bodies[numbers_.count(0, static_cast<int>(model.bodies.size()) - 1)];
    }
    return dynamics::WORLD_BODY;
  }
  /** A root's body; WORLD_BODY if there is none. */
  int anyRoot() {
    for (int tries = 0; tries < 20; ++tries) {
      const sim::ModelInfo& model = simulator_->models()[anyModelIndex()];
      if (model.alive && !model.bodies.empty() && model.bodies[0] != dynamics::WORLD_BODY) return model.bodies[0];
    }
    return dynamics::WORLD_BODY;
  }
  int anyRobot() { return simulator_->robots().empty() ? -1 : numbers_.count(0, static_cast<int>(simulator_->robots().size()) - 1); }
  double oddly(double usual) {
    if (!numbers_.chance(0.05)) return usual;
    return std::vector<double>{NAN, INFINITY, 1e300, -1e-300}[numbers_.count(0, 3)];
  }

  void moveModel() {
    const int body = anyRoot();
    if (body < 0) return;
    dynamics::BodyState state = simulator_->world().bodyState(body);
    state.X_WB = makePose(state.X_WB.translation() + numbers_.within(2 * size_), numbers_.direction() * numbers_.uniform(0, M_PI));
    state.v_WCom = numbers_.direction() * oddly(numbers_.spread(1e-2, 10));
    state.w_WB = numbers_.direction() * numbers_.spread(1e-1, 100);
    simulator_->moveModel(body, state);
  }
  void moveOnto() {
    const int body = anyRoot(), other = anyRoot();
    if (body < 0) return;
    dynamics::BodyState state = simulator_->world().bodyState(other);
    state.X_WB.translation() += numbers_.within(0.3 * size_);
    simulator_->moveModel(body, state);
  }
  void push() {
    const int body = anyBody();
    if (body < 0) return;
    sim::BodyLoad load;
    load.body = body;
    const double weight = 9.81 * simulator_->world().bodySpec(body).inertial.mass;
    load.wrench.force = numbers_.direction() * oddly(weight * numbers_.spread(0.1, 30));
    load.wrench.torque = numbers_.direction() * weight * size_ * numbers_.spread(1e-3, 1);
    load.p_B = numbers_.within(size_);
    simulator_->applyLoad(load, {simulator_->time(), numbers_.uniform(-0.01, 0.05)});
  }
  void effort() {
    const int robot = anyRobot();
    if (robot < 0 || simulator_->robots()[robot].joints.empty()) return;
    const std::vector<int>& joints = simulator_->robots()[robot].joints;
    simulator_->applyEffort(joints[numbers_.count(0, static_cast<int>(joints.size()) - 1)],
                            oddly(numbers_.uniform(-1, 1) * numbers_.spread(1e-2, 100)), {simulator_->time(), numbers_.uniform(0, 0.05)});
  }
  void spawn() {
    const int body = anyRoot();
    const Vector3 near = body < 0 ? Vector3::Zero() : Vector3(simulator_->world().bodyState(body).X_WB.translation());
    last_spawned_ = randomTree(&numbers_, fmt::format("spawned{}", spawned_++), near + Vector3(0, 0, 3 * size_), size_).config;
    simulator_->spawn(last_spawned_);
  }
  void attach() {
    const int model = anyModelIndex();
    if (!simulator_->models()[model].alive) return;
    const std::vector<sim::LinkPart> parts = sim::linksOf(*simulator_, model);
    if (parts.empty()) return;
    const bool breaks = numbers_.chance(0.3);
    simulator_->attach(anyModel(), parts[numbers_.count(0, static_cast<int>(parts.size()) - 1)],
                       breaks ? numbers_.spread(1, 1e3) : INFINITY, breaks ? numbers_.spread(0.1, 100) : INFINITY);
  }
  void setPhysics() {
    const Vector3 gravity = numbers_.chance(0.2) ? Vector3(Vector3::Zero()) : Vector3(numbers_.direction() * numbers_.uniform(0, 20));
    simulator_->setPhysics(gravity, numbers_.chance(0.7) ? simulator_->config().time_step : oddly(numbers_.spread(1e-4, 4e-3)), 1);
  }
  void setInertial() {
    const int body = anyBody();
    if (body < 0) return;
    geometry::MassProperties inertial = simulator_->linkInertial(body, 0);
    const double factor = oddly(numbers_.spread(0.1, 10));
    inertial.mass *= factor;
    inertial.inertia *= factor;
    simulator_->setLinkInertial(body, 0, inertial);
  }
  void setJoint() {
    const int robot = anyRobot();
    if (robot < 0 || simulator_->robots()[robot].joints.empty()) return;
    const int joint = numbers_.count(0, static_cast<int>(simulator_->robots()[robot].joints.size()) - 1);
    const double centre = simulator_->world().jointState(simulator_->robots()[robot].joints[joint]).position;
    if (numbers_.chance(0.3)) return simulator_->setJointDamping(robot, joint, oddly(numbers_.spread(1e-3, 10)));
    if (numbers_.chance(0.5))
      return simulator_->setJointLimits(robot, joint, centre - numbers_.spread(1e-6, 1), centre + oddly(numbers_.spread(1e-6, 1)));
    simulator_->setMotorGains(robot, joint, {oddly(numbers_.spread(1e-1, 1e4)), 0, numbers_.spread(1e-2, 1e2)});
  }
  void setPositions() {
    const int robot = anyRobot();
    if (robot < 0 || simulator_->robots()[robot].joint_names.empty()) return;
    std::vector<double> positions;
    for (std::size_t i = 0; i < simulator_->robots()[robot].joint_names.size(); ++i) positions.push_back(oddly(numbers_.uniform(-1, 1)));
    simulator_->setJointPositions(robot, simulator_->robots()[robot].joint_names, positions);
  }
  void command() {
    const int robot = anyRobot();
    if (robot < 0) return;
    sim::JointCommandMessage message;
    message.joints = simulator_->robots()[robot].joint_names;
    for (std::size_t i = 0; i < message.joints.size(); ++i) message.positions.push_back(oddly(numbers_.uniform(-1, 1)));
    simulator_->commandJoints(robot, message);
  }
  void loadEnvironment() {
    const int body = anyRoot();
    sim::EnvironmentConfig stone;
    stone.name = fmt::format("stone{}", loaded_++);
    stone.uri = sim::meshFile("unit_ball", geometry::icosphereMesh(0.5, 2));
    stone.scale = Vector3::Constant(size_ * numbers_.uniform(0.5, 2));
    const Vector3 near = body < 0 ? Vector3::Zero() : Vector3(simulator_->world().bodyState(body).X_WB.translation());
    stone.X_WE = makePose(near - Vector3(0, 0, 1.5 * size_) + numbers_.within(size_));
    simulator_->loadEnvironment(stone);
  }

  SceneNumbers numbers_;
  double size_;
  sim::Simulator* simulator_ = nullptr;
  sim::RobotConfig last_spawned_;
  int spawned_ = 0, loaded_ = 0;
};

}  // namespace blem_sim
