// The step problem of one island on its impulses: sweeps over contacts, joint friction, limits and loops, led on by conjugate steps
// [Silcowitz, Niebe and Erleben 2010]. Momentum is exact whatever the number of sweeps; Coulomb's law is approached. See docs/solver.md.
#pragma once

#include <cstdint>
#include <vector>

#include "island/island_response.h"
#include "lanes/sweep_lanes.h"
#include "problem/island_at_hand.h"

namespace blem_sim::dynamics {

/** First impulses of sweeps: the terms' previous impulses, or none. */
enum class SweepStart { PREVIOUS, NOTHING };

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
  /** Sweeps until the largest change of an impulse is below `enough` of the largest impulse, at most `most` times. */
  SweepReport sweep(int most, double enough, Eigen::VectorXd* velocity);
  /** Whether, at a velocity, exactly those motors stay within their efforts that were taken to answer linearly. */
  bool motorsAgree(const Eigen::VectorXd& velocity) const;
  /** Velocities without any impulse of contacts, joint friction, limits and loops. */
  void freeVelocity(Eigen::VectorXd* velocity) { response_.freeVelocity(momentum_, velocity); }
  /** Multiplies all impulses by a factor. @param velocity with these impulses, out */
  void scale(double factor, Eigen::VectorXd* velocity);

  /** The impulses found: of contacts, world axes; of joints and loops, as proximal points that answer so at the velocity. */
  void read(const Eigen::VectorXd& velocity, IslandTerms* terms) const;

 private:
  struct Pair {
    BodyPair pair;
    ResponseSide a, b;
  };
  /** Impulses along the axis of a joint. */
  struct AxisRow {
    double response = 0;  // [1/kg or 1/(kg m^2)] of the joint's velocity
    double motor = 0, dry = 0, lower = 0, upper = 0;

    AxisRow() = default;
    AxisRow(const JointTerm& joint, double axis_response, SweepStart start);
    double sum() const { return motor + dry + lower - upper; }
    void scale(double factor);
    /** Visits friction and limits at a velocity. @return `change` plus the change of their sum */
    double visit(const JointTerm& joint, double v, double change = 0);
    /** Change of the impulse of a motor that is not folded into the mass matrix. */
    double visitMotor(const JointTerm& joint, double v);
  };
  struct JointRow {
    int term, unit, dof;
    std::size_t column;
    AxisRow axis;
  };
  struct LoopRow {
    Matrix6 inverse;  // of the forbidden rows' response
    Vector6 impulse;  // of forbidden rows
    AxisRow axis;     // the free one
  };
  bool loadResponse(const Eigen::VectorXd& velocity);
  void loadJoints(SweepStart start);
  void loadLoops(SweepStart start);
  void orderPatches(const Vector3& up);
  void colourPatches();
  void layGroups();
  void loadContacts(SweepStart start);
  void loadBodies(SweepGroup* group, SweepBodies* bodies) const;
  void findVelocity(Eigen::VectorXd* velocity);
  Vector6 relativeTwist(const Pair& pair, const Eigen::VectorXd& velocity) const;
  void push(const Pair& pair, const Vector6& wrench, Eigen::VectorXd* velocity) const;
  void sweepJoints(Eigen::VectorXd* velocity);
  void sweepLoops(Eigen::VectorXd* velocity);
  void sweepTrees(std::size_t group, Eigen::VectorXd* velocity);
  void sweepGroup(std::size_t group, Eigen::VectorXd* velocity);
  void sweepColour(std::size_t colour, Eigen::VectorXd* velocity);
  void plainSweep(Eigen::VectorXd* velocity);
  void noteVelocity(const Eigen::VectorXd& velocity);
  void moveOn(double share, Eigen::VectorXd* velocity);

  const IslandAtHand* island_ = nullptr;
  IslandResponse response_;
  Eigen::VectorXd gains_, momentum_;   // by dof of the forest
  std::vector<JointResponse> motors_;  // the line of each joint term's motor
  std::vector<int> dofs_;
  std::vector<Pair> pairs_, loop_pairs_;  // by patch, by loop
  std::vector<double> heights_;
  std::vector<int> order_, colour_, colour_start_;
  std::vector<std::uint64_t> used_colours_;  // by mover
  std::vector<int> by_colour_, chosen_;
  std::vector<SweepGroup> groups_;
  std::vector<SweepBodies> bodies_;       // by group, of those that are free
  std::vector<std::size_t> group_start_;  // by colour
  std::vector<SweepContact> contacts_;
  std::vector<SweepImpulse> impulses_;
  std::vector<SweepChange> changes_;  // by group
  std::vector<JointRow> joint_rows_;
  std::vector<LoopRow> loop_rows_;
  SweepChange change_;                   // of the last sweep, but for the sum of squares
  double squared_change_ = 0;            // [N^2 s^2] that sum over all contacts
  std::vector<double> before_, search_;  // by place among dofs_
};

}  // namespace blem_sim::dynamics
