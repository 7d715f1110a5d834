// Drawn views of depth cameras and lidars as sensor_msgs.
#pragma once

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/LaserScan.h>
#include <sensor_msgs/PointCloud2.h>

#include <vector>

#include "blem_sim/sim/config.h"

namespace blem_sim::node {

/** 32FC1 [m], NaN where nothing was measured. @param depths as depthsOf gives them */
sensor_msgs::Image toMetreImage(const sim::RangeSensorConfig& camera, const std::vector<float>& depths);
/** 16UC1 [mm], 0 where nothing was measured, or beyond 65.535 m. */
sensor_msgs::Image toMillimetreImage(const sim::RangeSensorConfig& camera, const std::vector<float>& depths);
/** A pinhole without distortion. */
sensor_msgs::CameraInfo toCameraInfo(const sim::RangeSensorConfig& camera);
/** Organised cloud [m] in the optical frame, NaN where nothing was measured. */
sensor_msgs::PointCloud2 toCloud(const sim::RangeSensorConfig& camera, const std::vector<float>& depths);
/** @param ranges as rangesOf gives them for one layer */
sensor_msgs::LaserScan toScan(const sim::SensorConfig& lidar, const std::vector<float>& ranges);
/** A row per layer, the lowest first; in the sensor's frame [m]. */
sensor_msgs::PointCloud2 toLayeredCloud(const sim::RangeSensorConfig& lidar, const std::vector<float>& ranges);

}  // namespace blem_sim::node
