// `<gazebo>` blocks of a URDF as texts. What they mean for a simulation is read elsewhere.
#pragma once

#include <string>
#include <vector>

namespace blem_sim::model {

/** Text of an element, or of an attribute, inside a block. */
struct GazeboValue {
  std::string path;  ///< names from the block on: "ray/scan/horizontal/samples"; of an attribute its element's path and its name
  std::string text;  ///< without white space at its ends
};

/** A `<gazebo>`, or a `<sensor>` or `<plugin>` in it. */
struct GazeboBlock {
  std::string element;              ///< gazebo, sensor or plugin
  std::string type;                 ///< of a sensor; a plugin's filename
  std::string name;                 ///< of a sensor or a plugin
  std::string reference;            ///< link or joint that the `<gazebo>` names; empty: the robot
  std::vector<GazeboValue> values;  ///< in the file's order, without those of inner blocks
  std::vector<GazeboBlock> blocks;  ///< sensors and plugins inside
};

}  // namespace blem_sim::model
