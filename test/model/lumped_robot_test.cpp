#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "blem_sim/model/loaders.h"
#include "support/input_errors.h"
#include "support/shared_data.h"
#include "support/shared_packages.h"

namespace blem_sim::model {
namespace {

RobotModel loadRobot(const std::string& inside) { return loadUrdf("<robot name=\"r\">" + inside + "</robot>", "test.urdf", UriResolver()); }

std::string link(const std::string& name, const std::string& mass = "", const std::string& inside = "") {
  const std::string inertial =
      mass.empty() ? ""
                   : "<inertial><origin xyz=\"0.1 0.2 0.3\" rpy=\"0.3 0.2 0.1\"/><mass value=\"" + mass +
                         "\"/><inertia ixx=\"0.01\" ixy=\"0.001\" ixz=\"0.002\" iyy=\"0.02\" iyz=\"0.003\" izz=\"0.025\"/></inertial>";
  return "<link name=\"" + name + "\">" + inertial + inside + "</link>";
}

std::string jointOf(const std::string& name, const std::string& type, const std::string& parent, const std::string& child,
                    const std::string& inside = "") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" + child +
         "\"/><origin xyz=\"1 0.5 0.25\" rpy=\"0.5 -0.25 1\"/>" + inside + "</joint>";
}

const Pose X_JOINT = makePose(Vector3(1, 0.5, 0.25), Vector3(0.5, -0.25, 1));

bool isNoted(const std::vector<std::string>& notes, const std::string& words) {
  return std::any_of(notes.begin(), notes.end(), [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

using Matrix4 = Eigen::Matrix4d;

/** Integral of p p^T dm over homogeneous points p: moves with X J X^T and adds up, without a parallel axis theorem.
 *  [Wensing, Kim, Slotine 2018, Linear Matrix Inequalities for Physically Consistent Inertial Parameter Identification] */
Matrix4 pseudoInertia(const Inertial& inertial) {
  Matrix4 about_com = Matrix4::Zero();
  about_com.topLeftCorner<3, 3>() = inertial.inertia.trace() / 2 * Matrix3::Identity() - inertial.inertia;
  about_com(3, 3) = inertial.mass;
  Matrix4 X = Matrix4::Identity();
  X.topRightCorner<3, 1>() = inertial.com;
  return X * about_com * X.transpose();
}

void expectBruteForceSum(const RobotModel& robot, const LumpedRobot& lumped) {
  for (std::size_t b = 0; b < lumped.bodies.size(); ++b) {
    Matrix4 expected = Matrix4::Zero();
    for (int l : lumped.bodies[b].links) {
      ASSERT_EQ(lumped.link_placement[l].body, static_cast<int>(b));
      const Matrix4 X_BL = lumped.link_placement[l].X_BL.matrix();
      if (robot.links[l].inertial) expected += X_BL * pseudoInertia(*robot.links[l].inertial) * X_BL.transpose();
    }
    if (expected.isZero(0)) continue;
    EXPECT_NEAR(lumped.bodies[b].inertial.mass, expected(3, 3), 1e-12 * expected(3, 3));
    EXPECT_LT((pseudoInertia(lumped.bodies[b].inertial) - expected).norm(), 1e-12 * expected.norm()) << lumped.bodies[b].name;
  }
}

TEST(LumpedRobot, fixedJointsSumInertialsInTheirFrames) {
  const RobotModel robot = loadRobot(link("a", "1") + link("b", "2") + link("c", "3") + link("d", "4") + jointOf("ab", "fixed", "a", "b") +
                                     jointOf("bc", "fixed", "b", "c") + jointOf("cd", "continuous", "c", "d"));
  const LumpedRobot lumped = lumpFixedJoints(robot, {}, false);
  ASSERT_EQ(lumped.bodies.size(), 2u);
  EXPECT_EQ(lumped.bodies[0].name, "a");
  EXPECT_EQ(lumped.bodies[0].links, (std::vector<int>{0, 1, 2}));
  EXPECT_TRUE(lumped.link_placement[2].X_BL.isApprox(X_JOINT * X_JOINT, 1e-12));
  ASSERT_EQ(lumped.joints.size(), 1u);
  EXPECT_TRUE(lumped.joints[0].X_PJ.isApprox(X_JOINT * X_JOINT * X_JOINT, 1e-12));
  EXPECT_EQ(lumped.joints[0].parent, 0);
  EXPECT_EQ(lumped.joints[0].child, 1);
  EXPECT_DOUBLE_EQ(lumped.mass(), 10);
  expectBruteForceSum(robot, lumped);
}

TEST(LumpedRobot, sharedRobotsKeepTheirInertia) {
  for (const char* file : {"robots/example-robot-data/robots/anymal_c_simple_description/urdf/anymal.urdf",
                           "robots/klampt/huboplus/huboplus.urdf", "robots/klampt/tx90pr2/tx90pr2.urdf"}) {
    SKIP_WITHOUT_SHARED_DATA(file);
    SCOPED_TRACE(file);
    const RobotModel robot = loadUrdfFile(*sharedData(file), UriResolver(sharedPackages()));
    expectBruteForceSum(robot, lumpFixedJoints(robot, {}, true));
  }
}

TEST(LumpedRobot, keptFixedJointsStayJoints) {
  const RobotModel robot =
      loadRobot(link("a", "1") + link("b", "2") + link("c", "3") + jointOf("ab", "fixed", "a", "b") + jointOf("bc", "fixed", "b", "c"));
  const LumpedRobot lumped = lumpFixedJoints(robot, {"bc", "no_such_joint"}, false);
  ASSERT_EQ(lumped.bodies.size(), 2u);
  ASSERT_EQ(lumped.joints.size(), 1u);
  EXPECT_EQ(lumped.joints[0].type, JointType::FIXED);
  EXPECT_EQ(lumped.joints[0].name, "bc");
  EXPECT_TRUE(lumped.joints[0].pose(3).isApprox(X_JOINT * X_JOINT, 1e-12));
  EXPECT_EQ(lumped.bodies[1].name, "c");
  EXPECT_DOUBLE_EQ(lumped.bodies[1].inertial.mass, 3);
}

TEST(LumpedRobot, posesOfJoints) {
  LumpedJoint moving;
  moving.X_PJ = X_JOINT;
  moving.axis = Vector3(0, 0.6, 0.8);
  const double q = 0.7;
  const Vector3 p(1, 2, 3);
  // Rodrigues' formula.
  const Vector3 turned = p * std::cos(q) + moving.axis.cross(p) * std::sin(q) + moving.axis * moving.axis.dot(p) * (1 - std::cos(q));
  for (JointType type : {JointType::REVOLUTE, JointType::CONTINUOUS}) {
    moving.type = type;
    EXPECT_LT((moving.pose(q) * p - X_JOINT * turned).norm(), 1e-12);
  }
  moving.type = JointType::PRISMATIC;
  EXPECT_LT((moving.pose(q) * p - X_JOINT * Vector3(p + q * moving.axis)).norm(), 1e-12);
}

TEST(LumpedRobot, planarJointBecomesTwoSlidesAndATurn) {
  for (const Vector3& normal : {Vector3(0, 0, 1), Vector3(1, 0, 0), Vector3(0, -1, 0), Vector3(0.6, 0, -0.8)}) {
    const std::string axis =
        "<axis xyz=\"" + std::to_string(normal.x()) + " " + std::to_string(normal.y()) + " " + std::to_string(normal.z()) + "\"/>";
    const RobotModel robot =
        loadRobot(link("a") + link("b", "2") + jointOf("base", "planar", "a", "b", axis + "<dynamics damping=\"0.5\"/>"));
    const LumpedRobot lumped = lumpFixedJoints(robot, {}, true);
    ASSERT_EQ(lumped.joints.size(), 3u);
    ASSERT_EQ(lumped.bodies.size(), 4u);
    EXPECT_EQ(lumped.joints[0].name, "base/x");
    EXPECT_EQ(lumped.joints[1].name, "base/y");
    EXPECT_EQ(lumped.joints[2].name, "base/yaw");
    EXPECT_EQ(lumped.bodies[3].name, "b");
    EXPECT_EQ(lumped.link_placement[1].body, 3);
    EXPECT_TRUE(lumped.joints[0].axis.cross(lumped.joints[1].axis).isApprox(normal, 1e-12));
    EXPECT_EQ(lumped.joints[2].viscous_friction, 0.5);
    const Pose X = lumped.joints[0].pose(1) * lumped.joints[1].pose(2) * lumped.joints[2].pose(0.5);
    const Vector3 in_joint = X_JOINT.inverse() * X.translation();
    EXPECT_NEAR(in_joint.dot(normal), 0, 1e-12);
    EXPECT_NEAR(in_joint.norm(), std::sqrt(5.0), 1e-12);
    for (int body = 1; body < 3; ++body) {
      EXPECT_GT(lumped.bodies[body].inertial.mass, 0);
      EXPECT_LE(lumped.bodies[body].inertial.mass, 2e-3 * (1 + 1e-12));
      EXPECT_GT(lumped.bodies[body].inertial.inertia.determinant(), 0);
    }
    EXPECT_TRUE(isNoted(lumped.notes, "planar joint 'base'"));
    EXPECT_TRUE(isNoted(lumped.notes, "weighs 0.2 % more"));
  }
  const LumpedRobot flat =
      lumpFixedJoints(loadRobot(link("a") + link("b", "2") + jointOf("base", "planar", "a", "b", "<axis xyz=\"0 0 1\"/>")), {}, true);
  EXPECT_EQ(flat.joints[0].axis, Vector3(Vector3::UnitX()));
  EXPECT_EQ(flat.joints[1].axis, Vector3(Vector3::UnitY()));
}

TEST(LumpedRobot, floatingJointIsABodyOfItsOwn) {
  const LumpedRobot lumped = lumpFixedJoints(loadRobot(link("a") + link("b", "2") + jointOf("free", "floating", "a", "b")), {}, true);
  ASSERT_EQ(lumped.joints.size(), 1u);
  EXPECT_EQ(lumped.joints[0].type, JointType::FLOATING);
  EXPECT_TRUE(lumped.joints[0].pose(5).isApprox(X_JOINT, 1e-15));
  EXPECT_EQ(lumped.bodies[0].inertial.mass, 0);  // the fixed base may be massless
}

std::string sphere(double radius, const std::string& x) {
  return "<collision><origin xyz=\"" + x + " 0 0\"/><geometry><sphere radius=\"" + std::to_string(radius) + "\"/></geometry></collision>";
}

TEST(LumpedRobot, missingInertialsComeFromShapesAndAreNoted) {
  const std::string box = "<collision><geometry><box size=\"0.1 0.2 0.3\"/></geometry></collision>";
  const std::string capsule =
      "<collision><geometry><cylinder radius=\"0.1\" length=\"0.4\"/></geometry></collision>"
      "<collision><origin xyz=\"0 0 0.2\"/><geometry><sphere radius=\"0.1\"/></geometry></collision>"
      "<collision><origin xyz=\"0 0 -0.2\"/><geometry><sphere radius=\"0.1\"/></geometry></collision>";
  const RobotModel robot = loadRobot(link("box", "", box) + link("balls", "", sphere(0.1, "1") + sphere(0.1, "-1")) +
                                     link("capsule", "", capsule) + link("nothing") + jointOf("j0", "continuous", "box", "balls") +
                                     jointOf("j1", "continuous", "balls", "capsule") + jointOf("j2", "continuous", "capsule", "nothing"));
  const LumpedRobot lumped = lumpFixedJoints(robot, {}, false);
  const Inertial& solid = lumped.bodies[0].inertial;
  EXPECT_NEAR(solid.mass, 6, 1e-9);
  EXPECT_LT((solid.inertia.diagonal() - 6.0 / 12 * Vector3(0.13, 0.1, 0.05)).norm(), 1e-9);
  const double ball = 1000 * 4.0 / 3 * M_PI * 1e-3;
  EXPECT_NEAR(lumped.bodies[1].inertial.mass, 2 * ball, 1e-9);
  EXPECT_NEAR(lumped.bodies[1].inertial.inertia(0, 0), 2 * ball * 0.4 * 0.01, 1e-9);
  EXPECT_NEAR(lumped.bodies[1].inertial.inertia(1, 1), 2 * ball * (0.4 * 0.01 + 1), 1e-9);
  // The capsule by slices: discs of radius r(z).
  double mass = 0, along = 0, across = 0;
  constexpr int SLICES = 200000;
  for (int i = 0; i < SLICES; ++i) {
    const double dz = 0.6 / SLICES, z = -0.3 + (i + 0.5) * dz, beyond = std::max(0.0, std::abs(z) - 0.2), r2 = 0.01 - beyond * beyond;
    const double m = 1000 * M_PI * r2 * dz;
    mass += m;
    along += m * r2 / 2;
    across += m * (r2 / 4 + z * z);
  }
  const Inertial& rod = lumped.bodies[2].inertial;
  EXPECT_NEAR(rod.mass, mass, 1e-6);
  EXPECT_NEAR(rod.inertia(2, 2), along, 1e-7);
  EXPECT_NEAR(rod.inertia(0, 0), across, 1e-7);
  EXPECT_EQ(lumped.bodies[3].inertial.mass, 0.01);
  for (const char* name : {"'box'", "'balls'", "'capsule'", "'nothing'"}) EXPECT_TRUE(isNoted(lumped.notes, name)) << name;
}

TEST(LumpedRobot, inertiasAreRepairedOrRefused) {
  const auto body = [](const std::string& inertia) {
    return loadRobot("<link name=\"b\"><inertial><mass value=\"2\"/><inertia " + inertia + "/></inertial></link>");
  };
  const LumpedRobot point = lumpFixedJoints(body("ixx=\"0\" ixy=\"0\" ixz=\"0\" iyy=\"0\" iyz=\"0\" izz=\"0\""), {}, false);
  EXPECT_GT(point.bodies[0].inertial.inertia.determinant(), 0);
  EXPECT_TRUE(isNoted(point.notes, "zero"));
  const LumpedRobot rod = lumpFixedJoints(body("ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"-1e-9\""), {}, false);
  EXPECT_GT(rod.bodies[0].inertial.inertia(2, 2), 0);
  EXPECT_TRUE(isNoted(rod.notes, "raised"));
  const LumpedRobot impossible = lumpFixedJoints(body("ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"3\""), {}, false);
  EXPECT_EQ(impossible.bodies[0].inertial.inertia(2, 2), 3);  // Atlas is given so; it is kept, and said
  EXPECT_TRUE(isNoted(impossible.notes, "no rigid body"));
  EXPECT_FALSE(isNoted(impossible.notes, "test.urdf")) << "the robot's name stands before all of its notes";
  const RobotModel skewed = body("ixx=\"1\" ixy=\"2\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"");
  EXPECT_TRUE(isOneLineWith(refusal([&] { lumpFixedJoints(skewed, {}, false); }), {"test.urdf", "link 'b'", "not positive definite"}));
  EXPECT_EQ(refusal([&] { lumpFixedJoints(skewed, {}, true); }), "");  // a fixed base needs none
}

TEST(LumpedRobot, massesOfLumpedLinksMayBeZero) {
  const RobotModel robot = loadRobot(link("a", "1") + link("b", "0") + jointOf("ab", "fixed", "a", "b"));
  EXPECT_EQ(lumpFixedJoints(robot, {}, false).bodies[0].inertial.mass, 1);
  EXPECT_TRUE(isOneLineWith(refusal([&] { lumpFixedJoints(robot, {"ab"}, false); }),
                            {"link 'b'", "mass is 0 kg", "force_torque", "leave the sensor out"}));
}

}  // namespace
}  // namespace blem_sim::model
