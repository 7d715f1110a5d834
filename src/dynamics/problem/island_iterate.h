// The iterate of an island's problem: velocities, what contacts, joints and loops answer to them, and the objective's gradient.
#pragma once

#include <vector>

#include "problem/island_contacts.h"
#include "problem/island_joints.h"
#include "problem/live_parts.h"

namespace blem_sim::dynamics {

/** Velocities are in the space, the direction of a search too; live dofs are iterated, idle ones follow elsewhere (IdleBranches). */
class IslandIterate {
 public:
  /** Takes the velocities in the space as the first iterate of an island, and finds its live parts. */
  void start(const IslandAtHand& island);
  /** Begins the hard problem from the velocities at hand, with the live parts that are marked. */
  void begin();
  /** The node that a dof moves is live, from begin() or takeWoken() on. */
  void wake(int dof) { live_.wake(dof); }
  void wakeAll() { live_.wakeAll(); }
  /** Goes on with the parts that were woken meanwhile. */
  void takeWoken();

  /** Softness of contacts, of friction and limits of live joints: proximal weights over those of the hard problem. */
  void soften(double contact, double joint);
  /** Impulses at hand become the proximal points of contacts, joints and loops. */
  void remember();
  /** Slips of contacts are mixed anew from here on. */
  void forgetSlips() { contacts_.forgetSlips(); }
  /** Responses as if contacts, friction and limits went on as they were when the last step ended, linear though they are not. */
  void expect();
  /** Velocities and the terms' impulses at hand become the iterate. Precondition: begin */
  void adoptImpulses();

  /** Fills the gradient on live dofs. @return [sqrt(kg) m/s] its norm there */
  double evaluateGradient();
  /** The same on idle dofs, by their joints' responses at the velocities in the space. */
  double evaluateIdleGradient();

  /** Changes along the direction: of momenta on live dofs, of relative velocities of contacts, joints and loops. */
  void setDirection();
  /** Changes of contacts', live joints' and loops' velocities that go with a change of the dofs' velocities. */
  void setSteps(const Eigen::VectorXd& change);
  /** Slope of the objective at a along the direction, and its derivative. @param kinetic those of the kinetic part */
  PotentialSlope slope(double a, const PotentialSlope& kinetic);
  /** Moves by a along the direction. @return [rad/s or m/s] largest change of a velocity */
  double move(double a);

  /** Responses of idle joints at the velocities in the space. */
  void respondIdle() { joints_.respondIdle(); }
  /** Writes contacts' impulses and velocities to the terms, and mimic joints' impulses to the answer. */
  void read();
  void readContacts() const { contacts_.read(); }

  const LiveParts& live() const { return live_; }
  const IslandContacts& contacts() const { return contacts_; }
  const IslandJoints& joints() const { return joints_; }
  /** [m/s] of the fastest contact before the solve. */
  double firstSpeed() const { return first_speed_; }

 private:
  static constexpr double UNKNOWN = -1;  // no step length
  PotentialSlope respond(double a);
  void evaluate();
  void gradient();

  const IslandAtHand* island_ = nullptr;
  LiveParts live_;
  IslandContacts contacts_;
  IslandJoints joints_;
  double responses_at_ = UNKNOWN;  // step length from the iterate, along the direction, to where responses are known; 0: the iterate
  double first_speed_ = 0;
};

}  // namespace blem_sim::dynamics
