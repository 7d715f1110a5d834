// Changes of trees' velocities by impulses at contacts, at once; motors and joint friction give no impulses.
#pragma once

#include <vector>

#include "lanes/body_pair.h"
#include "lanes/contact_term.h"
#include "trees/forest_motion.h"
#include "trees/tree_rows.h"

namespace blem_sim::dynamics {

/** Vectors over the forest that impacts are reckoned in, each island in its own trees. */
struct ImpactSpace {
  Eigen::VectorXd velocity;  ///< with half of the step's forces: that of the moment when impacts happen
  Eigen::VectorXd leap;      ///< its change by impacts
  Eigen::VectorXd momentum;  ///< the mass matrix times that: the sum of impulses
  Eigen::VectorXd column;    ///< work space
  TreeFactor factor;         ///< of the mass matrix
  TreePaths paths;
  std::vector<Vector6> twist;  ///< per node

  void resize(const Forest& forest);
};

/**
 * Contacts as three directions each, the normal first, along which their bodies' points move against each other (A against B) and impulses
 * act on A. Used again from step to step, so that it need not allocate.
 */
class ImpactRows {
 public:
  void clear();
  bool empty() const { return contacts_.empty(); }
  /** Precondition: the trees of both nodes are factored. @return index of the contact here */
  int add(const Forest& forest, const ForestMotion& motion, const BodyPair& pair, const ContactTerm& term, ImpactSpace* space);

  /** Relative velocity [m/s] along the contact's directions, for given velocities of the dofs. */
  Vector3 velocity(int contact, const Eigen::VectorXd& v) const;
  /** Adds to velocities their change by an impulse [N s]. */
  void push(int contact, const Vector3& impulse, Eigen::VectorXd* v) const;
  /** Adds the impulse to momenta. */
  void addMomentum(int contact, const Vector3& impulse, Eigen::VectorXd* momentum) const;
  /** The impulse in world axes. */
  Vector3 inWorld(int contact, const Vector3& impulse) const { return contacts_[contact].basis * impulse; }

  /** Inverse mass [1/kg] along the normal; 0 if nothing can move there. */
  double inverseMass(int contact) const { return contacts_[contact].normal; }
  /** Largest inverse mass [1/kg] across the normal; 0 if nothing can move there. */
  double inverseMassAcross(int contact) const { return contacts_[contact].across; }

 private:
  struct Side {
    int first_dof = 0, dofs = 0;
    int rows = 0;  ///< in numbers_: start of three rows of J, and behind them three columns of M^-1 J', one after the other
  };
  struct Entry {
    Matrix3 basis;  ///< columns: normal and two tangents
    Side sides[2];
    int side_count = 0;
    double normal = 0, across = 0;
  };
  void addSide(const Forest& forest, int tree, Entry* entry);
  /** A contact's body, as it takes part in the motion of A against B. */
  struct Partner {
    int node;
    Vector3 shift;  ///< from the reference point of the contact to the node's
    double sign;    ///< 1: A, -1: B
  };
  void fill(const Forest& forest, const ForestMotion& motion, const Partner& partner, const Vector3& point, const Entry& entry);
  void respond(const Forest& forest, int tree, const Side& side, ImpactSpace* space);

  std::vector<Entry> contacts_;
  std::vector<double> numbers_;
};

}  // namespace blem_sim::dynamics
