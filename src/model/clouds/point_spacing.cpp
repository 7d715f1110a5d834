#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>

#include "blem_sim/model/cloud.h"

namespace blem_sim::model {
namespace {

constexpr std::size_t MOST_SAMPLES = 4000;
constexpr int NEIGHBOUR = 4;               // whose distance counts
constexpr double RADIUS_OF_SPACING = 0.3;  // below a third, so that what rests on points is off by less than that
constexpr double SMALLEST_RADIUS = 1e-4;   // [m]

pcl::PointCloud<pcl::PointXYZ>::Ptr aboutTheMiddle(const std::vector<Vector3>& points) {
  Box bounds;
  for (const Vector3& p : points) bounds.extend(p);
  const Vector3 middle = bounds.center();
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  cloud->reserve(points.size());
  for (const Vector3& p : points) {
    const Eigen::Vector3f q = (p - middle).cast<float>();
    cloud->push_back(pcl::PointXYZ(q.x(), q.y(), q.z()));
  }
  return cloud;
}

}  // namespace

double pointSpacing(const std::vector<Vector3>& points) {
  if (points.size() < 2) return 0;
  const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud = aboutTheMiddle(points);
  pcl::KdTreeFLANN<pcl::PointXYZ> tree;
  tree.setInputCloud(cloud);
  const int neighbours = std::min<int>(NEIGHBOUR, static_cast<int>(points.size()) - 1);
  const std::size_t stride = (points.size() + MOST_SAMPLES - 1) / MOST_SAMPLES;
  std::vector<int> found;
  std::vector<float> squares, distances;
  for (std::size_t i = 0; i < points.size(); i += stride) {
    tree.nearestKSearch((*cloud)[i], neighbours + 1, found, squares);  // the nearest is the point itself
    distances.push_back(std::sqrt(squares.back()));
  }
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

double pointRadius(double spacing) {
  return spacing > 0 ? std::max(SMALLEST_RADIUS, RADIUS_OF_SPACING * spacing) : CloudOptions().point_radius;
}

}  // namespace blem_sim::model
