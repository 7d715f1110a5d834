#include "ode/ode_stepper.h"

#include <mutex>

#include "ode/contact_joints.h"
#include "ode/joint_drives.h"
#include "ode/joint_wrenches.h"
#include "ode/mimic_coupling.h"
#include "scene/joint_readings.h"
#include "scene/stepper.h"

namespace blem_sim::dynamics {
namespace {

constexpr int MAX_TRIES = 4;            // of a step whose complementarity problem failed
constexpr double SOFTER_EACH_TRY = 10;  // times cfm

/** One call of an ODE stepper. */
class OdeSolver {
 public:
  virtual ~OdeSolver() = default;
  virtual void solve(dWorldID world, double dt) = 0;
  /** The last solve is the one that counts. */
  virtual void accept() {}
  virtual void save(geometry::StateWriter*) const {}
  virtual void restore(geometry::StateReader*) {}
};

class WorldStepSolver : public OdeSolver {
 public:
  void solve(dWorldID world, double dt) override { dWorldStep(world, dt); }
};

class QuickStepSolver : public OdeSolver {
 public:
  explicit QuickStepSolver(int iterations) : iterations_(iterations) {}

  // ODE shuffles rows by one seed per process; each stepper sets its own, so other worlds do not change it and a restored one replays.
  void solve(dWorldID world, double dt) override {
    static std::mutex mutex;
    const std::lock_guard<std::mutex> lock(mutex);
    dWorldSetQuickStepNumIterations(world, iterations_);
    dRandSetSeed(seed_);
    dWorldQuickStep(world, dt);
    next_seed_ = dRandGetSeed();
  }
  void accept() override { seed_ = next_seed_; }
  void save(geometry::StateWriter* writer) const override { writer->word(seed_); }
  void restore(geometry::StateReader* reader) override { seed_ = static_cast<unsigned long>(reader->word()); }

 private:
  int iterations_;
  unsigned long seed_ = 1, next_seed_ = 1;
};

class OdeStepper : public Stepper {
 public:
  OdeStepper(const SolverSettings& settings, std::unique_ptr<OdeSolver> solver) : settings_(settings), solver_(std::move(solver)) {}

  void step(Scene* scene, const StepInput& input, SolveResult* result) override {
    result->lcp_errors = 0;
    scene->bits(&start_);
    axes_.resize(scene->joints().size());
    for (std::size_t j = 0; j < axes_.size(); ++j)
      if (scene->joints()[j].motor) axes_[j] = jointAxis(*scene, static_cast<int>(j));
    contacts_.prepare(*scene, input.contacts, memory_, input.dt, settings_);
    mimics_.solve(*scene, input.dt, settings_, [&](const std::vector<double>& coupling) {
      scene->setBits(start_);
      solve(scene, input, coupling, result);
    });
    solver_->accept();
    contacts_.readForces(&result->contact_forces);
    readEfforts(*scene, input.drives, mimics_.efforts(), axes_, result);
    memory_.replace(contacts_.memos(result->contact_forces));
    jointWrenches(*scene, start_, input, *result, &result->joint_wrenches);
  }

  void save(const Scene&, geometry::StateWriter* writer) override {
    memory_.save(writer);
    solver_->save(writer);
    mimics_.save(writer);
  }
  void restore(const Scene& scene, geometry::StateReader* reader) override {
    memory_.restore(reader);
    solver_->restore(reader);
    mimics_.restore(scene.joints().size(), reader);
  }
  void forgetContacts(const std::vector<std::uint64_t>& ids, const ContactRenames& go_on) override { memory_.forget(ids, go_on); }
  bool pushed(std::uint64_t contact) const override { return memory_.find(contact) != nullptr; }

 private:
  // A failed complementarity problem leaves its forces at 0: the step is done again, softer.
  void solve(Scene* scene, const StepInput& input, const std::vector<double>& coupling, SolveResult* result) {
    double cfm_scale = 1;
    for (int attempt = 0; attempt < MAX_TRIES; ++attempt, cfm_scale *= SOFTER_EACH_TRY) {
      if (attempt > 0) scene->setBits(start_);
      trySolve(scene, input, coupling, cfm_scale);
      const int errors = OdeLibrary::takeLcpErrors();
      result->lcp_errors += errors;
      if (errors == 0) return;
    }
  }

  void trySolve(Scene* scene, const StepInput& input, const std::vector<double>& coupling, double cfm_scale) {
    dWorldSetCFM(scene->ode(), settings_.joint_cfm * cfm_scale);
    // ODE writes feedback only for joints that have rows.
    for (JointSlot& slot : scene->joints()) slot.joint_feedback = slot.motor_feedback = dJointFeedback{};
    for (const BodySlot& slot : scene->bodies()) {
      if (!slot.ode) continue;
      dBodySetForce(slot.ode, slot.pending.force.x(), slot.pending.force.y(), slot.pending.force.z());
      dBodySetTorque(slot.ode, slot.pending.torque.x(), slot.pending.torque.y(), slot.pending.torque.z());
    }
    setDrives(scene, input, coupling, settings_, cfm_scale);
    contacts_.create(scene, cfm_scale);
    OdeLibrary::takeLcpErrors();
    solver_->solve(scene->ode(), input.dt);
    contacts_.clear(scene);
  }

  SolverSettings settings_;
  std::unique_ptr<OdeSolver> solver_;
  ContactMemory memory_;
  ContactJoints contacts_;
  MimicCoupling mimics_;
  std::vector<BodyBits> start_;
  std::vector<Vector3> axes_;
};

}  // namespace

std::unique_ptr<Stepper> makeWorldStep(const SolverSettings& settings) {
  return std::make_unique<OdeStepper>(settings, std::make_unique<WorldStepSolver>());
}

std::unique_ptr<Stepper> makeQuickStep(const SolverSettings& settings) {
  return std::make_unique<OdeStepper>(settings, std::make_unique<QuickStepSolver>(settings.quick_step_iterations));
}

}  // namespace blem_sim::dynamics
