// Surfaces of live environments from messages.
#pragma once

#include <nav_msgs/OccupancyGrid.h>
#include <sensor_msgs/PointCloud2.h>
#include <shape_msgs/Mesh.h>

#include <atomic>
#include <cstddef>
#include <vector>

#include "blem_sim/model/voxel_map.h"
#include "blem_sim/sim/simulator_types.h"
#include "clouds/cloud_frames.h"

namespace blem_sim::node {

/** A cloud or mesh that is ready for contact. */
struct BuiltCloud {
  sim::CloudSurface surface;
  std::vector<sim::SearchedAhead> ahead;  ///< its contacts where things were a few steps ago
  ros::Time stamp;                        ///< of its message
  std::size_t points_received = 0;        ///< or vertices, or cells
  double seconds = 0;                     ///< of wall time that it took
};

/** Turns one environment's messages into surfaces, one after the other. */
class SurfaceBuilder {
 public:
  /** [s] by which a stamp may be ahead of simulated time. */
  static constexpr double MOST_AHEAD = 0.5;

  /** @param frames, time [s] simulated: must outlive this */
  SurfaceBuilder(const sim::EnvironmentConfig& config, const CloudFrames& frames, const std::atomic<double>& time);

  /** @throws InputError: the message lies, there is no transform in time, or no surface is left */
  BuiltCloud build(const sensor_msgs::PointCloud2& message);
  BuiltCloud build(const shape_msgs::Mesh& message);
  BuiltCloud build(const nav_msgs::OccupancyGrid& message);
  /** Forgets the map: time has started again. */
  void restart() { map_.clear(); }

 private:
  /** Pose in the environment's frame; refuses a stamp of the future. */
  Pose poseOf(const std_msgs::Header& header) const;
  model::SensedCloud sensed(const sensor_msgs::PointCloud2& message) const;

  sim::EnvironmentConfig config_;
  const CloudFrames& frames_;
  const std::atomic<double>& time_;
  model::VoxelMap map_;
  model::CloudOptions surface_options_;
};

}  // namespace blem_sim::node
