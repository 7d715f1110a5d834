#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "blem_sim/model/loaders.h"
#include "support/input_errors.h"
#include "support/temporary_folder.h"

namespace blem_sim::model {
namespace {

constexpr double INFINITE = std::numeric_limits<double>::infinity();

RobotModel load(const std::string& inside, const std::string& base = "") {
  return loadUrdf("<?xml version=\"1.0\"?><robot name=\"r\">" + inside + "</robot>", "test.urdf", UriResolver(), {base});
}

bool noted(const std::vector<std::string>& notes, const std::string& words) {
  return std::any_of(notes.begin(), notes.end(), [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

TEST(UrdfLoader, everyJointType) {
  std::string inside = "<link name=\"l0\"/>";
  const char* const types[] = {"fixed", "revolute", "continuous", "prismatic", "planar", "floating"};
  for (int i = 0; i < 6; ++i) {
    const std::string n = std::to_string(i);
    inside +=
        "<link name=\"l" + std::to_string(i + 1) + "\"/><joint name=\"j" + n + "\" type=\"" + types[i] + "\"><parent link=\"l" + n +
        "\"/><child link=\"l" + std::to_string(i + 1) + "\"/><axis xyz=\"0 3 4\"/><origin xyz=\"1 2 3\" rpy=\"0.1 0.2 0.3\"/>" +
        "<limit lower=\"-0.5\" upper=\"1e6\" effort=\"1000000\" velocity=\"2.5\"/><dynamics damping=\"0.25\" friction=\"0.75\"/></joint>";
  }
  const RobotModel robot = load(inside);
  const JointType expected[] = {JointType::FIXED,     JointType::REVOLUTE, JointType::CONTINUOUS,
                                JointType::PRISMATIC, JointType::PLANAR,   JointType::FLOATING};
  ASSERT_EQ(robot.joints.size(), 6u);
  for (int i = 0; i < 6; ++i) {
    const JointModel& joint = robot.joints[i];
    EXPECT_EQ(joint.type, expected[i]);
    EXPECT_EQ(joint.parent, i);
    EXPECT_EQ(joint.child, i + 1);
    EXPECT_TRUE(joint.X_PJ.isApprox(makePose(Vector3(1, 2, 3), Vector3(0.1, 0.2, 0.3)), 1e-12));
    const bool has_axis = joint.type != JointType::FIXED && joint.type != JointType::FLOATING;
    EXPECT_TRUE(joint.axis.isApprox(has_axis ? Vector3(0, 0.6, 0.8) : Vector3(Vector3::UnitX()), 1e-15));
    const bool ranged = joint.type == JointType::REVOLUTE || joint.type == JointType::PRISMATIC;
    EXPECT_EQ(joint.limits.lower, ranged ? -0.5 : -INFINITE);
    EXPECT_EQ(joint.limits.upper, INFINITE);
    EXPECT_EQ(joint.limits.effort, INFINITE);
    EXPECT_EQ(joint.limits.velocity, 2.5);
    EXPECT_EQ(joint.dry_friction, 0.75);
    EXPECT_EQ(joint.viscous_friction, 0.25);
  }
}

TEST(UrdfLoader, jointsComeAfterTheirParentsElseInTheFilesOrder) {
  const auto fixed = [](const std::string& name, const std::string& parent, const std::string& child) {
    return "<joint name=\"" + name + "\" type=\"fixed\"><parent link=\"" + parent + "\"/><child link=\"" + child + "\"/></joint>";
  };
  const RobotModel robot =
      load("<link name=\"z\"/><link name=\"y\"/><link name=\"root\"/><link name=\"a\"/><link name=\"b\"/>" + fixed("grandchild", "y", "z") +
           fixed("second", "root", "b") + fixed("third", "root", "y") + fixed("first", "b", "a"));
  std::string order;
  for (const JointModel& joint : robot.joints) order += joint.name + " ";
  EXPECT_EQ(order, "second third grandchild first ");
  EXPECT_EQ(robot.links[robot.root].name, "root");
  EXPECT_EQ(robot.linkIndex("y"), 1);  // links keep the file's order
  EXPECT_EQ(robot.linkIndex("none"), -1);
  EXPECT_EQ(robot.jointIndex("third"), 1);
  EXPECT_EQ(robot.jointIndex("none"), -1);
}

TEST(UrdfLoader, mimicKeepsItsDirectMaster) {
  const auto turn = [](int i, const std::string& mimic) {
    const std::string n = std::to_string(i);
    return "<link name=\"l" + std::to_string(i + 1) + "\"/><joint name=\"j" + n + "\" type=\"continuous\"><parent link=\"l" + n +
           "\"/><child link=\"l" + std::to_string(i + 1) + "\"/>" + mimic + "</joint>";
  };
  const RobotModel robot = load("<link name=\"l0\"/>" + turn(0, "") + turn(1, "<mimic joint=\"j0\" multiplier=\"-2\" offset=\"0.5\"/>") +
                                turn(2, "<mimic joint=\"j1\"/>"));
  EXPECT_FALSE(robot.joints[0].mimic);
  ASSERT_TRUE(robot.joints[1].mimic && robot.joints[2].mimic);
  EXPECT_EQ(robot.joints[1].mimic->multiplier, -2);
  EXPECT_EQ(robot.joints[1].mimic->offset, 0.5);
  EXPECT_EQ(robot.joints[2].mimic->joint, "j1");
  EXPECT_EQ(robot.joints[2].mimic->multiplier, 1);
  EXPECT_EQ(robot.joints[2].mimic->offset, 0);
}

std::string collision(const std::string& shape, const std::string& xyz = "0 0 0", const std::string& rpy = "0 0 0") {
  return "<collision><origin xyz=\"" + xyz + "\" rpy=\"" + rpy + "\"/><geometry>" + shape + "</geometry></collision>";
}

TEST(UrdfLoader, primitivesStandInTheLinksFrame) {
  const RobotModel robot = load("<link name=\"a\">" + collision("<box size=\"1 2 3\"/>", "10 0 0", "0 0 1.5707963267948966") +
                                collision("<cylinder radius=\"0.5\" length=\"4\"/>", "0 0 7", "1.5707963267948966 0 0") +
                                collision("<sphere radius=\"0.25\"/>", "1 2 3") + "</link>");
  const std::vector<CollisionShape>& shapes = robot.links[0].collisions;
  ASSERT_EQ(shapes.size(), 3u);
  EXPECT_EQ(shapes[0].report.triangles, 12);
  EXPECT_TRUE(shapes[0].report.closed);
  EXPECT_EQ(shapes[0].report.name, "r::a");
  EXPECT_EQ(shapes[0].radius, 0);
  EXPECT_TRUE(shapes[0].mesh->bounds().min().isApprox(Vector3(9, -0.5, -1.5), 1e-9));
  EXPECT_TRUE(shapes[0].report.extents.max().isApprox(Vector3(11, 0.5, 1.5), 1e-9));
  EXPECT_TRUE(shapes[1].report.closed);
  EXPECT_NEAR(shapes[1].mesh->bounds().sizes().y(), 4, 1e-9);
  EXPECT_NEAR(shapes[1].mesh->bounds().sizes().x(), 1, 5e-3);
  ASSERT_EQ(shapes[2].mesh->elements.size(), 1u);
  EXPECT_TRUE(shapes[2].mesh->isPoint(0));
  EXPECT_EQ(shapes[2].mesh->vertices[0], Vector3(1, 2, 3));
  EXPECT_EQ(shapes[2].radius, 0.25);
  EXPECT_EQ(shapes[2].report.boundary_width, 0.25);
}

TEST(UrdfLoader, whatIsOnlyDrawnTakesNothingAway) {
  const std::string inertial = R"(<inertial><mass value="2"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>)";
  for (const char* visual : {"", "<geometry/>", "<geometry><capsule radius=\"1\" length=\"1\"/></geometry>", "<geometry><mesh/></geometry>",
                             "<origin xyz=\"0 0\"/><geometry><sphere radius=\"1 \"/></geometry>", "<material/>"}) {
    const RobotModel robot = load("<material name=\"m\"/><material name=\"m\"/><link name=\"a\">" + inertial + "<visual>" + visual +
                                  "</visual>" + collision("<box size=\"1 1 1\"/>") + "</link>");
    EXPECT_EQ(robot.links[0].collisions.size(), 1u) << visual;
    EXPECT_EQ(robot.links[0].inertial->mass, 2) << visual;
  }
}

TEST(UrdfLoader, whiteSpaceAroundNumbersMeansNothing) {
  const RobotModel robot = load(
      "<link name=\"a\"><inertial><mass value=\" 2 \"/><inertia ixx=\"1 \" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" "
      "izz=\"3\n\"/></inertial>" +
      collision("<sphere radius=\"0.5 \"/>", " 1\t2\n3 ") + "</link>");
  EXPECT_EQ(robot.links[0].inertial->mass, 2);
  EXPECT_EQ(robot.links[0].inertial->inertia(2, 2), 3);
  ASSERT_EQ(robot.links[0].collisions.size(), 1u);
  EXPECT_EQ(robot.links[0].collisions[0].radius, 0.5);
  EXPECT_EQ(robot.links[0].collisions[0].mesh->vertices[0], Vector3(1, 2, 3));
}

TEST(UrdfLoader, cylinderWithSpheresAtItsEndsIsOneCapsule) {
  const std::string ends = collision("<sphere radius=\"0.1\"/>", "1.5 0 0") + collision("<sphere radius=\"0.1\"/>", "0.5 0 0");
  const std::string middle = collision("<cylinder radius=\"0.1\" length=\"1\"/>", "1 0 0", "0 1.5707963267948966 0");
  const RobotModel robot = load("<link name=\"a\">" + ends + middle + collision("<sphere radius=\"0.1\"/>", "1.5 0 0") + "</link>");
  const std::vector<CollisionShape>& shapes = robot.links[0].collisions;
  ASSERT_EQ(shapes.size(), 2u);  // the capsule, and the sphere that was there twice
  const auto capsule = std::find_if(shapes.begin(), shapes.end(), [](const CollisionShape& shape) { return shape.report.segments == 1; });
  ASSERT_NE(capsule, shapes.end());
  EXPECT_EQ(capsule->radius, 0.1);
  EXPECT_TRUE(capsule->mesh->bounds().min().isApprox(Vector3(0.5, 0, 0), 1e-9));
  EXPECT_TRUE(capsule->mesh->bounds().max().isApprox(Vector3(1.5, 0, 0), 1e-9));
  EXPECT_TRUE(noted(robot.notes, "capsule"));
  // One end of another radius: three shapes as given.
  const RobotModel three = load("<link name=\"a\">" + middle + collision("<sphere radius=\"0.1\"/>", "1.5 0 0") +
                                collision("<sphere radius=\"0.2\"/>", "0.5 0 0") + "</link>");
  EXPECT_EQ(three.links[0].collisions.size(), 3u);
}

TEST(UrdfLoader, meshesAreScaledThenPlaced) {
  const TemporaryFolder folder;
  folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const std::string mesh = "<mesh filename=\"a.obj\" scale=\"1 -2 3\"/>";
  const RobotModel robot =
      load("<link name=\"a\">" + collision(mesh, "0 0 10", "0 0 3.14159265358979") + collision(mesh) + "</link>", folder.path());
  const std::vector<CollisionShape>& shapes = robot.links[0].collisions;
  ASSERT_EQ(shapes.size(), 2u);
  EXPECT_LT((shapes[0].report.extents.min() - Vector3(-1, 0, 10)).norm(), 1e-9);
  EXPECT_LT((shapes[0].mesh->bounds().max() - Vector3(0, 2, 13)).norm(), 1e-9);
  EXPECT_LT((shapes[1].report.extents.min() - Vector3(0, -2, 0)).norm(), 1e-9);
  EXPECT_EQ(shapes[1].report.source, folder.path("a.obj"));
}

TEST(UrdfLoader, inertialFramesTurnTheInertia) {
  const RobotModel robot = load(
      "<link name=\"a\"><inertial><origin xyz=\"1 2 3\" rpy=\"0 0 1.5707963267948966\"/><mass value=\"4\"/>"
      "<inertia ixx=\"1\" ixy=\"0.1\" ixz=\"0.2\" iyy=\"2\" iyz=\"0.3\" izz=\"2.5\"/></inertial></link>");
  ASSERT_TRUE(robot.links[0].inertial);
  const Inertial& inertial = *robot.links[0].inertial;
  EXPECT_EQ(inertial.mass, 4);
  EXPECT_TRUE(inertial.com.isApprox(Vector3(1, 2, 3), 1e-15));
  // The frame is turned by 90 deg about z: x becomes y, y becomes -x.
  Matrix3 expected;
  expected << 2, -0.1, -0.3, -0.1, 1, 0.2, -0.3, 0.2, 2.5;
  EXPECT_TRUE(inertial.inertia.isApprox(expected, 1e-12)) << inertial.inertia;
}

TEST(UrdfLoader, safetyControllersAreRead) {
  const auto robot = [](const std::string& attributes) {
    return load(
        "<link name=\"a\"/><link name=\"b\"/><joint name=\"j\" type=\"continuous\"><parent link=\"a\"/><child link=\"b\"/>"
        "<safety_controller " +
        attributes + "/></joint>");
  };
  const SafetyController safety =
      *robot("soft_lower_limit=\"-1\" soft_upper_limit=\"2\" k_position=\"15\" k_velocity=\"10\"").joints[0].safety;
  EXPECT_EQ(safety.lower, -1);
  EXPECT_EQ(safety.upper, 2);
  EXPECT_EQ(safety.k_position, 15);
  EXPECT_EQ(safety.k_velocity, 10);
  for (const char* bad : {"k_position=\"1\"", "k_velocity=\"-1\"", "k_velocity=\"fast\"", "k_velocity=\"1\" soft_upper_limit=\"inf\""})
    EXPECT_THROW(robot(bad), InputError) << bad;
}

TEST(UrdfLoader, transmissionsAreRead) {
  const auto robot = [](const std::string& transmission) {
    return load(
        "<link name=\"a\"/><link name=\"b\"/><joint name=\"j\" type=\"continuous\"><parent link=\"a\"/><child link=\"b\"/></joint>" +
        transmission);
  };
  const RobotModel with = robot(
      "<transmission name=\"t\"><type>transmission_interface/SimpleTransmission</type><joint name=\"j\"><offset> 0.2 </offset></joint>"
      "<actuator name=\"m\"><mechanicalReduction>-50</mechanicalReduction></actuator></transmission>"
      "<transmission name=\"other\"><joint name=\"k\"/></transmission>");
  ASSERT_EQ(with.transmissions.size(), 1u);
  EXPECT_EQ(with.transmissionOf("j")->reduction, -50);
  EXPECT_EQ(with.transmissionOf("j")->offset, 0.2);
  EXPECT_EQ(with.transmissionOf("k"), nullptr);
  EXPECT_TRUE(noted(with.notes, "no joint 'k'"));
  EXPECT_EQ(robot("<transmission name=\"t\"><joint name=\"j\"/><mechanicalReduction>7</mechanicalReduction></transmission>")
                .transmissionOf("j")
                ->reduction,
            7);
  for (const char* bad : {"0", "fast", "1 2", "nan", ""})
    EXPECT_THROW(robot(std::string("<transmission name=\"t\"><joint name=\"j\"/><actuator name=\"m\"><mechanicalReduction>") + bad +
                       "</mechanicalReduction></actuator></transmission>"),
                 InputError)
        << bad;
}

TEST(UrdfLoader, everyJointOfATransmissionHasIt) {
  const RobotModel robot = load(
      "<link name=\"a\"/><link name=\"b\"/><link name=\"c\"/>"
      "<joint name=\"j\" type=\"continuous\"><parent link=\"a\"/><child link=\"b\"/></joint>"
      "<joint name=\"k\" type=\"continuous\"><parent link=\"b\"/><child link=\"c\"/></joint>"
      "<transmission name=\"wrist\"><type>transmission_interface/DifferentialTransmission</type>"
      "<joint name=\"j\"><role>joint1</role></joint><joint "
      "name=\"k\"><role>joint2</role><mechanicalReduction>3</mechanicalReduction></joint>"
      "<actuator name=\"m\"><mechanicalReduction>10</mechanicalReduction></actuator><actuator name=\"n\"/></transmission>");
  ASSERT_NE(robot.transmissionOf("j"), nullptr);
  ASSERT_NE(robot.transmissionOf("k"), nullptr);
  EXPECT_EQ(robot.transmissionOf("j")->reduction, 1);
  EXPECT_EQ(robot.transmissionOf("k")->reduction, 3);
}

TEST(UrdfLoader, notesSayWhatIsLeftOut) {
  const RobotModel robot = load(
      "<link name=\"a\"/><link name=\"b\"/><wheel/><wheel/><transmission name=\"t\"/>"
      "<joint name=\"j\" type=\"revolute\"><parent link=\"a\"/><child link=\"b\"/><limit effort=\"0\" velocity=\"1\"/>"
      "<safety_controller k_velocity=\"1\"/></joint>");
  for (const char* words : {"<wheel> left out (2", "transmission 't' left out", "cannot move", "touches nothing"})
    EXPECT_TRUE(noted(robot.notes, words)) << words;
}

}  // namespace
}  // namespace blem_sim::model
