// Newton's method on one island: live dofs are iterated with a line search, idle branches follow.
#pragma once

#include "newton/idle_branches.h"
#include "newton/island_hessian.h"
#include "newton/newton_report.h"

namespace blem_sim::dynamics {

/** When a run of iterations ends. */
struct RunLimits {
  static constexpr int ENDLESS = 1 << 30;
  double tolerance = 0;    ///< [sqrt(kg) m/s] gradient that is none
  double exactness = 0;    ///< share of the first gradient that is enough, if it is above the tolerance
  int most = 0;            ///< iterations
  int patience = ENDLESS;  ///< iterations that need not lead on; with less than `most`, a run ends where idle joints have strayed
};

/** A run of iterations. */
struct NewtonRun {
  int iterations = 0;
  double gradient = INFINITY;  ///< [sqrt(kg) m/s] norm at the end; infinite if a matrix was not positive definite
  bool strayed = false;        ///< so many idle joints did not answer linearly that all were woken
};

class NewtonLoop {
 public:
  /** Takes an island, at the velocities in its space. */
  void start(const IslandAtHand& island);
  /** Begins the hard problem from the velocities at hand. */
  void begin();
  /** Begins from the first velocities, all dofs live: idle joints have led to no place to go on from. */
  void beginAllLive();
  /** Softness of contacts and of joints' friction and limits. */
  void soften(double contact, double joint);
  /** The iterate becomes the proximal point, its slips mixed with those of the last ones. */
  void remember() { iterate_.reactions().remember(); }
  /** The same, its slips as they are. */
  void rememberUnmixed();
  /** SlipMixing::damp */
  void dampSlips(double share) { iterate_.reactions().dampSlips(share); }
  /** Slips are mixed anew from here on. */
  void forgetSlips() { iterate_.reactions().forgetSlips(); }

  /** [sqrt(kg) m/s] Gradient of the velocities that the island came with; of idle dofs alone if that is above the tolerance. */
  double firstGradient(double tolerance);
  /** A first step as if contacts, friction and limits went on as they were when the last step ended. */
  void predict();
  /** Iterates within limits. All velocities are known afterwards. */
  NewtonRun run(const RunLimits& limits);
  /** The velocities and the terms' impulses at hand become the iterate. Its imbalance is that of motors and friction.
   *  @return [sqrt(kg) m/s] its gradient */
  double adopt();

  /** Writes reactions to the answer. */
  void read() { iterate_.read(); }
  /** The same, and fills the report's qualities. */
  void finish(NewtonReport* report);
  /** Changes of contacts' velocities that go with a change of the dofs' velocities, in place of those along the direction. */
  void setSteps(const Eigen::VectorXd& change) { iterate_.reactions().setSteps(change); }

  const IslandIterate& iterate() const { return iterate_; }

 private:
  bool follow();
  IdleBranches::Outcome settle(double enough, double* gradient);
  bool keepsFactor(double gradient, double last) const;
  bool step();

  const IslandAtHand* island_ = nullptr;
  IslandIterate iterate_;
  IdleBranches idle_;
  IslandHessian hessian_;
};

}  // namespace blem_sim::dynamics
