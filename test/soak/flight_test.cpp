// The Hubo in free flight, limbs moving: momenta are kept, nothing diverges at any stiffness.
#include <gtest/gtest.h>

#include <random>

#include "soak/figures.h"
#include "soak/hubo_stand.h"
#include "soak/world_figures.h"

namespace blem_sim {
namespace {

constexpr double DT = HuboStand::DT, FASTEST = 5;  // [rad/s] of a limb
const Vector3 VELOCITY(0.5, -0.3, 4), SPIN(0.5, 1, 0.3);

HuboOptions flying() {
  HuboOptions options;
  options.settings = soakSettings();
  options.sole_contacts = 0;
  return options;
}

/** Joint speeds up to FASTEST, away from the nearer limit. */
std::vector<double> limbSpeeds(const dynamics::World& world) {
  std::mt19937_64 generator(7);
  std::vector<double> speeds;
  for (int j = 0; j < world.jointCount(); ++j) {
    const dynamics::JointSpec& spec = world.jointSpec(j);
    const double size = FASTEST * static_cast<double>(generator() >> 11) * 0x1p-53, q = world.jointState(j).position;
    speeds.push_back(q - spec.lower < spec.upper - q ? size : -size);
  }
  return speeds;
}

/** [J] kinetic about the centre of mass, and of the motors' springs. */
double innerEnergy(HuboStand* hubo) {
  const dynamics::World& world = hubo->world();
  double energy = innerKineticEnergy(world, hubo->bodies());
  for (int j = 0; j < world.jointCount(); ++j) {
    const dynamics::JointDrive& drive = hubo->drives()[j];
    energy += 0.5 * drive.stiffness * std::pow(drive.target_position - world.jointState(j).position, 2);
  }
  return energy;
}

/** A flight against theory. A ball beside the robot flies the parabola that the stepper gives to the same centre of mass. */
struct Flight {
  explicit Flight(HuboStand* h) : hubo(h), mass(totalMass(h->world(), h->bodies())), start(centreOfMass(h->world(), h->bodies())) {
    velocity = momentum(h->world(), h->bodies()) / mass;
    spin = angularMomentum(h->world(), h->bodies(), start);
    dynamics::BodySpec spec = dynamics::boxBody("ball", 1, {0.1, 0.1, 0.1}, start);
    ball = h->world().addBody(spec);
    dynamics::BodyState state = h->world().bodyState(ball);
    state.v_WCom = velocity;
    h->world().setBodyState(ball, state);
  }
  void observe(int steps) {
    const dynamics::World& world = hubo->world();
    const double t = DT * steps;
    const Vector3 com = centreOfMass(world, hubo->bodies());
    off_ball = std::max(off_ball, (com - world.bodyState(ball).X_WB.translation()).norm());
    off_theory = std::max(off_theory, (com - start - t * velocity - 0.5 * t * t * world.gravity()).norm());
    spin_off = std::max(spin_off, (angularMomentum(world, hubo->bodies(), com) - spin).norm() / spin.norm());
    const Vector3 ideal = mass * (velocity + t * world.gravity());
    momentum_off = std::max(momentum_off, (momentum(world, hubo->bodies()) - ideal).norm());
    for (int j = 0; j < world.jointCount(); ++j) fastest = std::max(fastest, std::abs(world.jointState(j).velocity));
  }
  void print(const std::string& name) const {
    figure(name + ": centre of mass off its parabola", off_ball, "m");
    figure(name + ": centre of mass off the continuous parabola", off_theory, "m");
    figure(name + ": momentum off", momentum_off, "kg m/s");
    figure(name + ": angular momentum off, relative", spin_off, "");
    figure(name + ": fastest joint", fastest, "rad/s");
  }
  HuboStand* hubo;
  double mass;
  Vector3 start, velocity, spin;
  int ball;
  double off_ball = 0, off_theory = 0, momentum_off = 0, spin_off = 0, fastest = 0;
};

class FreeFlight : public ::testing::TestWithParam<double> {};

// A robot is thrown with every limb in motion; motors without damping or friction hold the first posture.
TEST_P(FreeFlight, KeepsItsMomenta) {
  SKIP_WITHOUT_SHARED_DATA(HUBO_FOLDER);
  HuboOptions options = flying();
  options.stiffness = GetParam();
  options.joint_friction = false;
  HuboStand hubo(options);
  setJointSpeeds(&hubo.world(), hubo.bodies()[0], limbSpeeds(hubo.world()), VELOCITY, SPIN);
  Flight flight(&hubo);
  hubo.prepare();
  const double energy = innerEnergy(&hubo);
  double most = 0;
  StepTimes times;
  for (int i = 1; i <= 2000; ++i) {
    hubo.prepare();
    times.start();
    const dynamics::SolveResult& result = hubo.solve();
    times.stop(result);
    ASSERT_TRUE(result.finite) << i;
    flight.observe(i);
    most = std::max(most, innerEnergy(&hubo) / energy);
  }
  char name[64];
  std::snprintf(name, sizeof name, "flight kp %g", GetParam());
  flight.print(name);
  figure(std::string(name) + ": most energy over the first", most, "");
  times.print(name);
  EXPECT_LE(flight.off_ball, 1e-3);
  EXPECT_LE(flight.spin_off, 0.01);
  EXPECT_LT(most, 2) << "diverges";
}
INSTANTIATE_TEST_SUITE_P(Stiffness, FreeFlight, ::testing::Values(0, 1, 10, 100, 1e3, 1e4, 1e5, 1e6));

// The servo itself, told to wave every joint at up to 5 rad/s.
TEST(FreeFlightServo, WavingKeepsItsMomenta) {
  SKIP_WITHOUT_SHARED_DATA(HUBO_FOLDER);
  HuboStand hubo(flying());
  setJointSpeeds(&hubo.world(), hubo.bodies()[0], std::vector<double>(hubo.world().jointCount(), 0), VELOCITY, SPIN);
  const std::vector<double> speeds = limbSpeeds(hubo.world());
  std::vector<double> first;
  for (int j = 0; j < hubo.world().jointCount(); ++j) first.push_back(hubo.world().jointState(j).position);
  Flight flight(&hubo);
  constexpr double RATE = 2 * M_PI;  // [rad/s] of the wave
  for (int i = 1; i <= 2000; ++i) {
    const double phase = RATE * DT * i;
    for (std::size_t j = 0; j < speeds.size(); ++j)
      hubo.motors()[j].hold(first[j] + speeds[j] / RATE * (1 - std::cos(phase)), speeds[j] * std::sin(phase));
    ASSERT_TRUE(hubo.step().finite) << i;
    flight.observe(i);
  }
  flight.print("flight waving");
  EXPECT_LE(flight.off_ball, 1e-3);
  EXPECT_LE(flight.spin_off, 0.01);
}

}  // namespace
}  // namespace blem_sim
