// Changes of trees' velocities by impulses at contacts and joint limits, at once; motors and joint friction give no impulses.
#pragma once

#include <vector>

#include "lanes/body_pair.h"
#include "lanes/contact_term.h"
#include "problem/impact_mass.h"

namespace blem_sim::dynamics {

/**
 * Contacts as three directions each, the normal first, along which their bodies' points move against each other (A against B) and impulses
 * act on A; and joint limits, whose first direction is that back from the limit, and which have no others. Used again from step to step, so
 * that it need not allocate.
 */
class ImpactRows {
 public:
  void clear() {
    contacts_.clear();
    sides_.clear();
    numbers_.clear();
  }
  bool empty() const { return contacts_.empty(); }
  /** Island and work space that rows are made in. */
  struct Source {
    const Forest& forest;
    const ForestMotion& motion;
    ImpactMass* mass;  ///< of all trees that are asked for
    ImpactSpace* space;
  };
  /** @return index of the contact here */
  int add(const Source& source, const BodyPair& pair, const ContactTerm& term);
  /** @param sign 1: the limit is the lower one, -1: the upper one. @return its index among the contacts */
  int addLimit(const Source& source, int dof, double sign);

  /** Relative velocity [m/s] along the contact's directions, for given velocities of the dofs. */
  Vector3 velocity(int contact, const Eigen::VectorXd& v) const;
  /** Adds to velocities their change by an impulse [N s]. */
  void push(int contact, const Vector3& impulse, Eigen::VectorXd* v) const;
  /** Adds the impulse to momenta. */
  void addMomentum(int contact, const Vector3& impulse, Eigen::VectorXd* momentum) const;
  /** Number of dofs that an impulse changes the velocities of; not 0 where its inverse mass is not. */
  int dofs(int contact) const { return contacts_[contact].dofs; }
  /** The impulse in world axes. */
  Vector3 inWorld(int contact, const Vector3& impulse) const { return contacts_[contact].basis * impulse; }

  /** Inverse mass [1/kg] along the normal; 0 if nothing can move there. */
  double inverseMass(int contact) const { return contacts_[contact].normal; }
  /** Largest inverse mass [1/kg] across the normal; 0 if nothing can move there. */
  double inverseMassAcross(int contact) const { return contacts_[contact].across; }

 private:
  /** A tree that an impulse moves. */
  struct Side {
    int tree = 0, first_dof = 0, dofs = 0;
    int rows = 0;  ///< in numbers_: start of three rows of J, and behind them three columns of M^-1 J', one after the other
  };
  struct Entry {
    Matrix3 basis = Matrix3::Identity();  ///< columns: normal and two tangents
    int first_side = 0, side_end = 0;
    int dofs = 0;
    double normal = 0, across = 0;
  };
  /** A contact's body, as it takes part in the motion of A against B. */
  struct Partner {
    int node;
    Vector3 shift;  ///< from the reference point of the contact to the node's
    double sign;    ///< 1: A, -1: B
  };
  Entry begin() const;
  void addSides(const Source& source, int tree, Entry* entry);
  const Side& sideOf(int tree, const Entry& entry) const;
  void fill(const Source& source, const Partner& partner, const Vector3& point, const Entry& entry);
  void respond(const Source& source, int tree, const Entry& entry);
  Matrix3 response(const Entry& entry) const;

  std::vector<Entry> contacts_;
  std::vector<Side> sides_;
  std::vector<double> numbers_;
};

}  // namespace blem_sim::dynamics
