// Motion of a forest's trees: kinematics, inertias, momenta. One tree at a time, so that trees can be worked on at once.
#pragma once

#include <vector>

#include "trees/forest.h"

namespace blem_sim::dynamics {

/** Speed of a tree, by how far velocity products turn its velocities in a step. */
enum class Pace : char {
  SLOW,
  FAST,     ///< products are left out; the free motion is followed along its way (free_motion.h)
  TOO_FAST  ///< products are left out; the tree is tied to others and cannot be followed, but gains no energy
};

/** Step of the velocity of a free tree in flight, from half a step to half a part of one before its pose (island/flight.h). */
struct Lead {
  Vector3 velocity = Vector3::Zero();         ///< [m/s] which is added until the end of its way
  Vector3 velocity_before = Vector3::Zero();  ///< [m/s] of its root, without it
  Vector6 momentum_before = Vector6::Zero();  ///< of the tree

  bool any() const { return !velocity.isZero(0); }
};

/**
 * Poses and velocities of bodies. World axes; everything of a tree about its reference point, which stands still during a step: a
 * free root's centre of mass at its start, else the root's origin. The six velocities of a free root are its spin and the velocity of its
 * moving centre of mass.
 */
struct ForestMotion {
  // Per node.
  std::vector<Matrix3> rotation;  ///< R_WB
  std::vector<Vector3> origin;    ///< of the body frame, in the world
  std::vector<Vector3> com;       ///< about the reference point
  std::vector<Vector6> twist;     ///< at the start of the step
  std::vector<SpatialInertia> inertia;
  std::vector<double> position;       ///< of its joint
  std::vector<Vector3> joint_origin;  ///< of the frame of the joint that moves it, in the world
  std::vector<Vector3> joint_axis;    ///< in the world
  // Per dof.
  std::vector<Vector6> subspace;  ///< twist of unit velocity
  Eigen::VectorXd velocity;       ///< start of the step
  Eigen::VectorXd change;         ///< of the velocity in the last step
  Eigen::VectorXd next_velocity;  ///< end of the step
  Eigen::VectorXd products;       ///< velocity products: forces less M dv/dt
  Eigen::VectorXd applied;        ///< gravity and outside wrenches
  Eigen::VectorXd owed;  ///< [N m s or N s] impulses that held dofs, or led mimic joints, on their free way; the next step supplies them
  // Per packed entry.
  std::vector<double> mass;  ///< joint space inertia; zero where room is left
  // Per tree.
  std::vector<Vector3> reference;
  std::vector<Vector6> momentum;  ///< of a free tree, carried from step to step
  std::vector<Vector3> tree_com;  ///< about the reference point, at the start of the step
  std::vector<Pace> pace;         ///< in this step
  std::vector<Lead> lead;         ///< in this step

  // Work space, per node.
  std::vector<Vector6> drift;  ///< acceleration that goes with node_twist and constant velocities of the dofs, of computeProducts; of a
                               ///< fast tree that nothing drives, but contacts touch, the one of its free motion
  std::vector<Vector6> node_twist, node_force, node_change;
  std::vector<SpatialInertia> composite;

  void resize(const Forest& forest);
};

/** Places the bodies of a tree for the joint positions at hand; a free root stands where motion says. */
void placeBodies(const Forest& forest, int tree, ForestMotion* motion);

/** Centres of mass, inertias and motion subspaces about the reference point at hand; bodies must be placed. */
void computeBodies(const Forest& forest, int tree, ForestMotion* motion);

/** The reference point, all that computeBodies fills, and the mass matrix of a tree, and its twists; bodies must be placed. */
void computeInertias(const Forest& forest, int tree, ForestMotion* motion);

/** Twist of a node for given velocities of the dofs, its parent's being known. */
void computeTwist(const Forest& forest, int node, const ForestMotion& motion, const Eigen::VectorXd& velocity, std::vector<Vector6>* twist);

/** Twists of a tree's nodes for given velocities of its dofs. */
void computeTwists(const Forest& forest, int tree, const ForestMotion& motion, const Eigen::VectorXd& velocity,
                   std::vector<Vector6>* twist);

/**
 * Fills products, for the given velocities at the present poses. node_twist and drift are left, and in node_force the wrench that moves all
 * that a node carries, itself included, while the velocities of the dofs are constant; without gravity.
 */
void computeProducts(const Forest& forest, int tree, const Eigen::VectorXd& velocity, ForestMotion* motion);

/** Fills applied: gravity and the bodies' pending wrenches. */
void computeApplied(const Forest& forest, const Scene& scene, int tree, ForestMotion* motion);

/** Wrenches on nodes, as efforts on the dofs that move them: nodes' wrenches w are summed towards the root in place. */
struct WrenchProjection {
  const Forest& forest;
  const ForestMotion& motion;
  double sign;
  std::vector<Vector6>* wrench;  ///< per node
  Eigen::VectorXd* out;          ///< per dof

  /** Adds sign S' w of a node to its dofs of `out`, and w to its parent's wrench. */
  void addNode(int node) const;
  /** The same for all nodes of a tree, leaves first. */
  void addTree(int tree) const;
};

/** Positions, velocities and a free root's pose from the bodies of the scene, which were set from outside. */
void readTree(const Forest& forest, const Scene& scene, int tree, ForestMotion* motion);

/** Sets the bodies of the scene to the motion at hand. @param written per node, the bits that its body was given, out */
void writeTree(const Forest& forest, int tree, const ForestMotion& motion, Scene* scene, std::vector<BodyBits>* written);

}  // namespace blem_sim::dynamics
