// Reactions of an island's contacts, joints and loops to velocities, about their proximal points.
#pragma once

#include "iterate/island_contacts.h"
#include "iterate/island_joints.h"

namespace blem_sim::dynamics {

/** Velocities of contacts and live joints move along steps; responses are known at one step length. Idle joints answer beside that. */
class IslandReactions {
 public:
  /** Takes the terms at hand as hard ones, at the velocities in the space, without a memory of responses. */
  void begin(const IslandAtHand& island, const LiveParts& live);
  /** Joints in the order of what is live now, as soft as before. */
  void orderJoints();

  /** Softness of contacts, of friction and limits of live joints: proximal weights over those of the hard problem. */
  void soften(double contact, double joint);
  /** Impulses at hand become the proximal points of contacts, joints and loops. */
  void remember();
  /** SlipMixing::damp */
  void dampSlips(double share) { contacts_.dampSlips(share); }
  /** Slips of contacts are mixed anew from here on. */
  void forgetSlips() { contacts_.forgetSlips(); }
  /** Responses as if contacts, friction and limits went on as they were when the last step ended, linear though they are not. */
  void expect();
  /** The terms' impulses become those at the velocities at hand. */
  void adoptImpulses();

  /** Changes of contacts', live joints' and loops' velocities that go with a change of the dofs' velocities: the steps. */
  void setSteps(const Eigen::VectorXd& change);
  /** Slope of the objective at velocity + a step, and its derivative. @param kinetic those of the kinetic part */
  PotentialSlope slope(double a, const PotentialSlope& kinetic);
  /** Velocities move on by a times the steps. */
  void take(double a);
  /** Responses of idle joints at the velocities in the space. */
  void respondIdle() { joints_.respondIdle(); }
  /** Fills the wrenches on live nodes, in the space, with those of the impulses at the velocities at hand. */
  void sumWrenches();

  const IslandContacts& contacts() const { return contacts_; }
  const IslandJoints& joints() const { return joints_; }

 private:
  static constexpr double UNKNOWN = -1;  // no step length
  PotentialSlope respond(double a);
  std::vector<LoopTerm>& loops() const { return island_->terms()->loops; }

  const IslandAtHand* island_ = nullptr;
  const LiveParts* live_ = nullptr;
  IslandContacts contacts_;
  IslandJoints joints_;
  double responses_at_ = UNKNOWN;  // step length to where responses are known; 0: the velocities at hand
};

}  // namespace blem_sim::dynamics
