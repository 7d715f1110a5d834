// A robot with <gazebo> blocks, the words of such blocks, and what is told of them.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "blem_sim/model/loaders.h"
#include "gazebo/gazebo_robot.h"

namespace blem_sim::sim {

/** A robot of two links and three joints with these blocks. */
inline GazeboRobot described(const std::string& blocks, const RobotConfig& config = {}) {
  const auto joint = [](const std::string& name, const std::string& type, const std::string& child) {
    return "<link name=\"" + child + "\"/><joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"base\"/><child link=\"" +
           child + "\"/></joint>";
  };
  const std::string xml = "<robot name=\"r\"><link name=\"base\"/>" + joint("hip", "continuous", "leg") + joint("flange", "fixed", "tool") +
                          joint("drift", "planar", "sled") + blocks + "</robot>";
  return withGazeboBlocks(config, model::loadUrdf(xml, "test.urdf", model::UriResolver()));
}

inline std::string onLink(const std::string& inside, const std::string& link = "leg") {
  return "<gazebo reference=\"" + link + "\">" + inside + "</gazebo>";
}

inline std::string sensorBlock(const std::string& type, const std::string& inside, const std::string& name = "s") {
  return "<sensor type=\"" + type + "\" name=\"" + name + "\">" + inside + "</sensor>";
}

inline std::string plugin(const std::string& file, const std::string& inside, const std::string& name = "p") {
  return "<plugin name=\"" + name + "\" filename=\"libgazebo_ros_" + file + ".so\">" + inside + "</plugin>";
}

/** Number of notes of one line with these words in them. */
inline int toldTimes(const std::vector<std::string>& notes, const std::string& words) {
  const auto has = [&](const std::string& note) { return note.find(words) != std::string::npos && note.find('\n') == std::string::npos; };
  return static_cast<int>(std::count_if(notes.begin(), notes.end(), has));
}

inline int told(const GazeboRobot& robot, const std::string& words) { return toldTimes(robot.notes, words); }

inline std::string allNotes(const GazeboRobot& robot) {
  std::string all;
  for (const std::string& note : robot.notes) all += note + "\n";
  return all;
}

}  // namespace blem_sim::sim
