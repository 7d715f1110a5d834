// Depth cameras and lidars: a view is taken in a step, and drawn when somebody wants to see it.
#pragma once

#include <cstdint>
#include <vector>

#include "blem_sim/contact/depth_scene.h"
#include "blem_sim/sim/config.h"

namespace blem_sim::sim {

/**
 * The world as a sensor may see it at the end of a step. Drawing depends on nothing else: any thread may do so at any time, or nobody,
 * and the numbers are the same.
 */
struct RangeView {
  RangeSensorConfig rays;
  std::vector<contact::RayTarget> targets;
  Pose X_WS = Pose::Identity();  ///< sensor: it looks along x, z is up
  int model = -1;                ///< the sensor's robot, which it sees from `rays.nearest` on only
  std::uint64_t noise_seed = 0;
};

contact::Pinhole pinholeOf(const RangeSensorConfig& camera);

/** Axes of a camera's optical frame (z ahead, x right, y down [REP 103]) in the sensor's frame. */
Matrix3 opticalAxes();

double beamAngle(const RangeSensorConfig& lidar, int beam);    ///< [rad] counter-clockwise about z from x
double layerAngle(const RangeSensorConfig& lidar, int layer);  ///< [rad] above the plane of x and y
/** Unit vector along a beam, in the sensor's frame. */
Vector3 beamDirection(const RangeSensorConfig& lidar, int layer, int beam);

/** Depths along the optical axis [m], row by row from the top left. NaN where nothing is within the range, or something is nearer. */
std::vector<float> depthsOf(const RangeView& camera);

/** Ranges along the beams [m], layer by layer from the lowest. +inf where nothing is within the range, -inf where something is nearer
 *  [REP 117]. */
std::vector<float> rangesOf(const RangeView& lidar);

/**
 * A range as it is measured, from a stream of noise of the ray's own; never outside the sensor's range.
 * Model kinect: what is measured is a disparity in whole steps; 1/z changes by 2.85e-3 / m from one to the next, and the deviation of the
 * disparity is half a step: 1.4 mm at 1 m, 3.6 cm at 5 m. [Khoshelham, Elberink 2012]
 */
double measuredRange(const RangeView& view, std::size_t ray, double range);

}  // namespace blem_sim::sim
