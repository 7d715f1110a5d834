#include "problem/make_terms.h"

#include "problem/island_at_hand.h"
#include "scene/joint_motion.h"
#include "scene/joint_readings.h"

namespace blem_sim::dynamics {
namespace {

constexpr double CONTACT_PROXIMAL = 1e-4;  // rho = this * inverse mass at the contact: smaller is stiffer and needs more Newton iterations
constexpr double HEAVIEST = 1e3;           // contacts are no softer than those of a mass this many times below the heaviest tree
constexpr double NO_GAP = 1e-11;           // [m] made of rounding: gaps that contradict each other would lead bodies at rest on for ever
constexpr double JOINT_PROXIMAL = 1e-3;    // gain of friction and limits = inertia / this
constexpr double VELOCITY_END = 1e-6;      // gain at the end of a motor's velocities = inertia / this
constexpr double ROOT_GIVES = 1e-5;        // gain of a root's drive = inertia / this
constexpr double DRY_MOMENTUM = 0.9;  // share of its last change that stuck friction is expected to change by: all of it would never settle
constexpr double LOOP_PROXIMAL = 1e-4;  // rho = this * inverse inertia
constexpr double IMMOVABLE = 1e-12;     // [1/kg or 1/(kg m^2)]

double massEntry(const TermSource& s, int dof) { return s.motion.mass[s.forest.diagonal(dof)]; }

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
    term.velocity_gain = std::min(inertia / VELOCITY_END, dt * drive.velocity_gain);
    term.min_velocity = drive.min_velocity;
    term.max_velocity = drive.max_velocity;
  }
  term.viscous = dt * drive.viscous_friction;
  if (drive.dry_friction > 0) {
    term.dry_gain = inertia / JOINT_PROXIMAL;
    term.dry_bound = dt * drive.dry_friction;
    // Friction that stuck is expected to go on changing as it did, so that the joint need not creep for it.
    term.dry_previous = std::clamp(dt * (memory.dry + DRY_MOMENTUM * memory.dry_change), -term.dry_bound, term.dry_bound);
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

// Velocity of a point that moves with a twist, in the order in which the dot product with each axis' wrench adds.
Vector3 leversAt(const Vector6& t, const Vector3& point) {
  const double x = point.x(), y = point.y(), z = point.z();
  return {-t[2] * y + (t[1] * z + t[3]), -t[0] * z + (t[2] * x + t[4]), t[0] * y + (-t[1] * x + t[5])};
}

// Inverse of the mass that a force at a point of a node meets, mean over the axes.
double inverseMass(const TermSource& s, int node, const Vector3& point) {
  if (node < 0) return 0;
  const int last = s.forest.nodes()[node].last_dof;
  if (last < 0) return 0;
  Vector3 sums = Vector3::Zero();
  for (int e = 0; e < s.forest.rowLength(last); ++e) {
    const int k = s.forest.columns(last)[e];
    sums += leversAt(s.motion.subspace[k], point).cwiseAbs2() / massEntry(s, k);
  }
  return sums[0] / 3 + sums[1] / 3 + sums[2] / 3;
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

/** Pose of a loop's child against the one that the joint asks for. */
struct LoopFrames {
  Matrix3 R_WJ;
  Vector3 origin;       ///< of the joint frame, in the world
  Vector3 anchor;       ///< the child's, about the child's reference point
  Vector3 shift, tilt;  ///< of the child from where it should be [m], [rad]
};

LoopFrames loopFrames(const TermSource& s, const LoopClosure& loop, double q) {
  const Pose X_WP = nodePose(s, loop.parent) * loop.X_PJ, X_WJ = X_WP * jointMotion(loop.kind, loop.axis, q);
  const Pose X_WC = nodePose(s, loop.child) * loop.X_CJ;
  const Pose error = X_WJ.inverse() * X_WC;
  const Eigen::AngleAxisd turn(error.linear());
  LoopFrames frames;
  frames.R_WJ = X_WJ.linear();
  frames.origin = X_WP.translation();
  frames.anchor = X_WC.translation() - s.motion.reference[s.forest.nodes()[loop.child].tree];
  frames.shift = frames.R_WJ * error.translation();
  frames.tilt = frames.R_WJ * (turn.angle() * turn.axis());
  return frames;
}

/** Acceleration of node a against node b, at a point, while the velocities of all dofs stay. */
struct PairDrift {
  Vector3 point, spin;
};

PairDrift pairDrift(const TermSource& s, const BodyPair& pair, const Vector3& anchor) {
  const auto pointDrift = [&](int node, const Vector3& point) {
    return Vector3(velocityAt(s.motion.drift[node], point) +
                   angular(s.motion.node_twist[node]).cross(velocityAt(s.motion.node_twist[node], point)));
  };
  PairDrift drift{pointDrift(pair.a, anchor), angular(s.motion.drift[pair.a])};
  if (pair.b < 0) return drift;
  const Vector3 spin = angular(s.motion.node_twist[pair.b]);
  drift.point -= pointDrift(pair.b, anchor - pair.shift);
  drift.spin -= angular(s.motion.drift[pair.b]) + spin.cross(angular(s.motion.node_twist[pair.a]) - spin);
  return drift;
}

/**
 * [m/s^2] By how much the acceleration of a contact that rolls on differs from that of the point that touches. A ball's contact stays below
 * its centre; a rim's is its lowest point, while its axis turns.
 * @param spin [rad/s] of one body against the other
 */
Vector3 rollsOnBy(const ContactConstraint& c, const Vector3& normal, const Vector3& spin) {
  const Vector3 as_ball = c.rolling * spin.dot(normal) * spin;
  if (c.rim.isZero(0)) return as_ball;
  const double radius = c.rim.norm();
  const Vector3 axis = c.rim / radius, across = normal - normal.dot(axis) * axis;  // across: away from the lowest point; sine of the lean
  const double spin_about_axis = spin.dot(axis) - normal.dot(axis) * spin.dot(across) / across.squaredNorm();
  return as_ball + radius * spin_about_axis * spin.cross(axis.cross(across.normalized()));
}

/** [m/s^2] The same along the normal: curved surfaces that roll do not part as the points do that touch. */
double partsBy(const ContactConstraint& c, const Vector3& normal, const Vector3& spin) {
  const double as_ball = -c.rolling * (spin - spin.dot(normal) * normal).squaredNorm();
  if (c.rim.isZero(0)) return as_ball;
  const Vector3 axis = c.rim.normalized(), level = axis - normal.dot(axis) * normal;
  const double about_level = spin.dot(level) / level.norm();
  return as_ball - c.rim.norm() / level.norm() * about_level * about_level;
}

/** [m/s] Half a step of a contact's acceleration along paths that bend. */
struct Bend {
  Vector3 across;
  double along;  ///< its normal
};

// A sticking contact shall not have moved at the end of the step, along paths that bend, and a spring follows the depth there. One that
// rolls goes on over both bodies: where they spin, it does not take part in the bend of a point that it leaves.
Bend bendAt(const TermSource& s, const BodyPair& pair, const ContactTerm& contact, const ContactConstraint& c) {
  Vector3 drift = pairDrift(s, pair, contact.point).point;
  double parting = drift.dot(contact.normal);
  if (c.rolling > 0 || !c.rim.isZero(0)) {
    Vector3 spin = angular(s.motion.node_twist[pair.a]);
    if (pair.b >= 0) spin -= angular(s.motion.node_twist[pair.b]);
    drift += rollsOnBy(c, contact.normal, spin);
    parting += partsBy(c, contact.normal, spin);
  }
  return {0.5 * s.input.dt * (drift - drift.dot(contact.normal) * contact.normal), 0.5 * s.input.dt * parting};
}

// Proximal weights and points of a loop's rows. A direction in which nothing can move, such as out of a planar loop's plane, needs no row.
void weighLoop(const TermSource& s, const BodyPair& pair, const Vector6& force, LoopTerm* term) {
  for (int r = 0; r < 6; ++r) {
    const Vector6 wrench = term->basis.col(r);
    double inverse = inverseInertia(s, pair.a, wrench);
    if (pair.b >= 0) inverse += inverseInertia(s, pair.b, moveWrench(wrench, -pair.shift));
    const bool movable = inverse > IMMOVABLE;
    term->rho[r] = movable ? LOOP_PROXIMAL * inverse : INFINITY;
    term->previous[r] = movable ? s.input.dt * force[r] : 0;
    if (!movable) term->target[r] = 0;
  }
}

void makePatches(const TermSource& s, const std::vector<int>& contacts, IslandModel* model) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactConstraint& c = s.input.contacts[contacts[i]];
    const bool grounded = c.body_a == WORLD_BODY;
    const int a = s.forest.nodeOfBody(grounded ? c.body_b : c.body_a);
    const int b = grounded || c.body_b == WORLD_BODY ? -1 : s.forest.nodeOfBody(c.body_b);
    if (model->pairs.empty() || model->pairs.back().pair.a != a || model->pairs.back().pair.b != b) {
      PairContacts patch;
      patch.pair = makePair(s, a, b);
      patch.first = static_cast<int>(i);
      model->pairs.push_back(patch);
    }
    model->pairs.back().end = static_cast<int>(i) + 1;
  }
}

ContactTerm contactTerm(const TermSource& s, const ContactConstraint& c, const BodyPair& pair) {
  const ContactRecord* record = s.memory.find(c.id);
  const NormalRow row = surfaceRow(c, s.input.dt, 0, s.settings);
  ContactTerm term;
  term.point = c.point - s.motion.reference[s.forest.nodes()[pair.a].tree];
  term.normal = termSign(c) * c.normal_BA;
  const Bend bend = bendAt(s, pair, term, c);
  term.bend = bend.across;
  term.friction = c.friction;
  term.target = std::abs(c.depth) > NO_GAP ? row.speed : 0;
  term.compliance = row.compliance / s.input.dt;
  if (term.compliance > 0) term.target -= bend.along;
  if (record) {
    term.previous = termSign(c) * s.input.dt * record->force;
    term.slip = record->slip;
  }
  return term;
}

/** Figures that the weights of an island's contacts have in common. */
struct ContactWeights {
  double heaviest;  // [kg] tree
  double hard;      // [N s] push of a blow
};

ContactWeights weightsOf(const TermSource& s, IslandModel* model) {
  ContactWeights weights{0, 0};
  model->mass = 0;
  for (const int tree : model->trees) {
    const double own = s.motion.composite[s.forest.trees()[tree].first_node].mass;
    weights.heaviest = std::max(weights.heaviest, own);
    model->mass += own;
  }
  weights.hard = model->hardPush(s.settings.max_correction_speed);
  return weights;
}

void weighPatch(const TermSource& s, const ContactWeights& weights, const PairContacts& patch, IslandTerms* terms) {
  Vector3 middle = Vector3::Zero();
  for (int i = patch.first; i < patch.end; ++i) middle += terms->contacts[i].point;
  middle /= patch.end - patch.first;
  double inverse = inverseMass(s, patch.pair.a, middle);
  if (patch.pair.b >= 0) inverse += inverseMass(s, patch.pair.b, middle - patch.pair.shift);
  for (int i = patch.first; i < patch.end; ++i) {
    ContactTerm& c = terms->contacts[i];
    c.inverse_mass = inverse;
    c.stiffest_rho = CONTACT_PROXIMAL * std::min(inverse, HEAVIEST / weights.heaviest);
    // The impulse of a blow does not go on, and that of a squeeze that friction has locked need not.
    if (c.normal.dot(c.previous) > weights.hard) c.previous.setZero();
  }
}

}  // namespace

JointTerm jointTerm(const TermSource& s, int node) {
  const ForestNode& n = s.forest.nodes()[node];
  JointTerm term = driveTerm(s, n.joint, s.motion.position[node], massEntry(s, n.first_dof));
  term.dof = n.first_dof;
  return term;
}

void addRootTerms(const TermSource& s, int node, std::vector<JointTerm>* terms) {
  const ForestNode& root = s.forest.nodes()[node];
  const int index = rootDriveOf(s.input, root.body);
  if (index < 0) return;
  const RootDrive& drive = (*s.input.root_drives)[index];
  const auto add = [&](int axis, double velocity, double most) {
    JointTerm term;
    term.dof = root.first_dof + axis;
    term.root_drive = index;
    term.motor_gain = massEntry(s, term.dof) / ROOT_GIVES;
    term.motor_velocity = velocity;
    term.motor_bound = s.input.dt * most;
    term.velocity_gain = term.motor_gain;
    terms->push_back(term);
  };
  add(RootAxis::SPIN, drive.spin, drive.max_torque);
  add(RootAxis::X, drive.velocity.x(), drive.max_force);
  add(RootAxis::Y, drive.velocity.y(), drive.max_force);
}

LoopTerm loopTerm(const TermSource& s, int index, BodyPair* pair) {
  const LoopClosure& loop = s.forest.loops()[index];
  *pair = makePair(s, loop.child, loop.parent);
  const double q = jointPosition(s.scene, loop.joint);
  const LoopFrames frames = loopFrames(s, loop, q);
  const PairDrift drift = pairDrift(s, *pair, frames.anchor);
  // Directions in the joint frame, the free axis last: of translation for a slider, of rotation for a hinge.
  const Vector3 axis = frames.R_WJ * loop.axis, one = frames.R_WJ * loop.axis.unitOrthogonal(), two = axis.cross(one);
  const bool slides = loop.kind == JointKind::PRISMATIC;
  LoopTerm term;
  term.origin = frames.origin;
  term.drive.joint = loop.joint;
  term.rows = loop.kind == JointKind::FIXED ? 6 : 5;
  int row = 0;
  const auto add = [&](const Vector3& direction, bool linear) {
    term.basis.col(row) = linear ? wrenchOf(direction, frames.anchor) : spatial(direction, Vector3::Zero());
    // The speed that closes the gap by the end of the step, along a path that bends.
    const double closing = -direction.dot(linear ? frames.shift : frames.tilt) / s.input.dt;
    term.target[row] = std::clamp(closing, -s.settings.max_correction_speed, s.settings.max_correction_speed) -
                       0.5 * s.input.dt * direction.dot(linear ? drift.point : drift.spin);
    ++row;
  };
  for (const Vector3& d : {one, two}) add(d, true);
  for (const Vector3& d : {one, two}) add(d, false);
  add(axis, !slides);
  add(axis, slides);
  weighLoop(s, *pair, s.memory.joints[loop.joint].loop, &term);
  if (term.rows == 5) term.drive = driveTerm(s, loop.joint, q, LOOP_PROXIMAL / term.rho[5]);
  return term;
}

void makeContactTerms(const TermSource& source, const std::vector<int>& contacts, Team* team, IslandModel* model, IslandTerms* terms) {
  makePatches(source, contacts, model);
  terms->contacts.resize(contacts.size());
  const ContactWeights weights = weightsOf(source, model);
  forPairs(*model, team, [&](std::size_t p) {
    const PairContacts& patch = model->pairs[p];
    for (int i = patch.first; i < patch.end; ++i) terms->contacts[i] = contactTerm(source, source.input.contacts[contacts[i]], patch.pair);
    weighPatch(source, weights, patch, terms);
  });
}

}  // namespace blem_sim::dynamics
