// Triangles from points.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "blem_sim/model/cloud.h"

namespace blem_sim::model {

/** Points of an image: that of (row, column) is row * width + column; NaN where nothing was measured. */
struct PixelGrid {
  std::vector<Vector3> points;  ///< [m]
  int width = 0, height = 0;
};

/** Finite points, each place once, and where they were seen from. */
struct SeenPoints {
  std::vector<Vector3> points;       ///< [m]
  std::optional<Vector3> viewpoint;  ///< [m]
};

/** Parts of a cloud: points of different ones are farther apart than a distance [m]. Each has its points in the cloud's order. */
std::vector<SeenPoints> partsApart(const SeenPoints& cloud, double distance);

/**
 * Triangles over a grid's points: a cell of four measured corners gives two, split along its shorter diagonal, one
 * of three gives one. No edge is longer than max_edge; from one corner to another the distance to the viewpoint changes by no more than
 * max_depth_jump of the smaller one.
 */
std::vector<Vector3i> gridTriangles(const PixelGrid& grid, const Vector3& viewpoint, const CloudOptions& options);

/**
 * Greedy projection. [Marton, Rusu, Beetz 2009, On Fast Surface Reconstruction Methods for Large and Noisy Datasets]
 * @return triangles over the points, edges up to max_edge
 */
std::vector<Vector3i> projectionTriangles(const std::vector<Vector3>& points, double max_edge);

/**
 * Surface by marching cubes of the distance to the nearest point's tangent plane [Hoppe et al. 1992, Surface Reconstruction from
 * Unorganized Points], or by Poisson's equation [Kazhdan, Bolitho, Hoppe 2006, Poisson Surface Reconstruction]: vertices of its own.
 * Triangles with a corner farther than half of max_edge from every point are left out, unless holes are filled. So Poisson's equation is
 * solved for each part of the cloud by itself: PCL's time and memory grow with the square of size over cell, however few the points.
 * @throws InputError: no viewpoint; more cells than there is room for. @param source begins the message
 */
geometry::TriangleMesh marchingCubesMesh(const SeenPoints& cloud, const CloudOptions& options, const std::string& source);
geometry::TriangleMesh poissonMesh(const SeenPoints& cloud, const CloudOptions& options, const std::string& source);

}  // namespace blem_sim::model
