// Nesterov's steps of sweeps: before a sweep, impulses and velocities move on by a share of what the last one changed [Nesterov 1983].
#pragma once

#include <vector>

namespace blem_sim::dynamics {

/** The further the longer sweeps go well, and nothing once they do not. Threads may move different ranges at once. */
class SweepLead {
 public:
  /** Begins an island: there is no direction yet. @param numbers of velocities */
  void start(int numbers);
  /** A run of sweeps: the first one is not led on. */
  void beginRun();
  /** After a sweep. @param change [N^2 s^2] sum of the squares of its changes of impulses */
  void take(double change);

  /** Share of the last change by which a number moves on now. */
  double share() const { return sweeps_ / (sweeps_ + 3.0); }
  /** Moves numbers on. @param before what the sweep before found: becomes what the last one found */
  void move(double* begin, double* end, double* before) const;
  /** Moves velocities from `first` on, before `end`. @param velocities all of them */
  void moveVelocities(int first, int end, double* velocities);

 private:
  int sweeps_ = 0;              // that went well
  double least_ = 0;            // [N^2 s^2] change of a sweep since the beginning
  std::vector<double> before_;  // velocities that the sweep before found
};

}  // namespace blem_sim::dynamics
