// The parts of an island's solver on their own: what is live, when idle branches stray, and a question that is asked twice.
#include "island/island.h"

#include <gtest/gtest.h>

#include "dynamics/analytic_contacts.h"
#include "dynamics/standing_trees.h"
#include "island/island_motion.h"
#include "newton/island_faults.h"
#include "problem/island_velocity.h"
#include "problem/make_terms.h"
#include "support/standard_values.h"
#include "sweeps/swept_island.h"

namespace blem_sim::dynamics {
namespace {

/** A box that touches the ground and carries a chain of links, level, by joints with dry friction. */
struct ChainOnBox {
  explicit ChainOnBox(int links, double friction) : scene({0, 0, -9.81}, {}) {
    int parent = body(20);
    for (int i = 0; i < links; ++i) {
      JointSpec joint;
      joint.name = "joint";
      joint.parent = parent;
      joint.child = parent = body(0.1);
      joint.axis = Vector3::UnitY();
      joint.X_PJ = makePose({0.1, 0, 0});
      scene.addJoint(joint, 0);
    }
    drives.resize(links);
    for (JointDrive& drive : drives) drive.dry_friction = friction;
    standTrees(scene, &forest, &motion, &space);
    memory.resize(scene);
    takeMomentum(forest, 0, &motion, &space);
    ask();
  }

  int body(double mass) {
    BodySpec spec;
    spec.name = "body";
    spec.inertial.mass = mass;
    spec.inertial.com = {0.05, 0, 0};
    spec.inertial.inertia = mass * Vector3(0.01, 0.01, 0.01).asDiagonal();
    return scene.addBody(spec);
  }
  void ask() {
    const TermSource source{scene, forest, motion, input, settings, memory};
    IslandTerms& terms = answer.terms;
    model.trees = {0};
    for (std::size_t i = 1; i < forest.nodes().size(); ++i) terms.joints.push_back(jointTerm(source, static_cast<int>(i)));
    model.joints = static_cast<int>(terms.joints.size());
    for (int corner = 0; corner < 4; ++corner) {
      ContactConstraint c;
      c.body_a = 0;
      c.body_b = WORLD_BODY;
      c.point = Vector3(corner % 2 ? 0.3 : -0.3, corner / 2 ? 0.3 : -0.3, -0.1);
      c.normal_BA = Vector3::UnitZ();
      c.friction = 0.5;
      c.id = corner;
      contacts.push_back(c);
    }
    makeContactTerms(source, {0, 1, 2, 3}, &team, &model, &terms);
    start();
  }
  /** Velocities as before the solve. */
  void start() { setFreeMomentum({forest, scene, input, 0, true}, &motion, &space); }
  IslandAtHand atHand() { return {forest, motion, model, &answer, &space, &team}; }

  Scene scene;
  Forest forest;
  ForestMotion motion;
  SolverSpace space;
  StepMemory memory;
  SolverSettings settings;
  std::vector<JointDrive> drives;
  std::vector<ContactConstraint> contacts;
  StepInput input{DT, contacts, drives};
  IslandModel model;
  IslandAnswer answer;
  Team team;
};

TEST(LiveParts, AreWhatIsTouchedAndWhatCarriesThat) {
  ChainOnBox chain(3, 0);
  const IslandAtHand island = chain.atHand();
  LiveParts live;
  live.find(island);
  live.list();
  EXPECT_EQ(live.nodes(), std::vector<int>{0});
  EXPECT_EQ(live.dofs(), (std::vector<int>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(live.idleDofs(), (std::vector<int>{6, 7, 8}));
  live.wake(7);
  live.list();
  EXPECT_EQ(live.nodes(), (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(live.idleDofs(), std::vector<int>{8});
  EXPECT_TRUE(live.isIdle(8));
  EXPECT_FALSE(live.isIdle(6));
  live.wakeAll();
  live.list();
  EXPECT_TRUE(live.idleDofs().empty());
}

/** Idle branches of a chain that follow its box, which stands still. */
struct Following {
  explicit Following(ChainOnBox* chain) : island(chain->atHand()) {
    iterate.start(island);
    keepFirst(island);
    idle.start(island, &iterate);
    idle.forget();
  }
  IdleBranches::Outcome follow() {
    iterate.reactions().respondIdle();
    EXPECT_TRUE(idle.isBaseCurrent() || idle.eliminateIdle());
    idle.follow();
    EXPECT_TRUE(idle.areFollowing());
    const IdleBranches::Outcome outcome = idle.settle(1e-10, &missed);
    EXPECT_FALSE(idle.areFollowing());
    if (outcome != IdleBranches::Outcome::FOLLOWED) iterate.takeWoken();
    return outcome;
  }

  IslandAtHand island;
  IslandIterate iterate;
  IdleBranches idle;
  double missed = 0;
};

TEST(IdleBranches, FollowWhileFrictionSticks) {
  ChainOnBox chain(12, 100);
  Following branches(&chain);
  EXPECT_EQ(branches.follow(), IdleBranches::Outcome::FOLLOWED);
  EXPECT_LE(branches.missed, 1e-10);
  EXPECT_TRUE(branches.idle.isBaseCurrent());
  EXPECT_EQ(branches.iterate.live().idleDofs().size(), 12u);
}

TEST(IdleBranches, FewThatSlipAreWokenAndIfItHappensAgainAllAre) {
  ChainOnBox chain(3, 100);
  chain.answer.terms.joints[0].dry_bound = 1e-6;
  Following branches(&chain);
  EXPECT_EQ(branches.follow(), IdleBranches::Outcome::FEW_STRAYED);
  EXPECT_GT(branches.missed, 1e-10);
  EXPECT_FALSE(branches.idle.isBaseCurrent());
  EXPECT_EQ(branches.iterate.live().idleDofs(), (std::vector<int>{7, 8}));
  chain.answer.terms.joints[1].dry_bound = 1e-6;
  returnToFirst(branches.island);
  branches.iterate.takeWoken();
  EXPECT_EQ(branches.follow(), IdleBranches::Outcome::STRAYED);
  EXPECT_TRUE(branches.iterate.live().idleDofs().empty());
}

TEST(IdleBranches, AllAreWokenIfManySlip) {
  ChainOnBox chain(12, 1e-3);
  Following branches(&chain);
  EXPECT_EQ(branches.follow(), IdleBranches::Outcome::STRAYED);
  EXPECT_TRUE(branches.iterate.live().idleDofs().empty());
}

TEST(IslandSolver, AnswersAQuestionAskedAgainInTheSameWords) {
  ChainOnBox chain(3, 0.01);
  IslandSolver solver;
  *solver.terms() = chain.answer.terms;
  const NewtonReport first = solver.solve(chain.forest, chain.motion, chain.model, {}, &chain.space);
  const Eigen::VectorXd velocity = chain.space.velocity;
  const IslandTerms terms = solver.found().terms;
  EXPECT_GT(first.iterations, 0);
  EXPECT_GT(terms.contacts[0].impulse.z(), 0);
  chain.start();
  *solver.terms() = chain.answer.terms;
  const NewtonReport again = solver.solve(chain.forest, chain.motion, chain.model, {}, &chain.space);
  EXPECT_EQ(again.iterations, first.iterations);
  EXPECT_EQ(chain.space.velocity, velocity);
  for (std::size_t i = 0; i < terms.contacts.size(); ++i) EXPECT_EQ(solver.found().terms.contacts[i].impulse, terms.contacts[i].impulse);
}

/** The problem of a chain on a box, solved by sweeps alone. */
struct SweptChain {
  explicit SweptChain(const ChainOnBox& chain) : island{chain.forest, chain.motion, chain.model, &answer, &space, &team} {
    answer = chain.answer;
    space = chain.space;
    newton.start(island);
    newton.firstGradient(0);
    keepFirst(island);
    newton.beginAllLive();
    swept.start(island, &newton);
    EXPECT_TRUE(swept.sweepWithMotors(SweepStart::NOTHING, 1e-7, &sweeps));
    report.gradient = swept.adopt();
    newton.finish(&report);
  }

  IslandAnswer answer;
  SolverSpace space;
  Team team;
  IslandAtHand island;
  NewtonLoop newton;
  SweptIsland swept;
  SweepReport sweeps;
  NewtonReport report;
};

/** A chain whose motors want a velocity. */
struct DrivenChain : ChainOnBox {
  DrivenChain(double max_effort, double velocity, double friction) : ChainOnBox(4, friction) {
    for (JointTerm& joint : answer.terms.joints) {
      joint.motor_gain = 1;
      joint.motor_velocity = velocity;
      joint.motor_bound = DT * max_effort;
    }
  }
};

void expectAsSolved(DrivenChain&& chain) {
  const SweptChain swept(chain);
  EXPECT_LT(faults(swept.report, swept.answer.terms.contacts), 1);
  IslandSolver solver;
  *solver.terms() = chain.answer.terms;
  EXPECT_LT(faults(solver.solve(chain.forest, chain.motion, chain.model, {}, &chain.space), solver.found().terms.contacts), 1);
  for (int dof = 0; dof < chain.space.velocity.size(); ++dof)
    EXPECT_NEAR(swept.space.velocity[dof], chain.space.velocity[dof], 1e-5) << dof;
}

TEST(SweptIsland, SolvesWithMotorsThatHold) { expectAsSolved({100, 0, 0}); }

// Taken to push with all their strength until the next round, such motors throw light links to and fro.
TEST(SweptIsland, SolvesWithMotorsThatLeaveTheirBounds) { expectAsSolved({10, -1, 0}); }

TEST(SweptIsland, SolvesWithMotorsAtTheirBounds) { expectAsSolved({0.1, -10, 0}); }

// By a rounding inside its bound, friction would be said to stick.
TEST(SweptIsland, SolvesWithFrictionThatSlips) { expectAsSolved({0.1, -10, 0.01}); }

/** A chain whose motors push its joints against their limits. Without the limits it would fly apart, and its box off the ground. */
struct LimitedChain : DrivenChain {
  explicit LimitedChain(double velocity) : DrivenChain(500, velocity, 0) {
    for (JointTerm& joint : answer.terms.joints) joint.limit_gain = 10;
  }
};

// Contacts alone may gain, where limits take more.
TEST(SweptIsland, SolvesWithMotorsThatPushAgainstLimits) {
  expectAsSolved(LimitedChain(1000));
  expectAsSolved(LimitedChain(-1000));
}

TEST(Island, TermsAreMadeAnewInEveryStepAndItsModelTellsOfJoints) {
  ChainOnBox chain(3, 0.01);
  const TermSource source{chain.scene, chain.forest, chain.motion, chain.input, chain.settings, chain.memory};
  Island island;
  island.model.trees = {0};
  for (int step = 0; step < 2; ++step) {
    makeTerms(source, &island);
    EXPECT_EQ(island.solver.terms()->joints.size(), 3u);
    EXPECT_EQ(island.model.joints, 3);
  }
}

// Velocities below rounding have products that are, against them, without bound: a hand that rests is not too fast.
TEST(Pace, OfAHandAtRestWhoseFingersFollowEachOtherIsSlow) {
  Scene scene(Vector3::Zero(), {});
  JointSpec joint;
  joint.parent = WORLD_BODY;
  for (int i = 0; i < 2; ++i) {
    joint.name = i == 0 ? "finger" : "follower";
    joint.child = scene.addBody(boxBody("link", 0.1, {0.1, 0.02, 0.02}, {0.1 * i, 0.01 * i, 0}));
    joint.axis = i == 0 ? Vector3::UnitY() : Vector3(0, 1, 1).normalized();
    joint.X_PJ = makePose({-0.05, 0, 0});
    if (i == 1) joint.mimic_joint = 0;
    scene.addJoint(joint, 0);
    joint.parent = joint.child;
  }
  const std::vector<ContactConstraint> contacts;
  const std::vector<JointDrive> drives(2);
  const StepInput input{DT, contacts, drives};
  Forest forest;
  ForestMotion motion;
  SolverSpace space;
  standTrees(scene, &forest, &motion, &space);
  for (const double velocity : {0.0, 1e-17}) {
    motion.velocity.setConstant(velocity);
    motion.change.setConstant(1e-17);
    setFreeMomentum({forest, scene, input, 0, true}, &motion, &space);
    EXPECT_EQ(motion.pace[0], Pace::SLOW);
    EXPECT_GT(motion.products.norm(), 0) << "the case this is about";
  }
  motion.velocity.setConstant(3000);
  setFreeMomentum({forest, scene, input, 0, true}, &motion, &space);
  EXPECT_EQ(motion.pace[0], Pace::FAST);
}

TEST(IslandModel, IsAHeapOfFreeBodiesAlone) {
  IslandModel model;
  model.trees = {0};
  EXPECT_FALSE(model.isHeap());
  model.trees.push_back(1);
  EXPECT_TRUE(model.isHeap());
  EXPECT_FALSE(model.isCrowd());
  EXPECT_FALSE(model.isTied());
  model.joints = 1;
  EXPECT_FALSE(model.isHeap());
  EXPECT_FALSE(model.isMixedHeap());
  model.trees.resize(9);
  EXPECT_TRUE(model.isMixedHeap());
  EXPECT_FALSE(model.isHeap());
  model.loop_pairs.emplace_back();
  EXPECT_TRUE(model.isTied());
  model.clear();
  PairContacts of_pair;
  of_pair.pair.b = 1;
  model.pairs.push_back(of_pair);
  EXPECT_TRUE(model.isTied());
  model.mass = 2;
  EXPECT_DOUBLE_EQ(model.hardPush(0.1), 2);
}

}  // namespace
}  // namespace blem_sim::dynamics
