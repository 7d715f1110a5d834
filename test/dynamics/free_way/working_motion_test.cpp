// Trees that tumble or swing while their motors work against contacts, against theory: a motor that moves nothing does no work.
#include <gtest/gtest.h>

#include "support/chains.h"
#include "support/standard_values.h"

namespace blem_sim::dynamics {
namespace {

/** Two links without gravity, the second across the first, whose motor presses it against a stop on the first: one rigid body, in theory.
 */
class PressedElbow {
 public:
  /** @param held the first link turns about the origin; else all of it flies @param spin [rad/s] of all of it about the origin */
  PressedElbow(bool held, const Vector3& spin) : chain({{1, 0.3}, {0.5, 0.2}}, options(held)) {
    chain.drives.back().effort = EFFORT;
    for (int body = 0; body < 2; ++body) {
      BodyState state = chain.world.bodyState(body);
      state.w_WB = spin;
      state.v_WCom = spin.cross(state.X_WB * chain.world.bodySpec(body).inertial.com);
      chain.world.setBodyState(body, state);
    }
    first_energy = chain.world.kineticEnergy();
    first_spin = chain.angularMomentum();
  }

  /** Steps on, and expects the stop to hold and the joints' wrenches to be those of their laws. */
  void step() {
    const Pose X_WB = chain.world.bodyState(0).X_WB;
    ContactConstraint stop;
    stop.body_a = 1;
    stop.body_b = 0;
    stop.point = X_WB * Vector3(0.3, 0, -ARM);
    stop.normal_BA = X_WB.linear().col(0);
    stop.depth = ARM * (elbow() - M_PI / 2);
    const SolveResult& result = chain.world.step(DT, {stop}, chain.drives);
    EXPECT_GT(stop.normal_BA.dot(result.contact_forces[0]), 0);
    EXPECT_NEAR(elbow(), M_PI / 2, 1e-3);
    const double along_axis = result.joint_wrenches.back().torque.dot(X_WB.linear().col(1));
    EXPECT_NEAR(along_axis, result.axis_efforts.back(), 1e-5 * EFFORT);
  }

  double elbow() const { return chain.world.jointState(chain.world.jointCount() - 1).position; }

  Chain chain;
  double first_energy;
  Vector3 first_spin;

 private:
  static constexpr double EFFORT = 20, ARM = 0.05;  // [N m] more than what turning asks for; [m] from the elbow to the stop
  static ChainOptions options(bool held) {
    ChainOptions options;
    options.held = held;
    options.bend = M_PI / 2;
    options.gravity = Vector3::Zero();
    return options;
  }
};

TEST(WorkingMotion, KeepsItsEnergyAndMomentaInFlight) {
  for (const Vector3& spin : {Vector3(0, 7, 0), Vector3(3, 7, 2), Vector3(0, 0, 20)}) {
    PressedElbow flies(false, spin);
    for (int i = 0; i < 1000 && !HasFailure(); ++i) flies.step();
    EXPECT_NEAR(flies.chain.world.kineticEnergy() / flies.first_energy, 1, 1e-4) << spin.transpose();
    EXPECT_LT((flies.chain.angularMomentum() - flies.first_spin).norm(), 1e-6 * flies.first_spin.norm()) << spin.transpose();
  }
}

TEST(WorkingMotion, KeepsItsEnergyOnABearing) {
  PressedElbow turns(true, {0, 10, 0});
  for (int i = 0; i < 1000 && !HasFailure(); ++i) turns.step();
  EXPECT_NEAR(turns.chain.world.kineticEnergy() / turns.first_energy, 1, 1e-4);
}

}  // namespace
}  // namespace blem_sim::dynamics
