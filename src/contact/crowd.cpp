#include "crowd.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>

#include "id_filter.h"
#include "reduction_lanes.h"

namespace blem_sim {

namespace {

constexpr int PER_UNIT = 8;  // cells of normals
constexpr int NUMBERS = 2 * PER_UNIT + 1;
constexpr double TILT = 0.6;  // what a unit of tilt counts, in radii of the patch, in every other direction

// Places around a normal (u, v), half of them mixed with tilts.
struct Circles {
  Circles() {
    constexpr double FIRST = 0.1234;  // [rad] no mesh has sides across it: few contacts tie
    constexpr double GOLDEN_ANGLE = 2.39996322972865332;
    for (int d = 0; d < CELL_DIRECTIONS; ++d) {
      const double around = FIRST + 2 * M_PI * d / CELL_DIRECTIONS, tilted = FIRST + GOLDEN_ANGLE * d, weight = d % 2 ? TILT : 0;
      place[0][d] = static_cast<float>(std::cos(around));
      place[1][d] = static_cast<float>(std::sin(around));
      tilt[0][d] = static_cast<float>(weight * std::cos(tilted));
      tilt[1][d] = static_cast<float>(weight * std::sin(tilted));
    }
  }
  float place[2][CELL_DIRECTIONS], tilt[2][CELL_DIRECTIONS];
};

CellDirections directionsAcross(const Vector3& normal) {
  static const Circles circles;
  const PlaneAxes axes = axesAcross(normal);
  CellDirections directions;
  for (int axis = 0; axis < 3; ++axis) {
    const float u = static_cast<float>(axes.u[axis]), v = static_cast<float>(axes.v[axis]);
    for (int d = 0; d < CELL_DIRECTIONS; ++d) {
      directions.place[axis][d] = u * circles.place[0][d] + v * circles.place[1][d];
      directions.normal[axis][d] = u * circles.tilt[0][d] + v * circles.tilt[1][d];
    }
  }
  return directions;
}

// Cells of a coarse grid over normals, numbered as they come.
class CoarseCells {
 public:
  CoarseCells() { numbers_.fill(-1); }

  void clear() {
    for (const int key : keys_) numbers_[key] = -1;
    keys_.clear();
    directions_.clear();
  }

  int of(const Vector3& normal) {
    const auto number = [](double part) { return static_cast<int>(part * PER_UNIT + (PER_UNIT + 0.5)); };
    const int i = number(normal.x()), j = number(normal.y()), k = number(normal.z());
    const int key = (i * NUMBERS + j) * NUMBERS + k;
    if (numbers_[key] < 0) {
      numbers_[key] = static_cast<std::int16_t>(keys_.size());
      keys_.push_back(key);
      directions_.push_back(directionsAcross(Vector3(i - PER_UNIT, j - PER_UNIT, k - PER_UNIT).normalized()));
    }
    return numbers_[key];
  }

  const std::vector<CellDirections>& directions() const { return directions_; }

 private:
  std::array<std::int16_t, NUMBERS * NUMBERS * NUMBERS> numbers_;
  std::vector<int> keys_;
  std::vector<CellDirections> directions_;
};

struct Buffers {
  CoarseCells cells;
  std::vector<WrenchPoint> points;
  std::vector<int> cell_of, extreme, spared;
  std::vector<CellExtremes> extremes;
};

// Points and cells of the members, and which are to be kept whatever else is.
void fill(const std::vector<Contact>& contacts, const PatchScale& scale, const std::vector<int>& members, const ContactIds& spared,
          Buffers* buffers) {
  const IdFilter filter(spared);
  const int count = static_cast<int>(members.size());
  buffers->cells.clear();
  buffers->spared.clear();
  buffers->points.resize(members.size());
  buffers->cell_of.resize(members.size());
  WrenchPoint* points = buffers->points.data();
  int* cell_of = buffers->cell_of.data();
  for (int m = 0; m < count; ++m) {
    const Contact& contact = contacts[members[m]];
    points[m] = wrenchPoint(contact, scale);
    cell_of[m] = buffers->cells.of(contact.normal_BA);
    if (scale.isDeepest(contact) || filter.has(contact.id)) buffers->spared.push_back(m);
  }
}

// Indices of the members that are extreme in their cells, ascending.
void findExtreme(Buffers* buffers) {
  CellExtremes lowest;
  std::fill(std::begin(lowest.value), std::end(lowest.value), -std::numeric_limits<float>::infinity());
  buffers->extremes.assign(buffers->cells.directions().size(), lowest);
  const CellPoints points{buffers->points.data(), buffers->cell_of.data(), buffers->cells.directions().data(), buffers->extremes.data()};
  buffers->extreme.resize(buffers->points.size());
  const int raising = raiseCellExtremes(points, static_cast<int>(buffers->points.size()), buffers->extreme.data());
  buffers->extreme.resize(keepExtremePoints(points, raising, buffers->extreme.data()));
}

}  // namespace

void thinCrowd(const std::vector<Contact>& contacts, const PatchScale& scale, const std::vector<int>& members, const ContactIds& spared,
               std::vector<int>* kept) {
  static thread_local Buffers buffers;
  fill(contacts, scale, members, spared, &buffers);
  findExtreme(&buffers);
  kept->clear();
  std::set_union(buffers.extreme.begin(), buffers.extreme.end(), buffers.spared.begin(), buffers.spared.end(), std::back_inserter(*kept));
  for (int& m : *kept) m = members[m];
}

}  // namespace blem_sim
