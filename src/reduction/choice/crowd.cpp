#include "choice/crowd.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>

#include "choice/id_filter.h"
#include "lanes/contact_row.h"
#include "lanes/instruction_sets.h"
#include "lanes/reduction_lanes.h"

namespace blem_sim::reduction {

namespace {

constexpr int CELLS_PER_UNIT = 8;  // cells of normals
constexpr int NUMBERS = 2 * CELLS_PER_UNIT + 1;
constexpr double TILT = 0.6;  // weight of a unit of tilt, in radii of the patch, in every other direction

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

}  // namespace

// Cells of a coarse grid over normals, numbered as they come.
class CoarseCells {
 public:
  CoarseCells() { numbers_.fill(-1); }

  void clear() {
    for (const int key : keys_) numbers_[key] = -1;
    keys_.clear();
    directions_.clear();
  }

  /** Turns the keys of cells into their numbers. */
  void number(std::vector<int>* keys) {
    const std::int16_t* numbers = numbers_.data();
    int* all = keys->data();
    for (std::size_t i = 0; i < keys->size(); ++i) {
      if (numbers[all[i]] < 0) add(all[i]);
      all[i] = numbers[all[i]];
    }
  }

  const std::vector<CellDirections>& directions() const { return directions_; }

 private:
  void add(int key) {
    numbers_[key] = static_cast<std::int16_t>(keys_.size());
    keys_.push_back(key);
    const Vector3 cell(key / (NUMBERS * NUMBERS), key / NUMBERS % NUMBERS, key % NUMBERS);
    directions_.push_back(directionsAcross((cell - Vector3::Constant(CELLS_PER_UNIT)).normalized()));
  }

  std::array<std::int16_t, NUMBERS * NUMBERS * NUMBERS> numbers_;
  std::vector<int> keys_;
  std::vector<CellDirections> directions_;
};

namespace {

/** Input of readMembers: the members' contacts, their scale, and the limits for those that may be spared. */
struct Reading {
  const contact::Contact* contacts;
  const int* members;
  int count;
  const double* centre;  // [m]
  double per_radius;     // [1/m]
  double deep;           // [m] members as deep may be spared, as those among these bits of an IdFilter
  const std::uint64_t* spared_bits;
};

// Points of the members as wrenchPoint has them, the keys of the cells of their normals, and those that may be spared. @return their number
BLEM_SIM_LANES int readMembers(const Reading& given, WrenchPoint* points, int* keys, int* spared) {
  const Reading reading = given;
  typedef float Floats __attribute__((vector_size(16)));
  typedef int Ints __attribute__((vector_size(16)));
  static_assert(sizeof(WrenchPoint) == 2 * sizeof(Floats), "numbers in the order of rows");
  constexpr double MIDDLE = CELLS_PER_UNIT + 0.5;
  const double s = reading.per_radius;
  const Doubles middle = {reading.centre[0], reading.centre[1], reading.centre[2], 0}, scale = {s, s, s, 1};
  const Doubles gaps = {1, 1, -PER_GAP, 0}, least = {-2, -2, 0, 0};  // handicaps are never negative
  int size = 0;
  for (int m = 0; m < reading.count; ++m) {
    const contact::Contact& contact = reading.contacts[reading.members[m]];
    ContactRow row;
    readRow(contact, &row);
    const Doubles second = row.second * gaps;
    const Floats first_floats = __builtin_convertvector((row.first - middle) * scale, Floats);
    const Floats second_floats = __builtin_convertvector(second > least ? second : least, Floats);
    std::memcpy(&points[m], &first_floats, sizeof(Floats));
    std::memcpy(reinterpret_cast<char*>(&points[m]) + sizeof(Floats), &second_floats, sizeof(Floats));
    const Ints first_cells = __builtin_convertvector(row.first * Doubles{0, 0, 0, CELLS_PER_UNIT} + MIDDLE, Ints);
    const Ints second_cells = __builtin_convertvector(row.second * Doubles{CELLS_PER_UNIT, CELLS_PER_UNIT, 0, 0} + MIDDLE, Ints);
    keys[m] = (first_cells[3] * NUMBERS + second_cells[0]) * NUMBERS + second_cells[1];
    spared[size] = m;
    size += static_cast<int>(contact.depth >= reading.deep) | static_cast<int>(IdFilter::mayHave(reading.spared_bits, contact.id));
  }
  return size;
}

}  // namespace

struct CrowdThinner::Room {
  CoarseCells cells;
  std::vector<WrenchPoint> points;
  std::vector<int> cell_of, extreme, spared;
  std::vector<CellExtremes> extremes;

  void read(const ChoiceQuestion& asked);
  void findExtreme();
};

void CrowdThinner::Room::read(const ChoiceQuestion& asked) {
  const std::vector<contact::Contact>& contacts = asked.contacts;
  const std::vector<int>& members = asked.members;
  const PatchScale& scale = asked.scale;
  const IdFilter filter(asked.chosen_before);
  points.resize(members.size());
  cell_of.resize(members.size());
  spared.resize(members.size());
  const Reading reading{contacts.data(),       members.data(),    static_cast<int>(members.size()),
                        scale.centre().data(), scale.perRadius(), scale.depth() - DEPTH_TIE,
                        filter.bits()};
  spared.resize(readMembers(reading, points.data(), cell_of.data(), spared.data()));
  const auto is_not = [&](int m) {
    const contact::Contact& contact = contacts[members[m]];
    return !scale.isDeepest(contact) && !filter.has(contact.id);
  };
  spared.erase(std::remove_if(spared.begin(), spared.end(), is_not), spared.end());
  cells.clear();
  cells.number(&cell_of);
}

// Indices of the members that are extreme in their cells, ascending.
void CrowdThinner::Room::findExtreme() {
  CellExtremes lowest;
  std::fill(std::begin(lowest.value), std::end(lowest.value), -std::numeric_limits<float>::infinity());
  extremes.assign(cells.directions().size(), lowest);
  const CellPoints in_cells{points.data(), cell_of.data(), cells.directions().data(), extremes.data()};
  extreme.resize(points.size());
  const int raising = raiseCellExtremes(in_cells, static_cast<int>(points.size()), extreme.data());
  extreme.resize(keepExtremePoints(in_cells, raising, extreme.data()));
}

CrowdThinner::CrowdThinner() : room_(std::make_unique<Room>()) {}
CrowdThinner::~CrowdThinner() = default;

void CrowdThinner::thin(const ChoiceQuestion& asked, std::vector<int>* kept) {
  room_->read(asked);
  room_->findExtreme();
  kept->clear();
  std::set_union(room_->extreme.begin(), room_->extreme.end(), room_->spared.begin(), room_->spared.end(), std::back_inserter(*kept));
  for (int& m : *kept) m = asked.members[m];
}

}  // namespace blem_sim::reduction
