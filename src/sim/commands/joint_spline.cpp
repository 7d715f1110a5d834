#include <algorithm>

#include "blem_sim/sim/trajectory.h"
#include "numbers/nearest_turn.h"

namespace blem_sim::sim {

namespace {

using Knot = JointSpline::Knot;

JointSample holdAt(const Knot& knot) { return {knot.position, 0, 0, knot.effort}; }

/** Coefficients c[k] of t^k on [0, T] that meet both knots: linear; cubic Hermite; quintic Hermite. */
struct Polynomial {
  double c[6] = {0, 0, 0, 0, 0, 0};

  Polynomial(const Knot& from, const Knot& to) {
    const double T = to.time - from.time, T2 = T * T, T3 = T2 * T;
    const double p0 = from.position, p1 = to.position, v0 = from.velocity, v1 = to.velocity, a0 = from.acceleration, a1 = to.acceleration;
    c[0] = p0;
    if (to.order == 1) {
      c[1] = (p1 - p0) / T;
    } else if (to.order == 3) {
      c[1] = v0;
      c[2] = (3 * (p1 - p0) - (2 * v0 + v1) * T) / T2;
      c[3] = (2 * (p0 - p1) + (v0 + v1) * T) / T3;
    } else {
      c[1] = v0;
      c[2] = a0 / 2;
      c[3] = (20 * (p1 - p0) - (8 * v1 + 12 * v0) * T - (3 * a0 - a1) * T2) / (2 * T3);
      c[4] = (30 * (p0 - p1) + (14 * v1 + 16 * v0) * T + (3 * a0 - 2 * a1) * T2) / (2 * T3 * T);
      c[5] = (12 * (p1 - p0) - 6 * (v1 + v0) * T + (a1 - a0) * T2) / (2 * T3 * T2);
    }
  }

  double position(double t) const { return c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5])))); }
  double velocity(double t) const { return c[1] + t * (2 * c[2] + t * (3 * c[3] + t * (4 * c[4] + t * 5 * c[5]))); }
  double acceleration(double t) const { return 2 * c[2] + t * (6 * c[3] + t * (12 * c[4] + t * 20 * c[5])); }
};

JointSample sampleSegment(const Knot& from, const Knot& to, double time) {
  const Polynomial polynomial(from, to);
  const double t = time - from.time, fraction = t / (to.time - from.time);
  return {polynomial.position(t), polynomial.velocity(t), polynomial.acceleration(t), from.effort + fraction * (to.effort - from.effort)};
}

Knot makeKnot(double time, const JointSample& sample, int order) {
  return {time, sample.position, sample.velocity, sample.acceleration, sample.effort, order};
}

/** First knot after a time. */
std::vector<Knot>::const_iterator firstAfter(const std::vector<Knot>& knots, double time) {
  return std::upper_bound(knots.begin(), knots.end(), time, [](double t, const Knot& knot) { return t < knot.time; });
}

/** A segment is of the lower order of its two ends: a cubic needs a velocity at either. */
void lowerOrders(std::vector<Knot>* knots) {
  int previous = 5;
  for (Knot& knot : *knots) {
    const int own = knot.order;
    knot.order = std::min(own, previous);
    previous = own;
  }
}

/** Brings the first position nearest to `present`, and the others with it. */
void takeNearestTurn(double present, std::vector<Knot>* knots) {
  const double turns = turnsTo(present, knots->front().position);
  for (Knot& knot : *knots) knot.position += turns;
}

}  // namespace

JointSpline::JointSpline(double position) : knots_{{0, position, 0, 0, 0, 1}} {}

JointSample JointSpline::sample(double time) const {
  if (knots_.empty()) return {};
  const auto next = firstAfter(knots_, time);
  if (next == knots_.begin()) return holdAt(knots_.front());
  if (next != knots_.end()) return sampleSegment(*(next - 1), *next, time);
  const Knot& last = knots_.back();
  const bool ends_now = time == last.time && knots_.size() > 1 && (&last - 1)->time < last.time;
  return ends_now ? sampleSegment(*(&last - 1), last, time) : holdAt(last);
}

double JointSpline::startTime() const { return knots_.empty() ? 0 : knots_.front().time; }

JointSpline::Knot JointSpline::lastKnot() const { return knots_.empty() ? Knot{0, 0, 0, 0, 0, 1} : knots_.back(); }

double JointSpline::endTime() const { return knots_.empty() ? 0 : knots_.back().time; }

void JointSpline::splice(double now, double start, std::vector<Knot> knots, bool continuous) {
  const double switch_time = std::max(now, start);
  if (knots.empty()) {
    JointSample held = sample(now);
    held.velocity = held.acceleration = 0;
    knots_ = {makeKnot(now, held, 1)};
    return;
  }
  knots.erase(knots.begin(), firstAfter(knots, now));
  // Points of negative times, before a start that is still to come, are as old as those before now.
  knots.erase(knots.begin(), std::find_if(knots.begin(), knots.end(), [&](const Knot& knot) { return knot.time >= start; }));
  if (knots.empty()) return;
  lowerOrders(&knots);

  // The rest of the present spline, cut at both ends; Hermite pieces keep their shape when they are cut.
  std::vector<Knot> spliced = {makeKnot(now, sample(now), 1)};
  const auto after = firstAfter(knots_, now);
  const auto end = std::find_if(after, knots_.cend(), [&](const Knot& knot) { return knot.time >= switch_time; });
  spliced.insert(spliced.end(), after, end);
  if (switch_time > now) {
    const bool at_knot = end != knots_.cend() && end->time == switch_time;
    spliced.push_back(at_knot ? *end : makeKnot(switch_time, sample(switch_time), end == knots_.cend() ? 1 : end->order));
  }
  // A first point at the switch itself makes a segment without length: a jump, which the command asks for.
  if (continuous) takeNearestTurn(spliced.back().position, &knots);
  spliced.insert(spliced.end(), knots.begin(), knots.end());
  knots_ = std::move(spliced);
}

void JointSpline::save(geometry::StateWriter* writer) const {
  writer->number(static_cast<double>(knots_.size()));
  for (const Knot& knot : knots_)
    writer->numbers({knot.time, knot.position, knot.velocity, knot.acceleration, knot.effort, static_cast<double>(knot.order)});
}

void JointSpline::restore(geometry::StateReader* reader) {
  constexpr std::size_t NUMBERS = 6;
  const double count = reader->number();
  if (!(count >= 1 && count <= static_cast<double>(reader->numbersLeft() / NUMBERS))) reader->refuse();
  knots_.resize(static_cast<std::size_t>(count));
  for (Knot& knot : knots_) {
    double numbers[NUMBERS];
    reader->numbers(numbers, NUMBERS);
    if (numbers[5] != 1 && numbers[5] != 3 && numbers[5] != 5) reader->refuseContent("a knot's order is none of 1, 3 and 5");
    knot = {numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], static_cast<int>(numbers[5])};
  }
  const auto earlier = [](const Knot& a, const Knot& b) { return a.time < b.time; };
  if (!std::is_sorted(knots_.begin(), knots_.end(), earlier)) reader->refuseContent("the times of a spline go back");
}

}  // namespace blem_sim::sim
