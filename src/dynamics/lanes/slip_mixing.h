// De Saxce's term needs the slip that it leads to: a fixed point over the proximal steps, and where contacts are wedged a slow one.
#pragma once

#include <array>
#include <vector>

#include "lanes/contact_lanes.h"

namespace blem_sim::dynamics {

/** Anderson's mixing [1965] of the slips of the last proximal steps. */
class SlipMixing {
 public:
  /** Forgets the steps of another problem. @param lanes number of the next one's */
  void start(std::size_t lanes);
  /** Share of what a step finds slips off, by which they move from now on; below 1 they are not mixed. A slip that leads to a smaller one
   *  the larger it is would go to and fro for ever if it moved by all of it. */
  void damp(double share) { share_ = share; }
  /**
   * Takes the present iterate as the next proximal point, as blem_sim::remember, but for the slips of contacts that push: these become
   * those that the last steps together would lead to if they were linear. A step that missed more than the one before it is one to begin
   * with.
   */
  void remember(ContactBlock* begin, ContactBlock* end);

 private:
  static constexpr int KEPT = 2;  ///< changes from step to step
  /** Lane by lane [m/s]. */
  struct Slips {
    std::vector<double> found, miss;  ///< slips that a step found; these less the slips that it was made with
  };
  void goPartOfTheWay(ContactBlock* begin, ContactBlock* end);
  void findSlips(ContactBlock* begin, ContactBlock* end);
  void mix(ContactBlock* begin, ContactBlock* end);
  std::array<double, KEPT> shares(int changes) const;

  double share_ = 1;
  int steps_ = 0;  ///< since the start
  Slips now_, last_;
  std::array<Slips, KEPT> changes_;  ///< step by step, the oldest is overwritten
  std::vector<double> shift_;        ///< lane by lane [m/s], of the slips found
};

}  // namespace blem_sim::dynamics
