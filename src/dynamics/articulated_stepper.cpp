#include "articulated_stepper.h"

#include <algorithm>
#include <cmath>

#include "articulated_tree.h"
#include "contact_motion.h"
#include "islands.h"
#include "step_problem.h"

namespace blem_sim {
namespace {

constexpr double CONTACT_PROXIMAL = 1e-4;  // rho = this * inverse mass at the contact: smaller is stiffer and needs more Newton iterations
constexpr double JOINT_PROXIMAL = 1e-3;    // gain of friction and limits = inertia / this
constexpr double SAME_BIAS = 1e-13;        // [sqrt(kg) m/s] change of the free momentum that needs no second pass

/** Impulse of one contact in the last step. */
struct ImpulseMemo {
  std::uint64_t id;
  Vector3 impulse;  ///< [N s] on A, world axes
};

/** Reactions of one joint in the last step [N m s or N s]. */
struct JointMemo {
  double dry = 0, lower = 0, upper = 0;
};

/** q = multiplier * q[master] + offset, through a chain of mimic joints to the first master. */
struct MimicRelation {
  int master;
  double multiplier = 1, offset = 0;
};

MimicRelation mimicRelation(const Scene& scene, int joint) {
  MimicRelation relation{joint};
  for (const JointSpec* spec = &scene.joints()[joint].spec; spec->mimic_joint >= 0; spec = &scene.joints()[relation.master].spec) {
    relation.offset += relation.multiplier * spec->mimic_offset;
    relation.multiplier *= spec->mimic_multiplier;
    relation.master = spec->mimic_joint;
  }
  return relation;
}

/** One tree with its state of this step. */
struct Tree {
  ArticulatedTree tree;
  TreeState state;
  Pose root_pose;
  std::vector<double> positions;            ///< per node, of its joint
  Eigen::VectorXd velocity, next_velocity;  ///< at the start and at the end of the step
  Eigen::VectorXd bias;
  Eigen::MatrixXd mass;
};

/** Moves a free root by its centre of mass and turns it about it. @param velocity spin, then velocity of the centre of mass */
void moveRoot(const Vector3& com_B, double dt, const Eigen::VectorXd& velocity, Pose* X_WB) {
  const Vector3 spin = velocity.segment<3>(0), com = *X_WB * com_B + dt * velocity.segment<3>(3);
  const double angle = dt * spin.norm();
  if (angle > 0) {
    const Quaternion turn(Eigen::AngleAxisd(angle, spin.normalized()));
    X_WB->linear() = (turn * Quaternion(X_WB->linear())).normalized().toRotationMatrix();
  }
  X_WB->translation() = com - X_WB->linear() * com_B;
}

class ArticulatedStepper : public Stepper {
 public:
  explicit ArticulatedStepper(const SolverSettings& settings) : settings_(settings) {}

  void step(Scene* scene, ContactMemory* memory, const StepInput& input, SolveResult* result) override;
  void save(StateWriter* writer) const override;
  void restore(StateReader* reader) override;

 private:
  void buildTrees(const Scene& scene);
  void readTrees(const Scene& scene);
  std::vector<std::vector<int>> findIslands(const std::vector<ContactConstraint>& contacts, const Scene& scene) const;
  void solveIsland(const Scene& scene, const std::vector<int>& members, const StepInput& input, SolveResult* result);
  void addTrees(const std::vector<int>& members, const StepInput& input, StepProblem* problem);
  void addJoints(const Scene& scene, int tree, int base, const StepInput& input, StepProblem* problem);
  JointTerm jointTerm(const JointSpec& spec, int joint, const Tree& tree, int node, const StepInput& input) const;
  void addMimics(const Scene& scene, const std::vector<int>& members, StepProblem* problem) const;
  int dofIndex(const Scene& scene, int joint, const StepProblem& problem) const;
  void readMimics(const Scene& scene, const std::vector<int>& members, double dt, StepProblem* problem, SolveResult* result);
  void followMimics(const Scene& scene);
  ContactTerm contactTerm(const ContactConstraint& contact, const ContactRows& rows, double dt) const;
  bool takeMidpointBias(const Scene& scene, const std::vector<int>& members, double dt, StepProblem* problem);
  void readJoints(const std::vector<int>& members, const StepInput& input, const StepProblem& problem, SolveResult* result);
  void integrate(Scene* scene, double dt);
  const ImpulseMemo* findImpulse(std::uint64_t id) const;

  SolverSettings settings_;
  std::vector<ImpulseMemo> impulses_;  ///< of the last step, sorted by id
  std::vector<JointMemo> joint_memos_;

  std::uint64_t structure_ = 0;  ///< Scene::structure() that the trees were built for

  // Of this step.
  std::vector<Tree> trees_;
  std::vector<int> body_tree_, body_node_, local_tree_;
  std::vector<ContactRows> rows_;
  std::vector<ImpulseMemo> next_impulses_;
};

void ArticulatedStepper::buildTrees(const Scene& scene) {
  joint_memos_.resize(scene.joints().size());
  if (structure_ == scene.structure()) return;
  structure_ = scene.structure();
  const int bodies = static_cast<int>(scene.bodies().size());
  std::vector<bool> carried(bodies, false);
  for (const JointSlot& slot : scene.joints())
    if (slot.joint && slot.in_tree && slot.spec.parent != WORLD_BODY) carried[slot.spec.child] = true;
  trees_.clear();
  body_tree_.assign(bodies, -1);
  body_node_.assign(bodies, -1);
  for (int body = 0; body < bodies; ++body) {
    if (!scene.exists(body) || carried[body]) continue;
    const ArticulatedTree tree(scene, body);
    for (std::size_t i = 0; i < tree.nodes().size(); ++i) {
      body_tree_[tree.nodes()[i].body] = static_cast<int>(trees_.size());
      body_node_[tree.nodes()[i].body] = static_cast<int>(i);
    }
    trees_.push_back({tree, {}, {}, {}, {}, {}, {}, {}});
  }
}

void ArticulatedStepper::readTrees(const Scene& scene) {
  for (Tree& t : trees_) {
    t.tree.read(scene, &t.positions, &t.velocity, &t.root_pose);
    t.tree.kinematics(scene, t.root_pose, t.positions, t.velocity, &t.state);
    t.tree.massMatrix(t.state, &t.mass);
    t.tree.bias(scene, t.state, &t.bias);
  }
}

std::vector<std::vector<int>> ArticulatedStepper::findIslands(const std::vector<ContactConstraint>& contacts, const Scene& scene) const {
  Islands islands(static_cast<int>(trees_.size()));
  for (const ContactConstraint& c : contacts)
    if (c.body_a != WORLD_BODY && c.body_b != WORLD_BODY && isUsable(scene, c)) islands.join(body_tree_[c.body_a], body_tree_[c.body_b]);
  for (const JointSlot& slot : scene.joints())
    if (slot.joint && slot.spec.mimic_joint >= 0)
      islands.join(body_tree_[slot.spec.child], body_tree_[scene.joints()[slot.spec.mimic_joint].spec.child]);
  return islands.members();
}

JointTerm ArticulatedStepper::jointTerm(const JointSpec& spec, int joint, const Tree& tree, int node, const StepInput& input) const {
  const JointDrive& drive = input.drives[joint];
  const int dof = tree.tree.nodes()[node].first_dof;
  const double q = tree.positions[node], inertia = tree.mass(dof, dof), dt = input.dt;
  JointTerm term;
  const double gain = dt * drive.stiffness + drive.damping;
  if (gain > 0) {
    term.motor_gain = dt * gain;
    term.motor_velocity = (drive.stiffness * (drive.target_position - q) + drive.damping * drive.target_velocity) / gain;
    term.motor_bound = dt * drive.max_effort;
  }
  term.viscous = dt * drive.viscous_friction;
  if (drive.dry_friction > 0) {
    term.dry_gain = inertia / JOINT_PROXIMAL;
    term.dry_bound = dt * drive.dry_friction;
    term.dry_previous = joint_memos_[joint].dry;
  }
  if (std::isfinite(spec.lower) || std::isfinite(spec.upper)) {
    term.limit_gain = inertia / JOINT_PROXIMAL;
    // Speed that just reaches the limit, or leads back to it at a bounded speed.
    const auto allowed = [&](double room) {
      return room >= 0 ? room / dt : std::max(settings_.correction_fraction * room / dt, -settings_.max_correction_speed);
    };
    term.lower_velocity = -allowed(q - spec.lower);
    term.upper_velocity = allowed(spec.upper - q);
    term.lower_previous = joint_memos_[joint].lower;
    term.upper_previous = joint_memos_[joint].upper;
  }
  return term;
}

void ArticulatedStepper::addJoints(const Scene& scene, int tree, int base, const StepInput& input, StepProblem* problem) {
  const Tree& t = trees_[tree];
  const std::vector<TreeNode>& nodes = t.tree.nodes();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].dofs != 1) continue;
    problem->free_momentum[base + nodes[i].first_dof] += input.dt * input.drives[nodes[i].joint].effort;
    problem->joints.push_back(jointTerm(scene.joints()[nodes[i].joint].spec, nodes[i].joint, t, static_cast<int>(i), input));
    problem->joints.back().dof = base + nodes[i].first_dof;
  }
}

int ArticulatedStepper::dofIndex(const Scene& scene, int joint, const StepProblem& problem) const {
  const int body = scene.joints()[joint].spec.child, tree = body_tree_[body];
  return problem.offset[local_tree_[tree]] + trees_[tree].tree.nodes()[body_node_[body]].first_dof;
}

void ArticulatedStepper::addMimics(const Scene& scene, const std::vector<int>& members, StepProblem* problem) const {
  for (const int member : members) {
    for (const TreeNode& node : trees_[member].tree.nodes()) {
      if (node.dofs != 1 || scene.joints()[node.joint].spec.mimic_joint < 0) continue;
      const MimicRelation relation = mimicRelation(scene, node.joint);
      problem->mimics.push_back({dofIndex(scene, node.joint, *problem), dofIndex(scene, relation.master, *problem), relation.multiplier});
    }
  }
}

void ArticulatedStepper::addTrees(const std::vector<int>& members, const StepInput& input, StepProblem* problem) {
  int dofs = 0;
  for (std::size_t m = 0; m < members.size(); ++m) {
    const Tree& t = trees_[members[m]];
    local_tree_[members[m]] = static_cast<int>(m);
    problem->trees.push_back(&t.tree);
    problem->states.push_back(&t.state);
    problem->mass.push_back(t.mass);
    problem->offset.push_back(dofs);
    dofs += t.tree.dofCount();
  }
  problem->velocity.resize(dofs);
  problem->free_momentum.resize(dofs);
  for (std::size_t m = 0; m < members.size(); ++m) {
    const Tree& t = trees_[members[m]];
    const int base = problem->offset[m], n = t.tree.dofCount();
    problem->velocity.segment(base, n) = t.velocity;
    problem->free_momentum.segment(base, n) = t.mass.selfadjointView<Eigen::Lower>() * t.velocity;
    problem->free_momentum.segment(base, n) -= input.dt * t.bias;
  }
}

const ImpulseMemo* ArticulatedStepper::findImpulse(std::uint64_t id) const {
  const auto it = std::lower_bound(impulses_.begin(), impulses_.end(), id, [](const ImpulseMemo& m, std::uint64_t i) { return m.id < i; });
  return it != impulses_.end() && it->id == id ? &*it : nullptr;
}

ContactTerm ArticulatedStepper::contactTerm(const ContactConstraint& c, const ContactRows& rows, double dt) const {
  ContactTerm term;
  double inverse_mass = 0;
  const auto place = [&](int body, int* tree, int* node, Vector3* point) {
    if (body == WORLD_BODY) return;
    const Tree& t = trees_[body_tree_[body]];
    *tree = local_tree_[body_tree_[body]];
    *node = body_node_[body];
    *point = c.point - t.state.reference;
    for (int k = t.tree.lastDof(*node); k >= 0; k = t.tree.dofParent(k)) {
      const Vector6& s = t.state.subspace[k];
      inverse_mass += (s.tail<3>() + s.head<3>().cross(*point)).squaredNorm() / t.mass(k, k) / 3;
    }
  };
  place(c.body_a, &term.tree_a, &term.node_a, &term.point_a);
  place(c.body_b, &term.tree_b, &term.node_b, &term.point_b);
  term.frame.row(0) = c.normal_BA;
  term.frame.row(1) = c.normal_BA.unitOrthogonal();
  term.frame.row(2) = c.normal_BA.cross(term.frame.row(1).transpose());
  term.friction = c.friction;
  term.rho = CONTACT_PROXIMAL * inverse_mass;
  term.target.x() = rows.normal_speed;
  term.compliance = rows.normal_cfm > settings_.cfm ? rows.normal_cfm / dt : 0;  // the rigid rows' cfm is only for complementarity solvers
  if (const ImpulseMemo* memo = findImpulse(c.id)) term.previous = term.frame * memo->impulse;
  return term;
}

// Velocity products at the middle of the step: explicit ones let light limbs gain energy.
bool ArticulatedStepper::takeMidpointBias(const Scene& scene, const std::vector<int>& members, double dt, StepProblem* problem) {
  bool changed = false;
  for (std::size_t m = 0; m < members.size(); ++m) {
    Tree& t = trees_[members[m]];
    const int base = problem->offset[m], n = t.tree.dofCount();
    const Eigen::VectorXd first = t.bias;
    t.tree.setVelocity(0.5 * (t.velocity + problem->velocity.segment(base, n)), &t.state);
    t.tree.bias(scene, t.state, &t.bias);
    const Eigen::VectorXd change = dt * (t.bias - first);
    problem->free_momentum.segment(base, n) -= change;
    for (int k = 0; k < n; ++k) changed |= std::abs(change[k]) > SAME_BIAS * std::sqrt(t.mass(k, k));
  }
  return changed;
}

void ArticulatedStepper::solveIsland(const Scene& scene, const std::vector<int>& members, const StepInput& input, SolveResult* result) {
  StepProblem problem;
  std::fill(local_tree_.begin(), local_tree_.end(), -1);
  addTrees(members, input, &problem);
  for (std::size_t m = 0; m < members.size(); ++m) addJoints(scene, members[m], problem.offset[m], input, &problem);
  addMimics(scene, members, &problem);
  std::vector<std::size_t> term_contact;
  for (std::size_t i = 0; i < input.contacts.size(); ++i) {
    const ContactConstraint& c = input.contacts[i];
    if (!isUsable(scene, c) || local_tree_[body_tree_[c.body_a != WORLD_BODY ? c.body_a : c.body_b]] < 0) continue;
    term_contact.push_back(i);
    problem.contacts.push_back(contactTerm(c, rows_[i], input.dt));
  }
  const NewtonSettings newton;
  problem.solve(newton);
  if (takeMidpointBias(scene, members, input.dt, &problem)) problem.solve(newton);
  for (std::size_t i = 0; i < problem.contacts.size(); ++i) {
    const Vector3 impulse = problem.contacts[i].frame.transpose() * problem.contacts[i].impulse;
    result->contact_forces[term_contact[i]] = impulse / input.dt;
    next_impulses_.push_back({input.contacts[term_contact[i]].id, impulse});
  }
  readJoints(members, input, problem, result);
  readMimics(scene, members, input.dt, &problem, result);
}

// A mimic joint feels its master's pull, the master its reaction.
void ArticulatedStepper::readMimics(const Scene& scene, const std::vector<int>& members, double dt, StepProblem* problem,
                                    SolveResult* result) {
  const std::vector<double> impulses = problem->foldImpulses();
  std::size_t next = 0;
  for (const int member : members) {
    for (const TreeNode& node : trees_[member].tree.nodes()) {
      if (node.dofs != 1 || scene.joints()[node.joint].spec.mimic_joint < 0) continue;
      const MimicRelation relation = mimicRelation(scene, node.joint);
      const double effort = impulses[next++] / dt;
      result->joint_efforts[node.joint] += effort;
      result->joint_efforts[relation.master] -= relation.multiplier * effort;
    }
  }
}

void ArticulatedStepper::readJoints(const std::vector<int>& members, const StepInput& input, const StepProblem& problem,
                                    SolveResult* result) {
  std::size_t term = 0;
  for (std::size_t m = 0; m < members.size(); ++m) {
    Tree& t = trees_[members[m]];
    t.next_velocity = problem.velocity.segment(problem.offset[m], t.tree.dofCount());
    for (const TreeNode& node : t.tree.nodes()) {
      if (node.dofs != 1) continue;
      const JointTerm& j = problem.joints[term++];
      const double v = problem.velocity[j.dof], limit = j.limitImpulse(v);
      joint_memos_[node.joint] = {j.dryImpulse(v), std::max(0.0, limit), std::max(0.0, -limit)};
      result->joint_efforts[node.joint] =
          input.drives[node.joint].effort + (j.motorImpulse(v) + j.dryImpulse(v) - j.viscous * v) / input.dt;
    }
  }
}

void ArticulatedStepper::followMimics(const Scene& scene) {
  for (Tree& t : trees_) {
    for (std::size_t i = 0; i < t.tree.nodes().size(); ++i) {
      const TreeNode& node = t.tree.nodes()[i];
      if (node.dofs != 1 || scene.joints()[node.joint].spec.mimic_joint < 0) continue;
      const MimicRelation relation = mimicRelation(scene, node.joint);
      const int body = scene.joints()[relation.master].spec.child;
      t.positions[i] = relation.multiplier * trees_[body_tree_[body]].positions[body_node_[body]] + relation.offset;
    }
  }
}

void ArticulatedStepper::integrate(Scene* scene, double dt) {
  for (Tree& t : trees_) {
    const std::vector<TreeNode>& nodes = t.tree.nodes();
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (nodes[i].dofs == 1) t.positions[i] += dt * t.next_velocity[nodes[i].first_dof];
    if (t.tree.isFree()) moveRoot(scene->bodies()[nodes[0].body].spec.inertial.com, dt, t.next_velocity, &t.root_pose);
  }
  followMimics(*scene);
  for (Tree& t : trees_) {
    t.tree.kinematics(*scene, t.root_pose, t.positions, t.next_velocity, &t.state);
    t.tree.write(t.state, scene);
  }
}

void ArticulatedStepper::step(Scene* scene, ContactMemory* memory, const StepInput& input, SolveResult* result) {
  buildTrees(*scene);
  readTrees(*scene);
  local_tree_.resize(trees_.size());
  rows_.resize(input.contacts.size());
  for (std::size_t i = 0; i < input.contacts.size(); ++i) {
    const ContactConstraint& c = input.contacts[i];
    if (isUsable(*scene, c)) rows_[i] = contactRows(c, contactMotion(*scene, c), memory->find(c.id), input.dt, settings_);
  }
  result->lcp_errors = 0;
  result->contact_forces.assign(input.contacts.size(), Vector3::Zero());
  result->joint_efforts.assign(scene->joints().size(), 0);
  next_impulses_.clear();
  for (const std::vector<int>& members : findIslands(input.contacts, *scene)) solveIsland(*scene, members, input, result);
  integrate(scene, input.dt);
  impulses_ = next_impulses_;
  std::stable_sort(impulses_.begin(), impulses_.end(), [](const ImpulseMemo& a, const ImpulseMemo& b) { return a.id < b.id; });
  std::vector<ContactMemo> memos;
  for (std::size_t i = 0; i < input.contacts.size(); ++i) addMemo(input.contacts[i], rows_[i], result->contact_forces[i], &memos);
  memory->replace(std::move(memos));
}

void ArticulatedStepper::save(StateWriter* writer) const {
  writer->word(impulses_.size());
  for (const ImpulseMemo& m : impulses_) {
    writer->word(m.id);
    writer->vector(m.impulse);
  }
  writer->word(joint_memos_.size());
  for (const JointMemo& m : joint_memos_) {
    writer->number(m.dry);
    writer->number(m.lower);
    writer->number(m.upper);
  }
}

void ArticulatedStepper::restore(StateReader* reader) {
  impulses_.resize(reader->word());
  for (ImpulseMemo& m : impulses_) {
    m.id = reader->word();
    m.impulse = reader->vector();
  }
  joint_memos_.resize(reader->word());
  for (JointMemo& m : joint_memos_) {
    m.dry = reader->number();
    m.lower = reader->number();
    m.upper = reader->number();
  }
}

}  // namespace

std::unique_ptr<Stepper> makeArticulated(const SolverSettings& settings) { return std::make_unique<ArticulatedStepper>(settings); }

}  // namespace blem_sim
