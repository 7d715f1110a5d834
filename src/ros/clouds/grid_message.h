// Walls of a nav_msgs/OccupancyGrid.
#pragma once

#include <nav_msgs/OccupancyGrid.h>

#include <cstdint>

#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim::node {

/** Cells, and triangles of walls, beyond which a message is refused. */
constexpr std::uint64_t MOST_CELLS = 100000000, MOST_WALL_TRIANGLES = 4000000;

/** Choice of the cells that are walls. */
struct GridWalls {
  int occupied = 50;  ///< value from which on a cell is a wall; unknown ones (-1) are free
  double height = 1;  ///< [m]
};

/**
 * Walls over the occupied cells, from z = 0 of the grid's origin up, in the message's frame [m]: tops, and sides between occupied and free
 * cells or the border. Sides of one straight run are one rectangle, tops of equal rows as well. Normals point outwards. None if no cell is
 * occupied.
 * @throws InputError in one line: a resolution that is none, sizes that are not those of the data, an origin that is no pose, too many
 * cells or triangles
 */
geometry::TriangleMesh wallsOf(const nav_msgs::OccupancyGrid& grid, const GridWalls& walls);

}  // namespace blem_sim::node
