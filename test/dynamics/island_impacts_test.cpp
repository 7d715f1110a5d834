// The impact stage of a step on its own: trees at random, hit at random.
#include "island/island_impacts.h"

#include <gtest/gtest.h>

#include <random>

#include "island/island_motion.h"
#include "support/standard_values.h"

namespace blem_sim::dynamics {
namespace {

/** Two free trees of five bodies and a chain that the world holds, all hit at once. */
struct HitTrees {
  explicit HitTrees(unsigned seed) : random(seed), scene({0, 0, -9.81}, {}) {
    for (int tree = 0; tree < 3; ++tree) {
      int parent = tree < 2 ? body() : WORLD_BODY;
      for (int i = 0; i < 4; ++i) {
        JointSpec joint;
        joint.name = "joint";
        joint.parent = parent;
        joint.child = parent = body();
        joint.axis = vector().normalized();
        joint.X_PJ = makePose(vector());
        scene.addJoint(joint, 0);
      }
    }
    forest.build(scene);
    motion.resize(forest);
    solver.resize(forest);
    space.resize(forest);
    memory.resize(scene);
    drives.resize(scene.joints().size());
    for (int tree = 0; tree < 3; ++tree) {
      readTree(forest, scene, tree, &motion);
      placeBodies(forest, tree, &motion);
      const ForestTree& t = forest.trees()[tree];
      for (int k = t.first_dof; k < t.dof_end; ++k) motion.velocity[k] = any();
      computeInertias(forest, tree, &motion);
      takeMomentum(forest, tree, &motion, &solver);
      model.trees.push_back(tree);
    }
  }

  double any() { return 2 * static_cast<double>(random()) / 0x1p32 - 1; }
  Vector3 vector() {
    const double x = any(), y = any(), z = any();
    return {x, y, z};
  }
  int body() {
    BodySpec spec;
    spec.name = "body";
    spec.inertial.mass = 1.5 + any();
    spec.inertial.com = 0.1 * vector();
    spec.inertial.inertia = Vector3(0.02, 0.03, 0.04).asDiagonal();
    return scene.addBody(spec);
  }
  /** Bodies of one pair after the other. @param least of the restitutions, which are 1 at most */
  void hit(int contacts, double least, double friction) {
    for (int i = 0; i < contacts; ++i) {
      ContactConstraint c;
      c.body_a = static_cast<int>(random() % 14);
      c.body_b = static_cast<int>(random() % 15) - 1;
      if (c.body_a == c.body_b) c.body_b = WORLD_BODY;
      c.point = vector();
      c.normal_BA = vector().normalized();
      c.friction = friction;
      c.restitution = least + (1 - least) * 0.5 * (1 + any());
      c.id = i;
      constraints.push_back(c);
      indices.push_back(i);
    }
    Team team;
    makeContactTerms(source(), indices, &team, &model, &terms);
  }
  TermSource source() const { return {scene, forest, motion, input, settings, memory}; }

  /** [J] with half of the step's forces: when impacts happen. */
  double kineticEnergy() {
    double sum = 0;
    for (int tree = 0; tree < 3; ++tree) {
      const ForestTree& t = forest.trees()[tree];
      const int first = t.first_dof, count = t.dofCount();
      const Eigen::VectorXd p = 0.5 * (start + solver.free_momentum).segment(first, count) + 0.5 * leap.segment(first, count);
      factorTree({forest, tree, motion.mass}, &space.factor);
      space.column.segment(first, count) = p;
      solveTree(forest, tree, space.factor, &space.column, &space.paths);
      sum += 0.5 * p.dot(space.column.segment(first, count));
    }
    return sum;
  }
  bool happen() {
    for (int tree = 0; tree < 3; ++tree) setFreeMomentum({forest, scene, input, tree, true}, &motion, &solver);
    start = solver.mass_velocity;
    leap.setZero(forest.dofCount());
    before = kineticEnergy();
    const Eigen::VectorXd free = solver.free_momentum;
    const bool any = impacts.happen(source(), {model, terms, indices}, &space, &solver);
    leap = solver.free_momentum - free;
    return any;
  }
  double approach(int contact) const {
    const ContactTerm& term = terms.contacts[contact];
    for (const PairContacts& of_pair : model.pairs) {
      if (contact < of_pair.first || contact >= of_pair.end) continue;
      std::vector<Vector6> twist(forest.nodes().size());
      for (int tree = 0; tree < 3; ++tree) computeTwists(forest, tree, motion, space.velocity, &twist);
      Vector6 relative = twist[of_pair.pair.a];
      if (of_pair.pair.b >= 0) relative -= moveTwist(twist[of_pair.pair.b], -of_pair.pair.shift);
      return -term.normal.dot(velocityAt(relative, term.point));
    }
    return 0;
  }

  std::mt19937 random;
  Scene scene;
  Forest forest;
  ForestMotion motion;
  SolverSpace solver;
  ImpactSpace space;
  StepMemory memory;
  SolverSettings settings;
  std::vector<JointDrive> drives;
  std::vector<ContactConstraint> constraints;
  std::vector<int> indices;
  StepInput input{DT, constraints, drives};
  IslandModel model;
  IslandTerms terms;
  IslandImpacts impacts;
  Eigen::VectorXd start, leap;
  double before = 0;
};

TEST(IslandImpacts, KeepEnergyWithoutFrictionAtFullRestitution) {
  int hits = 0;
  for (unsigned seed = 0; seed < 50; ++seed) {
    HitTrees trees(seed);
    trees.hit(6, 1, 0);
    if (!trees.happen()) continue;
    ++hits;
    EXPECT_NEAR(trees.kineticEnergy(), trees.before, 1e-9 * trees.before) << seed;
    for (int i = 0; i < 6; ++i) EXPECT_LT(trees.approach(i), 0.3) << seed;
  }
  EXPECT_GT(hits, 45);
}

TEST(IslandImpacts, NeverGainAndKeepToCoulombsLaw) {
  for (const double friction : {0.0, 0.3, 1.0}) {
    for (unsigned seed = 0; seed < 100; ++seed) {
      HitTrees trees(seed);
      trees.hit(8, 0.1, friction);
      if (!trees.happen()) continue;
      EXPECT_LT(trees.kineticEnergy(), trees.before * (1 + 1e-12)) << seed;
      for (int i = 0; i < 8; ++i) {
        const Vector3& impulse = trees.impacts.impulse(i);
        const double push = trees.terms.contacts[i].normal.dot(impulse);
        EXPECT_GE(push, 0);
        EXPECT_LE((impulse - push * trees.terms.contacts[i].normal).norm(), friction * push * (1 + 1e-9) + 1e-12);
      }
    }
  }
}

TEST(IslandImpacts, LeaveEverythingAsItIsWithoutRestitution) {
  HitTrees trees(1);
  trees.hit(6, 1, 0.5);
  for (ContactConstraint& c : trees.constraints) c.restitution = 0;
  EXPECT_FALSE(trees.happen());
  EXPECT_FALSE(trees.impacts.any());
  EXPECT_TRUE(trees.leap.isZero(0));
}

}  // namespace
}  // namespace blem_sim::dynamics
