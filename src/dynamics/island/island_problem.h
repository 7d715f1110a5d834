// The step problem of one island: minimise, over the velocities v at the end of the step,
//   1/2 (v - v*)' M (v - v*) + sum_j phi_j(v_j) + sum_c psi_c(J_c v)
// by Newton's method with a line search. Every reaction is minus a gradient. See docs/solver.md.
#pragma once

#include <memory>
#include <vector>

#include "island/island_sweeps.h"
#include "island/kept_solution.h"
#include "lanes/body_pair.h"
#include "lanes/contact_lanes.h"
#include "lanes/joint_lanes.h"
#include "lanes/loop_term.h"
#include "lanes/slip_mixing.h"
#include "trees/block_matrix.h"
#include "trees/forest_motion.h"
#include "trees/islands.h"
#include "trees/team.h"
#include "trees/tree_rows.h"

namespace blem_sim::dynamics {

struct NewtonSettings {
  int max_iterations = 100;           ///< over all proximal steps
  int max_outer = 12;                 ///< proximal steps
  double gradient_tolerance = 1e-10;  ///< [sqrt(kg) m/s]
  double contact_tolerance = 1e-7;    ///< [N s]
  double joint_tolerance = 1e-7;      ///< [rad/s or m/s]
  int helpers = 0;                    ///< threads that take part in the loops of one island, beside the caller
};

/** Effort and quality of a solve. */
struct NewtonReport {
  int iterations = 0;
  double contact_residual = 0;  ///< [N s] largest violation of Coulomb's law over the contacts
  double contact_creep = 0;     ///< [m/s] the same as velocities, beyond a thousandth of the fastest contact's before the solve
  double joint_creep = 0;       ///< [rad/s or m/s] largest creep of a joint that sticks, miss of a limit or of a loop
  double imbalance = 0;         ///< [rad/s or m/s] difference of momentum and impulses, over the dof's inertia; worst dof
};

/** Vectors over the forest that the islands work in, each in its own trees. */
struct SolverSpace {
  Eigen::VectorXd free_momentum;  ///< M v*
  Eigen::VectorXd velocity, mass_velocity, gradient, direction, mass_direction, scale;
  /// M (v - v*). While a problem is iterated: on live dofs, with the share of idle ones that follow them; else on all dofs.
  Eigen::VectorXd kinetic;
  Eigen::VectorXd first_velocity, first_kinetic;  ///< at the first iterate
  Eigen::VectorXd anchor;                         ///< the velocities from which idle dofs follow
  Eigen::VectorXd idle_pull;                      ///< the right-hand side there, reduced: by it idle dofs move if live ones do not
  TreeFactor idle;                                ///< of idle dofs; the rows of live ones hold the rest of M, the base of their Hessian
  TreeFactor hessian;                             ///< of live dofs, in the end
  TreePaths paths;
  std::vector<Vector6> twist, wrench;  ///< per node
  std::vector<Matrix6> stiffness;      ///< per node
  std::vector<char> stiff;             ///< per node: stiffness is not zero
  std::vector<char> live;              ///< per node: contacts, loops or mimic joints act on it or on a node that it carries
  std::vector<int> block;              ///< per tree: its block in the island's matrix
  std::vector<int> block_row;          ///< per dof: its row in that block

  void resize(const Forest& forest);
};

/** Work [J] of the contacts' impulses, at the mean of the velocities with and without them. */
struct ContactWork {
  double gained = 0;     ///< by the bodies, without correcting depth
  double exchanged = 0;  ///< sum without signs
  double change = 0;     ///< impulses times the change of velocities that they make
};

/** One island: trees that something ties together. Used again from step to step, so that it need not allocate. */
class IslandProblem {
 public:
  std::vector<int> trees;
  std::vector<JointTerm> joints;
  std::vector<ContactPatch> patches;
  std::vector<ContactTerm> contacts;
  std::vector<LoopTerm> loops;
  std::vector<BodyPair> loop_pairs;  ///< of each loop, a the child
  std::vector<MimicFold> mimics;
  std::vector<double> mimic_impulses;  ///< after solve: by which each mimic's dof follows its master
  Vector3 up = Vector3::Zero();        ///< against gravity; zero without
  double mass = 0;                     ///< [kg] of all trees

  void clear();
  /** Solves for space->velocity, which holds the first guess, space->mass_velocity M times it. The terms hold the reactions afterwards. */
  NewtonReport solve(const Forest& forest, const ForestMotion& motion, const NewtonSettings& settings, SolverSpace* space);
  /** Goes on from the last solve's velocities after space->free_momentum has changed a little. */
  NewtonReport solveAgain(const NewtonSettings& settings);
  /**
   * After solve: contacts and loops that have added far more energy than moving the island at their speed takes are to correct less,
   * contacts that push hard nothing. Overwrites space->mass_direction.
   * @param speed [m/s] at which contacts correct depth at most
   * @return whether there were such: solveAgain solves the step with the rest of their corrections
   */
  bool limitCorrections(double speed);
  /** [N s] A push that no load needs: it would make the whole island ten times as fast. @param speed [m/s] the same */
  double hardPush(double speed) const;

 private:
  static constexpr std::size_t BLOCKS_AT_ONCE = 128, PATCHES_AT_ONCE = 64;  ///< sizes of chunks: some microseconds each
  static constexpr int CROWD = 150;                                         ///< most trees of an island whose Hessian is cheap to factor
  static constexpr int FIRST_ITERATIONS = 4;  ///< of the hard problem; each later one must lead on, or soft contacts or sweeps follow
  // island_problem.cpp: the objective's gradient
  template <typename Visit>
  void forContactRanges(const Visit& visit);
  template <typename Visit>
  void forPatches(const Visit& visit);
  void takeSteps(double a);
  void start();
  void begin();
  void fillBlocks();
  void readTerms();
  void setSteps(const Eigen::VectorXd& v);
  PotentialSlope respond(double a);
  void evaluate();
  void push(const BodyPair& pair, const Vector6& wrench);
  void gradient();
  void foldGradient();
  // island_idle.cpp: idle branches, which are not iterated
  void findLive();
  void wake(int node);
  void listLive();
  void orderJoints();
  const JointTerm* termOf(int block, int lane) const;
  void setJoints();
  void softenJoints();
  void respondIdle();
  bool isIdle(int dof) const;
  template <typename Visit>
  void forIdleJoints(const Visit& visit);
  template <typename Visit>
  void forDofs(const Visit& visit) const;
  bool isSolved(double tolerance);
  bool isBaseCurrent();
  bool eliminateIdle();
  bool anchor();
  double followIdle();
  bool settle(double enough);
  void keepFirst();
  void rewind();
  // island_hessian.cpp: its Hessian, and the direction solved with it
  void layBlocks();
  void stiffen(int node, const Matrix6& stiffness);
  void stiffenPair(const BodyPair& pair, const Matrix6& stiffness);
  void coupleBlocks(const BodyPair& pair, const Matrix6& stiffness);
  void addStiffness();
  void pushStiffness();
  void fillMatrix();
  bool factor();
  bool isFactorCurrent() const;
  bool keepsFactor(double last) const;
  void solveBlocks();
  void findDirection();
  // island_newton.cpp: the iteration
  NewtonReport solveFirst(const NewtonSettings& settings);
  void evaluateGradient();
  void predict();
  void setDirection();
  PotentialSlope slope(double a);
  double lineSearch();
  double gradientNorm(const std::vector<int>& dofs) const;
  double imbalance() const;
  double move(double a);
  int newton(const NewtonSettings& settings, double exactness, int max_iterations, int patience = 1 << 30);
  void soften(double contact, double joint);
  void remember();
  void assess(NewtonReport* report) const;
  void readMimics();
  NewtonReport iterate(const NewtonSettings& settings);
  void finish(const NewtonSettings& settings, NewtonReport* report);
  // island_heap.cpp: many bodies that push each other, and problems that the iteration did not solve
  int treeCount() const;
  bool isCrowd() const;
  bool isHeap() const;
  SweepProblem sweepProblem() const;
  double largestImpulse() const;
  double faults(const NewtonReport& report) const;
  double faultsWithCreep(const NewtonReport& report) const;
  void takeFirstVelocity();
  void adoptImpulses();
  ContactWork contactWork();
  bool sweepFrom(SweepStart start, SweepReport* report);
  void adoptSwept();
  void finishSwept(NewtonReport* report);
  bool polish(const NewtonSettings& settings, NewtonReport* report);
  bool turnsSlowly() const;
  bool isLikeBefore();
  void keepBalanced(const NewtonReport& report, double* least);
  void returnToBalanced(double least, NewtonReport* report);
  bool isSettled() const;
  bool solveFew(const NewtonSettings& settings, NewtonReport* report);
  bool isExact(const NewtonSettings& settings, const NewtonReport& report) const;
  bool solveStanding(const NewtonSettings& settings, NewtonReport* report);
  bool solveWithoutSweeps(const NewtonSettings& settings, NewtonReport* report);
  NewtonReport solveHeap(const NewtonSettings& settings);
  void sweepAndPolish(const NewtonSettings& settings, NewtonReport* report);
  void recover(NewtonReport* report);
  // island_bounds.cpp: bounds on contacts that correct depth
  double fastestTarget() const;
  bool giveUpLocked(double speed);
  double affordableShare(double speed);
  double kineticEnergy(const Eigen::VectorXd& velocity);
  void boundEnergy();

  const Forest* forest_ = nullptr;
  const ForestMotion* motion_ = nullptr;
  SolverSpace* space_ = nullptr;
  bool coupled_ = false;          ///< two branches or two trees are tied: the Hessian is a matrix of blocks, one per tree
  std::vector<int> live_nodes_;   ///< ascending
  std::vector<int> live_dofs_;    ///< ascending
  std::vector<int> idle_dofs_;    ///< ascending: the others, which follow: eliminated once and for all iterations
  std::vector<int> joint_order_;  ///< of the blocks' lanes: index of the term, -1 none; live ones first, in blocks of their own
  int live_joint_blocks_ = 0;
  double joint_softness_ = 1;  ///< of live joints; idle ones are never softened
  bool anchored_ = false;      ///< idle dofs follow from `anchor`; their velocities are not yet known
  bool strayed_ = false;       ///< so many joints have left the piece of their response that they were on, that all were woken
  bool woken_ = false;         ///< joints have left the piece of their response that they were on, once in this solve
  double gradient_norm_ = 0;   ///< [sqrt(kg) m/s]
  double first_speed_ = 0;     ///< [m/s] of the fastest contact before the solve
  std::unique_ptr<Team> team_ = std::make_unique<Team>();
  std::vector<ContactBlock> contact_blocks_;  ///< responses: at the line search's last step length
  std::vector<PotentialSlope> slopes_;        ///< by range of contact blocks
  std::vector<Vector6> patch_wrenches_;
  std::vector<Matrix6> patch_stiffness_;
  std::vector<char> patch_is_stiff_;
  std::vector<JointBlock> joint_blocks_;  ///< likewise responses at the line search's last step length
  SlipMixing slip_mixing_;
  IslandSweeps sweeps_;
  KeptSolution kept_;
  double responses_at_ = 0;            ///< that step length, along the direction
  bool responses_known_ = false;       ///< and it is 0: the present iterate
  double linear_ = 0, quadratic_ = 0;  ///< of the kinetic part along the search direction
  bool soft_ = false;                  ///< contacts are softened
  // Kinds of contacts and stiffnesses of joints, lane by lane, that the factor at hand and the elimination of idle dofs were made with.
  bool factored_ = false, base_known_ = false;
  std::vector<double> factored_kinds_, factored_joints_, base_joints_;
  Islands tree_blocks_;  ///< trees that mimic joints tie are one block
  std::vector<int> block_sizes_;
  bool laid_ = false;  ///< the matrix has a block for every pair that is tied
  BlockMatrix matrix_;
  Eigen::VectorXd block_vector_;
};

/** Contact blocks, which threads share: visit(index of the range, first, end). */
template <typename Visit>
void IslandProblem::forContactRanges(const Visit& visit) {
  ContactBlock* blocks = contact_blocks_.data();
  team_->forRanges(0, contact_blocks_.size(), BLOCKS_AT_ONCE,
                   [&](std::size_t first, std::size_t end) { visit(first / BLOCKS_AT_ONCE, blocks + first, blocks + end); });
}

/** Patches, which threads share. */
template <typename Visit>
void IslandProblem::forPatches(const Visit& visit) {
  team_->forRanges(0, patches.size(), PATCHES_AT_ONCE, [&](std::size_t first, std::size_t end) {
    for (std::size_t p = first; p < end; ++p) visit(p);
  });
}

template <typename Visit>
void IslandProblem::forDofs(const Visit& visit) const {
  for (const std::vector<int>* dofs : {&live_dofs_, &idle_dofs_})
    for (const int k : *dofs) visit(k);
}

template <typename Visit>
void IslandProblem::forIdleJoints(const Visit& visit) {
  for (std::size_t b = live_joint_blocks_; b < joint_blocks_.size(); ++b)
    for (int lane = 0; lane < LANES; ++lane)
      if (joint_blocks_[b].dof[lane] >= 0) visit(&joint_blocks_[b], lane, joint_blocks_[b].dof[lane]);
}

}  // namespace blem_sim::dynamics
