// The step problem of one island on its impulses: sweeps over contacts, joint friction, limits and loops, led on by Nesterov's steps
// [Nesterov 1983]. Momentum is exact whatever the number of sweeps; Coulomb's law is approached. See docs/solver.md.
#pragma once

#include <vector>

#include "sweeps/sweep_lead.h"
#include "sweeps/sweep_order.h"
#include "sweeps/swept_joints.h"
#include "sweeps/swept_velocities.h"

namespace blem_sim::dynamics {

struct SweepReport {
  int sweeps = 0;
  double first_change = 0;  ///< largest change of an impulse in the first sweep, over the largest impulse
  double last_change = 0;   ///< and in the last one
};

class IslandSweeps {
 public:
  /**
   * Takes the terms at hand, as they were made for the step.
   * @param velocity by dof, at the start of the step: by it motors are taken to be saturated or not; out: that of the impulses
   * @return false if a mass matrix is not positive definite
   */
  bool load(const IslandAtHand& island, SweepStart start, Eigen::VectorXd* velocity);
  /** The same from the terms' previous impulses, motors as motorsAgree() took them. */
  bool loadAgain(Eigen::VectorXd* velocity) { return arrange(SweepStart::PREVIOUS, velocity); }
  /** Sweeps until the largest change of an impulse is below `enough` of the largest impulse, at most `most` times. */
  SweepReport sweep(int most, double enough, Eigen::VectorXd* velocity);
  /** Whether motors do exactly what their laws say at a velocity. Those that do not are taken for something else by loadAgain(). */
  bool motorsAgree(const Eigen::VectorXd& velocity) { return joints_.motorsAgree(velocity); }
  /** Velocities without any impulse of contacts, joint friction, limits and loops, but with motors. */
  void freeVelocity(Eigen::VectorXd* velocity) {
    response_.freeVelocity(momentum_, velocity);
    joints_.pushMotors(response_, velocity);
  }
  /** Adds the work of joint friction, limits and loops. @param free_velocity, velocity without and with all impulses */
  void addJointWork(const Eigen::VectorXd& free_velocity, const Eigen::VectorXd& velocity, ImpulseWork* work) const {
    joints_.addWork(response_, free_velocity, velocity, work);
  }
  /** Multiplies all impulses by a factor. @param velocity with these impulses, out */
  void scale(double factor, Eigen::VectorXd* velocity);

  /** The impulses found: of contacts, world axes; of joints and loops, as proximal points that answer so at the velocity. */
  void read(const Eigen::VectorXd& velocity, IslandTerms* terms) const;

 private:
  bool arrange(SweepStart start, Eigen::VectorXd* velocity);
  bool loadResponse();
  void loadContacts(SweepStart start);
  void loadBodies(SweepGroup* group, SweepBodies* bodies) const;
  void loadLane(int lane, SweepGroup* group);
  void findVelocity(Eigen::VectorXd* velocity);
  template <typename Visit>
  void forGroups(const GroupRange& groups, const Visit& visit) const;
  void pushGroups(const GroupRange& groups, Eigen::VectorXd* velocity);
  void sweepOnce(Eigen::VectorXd* velocity);
  void sweepRegion(int region, Eigen::VectorXd* velocity);
  void sweepBorder(Eigen::VectorXd* velocity);
  void leadTogether(int region);
  void sweepJoints(Eigen::VectorXd* velocity);
  void sweepColour(int colour, Eigen::VectorXd* velocity);
  void sweepGroup(std::size_t group, Eigen::VectorXd* velocity);
  void sweepTrees(std::size_t group, Eigen::VectorXd* velocity);
  void push(const SweepGroup& group, const TwistLanes& wrench, Eigen::VectorXd* velocity) const;
  SweptContacts contactsOf(const SweepGroup& group) {
    return {contacts_.data() + group.first, contacts_.data() + group.end, impulses_.data() + group.first, lead_.share()};
  }

  const IslandAtHand* island_ = nullptr;
  IslandResponse response_;
  Eigen::VectorXd gains_, momentum_;  // by dof of the forest
  std::vector<ResponsePair> pairs_;   // by patch
  SweptJoints joints_;
  SweepOrder order_;
  std::vector<SweepGroup> groups_;
  std::vector<SweepBodies> bodies_;  // by group, of those that are free
  std::vector<SweepContact> contacts_;
  std::vector<SweepImpulse> impulses_;
  std::vector<SweepChange> changes_;  // by group
  SweepChange change_;                // of the last sweep, but for the sum of squares
  double squared_change_ = 0;         // [N^2 s^2] that sum over all contacts
  SweptVelocities velocities_;
  SweepLead lead_;
};

}  // namespace blem_sim::dynamics
