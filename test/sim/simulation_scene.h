// Small scenes for the tests of the simulation: mesh files in a folder of their own, configurations by hand, inline robots.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iomanip>
#include <string>

#include "blem_sim/sim/simulator.h"

namespace blem_sim::sim {

constexpr double G = 9.81;  // [m/s^2], the default configuration's

inline std::filesystem::path sceneFolderOf(pid_t process) {
  return std::filesystem::path(testing::TempDir()) / ("blem_sim_scene." + std::to_string(process));
}

/** Folder of one process, which ends with it: programs that run side by side write other files of the same names.
    That of a child that ends by _exit or a signal is its parent's to remove. */
class SceneFolder {
 public:
  SceneFolder() : path(sceneFolderOf(getpid())) { std::filesystem::create_directories(path); }
  SceneFolder(const SceneFolder&) = delete;
  SceneFolder& operator=(const SceneFolder&) = delete;
  ~SceneFolder() {
    std::error_code ignored;
    if (getpid() == owner_) std::filesystem::remove_all(path, ignored);
  }

  const std::filesystem::path path;

 private:
  const pid_t owner_ = getpid();  // a child that was forked leaves its parent's files alone
};

inline const std::filesystem::path& sceneFolder() {
  static const SceneFolder folder;
  return folder.path;
}

/** Writes a file of that name, in place of one that was written before, and tells its path. */
template <typename Write>
std::string sceneFile(const std::string& name, Write&& write) {
  const std::string file = (sceneFolder() / name).string();
  std::ofstream out(file);
  write(out);
  return file;
}

inline std::string meshFile(const std::string& name, const geometry::TriangleMesh& mesh) {
  return sceneFile(name + ".off", [&](std::ofstream& out) {
    out << std::setprecision(17) << "OFF\n" << mesh.vertices.size() << " " << mesh.elements.size() << " 0\n";
    for (const Vector3& v : mesh.vertices) out << v.x() << " " << v.y() << " " << v.z() << "\n";
    for (const Vector3i& e : mesh.elements) out << "3 " << e[0] << " " << e[1] << " " << e[2] << "\n";
  });
}

inline std::string pointsFile(const std::string& name, const std::vector<Vector3>& points) {
  return sceneFile(name + ".pcd", [&](std::ofstream& out) {
    out << "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " << points.size()
        << "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " << points.size() << "\nDATA ascii\n";
    for (const Vector3& p : points) out << p.x() << " " << p.y() << " " << p.z() << "\n";
  });
}

inline EnvironmentConfig pointCloud(const std::string& name, const std::vector<Vector3>& points) {
  EnvironmentConfig environment;
  environment.name = "cloud";
  environment.uri = pointsFile(name, points);
  return environment;
}

/** A mesh of two triangles at z = 0. */
inline EnvironmentConfig ground(double size = 4) {
  EnvironmentConfig environment;
  environment.name = "ground";
  environment.uri = meshFile("ground" + std::to_string(static_cast<int>(1000 * size)), geometry::gridMesh(size, size, 1, 1));
  return environment;
}

/** A closed box of triangles; its layer of 2.5 mm comes on top. */
inline ObjectConfig box(const std::string& name, const Vector3& size, double mass, const Vector3& position) {
  ObjectConfig object;
  object.name = name;
  object.uri = meshFile("box_" + std::to_string(size.x()) + "_" + std::to_string(size.y()) + "_" + std::to_string(size.z()),
                        geometry::boxMesh(size));
  object.mass = mass;
  object.X_WO = makePose(position);
  return object;
}

/** A solid sphere that is no mesh. */
inline ObjectConfig exactBall(const std::string& name, double radius, double mass) {
  ObjectConfig object;
  object.name = name;
  object.mass = mass;
  object.urdf_xml = fmt::format(
      R"(<robot name="ball"><link name="link"><inertial><mass value="{0}"/><inertia ixx="{1}" iyy="{1}" izz="{1}" ixy="0" ixz="0" iyz="0"/>)"
      R"(</inertial><collision><geometry><sphere radius="{2}"/></geometry></collision></link></robot>)",
      mass, 0.4 * mass * radius * radius, radius);
  return object;
}

/** A flat square of two triangles, free to move. */
inline ObjectConfig sheet(const std::string& name, double side, double mass, const Pose& X_WO) {
  ObjectConfig object;
  object.name = name;
  object.uri = meshFile("sheet_" + std::to_string(side), geometry::gridMesh(side, side, 1, 1));
  object.mass = mass;
  object.X_WO = X_WO;
  object.com = Vector3::Zero();
  object.inertia = mass * side * side / 12 * Vector3(1, 1, 2).asDiagonal();
  return object;
}

/** A robot whose joints move freely unless a test gives them gains, which are Eq. 7's unless it says otherwise. */
inline RobotConfig robot(const std::string& name, const std::string& urdf, bool fixed_base) {
  RobotConfig config;
  config.motors = MotorDefault::FREE;
  config.motor["default"] = MotorLaw::PID;
  config.name = name;
  config.urdf_xml = urdf;
  config.fixed_base = fixed_base;
  return config;
}

inline void stepFor(Simulator* simulator, double seconds) {
  const long steps = std::lround(seconds / simulator->config().time_step);
  for (long i = 0; i < steps; ++i) simulator->step();
}

inline dynamics::BodyState bodyOf(const Simulator& simulator, const std::string& model) {
  return simulator.report().bodies[simulator.models()[simulator.modelIndex(model)].bodies[0]];
}

/** Pushes a model of some ug with the largest load there is: its next state is out of all bounds. */
inline void tearAway(const std::string& model, Simulator* simulator) {
  BodyLoad load;
  load.body = simulator->models()[simulator->modelIndex(model)].bodies[0];
  load.wrench.force.x() = LARGEST_COMMAND;
  load.p_B = Vector3::Zero();
  simulator->applyLoad(load, {0, -1});
}

/** [N] of all contacts that fixed surfaces have with bodies. */
inline Vector3 forceOfWorld(const StepReport& report) {
  Vector3 force = Vector3::Zero();
  for (const ContactReport& contact : report.contacts) {
    if (contact.body_a == dynamics::WORLD_BODY) force -= contact.force;
    if (contact.body_b == dynamics::WORLD_BODY) force += contact.force;
  }
  return force;
}

/** The last reading of a sensor of the report. */
template <typename Reading>
Reading reading(const StepReport& report, int sensor) {
  for (const SensorSample& sample : report.samples)
    if (sample.sensor == sensor) return std::get<Reading>(sample.reading);
  ADD_FAILURE() << "sensor " << sensor << " has no reading";
  return Reading();
}

/** One link of 2 kg on a hinge about y, its centre of mass 0.5 m along x from the hinge; no collision shape. */
inline std::string pendulumUrdf(const std::string& joint_extras = "") {
  return R"(<robot name="pendulum">
  <link name="base"/>
  <link name="arm">
    <inertial><origin xyz="0.5 0 0"/><mass value="2"/><inertia ixx="0.01" iyy="0.02" izz="0.03" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <joint name="hinge" type="revolute">
    <parent link="base"/><child link="arm"/><origin xyz="0 0 1"/><axis xyz="0 1 0"/>
    <limit lower="-3" upper="3" effort="200" velocity="10"/>)" +
         joint_extras + R"(
  </joint>
</robot>)";
}

}  // namespace blem_sim::sim
