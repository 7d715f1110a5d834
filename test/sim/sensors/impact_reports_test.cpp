// Impacts of known momentum: forces of sensors and reports, times the step, are its change, whatever the number of parts of a step.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

constexpr double ASKED = 1e-3;  // of mass times speed
constexpr double EXACT = 1e-9;  // of mass times speed: miss by rounding and the solver's own tolerance
const double SPEEDS[] = {0.5, 1, 3.1, 5, 10, 19.8, 20}, TIME_STEPS[] = {1e-3, 5e-3};

/** A trunk of 4 kg, its centre of mass beside the ankle, on a foot of 1 kg; 0.34 m from the trunk's origin to the sole. */
std::string hopperUrdf(const std::string& ankle) {
  return R"(<robot name="hopper">
  <link name="trunk"><inertial><origin xyz="0.03 0.02 0.1"/><mass value="4"/>
    <inertia ixx="0.05" iyy="0.06" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="foot"><inertial><origin xyz="0.02 0 -0.02"/><mass value="1"/>
      <inertia ixx="0.002" iyy="0.004" izz="0.005" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0.02 0 -0.02"/><geometry><box size="0.24 0.16 0.04"/></geometry></collision></link>
  <joint name="ankle" type=")" +
         ankle + R"("><parent link="trunk"/><child link="foot"/><origin xyz="0 0 -0.3"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="1e6" velocity="100"/></joint>
</robot>)";
}

struct Landing {
  double speed = 5;  ///< [m/s] downwards
  double aside = 0;  ///< times as fast along x, since gravity leans
  double time_step = 1e-3;
  double friction = 0;
  double restitution = 0;
  std::string ankle = "fixed";
};

SensorConfig sensorOf(SensorType type, const std::string& link, const std::string& joint = "") {
  SensorConfig sensor;
  sensor.name = "sensor" + std::to_string(static_cast<int>(type));
  sensor.type = type;
  sensor.link = link;
  sensor.joint = joint;
  sensor.frame = "parent";
  return sensor;
}

/** World of one sheet and a lean of gravity, in which a body that starts at `above` its place of landing lands at the speed. */
SimulationConfig landingWorld(const Landing& landing, Vector3* above) {
  SimulationConfig config;
  config.time_step = landing.time_step;
  config.gravity = {landing.aside * G, 0, -G};
  config.environments = {ground()};
  config.environments[0].contact.friction = landing.friction;
  config.environments[0].contact.restitution = landing.restitution;
  const double height = landing.speed * landing.speed / (2 * G);
  *above = {-landing.aside * height, 0, height};
  return config;
}

SimulationConfig hopperWorld(const Landing& landing) {
  Vector3 above;
  SimulationConfig config = landingWorld(landing, &above);
  RobotConfig hopper = robot("hopper", hopperUrdf(landing.ankle), false);
  hopper.X_WR = makePose(above + Vector3(0, 0, 0.3425));
  hopper.contact.friction = landing.friction;
  hopper.gains["default"] = {3000, 0, 30};
  hopper.motor["default"] = MotorLaw::IMPLICIT_PD;
  hopper.sensors = {sensorOf(SensorType::CONTACT, "foot"), sensorOf(SensorType::FORCE_TORQUE, "", "ankle"),
                    sensorOf(SensorType::IMU, "trunk")};
  config.robots = {hopper};
  return config;
}

/** Misses of impulses to changes of momentum: in all, and in the worst step. */
struct Missed {
  Vector3 sum = Vector3::Zero();
  double worst = 0;
  void add(const Vector3& impulse, const Vector3& change) {
    sum += impulse - change;
    worst = std::max(worst, (impulse - change).norm());
  }
};

int stepsOf(const Landing& landing) { return static_cast<int>((landing.speed / G + 0.1) / landing.time_step); }

/** Misses of a hopper's sensors and of the list of contacts, as parts of mass times speed. */
struct HopperMissed {
  Missed sole, contacts, ankle, ankle_torque, imu;
  int most_parts = 1;
};

HopperMissed land(const Landing& landing) {
  Simulator simulator(hopperWorld(landing), model::UriResolver());
  const std::vector<int>& bodies = simulator.robots()[0].bodies;
  const dynamics::World& world = simulator.world();
  const double dt = landing.time_step;
  HopperMissed missed;
  for (int i = stepsOf(landing); i > 0; --i) {
    const dynamics::BodyState trunk = world.bodyState(bodies[0]), foot = world.bodyState(bodies[1]);
    const geometry::MassProperties &of_trunk = world.bodySpec(bodies[0]).inertial, &of_foot = world.bodySpec(bodies[1]).inertial;
    const StepReport& report = simulator.step();
    missed.most_parts = std::max(missed.most_parts, report.substeps);
    const Vector3 trunk_change = of_trunk.mass * (report.bodies[bodies[0]].v_WCom - trunk.v_WCom - dt * simulator.gravity());
    const Vector3 foot_change = of_foot.mass * (report.bodies[bodies[1]].v_WCom - foot.v_WCom - dt * simulator.gravity());

    missed.sole.add(dt * reading<ContactReading>(report, 0).total.force, trunk_change + foot_change);
    Vector3 on_robot = Vector3::Zero();
    for (const ContactReport& contact : report.contacts)
      on_robot += contact.body_a == dynamics::WORLD_BODY ? Vector3(-contact.force) : contact.force;
    missed.contacts.add(dt * on_robot, trunk_change + foot_change);

    const ForceTorqueReading wrench = reading<ForceTorqueReading>(report, 1);
    const Matrix3 R = trunk.X_WB.linear(), R_after = report.bodies[bodies[0]].X_WB.linear();
    const Vector3 on_trunk = -dt * (R * wrench.force);
    missed.ankle.add(on_trunk, trunk_change);
    const Vector3 arm = R * -of_trunk.com;  // of the trunk's origin, which the torque is about
    const Matrix3& inertia = of_trunk.inertia;
    const Vector3 spin = R_after * inertia * R_after.transpose() * report.bodies[bodies[0]].w_WB - R * inertia * R.transpose() * trunk.w_WB;
    missed.ankle_torque.add(-dt * (R * wrench.torque) + arm.cross(on_trunk), spin);
    // The origin of the trunk's link moves as its centre of mass does unless it turns.
    missed.imu.add(dt * of_trunk.mass * (R * reading<ImuReading>(report, 2).linear_acceleration), trunk_change);
  }
  return missed;
}

TEST(ImpactReports, RobotOnItsFoot) {
  for (const std::string ankle : {"fixed", "revolute"}) {
    for (const double dt : TIME_STEPS) {
      for (const double friction : {0.0, 0.6}) {
        for (const double speed : SPEEDS) {
          Landing landing;
          landing.speed = speed;
          landing.time_step = dt;
          landing.friction = friction;
          landing.aside = 0.3;
          landing.ankle = ankle;
          const HopperMissed missed = land(landing);
          const std::string scene = ankle + " ankle, " + std::to_string(speed) + " m/s, friction " + std::to_string(friction);
          EXPECT_LT(missed.sole.sum.norm(), ASKED * 5 * speed) << scene;
          EXPECT_LT(missed.contacts.sum.norm(), ASKED * 5 * speed) << scene;
          EXPECT_LT(missed.ankle.sum.norm(), ASKED * 5 * speed) << scene;
          EXPECT_TRUE(speed < 5 || missed.most_parts > 1) << scene;
          if (ankle != "fixed" || friction > 0) continue;
          // The hopper slides on without turning: each step is right by itself, and torques too.
          EXPECT_LT(missed.sole.worst, EXACT * 5 * speed) << scene;
          EXPECT_LT(missed.contacts.worst, EXACT * 5 * speed) << scene;
          EXPECT_LT(missed.ankle.worst, EXACT * 5 * speed) << scene;
          EXPECT_LT(missed.ankle_torque.worst, EXACT * 5 * speed) << scene;
          EXPECT_LT(missed.imu.worst, ASKED * 5 * speed) << scene;
        }
      }
    }
  }
}

/** A ball of 2 kg and 0.02 m. */
const char* const BALL = R"(<robot name="ball">
  <link name="ball"><inertial><mass value="2"/><inertia ixx="0.00032" iyy="0.00032" izz="0.00032" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><sphere radius="0.02"/></geometry></collision></link>
</robot>)";

// Friction spins it up while it moves on, part by part: torques are about where its middle was when they acted.
TEST(ImpactReports, TorqueOnABallThatLandsSliding) {
  for (const double dt : TIME_STEPS) {
    for (const double speed : {3.1, 10.0, 20.0}) {
      Landing landing;
      landing.speed = speed;
      landing.aside = 0.7;
      landing.time_step = dt;
      landing.friction = 0.3;
      Vector3 above;
      SimulationConfig config = landingWorld(landing, &above);
      RobotConfig ball = robot("ball", BALL, false);
      ball.X_WR = makePose(above + Vector3(0, 0, 0.0225));
      ball.contact.friction = landing.friction;
      ball.sensors = {sensorOf(SensorType::CONTACT, "ball")};
      config.robots = {ball};
      Simulator simulator(config, model::UriResolver());
      const int body = simulator.robots()[0].bodies[0];
      Missed missed;
      int most_parts = 1;
      for (int i = stepsOf(landing); i > 0; --i) {
        const Vector3 spin = simulator.world().bodyState(body).w_WB;
        const StepReport& report = simulator.step();
        most_parts = std::max(most_parts, report.substeps);
        missed.add(dt * reading<ContactReading>(report, 0).total.torque, 0.00032 * (report.bodies[body].w_WB - spin));
      }
      EXPECT_LT(missed.worst, EXACT * 2 * speed * 0.02) << speed << " m/s, " << dt << " s";
      EXPECT_GT(simulator.report().bodies[body].w_WB.y(), speed) << speed;
      EXPECT_TRUE(speed * dt < 0.015 || most_parts > 1) << speed;
    }
  }
}

TEST(ImpactReports, BoxThatTumblesAndBounces) {
  for (const double dt : TIME_STEPS) {
    for (const double restitution : {0.0, 0.7}) {
      for (const double speed : SPEEDS) {
        Landing landing;
        landing.speed = speed;
        landing.aside = 0.4;
        landing.time_step = dt;
        landing.friction = 0.5;
        landing.restitution = restitution;
        Vector3 above;
        SimulationConfig config = landingWorld(landing, &above);
        config.objects = {box("cube", Vector3::Constant(0.1), 1, Vector3::Zero())};
        config.objects[0].X_WO = makePose(above + Vector3(0, 0, 0.09), {0.3, 0.5, 0.7});
        Simulator simulator(config, model::UriResolver());
        const int body = simulator.models()[simulator.modelIndex("cube")].bodies[0];
        Missed momentum, spin;
        int most_parts = 1;
        for (int i = stepsOf(landing); i > 0; --i) {
          const dynamics::BodyState before = simulator.world().bodyState(body);
          const StepReport& report = simulator.step();
          const dynamics::BodyState& after = report.bodies[body];
          most_parts = std::max(most_parts, report.substeps);
          Vector3 force = Vector3::Zero(), torque = Vector3::Zero();
          for (const ContactReport& contact : report.contacts) {
            force -= contact.force;
            torque += contact.moment_b - (contact.point - before.X_WB.translation()).cross(contact.force);
          }
          momentum.add(dt * force, after.v_WCom - before.v_WCom - dt * simulator.gravity());
          spin.add(dt * torque, simulator.world().bodySpec(body).inertial.inertia(0, 0) * (after.w_WB - before.w_WB));
        }
        const std::string scene = std::to_string(speed) + " m/s, " + std::to_string(dt) + " s, e = " + std::to_string(restitution);
        EXPECT_LT(momentum.worst, EXACT * speed) << scene;
        EXPECT_LT(spin.worst, EXACT * speed * 0.05) << scene;
        EXPECT_TRUE(speed < 5 || most_parts > 1) << scene;
      }
    }
  }
}

/** A balanced disc about z on a post. */
const char* const TURNTABLE = R"(<robot name="turntable">
  <link name="post"/>
  <link name="disc"><inertial><mass value="1"/><inertia ixx="0.1" iyy="0.1" izz="0.2" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="spin" type="continuous"><parent link="post"/><child link="disc"/><axis xyz="0 0 1"/></joint>
</robot>)";

/** A turntable that spins up while a cube that lands beside it makes steps be made in parts. */
SimulationConfig turntableWorld(double dt, MotorLaw law) {
  SimulationConfig config;
  config.time_step = dt;
  config.environments = {ground()};
  config.objects = {box("cube", Vector3::Constant(0.1), 1, {1, 0, 0.16})};
  config.objects[0].linear_velocity = {0, 0, -15};
  RobotConfig table = robot("turntable", TURNTABLE, true);
  table.gains["default"] = {0, 0, 0.05 / dt};  // a time constant of a few steps
  table.motor["default"] = law;
  table.joint_friction["default"] = {0.1, 0.02};
  SensorConfig motors = sensorOf(SensorType::MOTOR_CURRENT, "");
  motors.torque_constant = {{"default", 0.5}};
  table.sensors = {sensorOf(SensorType::FORCE_TORQUE, "", "spin"), motors};
  config.robots = {table};
  return config;
}

TEST(ImpactReports, EffortAndCurrentAreThoseOfTheWholeStep) {
  for (const MotorLaw law : {MotorLaw::PID, MotorLaw::IMPLICIT_PD}) {
    for (const double dt : TIME_STEPS) {
      Simulator simulator(turntableWorld(dt, law), model::UriResolver());
      simulator.commandJoints(0, {{"spin"}, {}, {10.0}, {}});
      double speed = 0;
      int most_parts = 1;
      for (int i = 0; i < 40; ++i) {
        const StepReport& report = simulator.step();
        most_parts = std::max(most_parts, report.substeps);
        const dynamics::JointState& joint = report.joints[0];
        const double change = 0.2 * (joint.velocity - speed);
        // The motor's own effort: the disc's, and what friction of 0.1 + 0.02 v takes, v being the parts'.
        const double friction = dt * (0.1 + 0.02 * joint.velocity);
        EXPECT_NEAR(dt * joint.effort, change + friction, dt * 0.02 * std::abs(joint.velocity - speed) + 1e-9) << i;
        EXPECT_NEAR(dt * reading<ForceTorqueReading>(report, 0).torque.z(), change, 1e-9) << i;
        EXPECT_EQ(reading<MotorCurrentReading>(report, 1).efforts[0], joint.effort);
        EXPECT_EQ(reading<MotorCurrentReading>(report, 1).currents[0], joint.effort / 0.5);
        speed = joint.velocity;
      }
      EXPECT_GT(most_parts, 1);
      EXPECT_GT(speed, 5);
    }
  }
}

TEST(ImpactReports, StateKeepsTheEffortOfTheWholeStep) {
  const SimulationConfig config = turntableWorld(5e-3, MotorLaw::PID);
  Simulator simulator(config, model::UriResolver()), other(config, model::UriResolver());
  simulator.commandJoints(0, {{"spin"}, {}, {10.0}, {}});
  while (simulator.step().substeps == 1) ASSERT_LT(simulator.steps(), 20u);
  other.restore(simulator.save());
  EXPECT_EQ(other.report().joints[0].effort, simulator.report().joints[0].effort);
  EXPECT_EQ(other.stateHash(), simulator.stateHash());
}

}  // namespace
}  // namespace blem_sim::sim
