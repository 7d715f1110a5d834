// Wrenches in a stack of two links that stands on the world, level and tipped, in closed form.
#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

constexpr double MASS = 10;  // [kg] of each link

std::string stackUrdf(const std::string& type) {
  const auto link = [](const std::string& name) {
    return "<link name=\"" + name +
           "\"><inertial><origin xyz=\"0.1 0 0.5\"/><mass value=\"10\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"0.5\" "
           "ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>";
  };
  const auto joint = [&](const std::string& parent, const std::string& child, const std::string& z) {
    return "<joint name=\"" + parent + "_" + child + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" + child +
           "\"/><origin xyz=\"0 0 " + z +
           "\"/><axis xyz=\"1 0 0\"/><limit lower=\"0\" upper=\"0\" effort=\"1000000\" velocity=\"1000000\"/></joint>";
  };
  return "<robot name=\"stack\"><link name=\"base\"/>" + link("one") + link("two") + joint("base", "one", "0") + joint("one", "two", "1") +
         "<gazebo reference=\"base_one\"><sensor name=\"lower\" type=\"force_torque\"><force_torque><frame>child</frame><measure_direction>"
         "parent_to_child</measure_direction></force_torque></sensor></gazebo><gazebo reference=\"one_two\"><sensor name=\"upper\" "
         "type=\"force_torque\"/></gazebo></robot>";
}

void expectWithin(const Vector3& value, const Vector3& expected) {
  EXPECT_LT((value - expected).norm(), 1e-4 * expected.norm() + 1e-9) << value.transpose() << " against " << expected.transpose();
}

class WrenchStack : public testing::TestWithParam<const char*> {};

/** Joints of either type hold the links in place; the stack leans by gravity. */
TEST_P(WrenchStack, CarriesItsWeight) {
  for (const Vector3& gravity : {Vector3(0, 0, -50), Vector3(-30, 10, -50)}) {
    SimulationConfig config;
    config.gravity = gravity;
    config.robots = {robot("stack", stackUrdf(GetParam()), true)};
    Simulator simulator(config, model::UriResolver());
    stepFor(&simulator, 0.1);
    const Vector3 weight = -MASS * gravity, low(0.1, 0, 0.5), high(0.1, 0, 1.5);
    const ForceTorqueReading lower = reading<ForceTorqueReading>(simulator.report(), 0);
    const ForceTorqueReading upper = reading<ForceTorqueReading>(simulator.report(), 1);
    expectWithin(lower.force, 2 * weight);
    expectWithin(lower.torque, low.cross(weight) + high.cross(weight));
    expectWithin(upper.force, -weight);  // what the child exerts, unless told otherwise
    expectWithin(upper.torque, -low.cross(weight));
    EXPECT_EQ(lower.frame_id + upper.frame_id, "onetwo");
  }
}

INSTANTIATE_TEST_SUITE_P(JointTypes, WrenchStack, testing::Values("fixed", "revolute", "prismatic"),
                         [](const testing::TestParamInfo<const char*>& info) { return std::string(info.param); });

}  // namespace
}  // namespace blem_sim::sim
