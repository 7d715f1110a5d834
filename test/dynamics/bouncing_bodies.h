// Bodies that touch by balls fixed to them, between walls: bounces whose contacts are exact and do not depend on any contact generation.
#pragma once

#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "dynamics/analytic_contacts.h"

namespace blem_sim::dynamics {

/** A ball fixed to a body. */
struct Ball {
  int body;
  Vector3 centre;  ///< body frame
  double radius;
};

/** Half space of the static world below {normal . x = offset}. */
struct Wall {
  Vector3 normal;
  double offset;
};

class BouncingBodies {
 public:
  BouncingBodies(const Vector3& gravity, const Surface& surface, const SolverSettings& settings = {})
      : world(gravity, settings), surface_(surface) {}

  int add(double mass, const Vector3& inertia, const Vector3& centre, const std::vector<std::pair<Vector3, double>>& balls) {
    BodySpec spec;
    spec.name = "body" + std::to_string(world.bodyCount());
    spec.inertial.mass = mass;
    spec.inertial.inertia = inertia.asDiagonal();
    spec.X_WB = makePose(centre);
    const int body = world.addBody(spec);
    for (const auto& ball : balls) this->balls.push_back({body, ball.first, ball.second});
    return body;
  }
  /** A ball at each corner, of which it is inside. */
  int addBox(double mass, const Vector3& size, const Vector3& centre, double radius = 0) {
    std::vector<std::pair<Vector3, double>> corners;
    for (int i = 0; i < 8; ++i) corners.emplace_back(corner(size - Vector3::Constant(2 * radius), i), radius);
    const Vector3 s = size.cwiseProduct(size);
    return add(mass, mass / 12 * Vector3(s.y() + s.z(), s.x() + s.z(), s.x() + s.y()), centre, corners);
  }
  int addSphere(double mass, double radius, const Vector3& centre) {
    return add(mass, Vector3::Constant(0.4 * mass * radius * radius), centre, {{Vector3::Zero(), radius}});
  }
  void hinge(int parent, int child, const Vector3& at, const Vector3& axis) {
    JointSpec spec;
    spec.name = "hinge" + std::to_string(world.jointCount());
    spec.parent = parent;
    spec.child = child;
    spec.X_PJ = makePose(parent == WORLD_BODY ? at : Vector3(at - world.bodyState(parent).X_WB.translation()));
    spec.axis = axis;
    world.addJoint(spec);
  }
  void setVelocity(int body, const Vector3& velocity, const Vector3& spin) {
    BodyState state = world.bodyState(body);
    state.v_WCom = velocity;
    state.w_WB = spin;
    world.setBodyState(body, state);
  }

  const SolveResult& step(double dt) {
    findContacts(dt);
    return world.step(dt, contacts, std::vector<JointDrive>(world.jointCount()));
  }

  /** Fills contacts with all that may meet within the step. */
  void findContacts(double dt) {
    contacts.clear();
    std::vector<Vector3> at;
    double fastest = 0;
    for (const Ball& ball : balls) {
      const BodyState state = world.bodyState(ball.body);
      at.push_back(state.X_WB * ball.centre);
      fastest = std::max(fastest, (state.v_WCom + state.w_WB.cross(at.back() - state.X_WB.translation())).norm());
    }
    const double margin = 1e-3 + 3 * dt * fastest;
    const auto number = [](std::size_t i) { return static_cast<std::uint64_t>(i); };
    for (std::size_t i = 0; i < balls.size(); ++i) {
      for (std::size_t w = 0; w < walls.size(); ++w) {
        const double gap = walls[w].normal.dot(at[i]) - walls[w].offset - balls[i].radius;
        const Vector3 point = at[i] - balls[i].radius * walls[w].normal;
        if (gap < margin)
          contacts.push_back(contactOf(balls[i].body, WORLD_BODY, point, walls[w].normal, -gap, surface_, number(w) << 32 | i));
      }
      for (std::size_t j = i + 1; j < balls.size(); ++j) {
        if (balls[i].body == balls[j].body || (balls[i].radius == 0 && balls[j].radius == 0)) continue;
        const Vector3 apart = at[i] - at[j];
        const double gap = apart.norm() - balls[i].radius - balls[j].radius;
        const Vector3 normal = apart.normalized(), point = at[j] + (balls[j].radius + 0.5 * gap) * normal;
        if (gap < margin)
          contacts.push_back(contactOf(balls[i].body, balls[j].body, point, normal, -gap, surface_, (number(j) + 1000) << 32 | i));
      }
    }
    // Contacts of a pair follow on each other, as those of the contact stage do.
    std::stable_sort(contacts.begin(), contacts.end(), [](const ContactConstraint& a, const ContactConstraint& b) {
      return std::make_pair(a.body_a, a.body_b) < std::make_pair(b.body_a, b.body_b);
    });
  }

  /**
   * [J] kinetic and potential, the latter half a step earlier, since bodies are moved by the velocities at a step's end: flight keeps this
   * sum exactly.
   */
  double energy(double dt) const {
    double sum = world.kineticEnergy() + world.potentialEnergy();
    for (int b = 0; b < world.bodyCount(); ++b)
      sum += 0.5 * dt * world.bodySpec(b).inertial.mass * world.gravity().dot(world.bodyState(b).v_WCom);
    return sum;
  }

  World world;
  std::vector<Ball> balls;
  std::vector<Wall> walls;
  std::vector<ContactConstraint> contacts;

 private:
  Surface surface_;
};

/** Energy over a run. */
struct EnergyRun {
  double start = 0, end = 0;
  double worst = 0;         ///< [J] largest rise in one step beyond that by correcting depth
  double worst_gain = 0;    ///< [J] the same, also beyond apparent work of contacts (SolveResult::apparent_work)
  double worst_flight = 0;  ///< [J] largest change in a step without any force: the error of integrating free motion
  bool finite = true;
};

/** Largest work [J] by which contacts that correct depth may lift things in a step. */
inline double correctionWork(const BouncingBodies& scene, const SolveResult& result, double dt) {
  const SolverSettings settings;
  double work = 0;
  for (std::size_t i = 0; i < scene.contacts.size(); ++i) {
    const ContactConstraint& c = scene.contacts[i];
    if (c.depth <= 0) continue;
    const double speed = std::min(settings.correction_fraction * c.depth / dt, settings.max_correction_speed);
    work += dt * speed * std::max(0.0, c.normal_BA.dot(result.contact_forces[i]));
  }
  return work;
}

inline EnergyRun followEnergy(BouncingBodies* scene, double dt, int steps) {
  EnergyRun run;
  double energy = run.start = scene->energy(dt);
  for (int i = 0; i < steps && run.finite; ++i) {
    const SolveResult& result = scene->step(dt);
    run.finite = result.finite;
    const bool flies =
        std::all_of(result.contact_forces.begin(), result.contact_forces.end(), [](const Vector3& f) { return f.isZero(0); });
    const double next = scene->energy(dt);
    const double rise = next - energy - correctionWork(*scene, result, dt);
    run.worst = std::max(run.worst, rise);
    run.worst_gain = std::max(run.worst_gain, rise - std::accumulate(result.apparent_work.begin(), result.apparent_work.end(), 0.0));
    if (flies) run.worst_flight = std::max(run.worst_flight, std::abs(next - energy));
    energy = run.end = next;
  }
  return run;
}

/** Turns, throws and spins a body at random. */
inline void toss(BouncingBodies* scene, int body, std::mt19937* random, double speed, double spin) {
  const auto any = [&] { return 2 * static_cast<double>((*random)()) / 0x1p32 - 1; };
  const auto vector = [&](double size) {
    const double x = any(), y = any(), z = any();
    return Vector3(size * x, size * y, size * z);
  };
  BodyState state = scene->world.bodyState(body);
  const Vector3 turn = vector(M_PI);
  state.X_WB.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  state.v_WCom = vector(speed);
  state.w_WB = vector(spin);
  scene->world.setBodyState(body, state);
}

/** A cube above a plane. */
inline void tossCube(BouncingBodies* scene, int seed) {
  std::mt19937 random(seed);
  scene->walls = {{Vector3::UnitZ(), 0}};
  toss(scene, scene->addBox(1, {0.1, 0.1, 0.1}, {0, 0, 0.3}), &random, 1, 10);
}

/** Two cubes and a ball in a pit. */
inline void tossThree(BouncingBodies* scene, int seed) {
  std::mt19937 random(seed);
  const Vector3 x = Vector3::UnitX(), y = Vector3::UnitY();
  scene->walls = {{Vector3::UnitZ(), 0}, {x, -0.15}, {-x, -0.15}, {y, -0.15}, {-y, -0.15}};
  for (int i = 0; i < 3; ++i) {
    const Vector3 centre(0, 0, 0.3 + 0.15 * i);
    toss(scene, i == 1 ? scene->addSphere(0.5, 0.05, centre) : scene->addBox(1, {0.1, 0.1, 0.1}, centre, 0.02), &random, 1, 10);
  }
}

/** A rod of 30 cm above a plane. */
inline void tossRod(BouncingBodies* scene, int seed) {
  std::mt19937 random(seed);
  scene->walls = {{Vector3::UnitZ(), 0}};
  toss(scene, scene->addBox(0.2, {0.3, 0.02, 0.02}, {0, 0, 0.3}), &random, 1, 10);
}

/** A tree of three bodies and two hinges without motors above a plane. */
inline void tossTree(BouncingBodies* scene, int seed) {
  std::mt19937 random(seed);
  scene->walls = {{Vector3::UnitZ(), 0}};
  const Vector3 root(0, 0, 0.5);
  const int torso = scene->addBox(1, {0.1, 0.1, 0.1}, root);
  toss(scene, torso, &random, 1, 6);
  const BodyState state = scene->world.bodyState(torso);
  BodyState straight = state;
  straight.X_WB = makePose(root);
  scene->world.setBodyState(torso, straight);
  const int arm = scene->addBox(0.3, {0.2, 0.04, 0.04}, {0.15, 0, 0.5}), hand = scene->addBox(0.1, {0.04, 0.2, 0.04}, {0.25, 0.1, 0.5});
  scene->hinge(torso, arm, {0.05, 0, 0.5}, Vector3::UnitY());
  scene->hinge(arm, hand, {0.25, 0, 0.5}, Vector3::UnitZ());
  for (const int body : {torso, arm, hand})
    scene->setVelocity(body, state.v_WCom + state.w_WB.cross(scene->world.bodyState(body).X_WB.translation() - root), state.w_WB);
}

/** Newton's: equal balls that hang side by side, some of them swung. */
struct Cradle {
  static constexpr int BALLS = 5;
  static constexpr double ANGLE = 0.4, LENGTH = 0.5, RADIUS = 0.02;  // [rad], [m]

  /** @param gap [m] between balls that hang */
  Cradle(int swung, double gap, double friction = 0) : scene({0, 0, -9.81}, elastic(friction)) {
    for (int i = 0; i < BALLS; ++i) {
      const Vector3 hook((2 * RADIUS + gap) * i, 0, LENGTH);
      scene.addSphere(0.1, RADIUS, hook - LENGTH * Vector3::UnitZ());
      scene.hinge(WORLD_BODY, i, hook, Vector3::UnitY());
      if (i >= swung) continue;
      BodyState state = scene.world.bodyState(i);
      state.X_WB.linear() = Eigen::AngleAxisd(ANGLE, Vector3::UnitY()).toRotationMatrix();
      state.X_WB.translation() = hook - LENGTH * state.X_WB.linear().col(2);
      scene.world.setBodyState(i, state);
      scene.world.resetJointPosition(i, ANGLE);
    }
  }
  static Surface elastic(double friction) {
    Surface surface;
    surface.restitution = 1;
    surface.friction = friction;
    return surface;
  }
  /** Makes the steps of half a period. */
  void swing(double dt) {
    const double seconds = M_PI * std::sqrt(LENGTH / 9.81 * (1 + 0.4 * RADIUS * RADIUS / (LENGTH * LENGTH))) * (1 + ANGLE * ANGLE / 16);
    for (int i = 0; i < std::lround(seconds / dt); ++i) scene.step(dt);
  }
  double angle(int ball) const { return scene.world.jointState(ball).position; }

  BouncingBodies scene;
};

}  // namespace blem_sim::dynamics
