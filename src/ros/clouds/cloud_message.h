// Points of a sensor_msgs/PointCloud2.
#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <cstdint>
#include <vector>

#include "blem_sim/geometry/types.h"

namespace blem_sim::node {

/** Points of a message, measured or not, beyond which it is refused. */
constexpr std::uint64_t MOST_CLOUD_POINTS = 10000000;

/**
 * The measured points of a message, in its frame [m]. x, y and z may be float32 or float64 at any offsets, with padding between points and
 * rows; points with a NaN or an infinity are none. @param all those that were not measured as well: row by row, as NaN
 * @throws InputError in one line: fields that are missing, of another type or outside their point; big-endian numbers; sizes that
 * contradict each other or the data; more than MOST_CLOUD_POINTS points; none that was measured
 */
std::vector<Vector3> pointsOf(const sensor_msgs::PointCloud2& cloud, bool all = false);

}  // namespace blem_sim::node
