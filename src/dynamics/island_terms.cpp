#include "island_terms.h"

#include "contact_motion.h"
#include "joint_motion.h"

namespace blem_sim {
namespace {

constexpr double CONTACT_PROXIMAL = 1e-4;  // rho = this * inverse mass at the contact: smaller is stiffer and needs more Newton iterations
constexpr double JOINT_PROXIMAL = 1e-3;    // gain of friction and limits = inertia / this
constexpr double LOOP_PROXIMAL = 1e-4;     // rho = this * inverse inertia
constexpr double IMMOVABLE = 1e-12;        // [1/kg or 1/(kg m^2)]

double massEntry(const TermSource& s, int dof) { return s.motion.mass[s.forest.rowStart(dof) + s.forest.rowLength(dof) - 1]; }

// Speed that just reaches a bound, or leads back to it at a bounded speed.
double allowedSpeed(const TermSource& s, double room) {
  const double speed = room / s.input.dt;
  return room >= 0 ? speed : std::max(s.settings.correction_fraction * speed, -s.settings.max_correction_speed);
}

JointTerm driveTerm(const TermSource& s, int joint, double q, double inertia) {
  const JointDrive& drive = s.input.drives[joint];
  const JointSpec& spec = s.scene.joints()[joint].spec;
  const JointRecord& memory = s.memory.joints[joint];
  const double dt = s.input.dt, gain = dt * drive.stiffness + drive.damping;
  JointTerm term;
  term.joint = joint;
  if (gain > 0) {
    term.motor_gain = dt * gain;
    term.motor_velocity = (drive.stiffness * (drive.target_position - q) + drive.damping * drive.target_velocity) / gain;
    term.motor_bound = dt * drive.max_effort;
  }
  term.viscous = dt * drive.viscous_friction;
  if (drive.dry_friction > 0) {
    term.dry_gain = inertia / JOINT_PROXIMAL;
    term.dry_bound = dt * drive.dry_friction;
    term.dry_previous = dt * memory.dry;
  }
  if (std::isfinite(spec.lower) || std::isfinite(spec.upper)) {
    term.limit_gain = inertia / JOINT_PROXIMAL;
    term.lower_velocity = -allowedSpeed(s, q - spec.lower);
    term.upper_velocity = allowedSpeed(s, spec.upper - q);
    term.lower_previous = dt * memory.lower;
    term.upper_previous = dt * memory.upper;
  }
  return term;
}

// Inverse of the inertia that a unit wrench on a node meets, each dof taken alone.
double inverseInertia(const TermSource& s, int node, const Vector6& wrench) {
  double sum = 0;
  if (node < 0) return sum;
  const int last = s.forest.nodes()[node].last_dof;
  if (last < 0) return sum;
  for (int e = 0; e < s.forest.rowLength(last); ++e) {
    const int k = s.forest.columns(last)[e];
    const double lever = s.motion.subspace[k].dot(wrench);
    sum += lever * lever / massEntry(s, k);
  }
  return sum;
}

// The same at a point, mean over the directions of force.
double inverseMass(const TermSource& s, int node, const Vector3& point) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) sum += inverseInertia(s, node, wrenchOf(Vector3::Unit(axis), point)) / 3;
  return sum;
}

Pose nodePose(const TermSource& s, int node) {
  Pose X = Pose::Identity();
  if (node < 0) return X;
  X.linear() = s.motion.rotation[node];
  X.translation() = s.motion.origin[node];
  return X;
}

BodyPair makePair(const TermSource& s, int a, int b) {
  BodyPair pair;
  pair.a = a;
  pair.b = b;
  if (b >= 0) pair.shift = s.motion.reference[s.forest.nodes()[b].tree] - s.motion.reference[s.forest.nodes()[a].tree];
  return pair;
}

}  // namespace

JointTerm jointTerm(const TermSource& s, int node) {
  const ForestNode& n = s.forest.nodes()[node];
  JointTerm term = driveTerm(s, n.joint, s.motion.position[node], massEntry(s, n.first_dof));
  term.dof = n.first_dof;
  return term;
}

LoopTerm loopTerm(const TermSource& s, int index, BodyPair* pair) {
  const LoopClosure& loop = s.forest.loops()[index];
  *pair = makePair(s, loop.child, loop.parent);
  const Pose X_WJ = nodePose(s, loop.parent) * loop.X_PJ;
  const double q = s.scene.jointPosition(loop.joint);
  // Where the child's joint frame is against where the joint wants it.
  const Pose error = (X_WJ * jointMotion(loop.kind, loop.axis, q)).inverse() * nodePose(s, loop.child) * loop.X_CJ;
  const Matrix3 R = X_WJ.linear() * jointMotion(loop.kind, loop.axis, q).linear();
  const Vector3 anchor = (nodePose(s, loop.child) * loop.X_CJ).translation() - s.motion.reference[s.forest.nodes()[loop.child].tree];
  const Eigen::AngleAxisd turn(error.linear());
  const Vector3 shift = R * error.translation(), tilt = R * (turn.angle() * turn.axis());
  // Directions in the joint frame, the free axis last: of translation for a slider, of rotation for a hinge.
  const Vector3 axis = R * loop.axis, one = R * loop.axis.unitOrthogonal(), two = axis.cross(one);
  const bool slides = loop.kind == JointKind::PRISMATIC;
  LoopTerm term;
  term.origin = X_WJ.translation();
  term.drive.joint = loop.joint;
  term.rows = loop.kind == JointKind::FIXED ? 6 : 5;
  int column = 0;
  const auto add = [&](const Vector3& direction, bool linear) {
    term.basis.col(column) = linear ? wrenchOf(direction, anchor) : spatial(direction, Vector3::Zero());
    term.target[column] = -s.settings.joint_erp / s.input.dt * direction.dot(linear ? shift : tilt);
    ++column;
  };
  for (const Vector3& d : {one, two}) add(d, true);
  for (const Vector3& d : {one, two}) add(d, false);
  add(axis, !slides);
  add(axis, slides);
  for (int r = 0; r < 6; ++r) {
    const Vector6 wrench = term.basis.col(r);
    const double inverse =
        inverseInertia(s, pair->a, wrench) + (pair->b < 0 ? 0 : inverseInertia(s, pair->b, moveWrench(wrench, -pair->shift)));
    // What nothing can move, such as the way out of a planar loop's plane, needs no row.
    const bool movable = inverse > IMMOVABLE;
    term.rho[r] = movable ? LOOP_PROXIMAL * inverse : INFINITY;
    if (!movable) term.target[r] = 0;
    if (r == 5 && term.rows == 5) term.drive = driveTerm(s, loop.joint, q, 1 / inverse);
  }
  for (int r = 0; r < 6; ++r) term.previous[r] = std::isfinite(term.rho[r]) ? s.input.dt * s.memory.loops[index].force[r] : 0;
  return term;
}

void addContact(const TermSource& s, const ContactConstraint& c, IslandProblem* problem, double* approach) {
  const bool grounded = c.body_a == WORLD_BODY;
  const int a = s.forest.nodeOfBody(grounded ? c.body_b : c.body_a);
  const int b = grounded || c.body_b == WORLD_BODY ? -1 : s.forest.nodeOfBody(c.body_b);
  if (problem->patches.empty() || problem->patches.back().pair.a != a || problem->patches.back().pair.b != b) {
    ContactPatch patch;
    patch.pair = makePair(s, a, b);
    patch.first = static_cast<int>(problem->contacts.size());
    problem->patches.push_back(patch);
  }
  const ContactRecord* record = s.memory.find(c.id);
  const ContactMotion motion = c.restitution > 0 ? contactMotion(s.scene, c) : ContactMotion();
  const NormalRow row = normalRow(c, motion, record ? record->approach : 0, s.input.dt, 0, s.settings);
  ContactTerm term;
  term.point = c.point - s.motion.reference[s.forest.nodes()[a].tree];
  term.normal = termSign(c) * c.normal_BA;
  term.friction = c.friction;
  term.target = row.speed;
  term.compliance = row.compliance / s.input.dt;
  if (record) {
    term.previous = termSign(c) * s.input.dt * record->force;
    term.slip = record->slip;
  }
  *approach = row.approach;
  problem->contacts.push_back(term);
  problem->patches.back().end = static_cast<int>(problem->contacts.size());
}

void weighContacts(const TermSource& s, IslandProblem* problem) {
  for (const ContactPatch& patch : problem->patches) {
    Vector3 middle = Vector3::Zero();
    for (int i = patch.first; i < patch.end; ++i) middle += problem->contacts[i].point;
    middle /= patch.end - patch.first;
    double inverse = inverseMass(s, patch.pair.a, middle);
    if (patch.pair.b >= 0) inverse += inverseMass(s, patch.pair.b, middle - patch.pair.shift);
    for (int i = patch.first; i < patch.end; ++i) {
      problem->contacts[i].inverse_mass = inverse;
      problem->contacts[i].stiffest_rho = CONTACT_PROXIMAL * inverse;
    }
  }
}

}  // namespace blem_sim
