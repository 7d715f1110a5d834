// Wrenches on bodies and efforts on joints from outside, each for a time.
#pragma once

#include <cstdint>
#include <vector>

#include "blem_sim/geometry/state_stream.h"
#include "blem_sim/sim/simulator_types.h"

namespace blem_sim::sim {

/** Loads in the order they were applied. State: all of them. */
class AppliedLoads {
 public:
  static constexpr std::size_t MOST = 10000;

  /** @param next_step its start and length @throws InputError if there are MOST already, or numbers are none */
  void apply(const BodyLoad& load, const LoadTime& when, const LoadTime& next_step);
  /** @param effort [N m or N] */
  void apply(int joint, double effort, const LoadTime& when, const LoadTime& next_step);
  void clearBody(int body);
  void clearJoint(int joint);
  void clear();
  bool empty() const { return wrenches_.empty() && efforts_.empty(); }

  /** Loads that act in a step that starts at `time` [s], on bodies in these states: wrenches about centres of mass. */
  const std::vector<BodyLoad>& wrenchesAt(double time) const;
  /** Adds the efforts of a step that starts at `time` [s]. */
  void addEfforts(double time, std::vector<dynamics::JointDrive>* drives) const;
  /** Forgets the loads whose time is over. @param time [s] at which the next step starts */
  void expire(double time);

  void save(geometry::StateWriter* writer) const;
  /** @param bodies, joints slots that loads can be on */
  void restore(int bodies, int joints, geometry::StateReader* reader);

 private:
  struct Span {
    double start, end;  // [s] simulated; an endless one's end is infinite
    void save(geometry::StateWriter* writer) const;
    void restore(geometry::StateReader* reader);
    bool holds(double time) const;
    bool isOver(double time) const;
  };
  struct Pushed {
    Span span;
    BodyLoad load;
  };
  struct Driven {
    Span span;
    int joint;
    double effort;
  };
  static Span spanOf(const LoadTime& when, const LoadTime& next_step);
  void requireRoom() const;

  std::vector<Pushed> wrenches_;
  std::vector<Driven> efforts_;
  mutable std::vector<BodyLoad> acting_;  // work space of wrenchesAt
};

}  // namespace blem_sim::sim
