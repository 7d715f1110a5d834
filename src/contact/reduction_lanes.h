// The reduction's loops over all contacts, in plain arrays that compilers turn into vector code; the same bits on every processor.
#pragma once

#include <array>
#include <cstddef>

namespace blem_sim {

constexpr int WRENCH_DIRECTIONS = 256;  // more cost time, fewer leave extremes unseen
constexpr int CELL_DIRECTIONS = 16;
constexpr int OCTAGON_SIDES = 8;

/** Directions in the space of wrenches: force and torque parts by axis. */
struct alignas(64) WrenchDirections {
  float force[3][WRENCH_DIRECTIONS], torque[3][WRENCH_DIRECTIONS];
};

/** Where a contact pushes, lengths in a patch's radius; every wrench of it counts less by the handicap, in unit forces. */
struct WrenchPoint {
  float x[3], n[3], handicap;
};

/** By direction: a largest component of wrenches, and the first point that has it. */
struct alignas(64) WrenchExtremes {
  float value[WRENCH_DIRECTIONS];
  int point[WRENCH_DIRECTIONS];
};

/** Of one point, by direction. */
struct alignas(64) WrenchComponents {
  float value[WRENCH_DIRECTIONS];
};

/** Largest components of the wrenches (f, x f) with f in the friction cone, of unit normal force, without handicaps: into
 * components[count]; and the extremes over all points, less their handicaps. Precondition: count > 0. */
void findWrenches(const WrenchDirections& directions, const WrenchPoint* points, int count, WrenchComponents* components,
                  WrenchExtremes* extremes);

/** The extremes alone, when handicaps have changed. */
void findWrenchExtremes(const WrenchComponents* components, const WrenchPoint* points, int count, WrenchExtremes* extremes);

struct WrenchLack {
  float most;
  int direction;
};

/** Raises `reached`, by direction, to what a point with these components adds. @return where most is lacking of the extremes */
WrenchLack addWrenches(const WrenchComponents& components, float handicap, const WrenchExtremes& extremes, WrenchComponents* reached);

/** Weights of places and normals, by direction, in a cell of alike normals. */
struct alignas(64) CellDirections {
  float place[3][CELL_DIRECTIONS], normal[3][CELL_DIRECTIONS];
};

struct alignas(64) CellExtremes {
  float value[CELL_DIRECTIONS];
};

/** Contacts by cell: as many cells as directions and extremes. */
struct CellPoints {
  const WrenchPoint* points;
  const int* cells;
  const CellDirections* directions;
  CellExtremes* extremes;
};

/** Raises the extremes of every point's cell to what the point has.
 * @param raising into [count]: points, ascending, among which are all that are extreme in the end @return how many */
int raiseCellExtremes(const CellPoints& points, int count, int* raising);

/** Leaves those of the points that are extreme in a direction of their cell. @return how many */
int keepExtremePoints(const CellPoints& points, int count, int* among);

/** A point in a plane. */
struct PlanePlace {
  double x, y, depth;
};

/** A line through `from` along (dx, dy): what lies more than `limit` / length to its left is inside. */
struct alignas(64) Octagon {
  double x[OCTAGON_SIDES], y[OCTAGON_SIDES], dx[OCTAGON_SIDES], dy[OCTAGON_SIDES], limit[OCTAGON_SIDES];
};

/** Indices of the points that are not inside all sides or deeper than `depth`, ascending, into found[count]. @return how many */
int findOutside(const Octagon& octagon, double depth, const PlanePlace* points, int count, int* found);

}  // namespace blem_sim
