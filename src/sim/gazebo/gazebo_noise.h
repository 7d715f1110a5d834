// <noise> of sensors.
#pragma once

#include <string>
#include <vector>

#include "blem_sim/sim/config.h"
#include "gazebo/gazebo_reader.h"

namespace blem_sim::sim {

/** Gaussian noise of one axis, in the unit of what is measured. */
struct GazeboNoise {
  double mean = 0, stddev = 0;
  double bias_mean = 0, bias_stddev = 0;  ///< of a bias drawn at the start

  QuantityNoise quantity() const { return {stddev, 0, mean + bias_mean, bias_stddev}; }
};

/** The noise at a path ("imu/noise/accel"), whose kind stands at type_path; none if it is not gaussian, which is noted. */
GazeboNoise readNoise(GazeboReader* reader, const std::string& path, const std::string& type_path);

/** The largest of what axes have; noted if they differ. @param what the axes measure, for the note */
GazeboNoise readAxes(GazeboReader* reader, const std::vector<std::string>& axes, const std::string& what);

}  // namespace blem_sim::sim
