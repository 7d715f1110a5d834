// Numbers that are none, through the door of the world: refused in one line, or a step that says it is not finite and changes nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "blem_sim/dynamics/world.h"
#include "support/input_errors.h"

namespace blem_sim::dynamics {
namespace {

constexpr double INF = std::numeric_limits<double>::infinity();

BodySpec soundBody() {
  BodySpec body;
  body.name = "body";
  body.inertial.mass = 1;
  body.inertial.inertia = 0.1 * Matrix3::Identity();
  return body;
}

TEST(BadInput, BodiesAreRefused) {
  World world(Vector3::Zero(), SolverSettings());
  const std::vector<std::function<void(BodySpec*, double)>> fields = {[](BodySpec* b, double x) { b->inertial.mass = x; },
                                                                      [](BodySpec* b, double x) { b->inertial.inertia(0, 0) = x; },
                                                                      [](BodySpec* b, double x) { b->inertial.inertia *= x; }};
  for (const auto& set : fields) {
    for (const double x : {std::nan(""), INF, 0.0, -1.0, 1e-310, 1e300}) {
      BodySpec body = soundBody();
      set(&body, x);
      EXPECT_TRUE(isOneLineWith(refusal([&] { world.addBody(body); }), {"body 'body'"})) << x;
    }
  }
  EXPECT_EQ(world.bodyCount(), 0);
}

TEST(BadInput, JointsAreRefused) {
  World world(Vector3::Zero(), SolverSettings());
  world.addBody(soundBody());
  JointSpec sound;
  sound.name = "joint";
  const std::vector<std::function<void(JointSpec*, double)>> fields = {
      [](JointSpec* j, double x) { j->X_PJ.translation().x() = x; }, [](JointSpec* j, double x) { j->axis.x() = x; },
      [](JointSpec* j, double x) { j->lower = std::isnan(x) ? x : 1, j->upper = 0; },
      [](JointSpec* j, double x) { j->mimic_multiplier = x; }, [](JointSpec* j, double x) { j->armature = x; }};
  for (const auto& set : fields) {
    for (const double x : {std::nan(""), INF}) {
      JointSpec joint = sound;
      set(&joint, x);
      EXPECT_TRUE(isOneLineWith(refusal([&] { world.addJoint(joint); }), {"joint 'joint'"})) << x;
    }
  }
  sound.armature = -1;
  EXPECT_TRUE(isOneLineWith(refusal([&] { world.addJoint(sound); }), {"armature"}));
  sound.armature = 0;
  EXPECT_TRUE(isOneLineWith(refusal([&] { world.addJoint(sound, NAN); }), {"position"}));
  EXPECT_EQ(world.jointCount(), 0);
}

/** Input of a step for a body on a hinge over a contact. */
struct Told {
  double dt = 0.001;
  ContactConstraint contact;
  JointDrive drive;
};

TEST(BadInput, AStepSaysThatItIsNotFiniteAndChangesNothing) {
  const std::vector<std::function<void(Told*, double)>> fields = {[](Told* t, double x) { t->dt = x; },
                                                                  [](Told* t, double x) { t->contact.point.x() = std::abs(x) / 0.0 * x; },
                                                                  [](Told* t, double x) { t->contact.normal_BA *= std::isnan(x) ? x : 0; },
                                                                  [](Told* t, double x) { t->contact.friction = x; },
                                                                  [](Told* t, double x) { t->contact.restitution = x; },
                                                                  [](Told* t, double x) { t->contact.stiffness = x; },
                                                                  [](Told* t, double x) { t->contact.damping = x; },
                                                                  [](Told* t, double x) { t->drive.stiffness = x; },
                                                                  [](Told* t, double x) { t->drive.damping = x; },
                                                                  [](Told* t, double x) { t->drive.max_effort = x; },
                                                                  [](Told* t, double x) { t->drive.dry_friction = x; },
                                                                  [](Told* t, double x) { t->drive.viscous_friction = x; }};
  for (const std::string& stepper : stepperNames()) {
    SolverSettings settings;
    settings.stepper = stepper;
    World world({0, 0, -9.81}, settings);
    world.addBody(soundBody());
    world.addJoint(JointSpec());
    for (std::size_t field = 0; field < fields.size(); ++field) {
      for (const double x : {std::nan(""), -1.0}) {
        Told told;
        told.contact.body_a = 0;
        told.contact.point = {0.1, 0, 0};
        told.contact.normal_BA = Vector3::UnitZ();
        fields[field](&told, x);
        const WorldState before = world.save();
        EXPECT_FALSE(world.step(told.dt, {told.contact}, {told.drive}).finite) << stepper << " " << field << " " << x;
        EXPECT_TRUE(world.save() == before) << stepper << " " << field;
      }
    }
  }
}

}  // namespace
}  // namespace blem_sim::dynamics
