#include "lanes/reduction_lanes.h"

#include "lanes/instruction_sets.h"
#include "lanes/wrench_bounds.h"

namespace blem_sim::reduction {

namespace {

constexpr float CHOICE_FRICTION = 0.5f;  // friction of the cones that are compared; the choice hardly depends on it

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

void WrenchPointRows::clear() {
  for (int axis = 0; axis < 3; ++axis) {
    x[axis].clear();
    n[axis].clear();
  }
  handicap.clear();
}

void WrenchPointRows::add(const WrenchPoint& point) {
  for (int axis = 0; axis < 3; ++axis) {
    x[axis].push_back(point.x[axis]);
    n[axis].push_back(point.n[axis]);
  }
  handicap.push_back(point.handicap);
}

BLEM_SIM_LANES bool addsLittleBeside(const WrenchPointRows& points, const WrenchPoint& point, float most) {
  const float *px = points.x[0].data(), *py = points.x[1].data(), *pz = points.x[2].data();
  const float *nx = points.n[0].data(), *ny = points.n[1].data(), *nz = points.n[2].data(), *handicap = points.handicap.data();
  const WrenchPoint p = point;
  const int count = static_cast<int>(points.handicap.size());
  int little = 0;
  for (int i = 0; i < count; ++i) {
    const float dx = p.x[0] - px[i], dy = p.x[1] - py[i], dz = p.x[2] - pz[i];
    const float tx = p.n[0] - nx[i], ty = p.n[1] - ny[i], tz = p.n[2] - nz[i];
    const float way = __builtin_sqrtf(dx * dx + dy * dy + dz * dz), tilt = __builtin_sqrtf(tx * tx + ty * ty + tz * tz);
    little |= PER_PLACE * way + PER_NORMAL * tilt + handicap[i] - p.handicap <= most ? 1 : 0;
  }
  return little != 0;
}

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

namespace {

typedef float Floats __attribute__((vector_size(32)));  // wider ones would be taken apart where processors have none
typedef long Halves __attribute__((vector_size(32)));   // two comparisons each

// Raises a part of the extremes, and adds which of them the point reaches.
BLEM_SIM_INLINE void raiseSome(const CellDirections& c, const WrenchPoint& p, int first, float* extremes, Halves* reached) {
  Floats place[3], normal[3], before;
  for (int axis = 0; axis < 3; ++axis) {
    __builtin_memcpy(&place[axis], c.place[axis] + first, sizeof(Floats));
    __builtin_memcpy(&normal[axis], c.normal[axis] + first, sizeof(Floats));
  }
  __builtin_memcpy(&before, extremes + first, sizeof(Floats));
  const Floats component =
      place[0] * p.x[0] + place[1] * p.x[1] + place[2] * p.x[2] + normal[0] * p.n[0] + normal[1] * p.n[1] + normal[2] * p.n[2] - p.handicap;
  const Floats after = component > before ? component : before;
  __builtin_memcpy(extremes + first, &after, sizeof(Floats));
  *reached |= reinterpret_cast<Halves>(component >= before);
}

}  // namespace

BLEM_SIM_LANES int raiseCellExtremes(const CellPoints& points, int count, int* raising) {
  constexpr int SOME = sizeof(Floats) / sizeof(float);
  static_assert(CELL_DIRECTIONS == 2 * SOME, "in two parts");
  int size = 0;
  for (int i = 0; i < count; ++i) {
    const WrenchPoint& point = points.points[i];
    const CellDirections& directions = points.directions[points.cells[i]];
    float* extremes = points.extremes[points.cells[i]].value;
    Halves raises = {};
    raiseSome(directions, point, 0, extremes, &raises);
    raiseSome(directions, point, SOME, extremes, &raises);
    raising[size] = i;
    size += (raises[0] | raises[1] | raises[2] | raises[3]) != 0;
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

BLEM_SIM_LANES int findFarthest(const PlaneDirections& directions, const PlanePlaces& places, PlaneExtremes* extremes, int* found) {
  const double *x = places.x.data(), *y = places.y.data();
  const int count = static_cast<int>(places.x.size());
  for (int d = 0; d < OCTAGON_SIDES; ++d) extremes->value[d] = -__builtin_inf();
  int raising = 0;
  for (int i = 0; i < count; ++i) {
    const double px = x[i], py = y[i];
    long raises = 0;
    for (int d = 0; d < OCTAGON_SIDES; ++d) {
      const double along = directions.along(d, px, py), before = extremes->value[d];
      raises |= along >= before;
      extremes->value[d] = along > before ? along : before;
    }
    found[raising] = i;
    raising += raises != 0;
  }
  int size = 0;
  for (int r = 0; r < raising; ++r) {
    const double px = x[found[r]], py = y[found[r]];
    long extreme = 0;
    for (int d = 0; d < OCTAGON_SIDES; ++d) extreme |= directions.along(d, px, py) == extremes->value[d];
    found[size] = found[r];
    size += extreme != 0;
  }
  return size;
}

BLEM_SIM_LANES int findOutside(const Octagon& octagon, const PlanePlaces& places, int* found) {
  const double *x = places.x.data(), *y = places.y.data();
  const int count = static_cast<int>(places.x.size());
  constexpr int BLOCK = 64;
  int size = 0;
  for (int first = 0; first < count; first += BLOCK) {
    const int some = count - first < BLOCK ? count - first : BLOCK;
    double least[BLOCK];  // over all sides: product with the side, positive inside, less the limit
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

// Right angles from the x-axis, on the unit circle of the sum norm: as good as angles for their order.
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

}  // namespace blem_sim::reduction
