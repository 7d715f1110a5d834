#include "gazebo/gazebo_robot.h"

#include "gazebo/gazebo_sensors.h"
#include "gazebo/gazebo_values.h"

namespace blem_sim::sim {

GazeboRobot withGazeboBlocks(const RobotConfig& config, const model::RobotModel& model) {
  GazeboRobot robot{config, {}};
  GazeboNotes notes(model.source);
  GazeboSensors sensors(model, &notes, &robot.config);
  for (const model::GazeboBlock& block : model.gazebo) {
    readGazeboValues(block, model, &notes, &robot.config);
    sensors.read(block);
  }
  sensors.finish();
  robot.notes = notes.lines();
  return robot;
}

}  // namespace blem_sim::sim
