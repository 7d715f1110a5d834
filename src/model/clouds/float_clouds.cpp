#include "clouds/float_clouds.h"

#include <pcl/common/io.h>
#include <pcl/features/normal_3d.h>
#include <pcl/search/kdtree.h>

namespace blem_sim::model {

FloatCloud::Ptr toFloats(const std::vector<Vector3>& points, const Vector3& origin) {
  FloatCloud::Ptr cloud(new FloatCloud);
  cloud->reserve(points.size());
  for (const Vector3& p : points) {
    const Eigen::Vector3f q = (p - origin).cast<float>();
    cloud->push_back(pcl::PointXYZ(q.x(), q.y(), q.z()));
  }
  return cloud;
}

FloatNormals::Ptr withNormals(const FloatCloud::Ptr& cloud, const Vector3& viewpoint) {
  constexpr int NEIGHBOURS = 16;
  pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setSearchMethod(pcl::search::KdTree<pcl::PointXYZ>::Ptr(new pcl::search::KdTree<pcl::PointXYZ>));
  estimation.setKSearch(NEIGHBOURS);
  const Eigen::Vector3f from = viewpoint.cast<float>();
  estimation.setViewPoint(from.x(), from.y(), from.z());
  pcl::PointCloud<pcl::Normal> normals;
  estimation.compute(normals);
  FloatNormals::Ptr oriented(new FloatNormals);
  pcl::concatenateFields(*cloud, normals, *oriented);
  return oriented;
}

}  // namespace blem_sim::model
