// Clouds of points: filters, the boundary of each point, the surface that contact meets.
#pragma once

#include <string>
#include <vector>

#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim::model {

/** One filter of a cloud, by PCL. Numbers that a kind does not name are not used. */
struct CloudFilter {
  enum class Kind {
    VOXEL_GRID,            ///< one point, the mean, per cube of edge `size`
    STATISTICAL_OUTLIERS,  ///< drops points whose mean distance to `neighbours` others is `factor` deviations above the cloud's mean
    RADIUS_OUTLIERS,       ///< drops points with fewer than `neighbours` others within `size`
    PASS_THROUGH           ///< keeps points whose coordinate along `axis` is from `lower` to `upper`
  };
  Kind kind = Kind::VOXEL_GRID;
  double size = 0;  ///< [m]
  int neighbours = 0;
  double factor = 0;
  int axis = 2;                 ///< 0, 1, 2
  double lower = 0, upper = 0;  ///< [m], also infinite
};

/** Settings of a cloud of points in the simulation. */
struct CloudOptions {
  enum class As { AUTO, POINTS, MESH };
  As as = As::AUTO;                  ///< AUTO: points for a file without faces, triangles otherwise
  double point_radius = 0.004;       ///< [m] boundary of each point
  bool auto_radius = false;          ///< true: pointRadius of the filtered points instead of point_radius
  double max_edge = 0.05;            ///< [m] as: mesh; longest edge that joins neighbours of an organized cloud or of the projection mesher
  std::vector<CloudFilter> filters;  ///< in their order; they give up a cloud's pixel grid
};

/** @throws InputError in one line, if a filter's numbers are none that it takes. @param source begins the message */
void checkFilters(const std::vector<CloudFilter>& filters, const std::string& source);

/**
 * The points that filters leave, in an order that the points alone decide; without a filter all of them, untouched. Points that are not
 * finite are dropped first. Filters see floats about a place near the cloud.
 * @param points [m] @param notes one line per filter @throws InputError: checkFilters; voxels so small that PCL cannot number them
 */
std::vector<Vector3> filtered(std::vector<Vector3> points, const std::vector<CloudFilter>& filters, const std::string& source,
                              std::vector<std::string>* notes);

/**
 * Spacing [m] of points on a surface: the median, over at most 4,000 of them, of the distance to the fourth nearest other one. On a square
 * grid that is the grid's spacing; where points lie at random it is 1.1 over the root of their density. 0 for fewer than two places.
 * Precondition: finite.
 */
double pointSpacing(const std::vector<Vector3>& points);

/** Boundary [m] that suits a spacing [m]: 0.3 of it, 0.1 mm at least; CloudOptions' own for a cloud without a spacing. */
double pointRadius(double spacing);

}  // namespace blem_sim::model
