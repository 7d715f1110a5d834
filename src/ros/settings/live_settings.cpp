#include "settings/live_settings.h"

#include <utility>

#include "blem_sim/sim/trajectory.h"

namespace blem_sim::node {

namespace {

/** Settings of setPhysics; each is set alone. */
struct Physics {
  Vector3 gravity;
  double time_step, real_time_factor;
};

/** A setting that is one number of the physics. */
Setting physicsSetting(SimulationLoop* loop, double* (*number)(Physics*), Setting setting) {
  const auto present = [loop] {
    const sim::SimulationConfig& config = loop->simulator().config();
    return Physics{loop->simulator().gravity(), config.time_step, config.real_time_factor};
  };
  setting.get = [present, number] {
    Physics physics = present();
    return *number(&physics);
  };
  setting.set = [present, number, loop](double value) {
    Physics physics = present();
    *number(&physics) = value;
    loop->simulator().setPhysics(physics.gravity, physics.time_step, physics.real_time_factor);
    loop->paceChanged();
  };
  return setting;
}

/** One of a joint's gains. */
Setting gainSetting(sim::Simulator* simulator, std::pair<int, int> joint, double sim::JointGains::*gain, const std::string& name) {
  Setting setting{name, "gain of the joint's motor", 0, sim::LARGEST_COMMAND, {}, {}};
  setting.get = [=] { return simulator->motorGains(joint.first, joint.second).*gain; };
  setting.set = [=](double value) {
    sim::JointGains gains = simulator->motorGains(joint.first, joint.second);
    gains.*gain = value;
    simulator->setMotorGains(joint.first, joint.second, gains);
  };
  return setting;
}

}  // namespace

LiveSettings::LiveSettings(const ros::NodeHandle& private_node, SimulationLoop* loop) : loop_(loop), server_(private_node) {
  modelsChanged();
  loop->onModelsChanged([this] { modelsChanged(); });
  loop->onPaceChanged([this] { server_.tellValues(); });
}

void LiveSettings::modelsChanged() {
  std::vector<Setting> settings;
  addPhysics(&settings);
  addFriction(&settings);
  addGains(&settings);
  server_.offer(std::move(settings));
}

void LiveSettings::addPhysics(std::vector<Setting>* settings) const {
  constexpr double GRAVITY = 1e4, FASTEST = 1e6;
  const auto add = [&](double* (*number)(Physics*), Setting setting) {
    settings->push_back(physicsSetting(loop_, number, std::move(setting)));
  };
  add([](Physics* p) { return &p->gravity.x(); }, {"gravity_x", "[m/s^2]", -GRAVITY, GRAVITY, {}, {}});
  add([](Physics* p) { return &p->gravity.y(); }, {"gravity_y", "[m/s^2]", -GRAVITY, GRAVITY, {}, {}});
  add([](Physics* p) { return &p->gravity.z(); }, {"gravity_z", "[m/s^2]", -GRAVITY, GRAVITY, {}, {}});
  add([](Physics* p) { return &p->time_step; }, {"time_step", "[s]", 1e-6, 0.1, {}, {}});
  add([](Physics* p) { return &p->real_time_factor; }, {"real_time_factor", "0 = as fast as possible", 0, FASTEST, {}, {}});
}

void LiveSettings::addFriction(std::vector<Setting>* settings) const {
  sim::Simulator* const simulator = &loop_->simulator();
  for (const sim::ModelInfo& model : simulator->models()) {
    if (!model.alive) continue;
    const auto index = [simulator, name = model.name] { return simulator->modelIndex(name); };
    settings->push_back({model.name + "::friction", "Coulomb coefficient of all its surfaces", 0, sim::LARGEST_COMMAND,
                         [simulator, index] { return simulator->friction(index()); },
                         [simulator, index](double value) { simulator->setFriction(index(), value); }});
  }
}

void LiveSettings::addGains(std::vector<Setting>* settings) const {
  sim::Simulator* const simulator = &loop_->simulator();
  for (std::size_t robot = 0; robot < simulator->robots().size(); ++robot) {
    const sim::RobotInfo& info = simulator->robots()[robot];
    for (std::size_t joint = 0; joint < info.joint_names.size(); ++joint) {
      if (!info.driven[joint]) continue;
      const std::pair<int, int> place(robot, joint);
      const std::string name = info.name + "::" + info.joint_names[joint] + "::";
      settings->push_back(gainSetting(simulator, place, &sim::JointGains::p, name + "p"));
      settings->push_back(gainSetting(simulator, place, &sim::JointGains::i, name + "i"));
      settings->push_back(gainSetting(simulator, place, &sim::JointGains::d, name + "d"));
    }
  }
}

}  // namespace blem_sim::node
