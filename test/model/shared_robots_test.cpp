// Every robot of the shared data loads, with the masses and joints its README states.
#include <gtest/gtest.h>

#include "blem_sim/model/loaders.h"
#include "support/shared_data.h"
#include "support/shared_packages.h"

namespace blem_sim::model {
namespace {

struct RobotRow {
  const char* file;
  std::size_t links;
  int moving_joints;
  int triangles;  ///< of collision meshes, as the files hold them
  double mass;    ///< [kg]
};

class SharedRobots : public testing::TestWithParam<RobotRow> {};

TEST_P(SharedRobots, loadsWithMassAndJointsOfItsReadme) {
  const RobotRow& row = GetParam();
  SKIP_WITHOUT_SHARED_DATA(row.file);
  const RobotModel robot = loadUrdfFile(*sharedData(row.file), UriResolver(sharedPackages()), {"", Mending::OFF});
  const LumpedRobot lumped = lumpFixedJoints(robot, {}, true);
  EXPECT_EQ(robot.links.size(), row.links);
  EXPECT_EQ(static_cast<int>(lumped.joints.size()), row.moving_joints);
  EXPECT_EQ(lumped.bodies.size(), lumped.joints.size() + 1);
  EXPECT_NEAR(lumped.mass(), row.mass, 0.005);
  int triangles = 0;
  for (const LinkModel& link : robot.links) {
    for (const CollisionShape& shape : link.collisions) {
      EXPECT_FALSE(shape.mesh->elements.empty()) << shape.report.name;
      const geometry::MeshReport& report = shape.report;
      if (report.source.find('.') != std::string::npos && report.source.find('/') != std::string::npos)
        triangles += report.triangles + report.degenerate + report.duplicate + report.nonfinite;
    }
  }
  EXPECT_EQ(triangles, row.triangles);
}

INSTANTIATE_TEST_SUITE_P(
    Readme, SharedRobots,
    testing::Values(RobotRow{"robots/example-robot-data/robots/anymal_c_simple_description/urdf/anymal.urdf", 78, 12, 0, 52.13},
                    RobotRow{"robots/example-robot-data/robots/panda_description/urdf/panda.urdf", 13, 9, 2300, 17.45},
                    RobotRow{"robots/example-robot-data/robots/ur_description/urdf/ur5_robot.urdf", 11, 6, 5328, 20.99},
                    RobotRow{"robots/klampt/atlas/atlas.urdf", 41, 29, 16255, 90.78},
                    RobotRow{"robots/klampt/huboplus/huboplus.urdf", 58, 57, 87640, 40.80},
                    RobotRow{"robots/klampt/pr2gripper/pr2gripper.urdf", 6, 4, 5194, 2.40},
                    RobotRow{"robots/klampt/tx90l/tx90l.urdf", 8, 6, 68243, 51.10},
                    RobotRow{"robots/klampt/tx90pr2/tx90pr2.urdf", 13, 10, 72477, 53.40},
                    RobotRow{"robots/robotiq_arg85_description/robots/robotiq_arg85_description.urdf", 9, 6, 2276, 0.41}));

}  // namespace
}  // namespace blem_sim::model
