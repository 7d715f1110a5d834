// Hessian of an island on its live dofs: M plus the stiffnesses of contacts, loops and joints; its factor, and the direction that follows.
#pragma once

#include <vector>

#include "iterate/island_iterate.h"
#include "newton/hessian_blocks.h"

namespace blem_sim::dynamics {

/** Trees that nothing ties have a factor each, without fill-in; tied ones are a matrix of blocks. */
class IslandHessian {
 public:
  void start(const IslandAtHand& island, const IslandIterate& iterate);
  /** Forgets the factor, and which live dofs the matrix has. */
  void forget();
  void forgetFactor();
  /** Factors it at the responses at hand. @return false if it is not positive definite */
  bool factor();
  bool isFactored() const { return state_ == State::FACTORED; }
  /** Whether nothing has changed its kind since it was factored. Contacts that slip turn it a little with every iterate; all else is linear
   *  as long as nothing changes its kind. */
  bool isCurrent() const;
  /** Fills the direction: minus the inverse times the gradient, on live dofs. Precondition: factored */
  void findDirection();

 private:
  enum class State {
    NEW,      ///< live dofs and pairs are not known to the matrix
    LAID,     ///< the blocks are those of both
    FACTORED  ///< at the kinds and stiffnesses that are noted
  };
  void startFromBase();
  void noteKinds();
  void stiffen(int node, const Matrix6& stiffness);
  void stiffenPair(const BodyPair& pair, const Matrix6& stiffness);
  void addStiffness();
  void pushStiffness();
  bool eliminateTrees();

  const IslandAtHand* island_ = nullptr;
  const IslandIterate* iterate_ = nullptr;
  bool tied_ = false;  // two branches or two trees are tied
  State state_ = State::NEW;
  std::vector<double> kinds_, joint_stiffness_;  // lane by lane, of the factor at hand
  std::vector<Matrix6> pair_stiffness_;
  std::vector<char> pair_is_stiff_;
  HessianBlocks blocks_;
};

}  // namespace blem_sim::dynamics
