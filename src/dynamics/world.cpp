#include "blem_sim/dynamics/world.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "lanes/lanes.h"
#include "scene/input_check.h"
#include "scene/joint_readings.h"
#include "scene/world_state.h"
#include "scene/world_state_check.h"
#include "stepper_table.h"

namespace blem_sim::dynamics {
namespace {

// Whether all numbers are finite, by four sums that need not wait for each other: zero times a number that is not finite is not a number,
// and so is its sum.
BLEM_SIM_LANES bool finite(const std::vector<BodyBits>& bodies) {
  Lanes zero = {};
  for (const BodyBits& body : bodies)
    for (int i = 0; i + LANES <= BodyBits::SIZE; i += LANES)
      for (int lane = 0; lane < LANES; ++lane) zero[lane] += 0 * body.numbers[i + lane];
  for (const BodyBits& body : bodies)
    for (int i = BodyBits::SIZE / LANES * LANES; i < BodyBits::SIZE; ++i) zero[0] += 0 * body.numbers[i];
  return sum(zero) == 0;
}

bool isSound(const Scene& scene, const StepInput& input, const std::vector<BodyBits>& bodies) {
  if (!(input.dt > 0) || !std::isfinite(input.dt) || !std::isfinite(input.of_step)) return false;
  for (const ContactConstraint& c : input.contacts)
    if (!isSound(c)) return false;
  for (const JointDrive& d : input.drives)
    if (!isSound(d)) return false;
  for (const RootDrive& d : *input.root_drives)
    if (!isSound(d)) return false;
  for (const BodySlot& slot : scene.bodies())
    if (!slot.pending.force.allFinite() || !slot.pending.torque.allFinite()) return false;
  return scene.gravity().allFinite() && finite(bodies);
}

}  // namespace

struct World::Impl {
  Impl(const Vector3& gravity, const SolverSettings& settings)
      : settings(settings), scene(gravity, settings), stepper(makeStepper(settings)) {}

  /** Makes a step. False if it broke down; the scene is then as it was. */
  bool advance(const StepInput& input) {
    if (!isSound(scene, input, start)) return false;
    result.finite = true;
    try {
      stepper->step(&scene, input, &result);
    } catch (const OdeFailure&) {
      OdeLibrary::takeLcpErrors();
      scene.rebuild(start);
      return false;
    }
    if (!result.finite) return false;
    scene.bits(&end);
    if (finite(end)) return true;
    scene.setBits(start);
    return false;
  }

  void clearPending() {
    for (BodySlot& slot : scene.bodies()) slot.pending = Wrench();
  }

  const SolverSettings settings;
  Scene scene;
  std::unique_ptr<Stepper> stepper;
  SolveResult result;
  std::vector<BodyBits> start, end;  ///< of the step
  std::vector<JointState> joints;    ///< after the last step
  bool joints_known = false;         ///< nobody has moved a body or changed a joint since
};

World::World(const Vector3& gravity, const SolverSettings& settings) : impl_(std::make_unique<Impl>(gravity, settings)) {}
World::~World() = default;

int World::addBody(const BodySpec& spec) { return impl_->scene.addBody(spec); }

int World::addJoint(const JointSpec& spec, double position) {
  impl_->joints_known = false;
  return impl_->scene.addJoint(spec, position);
}

void World::removeBody(int body) {
  impl_->joints_known = false;
  if (impl_->scene.exists(body)) impl_->scene.removeBody(body);
}

void World::removeJoint(int joint) {
  impl_->joints_known = false;
  if (hasJoint(joint)) impl_->scene.removeJoint(joint);
}

int World::bodyCount() const { return static_cast<int>(impl_->scene.bodies().size()); }
int World::jointCount() const { return static_cast<int>(impl_->scene.joints().size()); }
bool World::hasBody(int body) const { return impl_->scene.exists(body); }
bool World::hasJoint(int joint) const { return joint >= 0 && joint < jointCount() && impl_->scene.joints()[joint].joint; }
const BodySpec& World::bodySpec(int body) const { return impl_->scene.bodies()[body].spec; }
const JointSpec& World::jointSpec(int joint) const { return impl_->scene.joints()[joint].spec; }

BodyState World::bodyState(int body) const { return impl_->scene.exists(body) ? impl_->scene.bodyState(body) : BodyState(); }

void World::setBodyState(int body, const BodyState& state) {
  impl_->joints_known = false;
  if (impl_->scene.exists(body)) impl_->scene.setBodyState(body, state);
}

JointState World::jointState(int joint) const {
  if (impl_->joints_known) return impl_->joints[joint];
  return {jointPosition(impl_->scene, joint), jointVelocity(impl_->scene, joint), impl_->scene.joints()[joint].last_effort};
}

void World::resetJointPosition(int joint, double position) {
  impl_->joints_known = false;
  impl_->scene.joints()[joint].last_position = position;
}

void World::setInertial(int body, const geometry::MassProperties& inertial) {
  impl_->joints_known = false;
  if (impl_->scene.exists(body)) impl_->scene.setInertial(body, inertial);
}

void World::setJointLimits(int joint, double lower, double upper) {
  JointSpec& spec = impl_->scene.joints()[joint].spec;
  spec.lower = lower;
  spec.upper = upper;
}

void World::setJointEfforts(const std::vector<double>& efforts) {
  for (std::size_t j = 0; j < efforts.size(); ++j) impl_->scene.joints()[j].last_effort = efforts[j];
  if (!impl_->joints_known) return;
  for (std::size_t j = 0; j < efforts.size(); ++j) impl_->joints[j].effort = efforts[j];
}

const Vector3& World::gravity() const { return impl_->scene.gravity(); }
void World::setGravity(const Vector3& gravity) { impl_->scene.setGravity(gravity); }

void World::applyWrench(int body, const Wrench& wrench, const Vector3& point) {
  if (!impl_->scene.exists(body)) return;
  Wrench& pending = impl_->scene.bodies()[body].pending;
  pending.force += wrench.force;
  pending.torque += wrench.torque + (point - impl_->scene.com(body)).cross(wrench.force);
}

const SolveResult& World::step(double dt, const std::vector<ContactConstraint>& contacts, const std::vector<JointDrive>& drives,
                               double of_step, const std::vector<RootDrive>& root_drives) {
  assert(static_cast<int>(drives.size()) == jointCount());
  Impl& impl = *impl_;
  const StepInput input{dt, contacts, drives, of_step, &root_drives};
  impl.joints_known = false;
  impl.scene.bits(&impl.start);
  impl.result.finite = impl.advance(input);
  if (impl.result.finite) {
    for (std::size_t j = 0; j < drives.size(); ++j) impl.scene.joints()[j].last_effort = impl.result.motor_efforts[j];
    readJoints(dt, &impl.scene, &impl.joints);
    impl.joints_known = true;
  } else {
    impl.result.contact_forces.assign(contacts.size(), Vector3::Zero());
    impl.result.joint_wrenches.assign(drives.size(), Wrench());
    impl.result.motor_efforts.assign(drives.size(), 0);
    impl.result.axis_efforts.assign(drives.size(), 0);
    impl.result.root_wrenches.assign(root_drives.size(), Wrench());
    impl.result.residual = impl.result.creep = 0;
    impl.result.iterations = impl.result.lcp_errors = 0;
  }
  impl.clearPending();
  return impl.result;
}

double World::kineticEnergy() const {
  double energy = 0;
  for (int b = 0; b < bodyCount(); ++b) {
    if (!impl_->scene.exists(b)) continue;
    const Vector3 spin_B = impl_->scene.rotation(b).transpose() * impl_->scene.spin(b);
    energy += 0.5 * bodySpec(b).inertial.mass * impl_->scene.velocity(b).squaredNorm();
    energy += 0.5 * spin_B.dot(bodySpec(b).inertial.inertia * spin_B);
  }
  return energy;
}

double World::potentialEnergy() const {
  double energy = 0;
  for (int b = 0; b < bodyCount(); ++b)
    if (impl_->scene.exists(b)) energy -= bodySpec(b).inertial.mass * gravity().dot(impl_->scene.com(b));
  return energy;
}

WorldState World::save() const {
  WorldState state;
  save(&state);
  return state;
}

void World::save(WorldState* state) const {
  state->numbers.clear();
  state->words.clear();
  geometry::StateWriter writer(state);
  impl_->scene.save(&writer);
  impl_->stepper->save(impl_->scene, &writer);
}

void World::forgetHistory() {
  impl_->joints_known = false;
  impl_->stepper = makeStepper(impl_->settings);
  impl_->clearPending();
}

void World::forgetContacts(std::vector<std::uint64_t> ids, const ContactRenames& go_on) {
  std::sort(ids.begin(), ids.end());
  impl_->stepper->forgetContacts(ids, go_on);
}

bool World::pushed(std::uint64_t contact) const { return impl_->stepper->pushed(contact); }

void World::restoreChecked(const WorldState& state) {
  checkNumbers(impl_->scene, state);
  const WorldState before = save();
  try {
    restore(state);
    if (!impl_->stepper->agreesWith(impl_->scene)) readerOf(state).refuse();
  } catch (...) {
    restore(before);
    throw;
  }
}

void World::restore(const WorldState& state) {
  impl_->joints_known = false;
  geometry::StateReader reader = readerOf(state);
  impl_->scene.restore(&reader);
  impl_->stepper->restore(impl_->scene, &reader);
  reader.finish();
}

}  // namespace blem_sim::dynamics
