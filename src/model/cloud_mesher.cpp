#include <pcl/common/io.h>
#include <pcl/features/normal_3d.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/surface/gp3.h>

#include <algorithm>
#include <cmath>

#include "blem_sim/geometry/far_origin.h"
#include "quiet_pcl.h"
#include "surface_soup.h"

namespace blem_sim::model {
namespace {

/** Triangles of the pixel grid: a cell of four measured corners gives two, split along its shorter diagonal, one of three gives one. */
class GridMesher {
 public:
  GridMesher(const SurfaceSoup& cloud, double max_edge) : cloud_(cloud), max_edge_(max_edge) {}

  std::vector<Vector3i> triangles() {
    for (int row = 0; row + 1 < cloud_.height; ++row)
      for (int column = 0; column + 1 < cloud_.width; ++column) addCell(row * cloud_.width + column);
    return std::move(triangles_);
  }

 private:
  // NaN compares false: an edge to a point that was not measured is never short.
  double edge(int a, int b) const { return (cloud_.mesh.vertices[a] - cloud_.mesh.vertices[b]).norm(); }
  bool add(int a, int b, int c) {
    if (!(edge(a, b) <= max_edge_ && edge(b, c) <= max_edge_ && edge(c, a) <= max_edge_)) return false;
    triangles_.emplace_back(a, b, c);
    return true;
  }
  void addCell(int corner) {
    const int a = corner, b = corner + 1, c = corner + cloud_.width, d = c + 1;
    const bool along_bc = !(edge(a, d) < edge(b, c));
    const bool first = along_bc ? add(a, c, b) : add(a, c, d);
    const bool second = along_bc ? add(b, c, d) : add(a, d, b);
    if (first || second) return;
    // Three good corners on the other diagonal.
    if (along_bc ? add(a, c, d) : add(a, c, b)) return;
    if (along_bc)
      add(a, d, b);
    else
      add(b, c, d);
  }

  const SurfaceSoup& cloud_;
  double max_edge_;
  std::vector<Vector3i> triangles_;
};

/** Greedy projection of an unorganized cloud. [Marton, Rusu, Beetz 2009, On Fast Surface Reconstruction Methods for Large and Noisy
 * Datasets] */
std::vector<Vector3i> projectionTriangles(const std::vector<Vector3>& points, double max_edge) {
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  std::vector<int> original;
  Box bounds;
  for (const Vector3& p : points)
    if (p.allFinite()) bounds.extend(p);
  const Vector3 origin = geometry::farOrigin(bounds);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) continue;
    const Eigen::Vector3f p = (points[i] - origin).cast<float>();
    cloud->push_back(pcl::PointXYZ(p.x(), p.y(), p.z()));
    original.push_back(static_cast<int>(i));
  }
  if (cloud->size() < 3) return {};
  const QuietPcl quiet;
  constexpr int NEIGHBOURS_FOR_NORMAL = 16;
  pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setSearchMethod(pcl::search::KdTree<pcl::PointXYZ>::Ptr(new pcl::search::KdTree<pcl::PointXYZ>));
  estimation.setKSearch(NEIGHBOURS_FOR_NORMAL);
  pcl::PointCloud<pcl::Normal> normals;
  estimation.compute(normals);
  pcl::PointCloud<pcl::PointNormal>::Ptr oriented(new pcl::PointCloud<pcl::PointNormal>);
  pcl::concatenateFields(*cloud, normals, *oriented);
  // PCL's own angles and density factor; the search radius is the longest edge it may join.
  pcl::GreedyProjectionTriangulation<pcl::PointNormal> mesher;
  mesher.setSearchRadius(max_edge);
  mesher.setMu(2.5);
  mesher.setMaximumNearestNeighbors(100);
  mesher.setMaximumSurfaceAngle(M_PI / 4);
  mesher.setMinimumAngle(M_PI / 18);
  mesher.setMaximumAngle(2 * M_PI / 3);
  mesher.setNormalConsistency(false);
  mesher.setInputCloud(oriented);
  mesher.setSearchMethod(pcl::search::KdTree<pcl::PointNormal>::Ptr(new pcl::search::KdTree<pcl::PointNormal>));
  std::vector<pcl::Vertices> polygons;
  mesher.reconstruct(polygons);
  std::vector<Vector3i> triangles;
  for (const pcl::Vertices& polygon : polygons) {
    const Vector3i t(original[polygon.vertices[0]], original[polygon.vertices[1]], original[polygon.vertices[2]]);
    const double longest =
        std::max({(points[t[0]] - points[t[1]]).norm(), (points[t[1]] - points[t[2]]).norm(), (points[t[2]] - points[t[0]]).norm()});
    if (longest <= max_edge) triangles.push_back(t);
  }
  return triangles;
}

}  // namespace

std::vector<Vector3i> meshCloud(const SurfaceSoup& cloud, double max_edge) {
  if (cloud.width > 1 && cloud.height > 1) return GridMesher(cloud, max_edge).triangles();
  return projectionTriangles(cloud.mesh.vertices, max_edge);
}

}  // namespace blem_sim::model
