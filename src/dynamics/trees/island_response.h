// Responses of an island's trees to wrenches and joint impulses: inverse inertias of free bodies, columns of (M + D)^-1 of the others, D
// being the gains of motors and viscous friction.
#pragma once

#include <vector>

#include "lanes/sweep_lanes.h"
#include "trees/response_unit.h"

namespace blem_sim::dynamics {

/** One side of a pair: the free body or unit that a wrench on it moves. */
struct ResponseSide {
  int node = -1;         ///< -1: the static world
  int first_dof = 0;     ///< of a free body
  int unit = -1;         ///< -1: a free body
  std::size_t base = 0;  ///< of a free body: its place among the free bodies; else of its six columns
};

/** Two bodies that act on each other. */
struct ResponsePair {
  BodyPair pair;
  ResponseSide a, b;
};

class IslandResponse {
 public:
  /** Begins an island. @param trees ascending */
  void start(const Forest& forest, const ForestMotion& motion, const std::vector<int>& trees, const std::vector<MimicFold>& mimics);
  /** Factors the units. @param gains D by dof. @return false if a matrix is not positive definite */
  bool factor(const Eigen::VectorXd& gains);
  /** Side of a node; asked for again, the same columns serve. Precondition: factor */
  ResponseSide side(int node);
  ResponsePair pair(const BodyPair& pair);
  /** Column of (M + D)^-1 that belongs to a dof of a unit. Precondition: factor. @return its place among the columns */
  std::size_t column(int dof);

  int unitOf(int node) const;
  const std::vector<ResponseUnit>& units() const { return units_; }
  /** Number of free bodies and units, and which of them a side belongs to. */
  int movers() const { return freeBodies() + unit_count_; }
  int moverOf(const ResponseSide& side) const;
  /** The same of a tree, by its place among the island's. */
  int moverOfTree(std::size_t place) const { return mover_[place] >= 0 ? mover_[place] : freeBodies() - 1 - mover_[place]; }
  /** Free bodies, which are the first movers. */
  int freeBodies() const { return static_cast<int>(free_.size()); }
  int firstDof(int free_body) const { return free_[free_body].first_dof; }

  Vector6 twist(const ResponseSide& side, const Eigen::VectorXd& velocity) const;
  void push(const ResponseSide& side, const Vector6& wrench, Eigen::VectorXd* velocity) const;
  /** Twist of a against b, about a's reference point. */
  Vector6 relativeTwist(const ResponsePair& pair, const Eigen::VectorXd& velocity) const;
  /** A wrench on a, about its reference point, and its reaction on b. */
  void push(const ResponsePair& pair, const Vector6& wrench, Eigen::VectorXd* velocity) const;
  /** A free body, or the static world, as a lane of a group that is swept. @param first of the body's velocity in the sweep */
  void setLane(const ResponseSide& side, int lane, int first, BodyLanes* bodies) const;
  /** A joint impulse on a dof whose column was made. */
  void push(int unit, std::size_t column, double impulse, Eigen::VectorXd* velocity) const;
  /** Response of the relative twist to a wrench on a and its reaction on b, about a's reference point. */
  Matrix6 relative(const ResponsePair& pair) const;
  /** Velocities that the momentum at hand gives alone. @param momentum M v* + D v of the motors, by dof */
  void freeVelocity(const Eigen::VectorXd& momentum, Eigen::VectorXd* velocity);
  double entry(std::size_t column, int row) const { return columns_[column + row]; }

 private:
  struct FreeBody {
    int first_dof;
    double inverse_mass;
    Matrix3 inverse_inertia;
  };
  struct KnownColumns {
    int node;
    std::size_t base;
  };
  Matrix6 between(const ResponseSide& of, const ResponseSide& to) const;

  const Forest* forest_ = nullptr;
  const ForestMotion* motion_ = nullptr;
  const std::vector<MimicFold>* mimics_ = nullptr;
  std::vector<int> trees_;
  std::vector<int> mover_;  // by place among the trees: index in free_ if not negative, else -1 - unit
  std::vector<FreeBody> free_;
  std::vector<ResponseUnit> units_;  // those beyond unit_count_ keep their memory only
  int unit_count_ = 0;
  std::vector<double> columns_;
  std::vector<KnownColumns> known_;
  std::vector<double> right_hand_side_;
};

}  // namespace blem_sim::dynamics
