// Joint friction, limits and loops of an island while it is swept, and the motors that its response holds.
#pragma once

#include <vector>

#include "problem/island_at_hand.h"
#include "sweeps/impulse_work.h"
#include "sweeps/sweep_lead.h"
#include "trees/island_response.h"

namespace blem_sim::dynamics {

/** First impulses of sweeps: the terms' previous impulses, or none. */
enum class SweepStart { PREVIOUS, NOTHING };

class SweptJoints {
 public:
  /** Takes the motors as they answer at a velocity: those within their efforts are folded into the mass matrix, those at a bound are swept.
   */
  void takeMotors(const IslandAtHand& island, const Eigen::VectorXd& velocity);
  /** Adds the gains and impulses of those that are folded, and viscous friction. */
  void foldMotors(Eigen::VectorXd* gains, Eigen::VectorXd* momentum) const;
  /** Takes friction, limits and loops of the terms at hand. Precondition: the response is factored */
  void load(SweepStart start, IslandResponse* response);
  bool empty() const { return joint_rows_.empty() && loop_rows_.empty(); }

  /** Moves their impulses on. */
  void lead(const SweepLead& lead);
  /** Visits all in turn. @param velocity with their impulses, by dof */
  void sweep(const IslandResponse& response, Eigen::VectorXd* velocity);
  /** Adds what their impulses make of a velocity. */
  void push(const IslandResponse& response, Eigen::VectorXd* velocity) const;
  /** The same of the motors that are swept, alone. */
  void pushMotors(const IslandResponse& response, Eigen::VectorXd* velocity) const;
  /** Multiplies all impulses but those of motors. */
  void scale(double factor);
  /** Adds the work of all impulses but those of motors. @param free_velocity,velocity by dof, without and with all impulses */
  void addWork(const IslandResponse& response, const Eigen::VectorXd& free_velocity, const Eigen::VectorXd& velocity,
               ImpulseWork* work) const;
  /** Takes motors that have left the piece of their law that was folded as swept, and folds those that are swept but at no bound.
   *  @return whether there were none, so that motors do exactly what their laws say */
  bool motorsAgree(const Eigen::VectorXd& velocity);
  /** The impulses found, as proximal points that answer so at the velocity. */
  void read(const IslandResponse& response, const Eigen::VectorXd& velocity, IslandTerms* terms) const;

 private:
  /** Impulses along the axis of a joint. */
  struct AxisRow {
    double response = 0;  // [1/kg or 1/(kg m^2)] of the joint's velocity
    double motor = 0, dry = 0, lower = 0, upper = 0;
    double before[4] = {};  // those that the sweep before found

    AxisRow() = default;
    AxisRow(const JointTerm& joint, double axis_response, SweepStart start);
    double sum() const { return motor + dry + lower - upper; }
    /** Visits all of them at a velocity. @return change of their sum */
    double visit(const JointTerm& joint, bool has_motor, double v);
    void scale(double factor);
    void addWork(const JointTerm& joint, double free, double after, ImpulseWork* work) const;
    void lead(const SweepLead& lead);
    /** Proximal points of friction and limits. */
    void read(double v, JointTerm* joint) const;
  };
  /** A joint term's motor: a straight piece of its law, or, if it is swept, the impulse found so far. */
  struct Motor {
    JointResponse line;
    bool is_swept;
  };
  struct JointRow {
    int term, unit, dof;
    std::size_t column;
    bool has_motor;  // that is swept
    AxisRow axis;
  };
  struct LoopRow {
    ResponsePair pair;
    Matrix6 inverse;        // of the forbidden rows' response
    Vector6 impulse;        // of forbidden rows
    double before[6] = {};  // that found by the sweep before
    AxisRow axis;           // the free one
  };
  void loadJoint(int term, SweepStart start, IslandResponse* response);
  void loadLoop(std::size_t loop, SweepStart start, IslandResponse* response);
  void sweepLoop(std::size_t loop, const IslandResponse& response, Eigen::VectorXd* velocity);
  void readLoop(std::size_t row, const IslandResponse& response, const Eigen::VectorXd& velocity, LoopTerm* loop) const;

  const IslandAtHand* island_ = nullptr;
  std::vector<Motor> motors_;  // by joint term
  std::vector<JointRow> joint_rows_;
  std::vector<LoopRow> loop_rows_;
};

}  // namespace blem_sim::dynamics
