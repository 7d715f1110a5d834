#include "reduction_lanes.h"

#include "instruction_sets.h"

namespace blem_sim {

namespace {

constexpr float CHOICE_FRICTION = 0.5f;  // of the cones that are compared; the choice hardly depends on it

// With g the direction seen by a force at x, the largest component along direction d is g.n + mu |g - (g.n) n|.
BLEM_SIM_INLINE float wrenchComponent(const WrenchDirections& w, const WrenchPoint& p, int d) {
  const float gx = w.force[0][d] + w.torque[1][d] * p.x[2] - w.torque[2][d] * p.x[1];
  const float gy = w.force[1][d] + w.torque[2][d] * p.x[0] - w.torque[0][d] * p.x[2];
  const float gz = w.force[2][d] + w.torque[0][d] * p.x[1] - w.torque[1][d] * p.x[0];
  const float along = gx * p.n[0] + gy * p.n[1] + gz * p.n[2];
  const float rest = gx * gx + gy * gy + gz * gz - along * along;
  return along + CHOICE_FRICTION * __builtin_sqrtf(rest > 0 ? rest : 0);
}

BLEM_SIM_INLINE float cellComponent(const CellDirections& c, const WrenchPoint& p, int d) {
  return c.place[0][d] * p.x[0] + c.place[1][d] * p.x[1] + c.place[2][d] * p.x[2] + c.normal[0][d] * p.n[0] + c.normal[1][d] * p.n[1] +
         c.normal[2][d] * p.n[2] - p.handicap;
}

BLEM_SIM_INLINE void raise(const WrenchComponents& components, float handicap, WrenchComponents* to) {
  for (int d = 0; d < WRENCH_DIRECTIONS; ++d) {
    const float component = components.value[d] - handicap;
    to->value[d] = component > to->value[d] ? component : to->value[d];
  }
}

// Folds the values in halves: loops of known length, which need no order of their own.
template <int HALF>
BLEM_SIM_INLINE void fold(float* values) {
  for (int i = 0; i < HALF; ++i) values[i] = values[i + HALF] > values[i] ? values[i + HALF] : values[i];
}

BLEM_SIM_INLINE float largest(float (&values)[WRENCH_DIRECTIONS]) {
  static_assert(WRENCH_DIRECTIONS == 256, "folded to 16");
  fold<128>(values);
  fold<64>(values);
  fold<32>(values);
  fold<16>(values);
  fold<8>(values);
  fold<4>(values);
  const float a = values[0] > values[1] ? values[0] : values[1], b = values[2] > values[3] ? values[2] : values[3];
  return a > b ? a : b;
}

BLEM_SIM_INLINE void clear(WrenchComponents* components) {
  for (int d = 0; d < WRENCH_DIRECTIONS; ++d) components->value[d] = -__builtin_inff();
}

}  // namespace

BLEM_SIM_LANES void findWrenches(const WrenchDirections& directions, const WrenchPoint* points, int count, WrenchComponents* components,
                                 WrenchComponents* extremes) {
  clear(extremes);
  for (int i = 0; i < count; ++i) {
    const WrenchPoint point = points[i];
    float* values = components[i].value;
    for (int d = 0; d < WRENCH_DIRECTIONS; ++d) values[d] = wrenchComponent(directions, point, d);
    raise(components[i], point.handicap, extremes);
  }
}

BLEM_SIM_LANES void findWrenchExtremes(const WrenchComponents* components, const WrenchPoint* points, int count,
                                       WrenchComponents* extremes) {
  clear(extremes);
  for (int i = 0; i < count; ++i) raise(components[i], points[i].handicap, extremes);
}

BLEM_SIM_LANES float addWrenches(const WrenchComponents& components, float handicap, const WrenchComponents& extremes,
                                 WrenchComponents* reached) {
  raise(components, handicap, reached);
  float lacks[WRENCH_DIRECTIONS];
  for (int d = 0; d < WRENCH_DIRECTIONS; ++d) lacks[d] = extremes.value[d] - reached->value[d];
  return largest(lacks);
}

BLEM_SIM_LANES int firstLacking(const WrenchComponents& extremes, const WrenchComponents& reached, float lack) {
  // Counted back from the end, as floats, so that one maximum serves both.
  float left[WRENCH_DIRECTIONS];
  for (int d = 0; d < WRENCH_DIRECTIONS; ++d)
    left[d] = extremes.value[d] - reached.value[d] == lack ? static_cast<float>(WRENCH_DIRECTIONS - d) : 0;
  return WRENCH_DIRECTIONS - static_cast<int>(largest(left));
}

BLEM_SIM_LANES int raiseCellExtremes(const CellPoints& points, int count, int* raising) {
  int size = 0;
  for (int i = 0; i < count; ++i) {
    const WrenchPoint point = points.points[i];
    const CellDirections& directions = points.directions[points.cells[i]];
    float* value = points.extremes[points.cells[i]].value;
    int raises = 0;
    for (int d = 0; d < CELL_DIRECTIONS; ++d) {
      const float component = cellComponent(directions, point, d);
      raises |= component >= value[d];
      value[d] = component > value[d] ? component : value[d];
    }
    raising[size] = i;
    size += raises;
  }
  return size;
}

BLEM_SIM_LANES int keepExtremePoints(const CellPoints& points, int count, int* among) {
  int size = 0;
  for (int i = 0; i < count; ++i) {
    const WrenchPoint point = points.points[among[i]];
    const CellDirections& directions = points.directions[points.cells[among[i]]];
    const float* value = points.extremes[points.cells[among[i]]].value;
    int extreme = 0;
    for (int d = 0; d < CELL_DIRECTIONS; ++d) extreme |= cellComponent(directions, point, d) == value[d];
    among[size] = among[i];
    size += extreme;
  }
  return size;
}

namespace {

constexpr int LANES = 32;  // points at once: so many are kept as vectors, few would be turned into single numbers

// Of the points in every lane the largest, then the largest of the lanes.
BLEM_SIM_INLINE double largestAlong(double dx, double dy, const double* x, const double* y, int count) {
  double most[LANES];
  for (int lane = 0; lane < LANES; ++lane) most[lane] = -__builtin_inf();
  int first = 0;
  for (; first + LANES <= count; first += LANES) {
    for (int lane = 0; lane < LANES; ++lane) {
      const double along = dx * x[first + lane] + dy * y[first + lane];
      most[lane] = along > most[lane] ? along : most[lane];
    }
  }
  for (int i = first; i < count; ++i) {
    const double along = dx * x[i] + dy * y[i];
    most[0] = along > most[0] ? along : most[0];
  }
  for (int half = LANES / 2; half > 0; half /= 2) {
    for (int lane = 0; lane < half; ++lane) most[lane] = most[lane + half] > most[lane] ? most[lane + half] : most[lane];
  }
  return most[0];
}

BLEM_SIM_INLINE int farthestOf(int direction_count, const PlaneDirections& directions, const double* x, const double* y, int count,
                               PlaneExtremes* extremes, int* found) {
  constexpr int BLOCK = 64;
  for (int d = 0; d < direction_count; ++d) extremes->value[d] = largestAlong(directions.x[d], directions.y[d], x, y, count);
  int size = 0;
  for (int first = 0; first < count; first += BLOCK) {
    const int some = count - first < BLOCK ? count - first : BLOCK;
    long extreme[BLOCK];
    for (int i = 0; i < BLOCK; ++i) extreme[i] = 0;
    for (int d = 0; d < direction_count; ++d) {
      const double dx = directions.x[d], dy = directions.y[d], value = extremes->value[d];
      for (int i = 0; i < some; ++i) extreme[i] |= dx * x[first + i] + dy * y[first + i] == value ? 1 : 0;
    }
    for (int i = 0; i < some; ++i) {
      found[size] = first + i;
      size += extreme[i] != 0;
    }
  }
  return size;
}

}  // namespace

BLEM_SIM_LANES int findFarthest(const PlaneDirections& directions, const double* x, const double* y, int count, PlaneExtremes* extremes,
                                int* found) {
  return farthestOf(PLANE_DIRECTIONS, directions, x, y, count, extremes, found);
}

BLEM_SIM_LANES int findFarthestOfOctagon(const PlaneDirections& directions, const double* x, const double* y, int count,
                                         PlaneExtremes* extremes, int* found) {
  return farthestOf(OCTAGON_SIDES, directions, x, y, count, extremes, found);
}

BLEM_SIM_LANES int findOutside(const Octagon& octagon, const double* x, const double* y, int count, int* found) {
  constexpr int BLOCK = 64;
  int size = 0;
  for (int first = 0; first < count; first += BLOCK) {
    const int some = count - first < BLOCK ? count - first : BLOCK;
    double least[BLOCK];  // that a point is inside by, more than it must
    for (int i = 0; i < BLOCK; ++i) least[i] = __builtin_inf();
    for (int s = 0; s < OCTAGON_SIDES; ++s) {
      const double dx = octagon.dx[s], dy = octagon.dy[s], sx = octagon.x[s], sy = octagon.y[s], limit = octagon.limit[s];
      for (int i = 0; i < some; ++i) {
        const double inside = dx * (y[first + i] - sy) - dy * (x[first + i] - sx) - limit;
        least[i] = inside < least[i] ? inside : least[i];
      }
    }
    for (int i = 0; i < some; ++i) {
      found[size] = first + i;
      size += least[i] <= 0;
    }
  }
  return size;
}

namespace {

// Right angles from the x-axis, on the unit circle of the sum norm: as good as angles to tell what comes first.
BLEM_SIM_INLINE double angleOf(double dx, double dy) {
  const double around = (dx < 0 ? -dx : dx) + (dy < 0 ? -dy : dy), part = dy / (around > 0 ? around : 1);
  return dx < 0 ? 2 - part : (dy < 0 ? 4 + part : part);
}

BLEM_SIM_INLINE double angleFrom(double from, double least, double angle) {
  const double relative = angle - from;
  return relative < least ? relative + 4 : (relative >= least + 4 ? relative - 4 : relative);
}

}  // namespace

void Fan::start(double middle_x, double middle_y, bool closed) {
  x = middle_x;
  y = middle_y;
  least = closed ? 0 : -1;
  sides.clear();
}

void Fan::addSide(double to_x, double to_y) {
  const double angle = angleOf(to_x - x, to_y - y);
  if (sides.empty()) from = angle;
  sides.push_back(angleFrom(from, least, angle));
}

BLEM_SIM_LANES void findSectors(const Fan& fan, const double* x, const double* y, int count, int* sectors) {
  constexpr int BLOCK = 64;
  const double middle_x = fan.x, middle_y = fan.y, from = fan.from, least = fan.least;
  const double* sides = fan.sides.data();
  const int side_count = static_cast<int>(fan.sides.size());
  for (int first = 0; first < count; first += BLOCK) {
    const int some = count - first < BLOCK ? count - first : BLOCK;
    double angles[BLOCK];
    long passed[BLOCK];
    for (int i = 0; i < some; ++i) {
      angles[i] = angleFrom(from, least, angleOf(x[first + i] - middle_x, y[first + i] - middle_y));
      passed[i] = 0;
    }
    for (int s = 1; s < side_count; ++s) {
      const double side = sides[s];
      for (int i = 0; i < some; ++i) passed[i] += angles[i] >= side ? 1 : 0;
    }
    for (int i = 0; i < some; ++i) sectors[first + i] = static_cast<int>(passed[i]);
  }
}

}  // namespace blem_sim
