// Nesterov's steps of sweeps: before a sweep, impulses and velocities move on along the direction of the last ones [Nesterov 1983].
#pragma once

#include <vector>

#include "lanes/sweep_lanes.h"

namespace blem_sim::dynamics {

/** A number's way through the sweeps. */
struct Led {
  double before = 0, search = 0;  ///< the number before the last sweep, and its direction
};

/** The further the longer sweeps go well, and nothing once they do not. Threads may move different ranges at once. */
class SweepLead {
 public:
  /** Begins an island: there is no direction yet. @param numbers of velocities */
  void start(int numbers);
  /** A run of sweeps: the first one is not led on. */
  void beginRun();
  /** After a sweep. @param change [N^2 s^2] sum of the squares of its changes of impulses */
  void take(double change);

  /** Moves impulses on. */
  void move(SweepImpulse* begin, SweepImpulse* end) const;
  /** Moves a number on. */
  void move(double* number, Led* led) const;
  /** Moves velocities from `first` on, before `end`. @param velocities all of them */
  void move(int first, int end, double* velocities);

 private:
  bool moves_ = false;
  int sweeps_ = 0;                       // that went well
  double least_ = 0;                     // [N^2 s^2] change of a sweep since the beginning
  std::vector<double> before_, search_;  // by number: velocity before the last sweep, and the direction
  double share() const { return sweeps_ / (sweeps_ + 3.0); }
};

}  // namespace blem_sim::dynamics
