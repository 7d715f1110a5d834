// Clouds of points: filters, the boundary of each point, the surface that contact meets.
#pragma once

#include <limits>
#include <optional>
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
    PASS_THROUGH,          ///< keeps points whose coordinate along `axis` is from `lower` to `upper`
    MOVING_LEAST_SQUARES   ///< moves points onto polynomials of degree `order` through those within `size`; drops those with fewer than 3
  };
  Kind kind = Kind::VOXEL_GRID;
  double size = 0;  ///< [m]
  int neighbours = 0;
  double factor = 0;
  int axis = 2;                 ///< 0, 1, 2
  double lower = 0, upper = 0;  ///< [m], also infinite
  int order = 2;                ///< 1 to 5
};

/** Settings of a cloud of points in the simulation. */
struct CloudOptions {
  enum class As { AUTO, POINTS, MESH };
  /** AUTO: ORGANIZED for a cloud with a pixel grid, GREEDY_PROJECTION for others. */
  enum class Mesher { AUTO, ORGANIZED, GREEDY_PROJECTION, MARCHING_CUBES, POISSON };
  As as = As::AUTO;             ///< AUTO: points for a file without faces, triangles otherwise
  double point_radius = 0.004;  ///< [m] boundary of each point
  bool auto_radius = false;     ///< true: pointRadius of the filtered points instead of point_radius
  // As a mesh.
  Mesher mesher = Mesher::AUTO;
  double max_edge = 0.05;  ///< [m] ORGANIZED, GREEDY_PROJECTION: longest edge; the others: holes wider than that stay
  /** ORGANIZED: change of the distance to the viewpoint along an edge, over the smaller distance; infinite: not looked at. */
  double max_depth_jump = std::numeric_limits<double>::infinity();
  double cell = 0.01;                ///< [m] MARCHING_CUBES: edge of a cube; POISSON: about that of the smallest
  bool fill_holes = false;           ///< POISSON
  std::optional<Vector3> viewpoint;  ///< [m] of the sensor, which sees outsides; none: a PCD's own, or a pixel grid's camera in the origin
  std::vector<CloudFilter> filters;  ///< in their order; they give up a cloud's pixel grid
};

/** Name of a mesher in configurations and messages. */
const char* mesherName(CloudOptions::Mesher mesher);

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
