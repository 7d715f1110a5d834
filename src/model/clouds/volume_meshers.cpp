#include <fmt/format.h>
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/search/kdtree.h>
#include <pcl/surface/marching_cubes.h>
#include <pcl/surface/poisson.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "blem_sim/geometry/input_error.h"
#include "clouds/cloud_meshers.h"
#include "clouds/float_clouds.h"
#include "clouds/quiet_pcl.h"

namespace blem_sim::model {
namespace {

constexpr double MOST_CELLS = 5e7;  // of marching cubes, 5 bytes each
constexpr int MOST_DEPTH = 12;      // of Poisson's octree
constexpr int MARGIN = 4;           // [cells] around the points

/** Oriented points about an origin, with their bounds. */
struct OrientedCloud {
  OrientedCloud(const SeenPoints& seen, const CloudOptions& options, const std::string& source) {
    if (!seen.viewpoint)
      throw InputError(
          fmt::format("{}: mesher {}: give viewpoint: [x, y, z], the sensor's place [m] in the cloud's frame: from there it "
                      "is known which side of the points is outside",
                      source, mesherName(options.mesher)));
    Box bounds;
    for (const Vector3& p : seen.points) bounds.extend(p);
    origin = bounds.center();
    size = bounds.sizes();
    points = withNormals(toFloats(seen.points, origin), *seen.viewpoint - origin);
  }

  Vector3 origin, size;
  FloatNormals::Ptr points;
};

[[noreturn]] void refuseCell(const CloudOptions& options, const Vector3& size, const std::string& most, const std::string& source) {
  throw InputError(
      fmt::format("{}: cell: {} m makes more than {} of {:.4g} x {:.4g} x {:.4g} m; make it larger, or cut the cloud by "
                  "pass_through first",
                  source, options.cell, most, size.x(), size.y(), size.z()));
}

/** Places that are farther from all points than half of max_edge. */
class FarPlaces {
 public:
  FarPlaces(const FloatNormals::Ptr& points, const CloudOptions& options)
      : most_(options.fill_holes ? std::numeric_limits<float>::infinity()
                                 : static_cast<float>(0.25 * options.max_edge * options.max_edge)) {
    tree_.setInputCloud(points);
  }

  bool has(const Eigen::Vector3f& place) const {
    pcl::PointNormal point;
    point.getVector3fMap() = place;
    tree_.nearestKSearch(point, 1, nearest_, squared_);
    return !(squared_[0] <= most_);
  }

 private:
  float most_;  // [m^2]
  pcl::KdTreeFLANN<pcl::PointNormal> tree_;
  mutable std::vector<int> nearest_ = {0};
  mutable std::vector<float> squared_ = {0};
};

/** Triangles of a mesher's surface whose corners are near enough. */
geometry::TriangleMesh nearTriangles(const OrientedCloud& cloud, const CloudOptions& options,
                                     pcl::SurfaceReconstruction<pcl::PointNormal>* mesher) {
  FloatNormals vertices;
  std::vector<pcl::Vertices> polygons;
  mesher->reconstruct(vertices, polygons);
  const FarPlaces far(cloud.points, options);
  std::vector<bool> is_far;
  geometry::TriangleMesh mesh;
  for (const pcl::PointNormal& p : vertices) {
    is_far.push_back(far.has(p.getVector3fMap()));
    mesh.vertices.push_back(cloud.origin + p.getVector3fMap().cast<double>());
  }
  for (const pcl::Vertices& polygon : polygons) {
    const Vector3i t(polygon.vertices[0], polygon.vertices[1], polygon.vertices[2]);
    if (!is_far[t[0]] && !is_far[t[1]] && !is_far[t[2]]) mesh.elements.push_back(t);
  }
  return mesh;
}

// Two points without a normal, whose cells stay empty, widen the bounds that PCL takes from the points: a flat cloud has none.
void addMargin(double margin, FloatNormals* points) {
  Eigen::AlignedBox3f bounds;
  for (const pcl::PointNormal& p : *points) bounds.extend(p.getVector3fMap());
  for (const float sign : {-1.F, 1.F}) {
    pcl::PointNormal corner;
    corner.getVector3fMap() = (sign < 0 ? bounds.min() : bounds.max()).array() + sign * static_cast<float>(margin);
    corner.getNormalVector3fMap().setConstant(std::numeric_limits<float>::quiet_NaN());
    points->push_back(corner);
  }
}

/** Hoppe's distances, where PCL's own class asks for the nearest point of every cell: here of those alone that are near one. */
class NearCubes : public pcl::MarchingCubes<pcl::PointNormal> {
 public:
  /** @param reach [cells] along each axis, from a point to the farthest cell that counts */
  explicit NearCubes(int reach) : reach_(reach) { setPercentageExtendGrid(0); }

 private:
  void voxelizeData() override {
    const std::vector<char> near = cellsNearPoints();
    for (std::size_t cell = 0; cell < near.size(); ++cell)
      if (near[cell]) grid_[cell] = distanceAt(cell);
  }

  float distanceAt(std::size_t cell) {
    const int z = static_cast<int>(cell % res_z_), y = static_cast<int>(cell / res_z_ % res_y_),
              x = static_cast<int>(cell / res_z_ / res_y_);
    pcl::PointNormal at;
    at.getVector3fMap() = (lower_boundary_ + size_voxel_ * Eigen::Array3f(x, y, z)).matrix();
    tree_->nearestKSearch(at, 1, nearest_, squared_);
    const pcl::PointNormal& point = (*input_)[nearest_[0]];
    return point.getNormalVector3fMap().dot(at.getVector3fMap() - point.getVector3fMap());
  }

  std::vector<char> cellsNearPoints() const {
    std::vector<char> near(grid_.size());
    for (const pcl::PointNormal& p : *input_) {
      if (std::isnan(p.normal_x)) continue;
      const Eigen::Array3i at = ((p.getArray3fMap() - lower_boundary_) / size_voxel_).round().cast<int>();
      near[(static_cast<std::size_t>(at.x()) * res_y_ + at.y()) * res_z_ + at.z()] = 1;
    }
    const std::size_t rows = res_z_, planes = rows * res_y_;
    widen(1, res_z_, &near);
    widen(rows, res_y_, &near);
    widen(planes, res_x_, &near);
    return near;
  }

  // Marks the cells within reach of marked ones along an axis. @param stride between cells along it @param count of cells along it
  void widen(std::size_t stride, int count, std::vector<char>* near) const {
    const std::vector<char> before = *near;
    for (std::size_t cell = 0; cell < before.size(); ++cell) {
      if (!before[cell]) continue;
      const int at = static_cast<int>(cell / stride % count);
      for (int k = std::max(-reach_, -at); k <= std::min(reach_, count - 1 - at); ++k) (*near)[cell + k * stride] = 1;
    }
  }

  int reach_;
  std::vector<int> nearest_ = {0};
  std::vector<float> squared_ = {0};
};

}  // namespace

geometry::TriangleMesh marchingCubesMesh(const SeenPoints& seen, const CloudOptions& options, const std::string& source) {
  if (seen.points.size() < 3) return {};
  if (options.fill_holes) throw InputError(source + ": fill_holes: marching cubes keep holes; leave it out, or take mesher: poisson");
  const QuietPcl quiet;
  const OrientedCloud cloud(seen, options, source);
  const Vector3 counts = (cloud.size / options.cell).array().ceil() + 2 * MARGIN;
  if (!(counts.prod() <= MOST_CELLS)) refuseCell(options, cloud.size, fmt::format("{:g} cells", MOST_CELLS), source);
  const FloatNormals::Ptr wider(new FloatNormals(*cloud.points));
  addMargin(MARGIN * options.cell, wider.get());
  // Cells beside what is kept have values, too.
  NearCubes mesher(static_cast<int>(std::ceil(0.5 * options.max_edge / options.cell)) + 1);
  mesher.setGridResolution(static_cast<int>(counts.x()), static_cast<int>(counts.y()), static_cast<int>(counts.z()));
  mesher.setInputCloud(wider);
  mesher.setSearchMethod(pcl::search::KdTree<pcl::PointNormal>::Ptr(new pcl::search::KdTree<pcl::PointNormal>));
  return nearTriangles(cloud, options, &mesher);
}

namespace {

geometry::TriangleMesh poissonPart(const SeenPoints& seen, const CloudOptions& options, const std::string& source) {
  if (seen.points.size() < 3) return {};
  const OrientedCloud cloud(seen, options, source);
  pcl::Poisson<pcl::PointNormal> mesher;
  const int depth = static_cast<int>(std::ceil(std::log2(std::max(1.0, cloud.size.maxCoeff() * mesher.getScale() / options.cell))));
  if (depth > MOST_DEPTH) refuseCell(options, cloud.size, fmt::format("{} halvings", MOST_DEPTH), source);
  mesher.setDepth(std::max(2, depth));
  mesher.setSolverDivide(std::max(2, depth));
  mesher.setIsoDivide(std::max(2, depth));
  mesher.setInputCloud(cloud.points);
  return nearTriangles(cloud, options, &mesher);
}

void append(const geometry::TriangleMesh& part, geometry::TriangleMesh* mesh) {
  const auto first = static_cast<int>(mesh->vertices.size());
  mesh->vertices.insert(mesh->vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const Vector3i& e : part.elements) mesh->elements.push_back(e + Vector3i::Constant(first));
}

}  // namespace

geometry::TriangleMesh poissonMesh(const SeenPoints& seen, const CloudOptions& options, const std::string& source) {
  const QuietPcl quiet;
  if (options.fill_holes) return poissonPart(seen, options, source);
  geometry::TriangleMesh mesh;
  for (const SeenPoints& part : partsApart(seen, options.max_edge)) append(poissonPart(part, options, source), &mesh);
  return mesh;
}

}  // namespace blem_sim::model
