// URDFs that cannot be simulated are refused with one line: source, link or joint, and the cure.
#include <gtest/gtest.h>

#include "blem_sim/model/loaders.h"
#include "support/input_errors.h"
#include "support/temporary_folder.h"

namespace blem_sim::model {
namespace {

struct BadUrdfRow {
  const char* name;
  std::string xml;
  std::vector<std::string> words;
};

std::string robot(const std::string& inside) { return "<robot name=\"r\"><link name=\"a\"/>" + inside + "</robot>"; }

std::string inertial(const std::string& mass, const std::string& ixx = "1") {
  return "<inertial><mass value=\"" + mass + "\"/><inertia ixx=\"" + ixx +
         "\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial>";
}

std::string joint(const std::string& name, const std::string& type, const std::string& parent, const std::string& child,
                  const std::string& inside = "") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" + child + "\"/>" + inside +
         "</joint>";
}

const std::string LIMIT = "<limit lower=\"-1\" upper=\"1\" effort=\"1\" velocity=\"1\"/>";

/** Two links and a joint between them. */
std::string arm(const std::string& type, const std::string& inside, const std::string& link = "") {
  return robot("<link name=\"b\">" + link + "</link>" + joint("j", type, "a", "b", inside));
}

std::string collisionOf(const std::string& shape) {
  return robot("<link name=\"b\"><collision><geometry>" + shape + "</geometry></collision></link>");
}

class BadUrdfs : public testing::TestWithParam<BadUrdfRow> {};

/** Loads and lumps, as a simulation does. */
std::string refusalOf(const std::string& xml) {
  return refusal([&] { lumpFixedJoints(loadUrdf(xml, "test.urdf", UriResolver()), {}, true); });
}

TEST_P(BadUrdfs, areRefusedInOneLineAndNothingIsPrinted) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const std::string text = refusalOf(GetParam().xml);
  const std::string printed = testing::internal::GetCapturedStdout() + testing::internal::GetCapturedStderr();
  EXPECT_TRUE(isOneLineWith(text, GetParam().words)) << text;
  EXPECT_TRUE(isOneLineWith(text, {"test.urdf"})) << text;
  EXPECT_EQ(printed, "");
}

INSTANTIATE_TEST_SUITE_P(
    All, BadUrdfs,
    testing::Values(
        BadUrdfRow{"empty", "", {"empty"}}, BadUrdfRow{"not_xml", "# this is a\ntext file", {"not XML"}},
        BadUrdfRow{"entity",
                   "<robot name=\"r\"><link name=\"a\"/><link name=\"b\"/><joint name=\"&b\" type=\"fixed\"><parent link=\"a\"/>"
                   "<child link=\"b\"/></joint></robot>",
                   {"joint '&b'", "&amp;"}},
        BadUrdfRow{"cut", "<robot name=\"r\"><link name=\"a\">", {"not XML", "line 1"}},
        BadUrdfRow{"other_root", "<sdf version=\"1.6\"/>", {"<sdf>", "<robot"}},
        BadUrdfRow{"no_name", "<robot><link name=\"a\"/></robot>", {"name"}},
        BadUrdfRow{"xacro", robot("<xacro:macro name=\"m\"/>"), {"xacro", "expand"}},
        BadUrdfRow{"xacro_inside", robot("<link name=\"b\"><xacro:inertia m=\"1\"/></link>"), {"<xacro:inertia>", "expand"}},
        BadUrdfRow{"xacro_name", robot("<link name=\"${prefix}b\"/>"), {"<link name=\"${prefix}b\">", "xacro", "expand"}},
        BadUrdfRow{"xacro_number", arm("continuous", "", inertial("${mass}")), {"<mass value=\"${mass}\">", "expand"}},
        BadUrdfRow{"xacro_argument", arm("$(arg kind)", ""), {"$(arg kind)", "expand"}},
        BadUrdfRow{"no_link", "<robot name=\"r\"/>", {"no link"}},
        BadUrdfRow{"same_links", robot("<link name=\"a\"/>"), {"link 'a'", "twice"}},
        BadUrdfRow{"same_joints",
                   robot("<link name=\"b\"/><link name=\"c\"/>" + joint("j", "fixed", "a", "b") + joint("j", "fixed", "a", "c")),
                   {"joint 'j'", "twice"}},
        BadUrdfRow{"two_roots", robot("<link name=\"b\"/>"), {"2 links have no parent (a, b)"}},
        BadUrdfRow{"no_root", robot("<link name=\"b\"/>" + joint("j", "fixed", "a", "b") + joint("k", "fixed", "b", "a")), {"loop"}},
        BadUrdfRow{"loop",
                   robot("<link name=\"b\"/><link name=\"c\"/>" + joint("j", "fixed", "b", "c") + joint("k", "fixed", "c", "b")),
                   {"loop", "'b'"}},
        BadUrdfRow{"two_parents",
                   robot("<link name=\"b\"/><link name=\"c\"/>" + joint("j", "fixed", "a", "b") + joint("k", "fixed", "c", "b")),
                   {"link 'b'", "'j' and 'k'"}},
        BadUrdfRow{"itself", robot(joint("j", "fixed", "a", "a")), {"joint 'j'", "itself"}},
        BadUrdfRow{"unknown_link", robot(joint("j", "fixed", "a", "z")), {"joint 'j'", "no link 'z'"}},
        BadUrdfRow{"no_child", robot("<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/></joint>"), {"joint 'j'", "child"}},
        BadUrdfRow{"joint_type", arm("hinge", ""), {"joint 'j'", "'hinge'", "revolute"}},
        BadUrdfRow{"no_limit", arm("revolute", ""), {"joint 'j'", "<limit", "continuous"}},
        BadUrdfRow{"no_effort", arm("prismatic", "<limit lower=\"0\" upper=\"1\" velocity=\"1\"/>"), {"joint 'j'", "effort"}},
        BadUrdfRow{
            "crossed_limits", arm("revolute", "<limit lower=\"1\" upper=\"-1\" effort=\"1\" velocity=\"1\"/>"), {"joint 'j'", "above"}},
        BadUrdfRow{"negative_effort", arm("continuous", "<limit effort=\"-1\" velocity=\"1\"/>"), {"joint 'j'", "effort limit -1"}},
        BadUrdfRow{"negative_damping", arm("continuous", "<dynamics damping=\"-1\"/>"), {"joint 'j'", "damping"}},
        BadUrdfRow{"nan_limit", arm("revolute", "<limit lower=\"nan\" upper=\"1\" effort=\"1\" velocity=\"1\"/>"), {"joint 'j'", "'nan'"}},
        BadUrdfRow{"comma", arm("continuous", "<origin xyz=\"0,5 0 0\"/>"), {"joint 'j'", "'0,5'"}},
        BadUrdfRow{"two_numbers", arm("continuous", "<origin xyz=\"0 0\"/>"), {"joint 'j'", "3 numbers expected, 2 given"}},
        BadUrdfRow{"no_axis", arm("continuous", "<axis xyz=\"0 0 0\"/>"), {"joint 'j'", "axis"}},
        BadUrdfRow{"unknown_mimic", arm("continuous", "<mimic joint=\"z\"/>"), {"joint 'j'", "unknown joint 'z'"}},
        BadUrdfRow{"own_mimic", arm("continuous", "<mimic joint=\"j\"/>"), {"joint 'j'", "mimics itself"}},
        BadUrdfRow{"cyclic_mimic",
                   robot("<link name=\"b\"/><link name=\"c\"/>" + joint("j", "continuous", "a", "b", "<mimic joint=\"k\"/>") +
                         joint("k", "continuous", "b", "c", "<mimic joint=\"j\"/>")),
                   {"joint 'j'", "mimics itself through 'k'"}},
        BadUrdfRow{"fixed_mimic",
                   robot("<link name=\"b\"/><link name=\"c\"/>" + joint("j", "continuous", "a", "b", "<mimic joint=\"k\"/>") +
                         joint("k", "fixed", "b", "c")),
                   {"joint 'j'", "'k', which is fixed"}},
        BadUrdfRow{"zero_mass", arm("continuous", "", inertial("0")), {"link 'b'", "mass is 0 kg"}},
        BadUrdfRow{"negative_mass", arm("continuous", "", inertial("-2")), {"link 'b'", "-2 kg is negative"}},
        BadUrdfRow{"nan_mass", arm("continuous", "", inertial("nan")), {"link 'b'", "'nan'"}},
        BadUrdfRow{"infinite_inertia", arm("continuous", "", inertial("1", "1e999")), {"link 'b'", "1e999"}},
        BadUrdfRow{"negative_inertia", arm("continuous", "", inertial("1", "-1")), {"link 'b'", "not positive definite"}},
        BadUrdfRow{"no_mass", arm("continuous", "", "<inertial><inertia ixx=\"1\"/></inertial>"), {"link 'b'", "<mass"}},
        BadUrdfRow{"no_inertia", arm("continuous", "", "<inertial><mass value=\"1\"/></inertial>"), {"link 'b'", "<inertia"}},
        BadUrdfRow{
            "half_inertia", arm("continuous", "", "<inertial><mass value=\"1\"/><inertia ixx=\"1\"/></inertial>"), {"link 'b'", "ixy"}},
        BadUrdfRow{"no_shape", collisionOf(""), {"link 'b' collision 1", "<box>"}},
        BadUrdfRow{"cone", collisionOf("<cone/>"), {"link 'b'", "<cone>"}},
        BadUrdfRow{"capsule", collisionOf("<capsule/>"), {"link 'b'", "<sphere>"}},
        BadUrdfRow{"flat_box", collisionOf("<box size=\"1 0 1\"/>"), {"link 'b'", "greater than zero"}},
        BadUrdfRow{"negative_radius", collisionOf("<sphere radius=\"-1\"/>"), {"link 'b'", "greater than zero"}},
        BadUrdfRow{"no_file", collisionOf("<mesh/>"), {"link 'b'", "filename"}},
        BadUrdfRow{"missing_mesh",
                   arm("continuous", "", "<collision><geometry><mesh filename=\"package://none/a.stl\"/></geometry></collision>"),
                   {"link 'b' collision 1", "package://none/a.stl", "tried", "--package"}}),
    [](const testing::TestParamInfo<BadUrdfRow>& info) { return std::string(info.param.name); });

TEST(BadUrdf, whatUrdfdomRefusesBesidesIsSaidInOneLine) {
  const std::string text = refusalOf(robot("<material name=\"\"/><material/>"));
  if (!text.empty()) {
    EXPECT_TRUE(isOneLineWith(text, {"test.urdf", "not a URDF"})) << text;
  }
  const std::string version = refusalOf("<robot name=\"r\" version=\"7.3\"><link name=\"a\"/></robot>");
  EXPECT_TRUE(isOneLineWith(version, {"test.urdf", "not a URDF", "version"})) << version;
}

TEST(BadUrdf, filesThatAreMissing) {
  EXPECT_TRUE(isOneLineWith(refusal([] { loadUrdfFile("/nowhere/robot.urdf", UriResolver()); }), {"/nowhere/robot.urdf", "no such file"}));
}

TEST(BadUrdf, damagedMeshIsNamedWithItsLink) {
  const TemporaryFolder folder;
  folder.write("a.stl", "short");
  const std::string text = refusal([&] {
    loadUrdf(arm("continuous", "", "<collision><geometry><mesh filename=\"a.stl\"/></geometry></collision>"), "test.urdf", UriResolver(),
             {folder.path()});
  });
  EXPECT_TRUE(isOneLineWith(text, {"test.urdf", "link 'b' collision 1", folder.path("a.stl"), "truncated"})) << text;
}

}  // namespace
}  // namespace blem_sim::model
