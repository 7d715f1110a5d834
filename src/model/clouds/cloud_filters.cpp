#include <fmt/format.h>
#include <pcl/filters/passthrough.h>
#include <pcl/filters/radius_outlier_removal.h>
#include <pcl/filters/statistical_outlier_removal.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/surface/mls.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "blem_sim/geometry/far_origin.h"
#include "blem_sim/geometry/input_error.h"
#include "blem_sim/model/cloud.h"
#include "clouds/float_clouds.h"
#include "clouds/quiet_pcl.h"

namespace blem_sim::model {
namespace {

using Kind = CloudFilter::Kind;

const char* const AXES[] = {"x", "y", "z"};
constexpr int MOST_NEIGHBOURS = 1000, MOST_ORDER = 5;

bool isLength(double value) { return value > 0 && std::isfinite(value); }

/** Fault of a filter in words, or none. */
std::string faultOf(const CloudFilter& filter) {
  const bool counts = filter.kind == Kind::STATISTICAL_OUTLIERS || filter.kind == Kind::RADIUS_OUTLIERS;
  if (counts && (filter.neighbours < 1 || filter.neighbours > MOST_NEIGHBOURS))
    return fmt::format("neighbours: is {}; give it a whole number from 1 to {}", filter.neighbours, MOST_NEIGHBOURS);
  if (filter.kind == Kind::VOXEL_GRID && !isLength(filter.size))
    return fmt::format("is {}; give it a number of metres above 0", filter.size);
  if (filter.kind == Kind::RADIUS_OUTLIERS && !isLength(filter.size))
    return fmt::format("radius: is {}; give it a number of metres above 0", filter.size);
  if (filter.kind == Kind::STATISTICAL_OUTLIERS && !(filter.factor >= 0 && std::isfinite(filter.factor)))
    return fmt::format("factor: is {}; give it a number of at least 0", filter.factor);
  if (filter.kind == Kind::MOVING_LEAST_SQUARES && !isLength(filter.size))
    return fmt::format("radius: is {}; give it a number of metres above 0", filter.size);
  if (filter.kind == Kind::MOVING_LEAST_SQUARES && (filter.order < 1 || filter.order > MOST_ORDER))
    return fmt::format("order: is {}; give it a whole number from 1 to {}", filter.order, MOST_ORDER);
  if (filter.kind != Kind::PASS_THROUGH) return "";
  if (filter.axis < 0 || filter.axis > 2) return "axis: is none of x, y, z";
  if (!(filter.lower <= filter.upper)) return fmt::format("range: [{}, {}]: the lower comes first", filter.lower, filter.upper);
  return "";
}

const char* filterName(Kind kind) {
  switch (kind) {
    case Kind::VOXEL_GRID:
      return "voxel_grid";
    case Kind::STATISTICAL_OUTLIERS:
      return "statistical_outliers";
    case Kind::RADIUS_OUTLIERS:
      return "radius_outliers";
    case Kind::PASS_THROUGH:
      return "pass_through";
    case Kind::MOVING_LEAST_SQUARES:
      return "moving_least_squares";
  }
  return "";
}

/** Runs a PCL filter whose settings are made. */
template <typename Filter>
void run(Filter& filter, FloatCloud::Ptr* cloud) {
  const FloatCloud::Ptr left(new FloatCloud);
  filter.setInputCloud(*cloud);
  filter.filter(*left);
  *cloud = left;
}

void makeVoxels(double size, const std::string& source, FloatCloud::Ptr* cloud) {
  Eigen::AlignedBox3d box;
  for (const pcl::PointXYZ& p : **cloud) box.extend(p.getVector3fMap().cast<double>());
  if (box.isEmpty()) return;
  const Vector3 counts = (box.sizes() / size).array().floor() + 2;
  if (counts.prod() > std::numeric_limits<int>::max())
    throw InputError(
        fmt::format("{}: filters: voxel_grid: {} m makes more than 2^31 voxels of {:.4g} x {:.4g} x {:.4g} m; make them larger, "
                    "or cut the cloud by pass_through first",
                    source, size, box.sizes().x(), box.sizes().y(), box.sizes().z()));
  pcl::VoxelGrid<pcl::PointXYZ> grid;
  const auto edge = static_cast<float>(size);
  grid.setLeafSize(edge, edge, edge);
  run(grid, cloud);
}

void moveOntoPolynomials(double radius, int order, FloatCloud::Ptr* cloud) {
  const FloatCloud::Ptr moved(new FloatCloud);
  pcl::MovingLeastSquares<pcl::PointXYZ, pcl::PointXYZ> surface;
  surface.setInputCloud(*cloud);
  surface.setSearchMethod(pcl::search::KdTree<pcl::PointXYZ>::Ptr(new pcl::search::KdTree<pcl::PointXYZ>));
  surface.setSearchRadius(radius);
  surface.setPolynomialOrder(order);
  surface.process(*moved);
  *cloud = moved;
}

/** @param origin [m] of the cloud's floats */
void apply(const CloudFilter& filter, const Vector3& origin, const std::string& source, FloatCloud::Ptr* cloud) {
  if (filter.kind == Kind::VOXEL_GRID) return makeVoxels(filter.size, source, cloud);
  if (filter.kind == Kind::STATISTICAL_OUTLIERS) {
    pcl::StatisticalOutlierRemoval<pcl::PointXYZ> outliers;
    outliers.setMeanK(filter.neighbours);
    outliers.setStddevMulThresh(filter.factor);
    return run(outliers, cloud);
  }
  if (filter.kind == Kind::RADIUS_OUTLIERS) {
    pcl::RadiusOutlierRemoval<pcl::PointXYZ> outliers;
    outliers.setRadiusSearch(filter.size);
    outliers.setMinNeighborsInRadius(filter.neighbours);
    return run(outliers, cloud);
  }
  if (filter.kind == Kind::MOVING_LEAST_SQUARES) return moveOntoPolynomials(filter.size, filter.order, cloud);
  // PCL takes no infinite bounds.
  constexpr double FARTHEST = std::numeric_limits<float>::max();
  const auto bound = [&](double value) { return static_cast<float>(std::clamp(value - origin[filter.axis], -FARTHEST, FARTHEST)); };
  pcl::PassThrough<pcl::PointXYZ> pass;
  pass.setFilterFieldName(AXES[filter.axis]);
  pass.setFilterLimits(bound(filter.lower), bound(filter.upper));
  run(pass, cloud);
}

}  // namespace

void checkFilters(const std::vector<CloudFilter>& filters, const std::string& source) {
  for (const CloudFilter& filter : filters) {
    const std::string fault = faultOf(filter);
    if (!fault.empty()) throw InputError(fmt::format("{}: filters: {}: {}", source, filterName(filter.kind), fault));
  }
}

std::vector<Vector3> filtered(std::vector<Vector3> points, const std::vector<CloudFilter>& filters, const std::string& source,
                              std::vector<std::string>* notes) {
  if (filters.empty()) return points;
  checkFilters(filters, source);
  const std::size_t all = points.size();
  points.erase(std::remove_if(points.begin(), points.end(), [](const Vector3& p) { return !p.allFinite(); }), points.end());
  if (points.size() < all) notes->push_back(fmt::format("{} points that are not finite dropped", all - points.size()));
  Box bounds;
  for (const Vector3& p : points) bounds.extend(p);
  const Vector3 origin = geometry::farOrigin(bounds);
  const QuietPcl quiet;
  FloatCloud::Ptr cloud = toFloats(points, origin);
  for (const CloudFilter& filter : filters) {
    const std::size_t before = cloud->size();
    apply(filter, origin, source, &cloud);
    notes->push_back(fmt::format("{}: {} of {} points left", filterName(filter.kind), cloud->size(), before));
  }
  points.clear();
  points.reserve(cloud->size());
  for (const pcl::PointXYZ& p : *cloud) points.push_back(origin + p.getVector3fMap().cast<double>());
  return points;
}

}  // namespace blem_sim::model
