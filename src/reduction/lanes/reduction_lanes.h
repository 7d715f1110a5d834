// The reduction's loops over all contacts, in plain arrays that compilers turn into vector code; the same bits on every processor.
#pragma once

#include <vector>

namespace blem_sim::reduction {

constexpr int WRENCH_DIRECTIONS = 256;  // more cost time, fewer leave extremes unseen
constexpr int CELL_DIRECTIONS = 16;
constexpr int OCTAGON_SIDES = 8;

/** Directions in the space of wrenches: force and torque parts by axis. */
struct alignas(64) WrenchDirections {
  float force[3][WRENCH_DIRECTIONS], torque[3][WRENCH_DIRECTIONS];
};

/** Place and normal of a contact, lengths in a patch's radius; every wrench of it counts less by the handicap, in unit forces. */
struct alignas(32) WrenchPoint {
  float x[3], n[3], handicap;
};

/** Many wrench points, coordinate by coordinate. */
struct WrenchPointRows {
  void clear();
  void add(const WrenchPoint& point);
  std::vector<float> x[3], n[3], handicap;
};

/** Whether some of the points is so near that `point` exceeds its wrenches by no more than `most` in any direction. */
bool addsLittleBeside(const WrenchPointRows& points, const WrenchPoint& point, float most);

/** Components of one point's wrenches, or the largest of several, by direction. */
struct alignas(64) WrenchComponents {
  float value[WRENCH_DIRECTIONS];
};

/** Largest components of the wrenches (f, x f) with f in the friction cone, of unit normal force, without handicaps: into
 * components[count]; and the largest of all points, less their handicaps. */
void findWrenches(const WrenchDirections& directions, const WrenchPoint* points, int count, WrenchComponents* components,
                  WrenchComponents* extremes);

/** The extremes alone, when handicaps have changed. */
void findWrenchExtremes(const WrenchComponents* components, const WrenchPoint* points, int count, WrenchComponents* extremes);

/** Raises `reached` to the components of a point, less its handicap. @return largest lack of `reached` against the extremes, in some
 * direction */
float addWrenches(const WrenchComponents& components, float handicap, const WrenchComponents& extremes, WrenchComponents* reached);

/** The first direction in which so much is lacking; WRENCH_DIRECTIONS if there is none. */
int firstLacking(const WrenchComponents& extremes, const WrenchComponents& reached, float lack);

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

/** Raises the extremes of every point's cell to the point's components.
 * @param raising into [count]: points, ascending, among which are all that are extreme in the end @return their number */
int raiseCellExtremes(const CellPoints& points, int count, int* raising);

/** Leaves those of the points that are extreme in a direction of their cell. @return their number */
int keepExtremePoints(const CellPoints& points, int count, int* among);

/** Points of a flat patch, seen along its normal, coordinate by coordinate. */
struct PlanePlaces {
  std::vector<double> x, y, depth;
};

/** Directions in a plane, and the farthest that points reach along them. */
struct alignas(64) PlaneDirections {
  double x[OCTAGON_SIDES], y[OCTAGON_SIDES];
  double along(int d, double px, double py) const { return x[d] * px + y[d] * py; }
};
struct alignas(64) PlaneExtremes {
  double value[OCTAGON_SIDES];
};

/** Indices of the points that are farthest along some direction, ascending, into found[number of places]. @return their number */
int findFarthest(const PlaneDirections& directions, const PlanePlaces& places, PlaneExtremes* extremes, int* found);

/** Lines through (x, y) along (dx, dy): points more than `limit` / length to their left are inside. */
struct Octagon {
  double x[OCTAGON_SIDES], y[OCTAGON_SIDES], dx[OCTAGON_SIDES], dy[OCTAGON_SIDES], limit[OCTAGON_SIDES];
};

/** Indices of the points that are not inside all sides, ascending, into found[number of places]. @return their number */
int findOutside(const Octagon& octagon, const PlanePlaces& places, int* found);

/** Triangles around a point, counter-clockwise. Keeps its memory. */
class Fan {
 public:
  /** @param closed whether the last triangle borders on the first */
  void start(double x, double y, bool closed);
  /** The first side of the next triangle goes to (x, y). */
  void addSide(double x, double y);

  double x = 0, y = 0;
  double from = 0;            ///< the first side's angle, in right angles, as unit circles of the sum norm count them
  double least = 0;           ///< other angles are counted from it on, from `from`
  std::vector<double> sides;  ///< angles, counted so, ascending
};

/** The triangle's index in whose angle each point lies, or the nearest if there is none: into sectors[count]. */
void findSectors(const Fan& fan, const double* x, const double* y, int count, int* sectors);

}  // namespace blem_sim::reduction
