#include <pcl/search/kdtree.h>
#include <pcl/surface/gp3.h>

#include <algorithm>
#include <cmath>

#include "blem_sim/geometry/far_origin.h"
#include "clouds/cloud_meshers.h"
#include "clouds/float_clouds.h"
#include "clouds/quiet_pcl.h"

namespace blem_sim::model {

std::vector<Vector3i> projectionTriangles(const std::vector<Vector3>& points, double max_edge) {
  if (points.size() < 3) return {};
  Box bounds;
  for (const Vector3& p : points) bounds.extend(p);
  const QuietPcl quiet;
  const Vector3 origin = geometry::farOrigin(bounds);
  // PCL's own angles and density factor; the search radius is the longest edge it may join.
  pcl::GreedyProjectionTriangulation<pcl::PointNormal> mesher;
  mesher.setSearchRadius(max_edge);
  mesher.setMu(2.5);
  mesher.setMaximumNearestNeighbors(100);
  mesher.setMaximumSurfaceAngle(M_PI / 4);
  mesher.setMinimumAngle(M_PI / 18);
  mesher.setMaximumAngle(2 * M_PI / 3);
  mesher.setNormalConsistency(false);
  mesher.setInputCloud(withNormals(toFloats(points, origin), Vector3::Zero()));
  mesher.setSearchMethod(pcl::search::KdTree<pcl::PointNormal>::Ptr(new pcl::search::KdTree<pcl::PointNormal>));
  std::vector<pcl::Vertices> polygons;
  mesher.reconstruct(polygons);
  std::vector<Vector3i> triangles;
  for (const pcl::Vertices& polygon : polygons) {
    const Vector3i t(polygon.vertices[0], polygon.vertices[1], polygon.vertices[2]);
    const double longest =
        std::max({(points[t[0]] - points[t[1]]).norm(), (points[t[1]] - points[t[2]]).norm(), (points[t[2]] - points[t[0]]).norm()});
    if (longest <= max_edge) triangles.push_back(t);
  }
  return triangles;
}

}  // namespace blem_sim::model
