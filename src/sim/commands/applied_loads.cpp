#include "commands/applied_loads.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/sim/trajectory.h"

namespace blem_sim::sim {
namespace {

constexpr double ROUNDING = 1e-9;  // [s] of times
constexpr double ENDLESS = -1;     // end in a saved state

void requireNumbers(const Vector3& v, const char* field) {
  for (const double x : {v.x(), v.y(), v.z()})
    if (!isCommand(x)) throw InputError(fmt::format("{}: has {}; numbers must be finite, and not beyond {:g}", field, x, LARGEST_COMMAND));
}

template <typename Items, typename Predicate>
void removeIf(Items* items, const Predicate& predicate) {
  items->erase(std::remove_if(items->begin(), items->end(), predicate), items->end());
}

}  // namespace

bool AppliedLoads::Span::holds(double time) const { return time >= start - ROUNDING && !isOver(time); }
bool AppliedLoads::Span::isOver(double time) const { return time >= end - ROUNDING; }

AppliedLoads::Span AppliedLoads::spanOf(const LoadTime& when, const LoadTime& next_step) {
  if (!std::isfinite(when.start) || !std::isfinite(when.duration)) throw InputError("start_time, duration: must be finite");
  const double start = std::max(when.start, next_step.start);
  if (when.duration < 0) return {start, std::numeric_limits<double>::infinity()};
  return {start, start + std::max(when.duration, next_step.duration)};
}

void AppliedLoads::requireRoom() const {
  if (wrenches_.size() + efforts_.size() >= MOST)
    throw InputError(fmt::format("{} wrenches and efforts act already, which is the most; clear some", MOST));
}

void AppliedLoads::apply(const BodyLoad& load, const LoadTime& when, const LoadTime& next_step) {
  requireNumbers(load.wrench.force, "wrench.force");
  requireNumbers(load.wrench.torque, "wrench.torque");
  requireNumbers(load.p_B, "reference_point");
  requireRoom();
  const Span span = spanOf(when, next_step);
  if (when.duration != 0) wrenches_.push_back({span, load});
}

void AppliedLoads::apply(int joint, double effort, const LoadTime& when, const LoadTime& next_step) {
  if (!isCommand(effort)) throw InputError(fmt::format("effort: is {}; give it a number not beyond {:g}", effort, LARGEST_COMMAND));
  requireRoom();
  const Span span = spanOf(when, next_step);
  if (when.duration != 0) efforts_.push_back({span, joint, effort});
}

void AppliedLoads::clearBody(int body) {
  removeIf(&wrenches_, [&](const Pushed& pushed) { return pushed.load.body == body; });
}

void AppliedLoads::clearJoint(int joint) {
  removeIf(&efforts_, [&](const Driven& driven) { return driven.joint == joint; });
}

void AppliedLoads::clear() {
  wrenches_.clear();
  efforts_.clear();
}

const std::vector<BodyLoad>& AppliedLoads::wrenchesAt(double time) const {
  acting_.clear();
  for (const Pushed& pushed : wrenches_)
    if (pushed.span.holds(time)) acting_.push_back(pushed.load);
  return acting_;
}

void AppliedLoads::addEfforts(double time, std::vector<dynamics::JointDrive>* drives) const {
  for (const Driven& driven : efforts_)
    if (driven.span.holds(time)) (*drives)[driven.joint].outside_effort += driven.effort;
}

void AppliedLoads::expire(double time) {
  removeIf(&wrenches_, [&](const Pushed& pushed) { return pushed.span.isOver(time); });
  removeIf(&efforts_, [&](const Driven& driven) { return driven.span.isOver(time); });
}

void AppliedLoads::Span::save(geometry::StateWriter* writer) const { writer->numbers({start, std::isinf(end) ? ENDLESS : end}); }

void AppliedLoads::Span::restore(geometry::StateReader* reader) {
  start = reader->number();
  end = reader->number();
  if (end == ENDLESS) end = std::numeric_limits<double>::infinity();
}

void AppliedLoads::save(geometry::StateWriter* writer) const {
  writer->numbers({static_cast<double>(wrenches_.size()), static_cast<double>(efforts_.size())});
  for (const Pushed& pushed : wrenches_) {
    pushed.span.save(writer);
    writer->number(pushed.load.body);
    for (const Vector3* v : {&pushed.load.wrench.force, &pushed.load.wrench.torque, &pushed.load.p_B}) writer->vector(*v);
  }
  for (const Driven& driven : efforts_) {
    driven.span.save(writer);
    writer->numbers({static_cast<double>(driven.joint), driven.effort});
  }
}

void AppliedLoads::restore(int bodies, int joints, geometry::StateReader* reader) {
  const auto number = [&](double below) {
    const double x = reader->number();
    if (!(x >= 0 && x < below) || x != std::floor(x)) reader->refuseContent("a load is on nothing that is there");
    return static_cast<int>(x);
  };
  clear();
  wrenches_.resize(number(MOST + 1));
  efforts_.resize(number(MOST + 1));
  for (Pushed& pushed : wrenches_) {
    pushed.span.restore(reader);
    pushed.load.body = number(bodies);
    for (Vector3* v : {&pushed.load.wrench.force, &pushed.load.wrench.torque, &pushed.load.p_B}) *v = reader->vector();
  }
  for (Driven& driven : efforts_) {
    driven.span.restore(reader);
    driven.joint = number(joints);
    driven.effort = reader->number();
  }
}

}  // namespace blem_sim::sim
