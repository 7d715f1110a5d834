#include "guard/energy_balance.h"

#include <algorithm>
#include <cmath>

#include "blem_sim/contact/collider_pairs.h"

namespace blem_sim::sim {
namespace {

double square(double x) { return x * x; }

bool isSpring(const dynamics::ContactConstraint& c) { return std::isfinite(c.stiffness) && std::isfinite(c.damping); }

/** Speed [m/s] at which a contact that is too deep pushes on purpose. */
double correctionSpeed(const dynamics::ContactConstraint& c, bool recovers, double dt, const dynamics::SolverSettings& settings) {
  if (!(c.depth > 0)) return 0;
  if (!isSpring(c)) return std::min(settings.correction_fraction * c.depth / dt, settings.max_correction_speed);
  return recovers && c.damping > 0 ? c.stiffness * c.depth / c.damping : 0;
}

/** Depth of a spring [m], and speed [m/s] at which it parts. */
struct SpringState {
  double depth, speed;

  /** [m] half a step before */
  double depthBefore(double dt) const { return depth + 0.5 * dt * speed; }
};

/**
 * [J] Apparent work of a spring that turns round within a step of dt: its impulse follows from depth and speed at the end, and is booked
 * along the mean velocity. Of one that obeys its law it is all that is booked, less than 0 unless it turns.
 */
double turnWork(const dynamics::ContactConstraint& spring, const SpringState& start, const SpringState& end, double dt) {
  const double booked = start.depthBefore(dt) - end.depthBefore(dt), parted = start.depth - end.depth;
  return std::max(0.0, -booked * (spring.stiffness * (parted + 0.5 * dt * start.speed - 0.5 * booked) + spring.damping * parted / dt));
}

/** Velocity [m/s] of a body's point, or of the world's. */
Vector3 velocityAt(const dynamics::World& world, const std::vector<dynamics::BodyState>& states, int body, const Vector3& point) {
  if (body == dynamics::WORLD_BODY) return Vector3::Zero();
  const dynamics::BodyState& state = states[body];
  return state.v_WCom + state.w_WB.cross(point - state.X_WB * world.bodySpec(body).inertial.com);
}

/** The contact of a constraint among those of another state; null if it is not there. */
const contact::Contact* findContact(const std::vector<contact::ContactManifold>& manifolds, const SolvedContact& solved) {
  const contact::ContactManifold* manifold = contact::findPair(manifolds, solved.collider_a, solved.collider_b);
  if (!manifold) return nullptr;
  const auto found = std::find_if(manifold->contacts.begin(), manifold->contacts.end(),
                                  [&](const contact::Contact& contact) { return contact.id == solved.id; });
  return found == manifold->contacts.end() ? nullptr : &*found;
}

bool rolls(const dynamics::ContactConstraint& contact) { return contact.rolling > 0 || !contact.rim.isZero(0); }

/** Displacements of points of bodies; contacts of one body follow on each other. */
class Displacements {
 public:
  Displacements(const std::vector<dynamics::BodyState>& before, const std::vector<dynamics::BodyState>& after)
      : before_(before), after_(after) {}

  Vector3 of(const Vector3& point, int body) {
    if (body == dynamics::WORLD_BODY) return Vector3::Zero();
    if (body != last_) X_BW_before_ = before_[body].X_WB.inverse();
    last_ = body;
    return after_[body].X_WB * (X_BW_before_ * point) - point;
  }

 private:
  const std::vector<dynamics::BodyState>&before_, &after_;
  int last_ = dynamics::WORLD_BODY;
  Pose X_BW_before_;
};

/**
 * Springs at the end of a solve. A contact that rolls goes on over both bodies, so it is found again; others stand on
 * points of both.
 */
class SpringEnds {
 public:
  SpringEnds(const dynamics::World& world, const MadeSolve& made, const std::vector<contact::ContactManifold>& end)
      : world_(world), made_(made), end_(end), of_a_(made.before, made.after), of_b_(made.before, made.after) {}

  /** @param i constraint of the solve */
  SpringState of(std::size_t i) {
    const dynamics::ContactConstraint& c = made_.contacts.constraints[i];
    const contact::Contact* now = rolls(c) ? findContact(end_, made_.contacts.solved[i]) : nullptr;
    if (now) return {now->depth, now->normal_BA.dot(velocityApart(c, now->point, now->point))};
    const Vector3 a = of_a_.of(c.point, c.body_a), b = of_b_.of(c.point, c.body_b);
    return {c.depth - c.normal_BA.dot(a - b), c.normal_BA.dot(velocityApart(c, c.point + a, c.point + b))};
  }

 private:
  Vector3 velocityApart(const dynamics::ContactConstraint& c, const Vector3& p_a, const Vector3& p_b) const {
    return velocityAt(world_, made_.after, c.body_a, p_a) - velocityAt(world_, made_.after, c.body_b, p_b);
  }

  const dynamics::World& world_;
  const MadeSolve& made_;
  const std::vector<contact::ContactManifold>& end_;
  Displacements of_a_, of_b_;
};

}  // namespace

void EnergyBalance::start(const dynamics::World& world) {
  joints_.resize(world.jointCount());
  for (int joint = 0; joint < world.jointCount(); ++joint) joints_[joint] = world.jointState(joint);
}

EnergyGain EnergyBalance::addSolve(const dynamics::World& world, const MadeSolve& made, const std::vector<contact::ContactManifold>& end) {
  tie(world, made);
  bookBodies(world, made);
  bookLoads(world, made.dt, made.before, made.after);
  bookJoints(world, made.dt, made.result);
  bookSprings(world, made, end);
  bookContacts(made);
  EnergyGain gain;
  for (const Book& book : books_) {
    const double rise = book.rise - book.held;
    gain.total += std::max(0.0, rise);
    gain.out_of_nothing += std::max(0.0, rise - book.on_purpose);
    if (rise - book.on_purpose > FLOOR * std::min(1.0, book.mass) + RELATIVE * book.moved) gain.beyond_bound = true;
  }
  holdBack();
  return gain;
}

// A contact without a force passes no energy on.
void EnergyBalance::tie(const dynamics::World& world, const MadeSolve& made) {
  islands_.start(world.bodyCount());
  for (int joint = 0; joint < world.jointCount(); ++joint) {
    const dynamics::JointSpec& spec = world.jointSpec(joint);
    islands_.tie(spec.parent, spec.child);
    if (spec.mimic_joint >= 0) islands_.tie(spec.child, world.jointSpec(spec.mimic_joint).child);
  }
  const std::vector<dynamics::ContactConstraint>& contacts = made.contacts.constraints;
  for (std::size_t i = 0; i < contacts.size(); ++i)
    if (!made.result.contact_forces[i].isZero(0)) islands_.tie(contacts[i].body_a, contacts[i].body_b);
  books_.assign(world.bodyCount(), Book());
}

EnergyBalance::Book& EnergyBalance::bookOf(const dynamics::ContactConstraint& contact) {
  return books_[islands_.islandOf(contact.body_a != dynamics::WORLD_BODY ? contact.body_a : contact.body_b)];
}

// Steppers move bodies by the velocity at a step's end, while kinetic energy changes by forces times mean velocity: the way that weights
// work along is the mean velocity's. Without this, flight would lose m g^2 dt^2 / 2 a step and a bounce gain it back.
void EnergyBalance::bookBodies(const dynamics::World& world, const MadeSolve& made) {
  const std::vector<dynamics::BodyState>&before = made.before, &after = made.after;
  coms_.resize(after.size());
  ways_.resize(after.size());
  held_.resize(after.size(), 0);
  for (std::size_t b = 0; b < after.size(); ++b) {
    const geometry::MassProperties& body = world.bodySpec(static_cast<int>(b)).inertial;
    const dynamics::BodyState &old = before[b], &now = after[b];
    coms_[b] = old.X_WB * body.com;
    ways_[b] = now.X_WB * body.com - coms_[b] - 0.5 * made.dt * (now.v_WCom - old.v_WCom);
    if (!made.result.free_ways.empty()) ways_[b] -= made.result.free_ways[b];
    const Vector3 old_spin = old.X_WB.linear().transpose() * old.w_WB, spin = now.X_WB.linear().transpose() * now.w_WB;
    const double kinetic = 0.5 * (body.mass * now.v_WCom.squaredNorm() + spin.dot(body.inertia * spin));
    const double kinetic_rise = 0.5 * (body.mass * (now.v_WCom - old.v_WCom).dot(now.v_WCom + old.v_WCom) +
                                       (spin - old_spin).dot(body.inertia * (spin + old_spin)));
    const double work = body.mass * world.gravity().dot(ways_[b]);
    Book& book = books_[islands_.islandOf(static_cast<int>(b))];
    book.rise += kinetic_rise - work;
    book.moved += kinetic + std::abs(work);
    book.held += held_[b];
    book.mass += body.mass;
  }
}

// Books the work of wrenches from outside: along the way of the mean velocity, as for weights.
void EnergyBalance::bookLoads(const dynamics::World& world, double dt, const std::vector<dynamics::BodyState>& before,
                              const std::vector<dynamics::BodyState>& after) {
  for (const BodyLoad& load : loads_) {
    const dynamics::BodyState &old = before[load.body], &now = after[load.body];
    const Vector3& com = world.bodySpec(load.body).inertial.com;
    const Vector3 arm = old.X_WB.linear() * (load.p_B - com);
    const Vector3 turn = 0.5 * dt * (old.w_WB + now.w_WB);
    const double work = load.wrench.force.dot(ways_[load.body]) + (load.wrench.torque + arm.cross(load.wrench.force)).dot(turn);
    Book& book = books_[islands_.islandOf(load.body)];
    book.rise -= work;
    book.moved += std::abs(work);
  }
}

// Books the work of joints: effort times mean velocity, for the same reason.
void EnergyBalance::bookJoints(const dynamics::World& world, double dt, const dynamics::SolveResult& result) {
  for (int joint = 0; joint < world.jointCount(); ++joint) {
    const dynamics::JointSpec& spec = world.jointSpec(joint);
    const dynamics::JointState state = world.jointState(joint);
    dynamics::JointState& last = joints_[joint];
    double work = result.axis_efforts[joint] * (state.position - last.position - 0.5 * dt * (state.velocity - last.velocity));
    if (!result.free_work.empty()) work += result.free_work[joint];
    Book& book = books_[islands_.islandOf(spec.child)];
    book.rise += 0.5 * spec.armature * (square(state.velocity) - square(last.velocity)) - work;
    book.moved += 0.5 * spec.armature * square(state.velocity) + std::abs(work);
    last = state;
  }
}

// Books the energy of springs; those that part crossed meshes hold none. Depths are those of half a step before: their change is the way of
// the mean velocity, as for weights. Without this, what sinks into a spring out of rest would gain the half of its weight's work. One whose
// damper holds all of its push stores nothing.
void EnergyBalance::bookSprings(const dynamics::World& world, const MadeSolve& made, const std::vector<contact::ContactManifold>& end) {
  SpringEnds ends(world, made, end);
  for (std::size_t i = 0; i < made.contacts.constraints.size(); ++i) {
    const dynamics::ContactConstraint& contact = made.contacts.constraints[i];
    if (!isSpring(contact) || made.contacts.solved[i].recovers) continue;
    const SpringState start{contact.depth, normalSpeed(contact, made.before)}, ended = ends.of(i);
    const double old_depth = std::max(0.0, start.depthBefore(made.dt)), depth = std::max(0.0, ended.depthBefore(made.dt));
    Book& book = bookOf(contact);
    const double stored = 0.5 * contact.stiffness * (square(depth) - square(old_depth));
    const bool pushes = !made.result.contact_forces[i].isZero(0);
    book.rise += pushes ? stored : std::min(0.0, stored);
    book.moved += 0.5 * contact.stiffness * std::max(square(depth), square(old_depth));
    if (pushes) book.on_purpose += turnWork(contact, start, ended, made.dt);
  }
}

double EnergyBalance::normalSpeed(const dynamics::ContactConstraint& contact, const std::vector<dynamics::BodyState>& states) const {
  const auto velocity = [&](int body) -> Vector3 {
    if (body == dynamics::WORLD_BODY) return Vector3::Zero();
    return states[body].v_WCom + states[body].w_WB.cross(contact.point - coms_[body]);
  };
  return contact.normal_BA.dot(velocity(contact.body_a) - velocity(contact.body_b));
}

// Apparent work of steppers that do not report it is taken as half the loss of a departure that loads brake in this step.
void EnergyBalance::bookContacts(const MadeSolve& made) {
  const std::vector<Vector3>& forces = made.result.contact_forces;
  const std::vector<double>& apparent = made.result.apparent_work;
  landings_.clear();
  for (std::size_t i = 0; i < forces.size(); ++i) {
    if (forces[i].isZero(0)) continue;
    const dynamics::ContactConstraint& contact = made.contacts.constraints[i];
    const double impulse = made.dt * std::max(0.0, contact.normal_BA.dot(forces[i]));
    const double old_speed = normalSpeed(contact, made.before), speed = normalSpeed(contact, made.after);
    const double correction = correctionSpeed(contact, made.contacts.solved[i].recovers, made.dt, settings_);
    Book& book = bookOf(contact);
    const double braked = 0.5 * impulse * std::max(0.0, std::max(0.0, old_speed) - std::max(0.0, speed));
    book.on_purpose += impulse * correction + (apparent.empty() ? braked : apparent[i]);
    if (!(contact.restitution > 0) || old_speed >= 0) continue;
    book.restitution = std::max(book.restitution, contact.restitution);
    book.approach -= impulse * old_speed;
    const double left = std::max(0.0, 1 - square(std::max(0.0, speed) / (contact.restitution * old_speed)));
    landings_.push_back({contact.body_a != dynamics::WORLD_BODY ? contact.body_a : contact.body_b, -impulse * old_speed, left});
  }
}

// A bounce leaves by the contacts that landed, so a body of each keeps its part of the bounce's energy, whatever the islands are then.
void EnergyBalance::holdBack() {
  std::fill(held_.begin(), held_.end(), 0);
  for (const Landing& landing : landings_) {
    const Book& book = books_[islands_.islandOf(landing.body)];
    if (book.rise >= 0 || !(book.approach > 0)) continue;
    held_[landing.body] -= book.rise * square(book.restitution) * landing.left * landing.approach / book.approach;
  }
}

// Bodies that came since the last solve hold nothing.
void EnergyBalance::save(int bodies, geometry::StateWriter* writer) const {
  const bool any = std::any_of(held_.begin(), held_.end(), [](double held) { return held != 0; });
  writer->number(any ? bodies : 0);
  for (std::size_t b = 0; any && b < static_cast<std::size_t>(bodies); ++b) writer->number(b < held_.size() ? held_[b] : 0);
}

void EnergyBalance::restore(int bodies, geometry::StateReader* reader) {
  const double count = reader->number();
  if (count != 0 && count != bodies) reader->refuse();
  reader->requireNumbers(static_cast<std::size_t>(count));
  held_.assign(static_cast<std::size_t>(count), 0);
  reader->numbers(held_.data(), held_.size());
  if (std::any_of(held_.begin(), held_.end(), [](double held) { return held < 0; }))
    reader->refuseContent("energy is held back that is below 0");
}

}  // namespace blem_sim::sim
