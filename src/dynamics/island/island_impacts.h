// Impacts with restitution or a friction of their own: velocities leap at the beginning of a step, before it is solved. See docs/solver.md.
#pragma once

#include <vector>

#include "problem/impact_rows.h"
#include "problem/make_terms.h"
#include "problem/solver_space.h"
#include "trees/islands.h"

namespace blem_sim::dynamics {

/** An island whose terms are made, before its solve. */
struct TouchedIsland {
  const IslandModel& model;
  const IslandTerms& terms;
  const std::vector<int>& contacts;  ///< of the step's input: which constraint each contact term is of
};

/** The impacts of one island in one step. Used again from step to step, so that it need not allocate. */
class IslandImpacts {
 public:
  /** Forgets the last step's impacts. @return whether any contact that has impacts may meet within this step */
  bool expect(const TermSource& source, const TouchedIsland& island);
  /**
   * Contacts that have impacts and will meet within the step reflect velocities as often as it takes until none approaches any more, or
   * the bounds on work are reached; what they push against that touches without bouncing, contacts and limits, holds; contacts that then
   * still approach are left to the solve, where they do not bounce. No reflection adds kinetic energy. If any happens, the free momentum of
   * `solver` and its first guess of the velocities change by the impulses.
   * @return whether anything met; if not, nothing was changed
   * Precondition: expect() was true
   */
  bool happen(const TermSource& source, const TouchedIsland& island, ImpactSpace* space, SolverSpace* solver);

  /** Whether anything met in the step at hand. */
  bool any() const { return !impulses_.empty(); }
  /** Impulse [N s] of a contact of the island, in the sense of its term. Precondition: any() */
  const Vector3& impulse(std::size_t contact) const { return impulses_[contact]; }
  /** Adds the impulses to those that the solve found. Precondition: any() */
  void addTo(IslandTerms* terms) const;
  /** Takes the leaps of velocity, if any, away from changes that are to be extrapolated. */
  void takeFrom(const Forest& forest, const std::vector<int>& trees, Eigen::VectorXd* change) const;
  /** Takes what limits held against impacts, if any, away from what they are expected to go on with. */
  void takeFrom(double dt, std::vector<JointRecord>* records) const;

 private:
  /**
   * A contact that has impacts, having restitution or a friction of its own in them; or what touches and does not bounce, a contact or a
   * joint at its limit: it holds against the impacts of others.
   */
  struct Bouncer {
    int contact = -1;  ///< of the island; -1: a limit
    const BodyPair* pair = nullptr;
    int dof = -1, joint = -1;  ///< of a limit
    double sign = 0;           ///< of a limit: 1: the lower one, -1: the upper one
    double pushed = 0;         ///< [N s or N m s] of a limit, in the last step
    bool has_impacts = false, holds = false;
    int row = -1;  ///< of rows_, once it has met
    double restitution = 0;
    double friction = 0, slow_friction = 0;  ///< in impacts, and in those of up to friction_speed
    double friction_speed = 0;               ///< [m/s]
    double depth = 0;                        ///< [m]
    double kick = 0;                         ///< [m/s] of its normal velocity by half of the step's forces
    double slowest = 0;                      ///< [m/s] closing speed below which nothing bounces
    double speed = 0;                        ///< [m/s] along the normal, at present
    double speed_before = 0;                 ///< [m/s] the same at the beginning of the round
    Vector3 impulse = Vector3::Zero();       ///< [N s] so far, along the row's directions
    Vector3 impulse_before = Vector3::Zero();
  };
  /** A bouncer that meets in this round, or holds. */
  struct Meeting {
    int group = 0, bouncer = 0, row = 0;
    bool holds = false;
    double friction = 0, restitution = 0;
    Vector3 before = Vector3::Zero();   ///< [m/s] relative velocity
    Vector3 impulse = Vector3::Zero();  ///< [N s] of the phase at hand
  };

  void begin(const TermSource& source, const TouchedIsland& island, const SolverSpace& solver);
  void findBouncers(const TermSource& source, const TouchedIsland& island);
  void findLimits(const TermSource& source, const TouchedIsland& island);
  void addHolding(const TermSource& source, const TouchedIsland& island);
  void setSpeeds(const TermSource& source, const TouchedIsland& island, const Eigen::VectorXd& velocity);
  bool meet(const TermSource& source, const TouchedIsland& island, Bouncer* bouncer);
  bool findMeetings(const TermSource& source, const TouchedIsland& island);
  void beginRound(const Forest& forest, const std::vector<int>& trees);
  void takeBack(const Forest& forest, const std::vector<int>& trees);
  void react();
  void hold(const TermSource& source, const TouchedIsland& island);
  bool findHolds(const TermSource& source, const TouchedIsland& island);
  void findGroups(const Forest& forest, const IslandModel& model);
  template <typename Visit>
  void sweep(double fastest, Meeting* first, Meeting* end, const Visit& visit);
  double compress(Meeting* first, Meeting* end);
  void expand(Meeting* first, Meeting* end, double lost);
  double push(const Vector3& impulse, Meeting* meeting);
  double stop(Meeting* meeting);
  double rub(double most, Meeting* meeting);
  void scale(double factor, Meeting* first, Meeting* end);
  void finish(const Forest& forest, const TouchedIsland& island, SolverSpace* solver);

  ImpactSpace* space_ = nullptr;
  int work_left_ = 0;
  double holding_exactness_ = 0;
  std::vector<Bouncer> bouncers_;
  std::vector<Meeting> meetings_;
  ImpactMass mass_;
  ImpactRows rows_;
  Islands groups_;  ///< of the model's trees
  std::vector<Vector3> impulses_;
};

}  // namespace blem_sim::dynamics
