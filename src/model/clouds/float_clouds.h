// Points as PCL takes them: floats about a place near them.
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <vector>

#include "blem_sim/geometry/types.h"

namespace blem_sim::model {

using FloatCloud = pcl::PointCloud<pcl::PointXYZ>;
using FloatNormals = pcl::PointCloud<pcl::PointNormal>;

FloatCloud::Ptr toFloats(const std::vector<Vector3>& points, const Vector3& origin);

/** Points with normals of the planes through their 16 nearest, towards a viewpoint [m, about the cloud's origin]. */
FloatNormals::Ptr withNormals(const FloatCloud::Ptr& cloud, const Vector3& viewpoint);

}  // namespace blem_sim::model
