// Runs a random scene for a second and reports faults.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "soak/figures.h"
#include "support/bare_meshes.h"
#include "support/random/random_scene.h"

namespace blem_sim {

constexpr int STATUS_BITS = 9;

/** Outcome of a scene, plain data so that a process can hand it to another. */
struct SceneOutcome {
  std::uint64_t seed = 0;
  char failure[32] = "";   ///< its kind, empty if there is none
  char details[160] = "";  ///< in words
  int steps = 0;
  std::array<int, STATUS_BITS> bits{};  ///< steps with each
  double worst_step = 0;                ///< [s] processor time of the slowest
  double gained = 0;                    ///< [J] in all, told or not
  double of_energy = 0;                 ///< the same, of the largest energy that moved

  bool failed() const { return failure[0] != 0; }
  void fail(const std::string& kind, const std::string& words) {
    if (failed()) return;
    std::snprintf(failure, sizeof failure, "%s", kind.c_str());
    std::snprintf(details, sizeof details, "%s", words.c_str());
  }
};

/** Watches the steps of one scene. */
class SceneWatch {
 public:
  SceneWatch(const RandomScene& scene, const sim::Simulator& simulator, SceneOutcome* outcome)
      : scene_(scene), simulator_(simulator), outcome_(*outcome) {
    start_ = simulator.report().energy + lag(simulator.report());
    gained_before_ = outcome->gained;
    for (const dynamics::BodyState& body : simulator.report().bodies) above_.push_back(body.X_WB.translation().z() > scene.floor);
    if (scene.watches_walls) findWalls();
  }

  void look(const sim::StepReport& report, double seconds) {
    ++outcome_.steps;
    for (int bit = 0; bit < STATUS_BITS; ++bit) outcome_.bits[bit] += (report.status >> bit) & 1;
    told_ = told_ | report.status;
    outcome_.worst_step = std::max(outcome_.worst_step, seconds);
    outcome_.gained += report.energy_gained;
    if (report.status & sim::STATE_NOT_FINITE) outcome_.fail("not finite", fmt::format("at {:.3f} s", report.time));
    lookAtEnergy(report);
    lookAtFloor(report);
    lookAtWalls(report);
  }
  /** [J] largest kinetic energy, or change of energy, since the start. */
  double scale() const { return scale_; }

 private:
  // Without drives energy is at most that of the start plus the gains that the steps said.
  void lookAtEnergy(const sim::StepReport& report) {
    const double rise = report.energy - start_;
    if (!std::isfinite(rise)) return;
    scale_ = std::max({scale_, simulator_.world().kineticEnergy(), std::abs(rise)});
    lag_ = std::max(lag_, lag(report));
    const double unsaid = rise - (outcome_.gained - gained_before_) - lag_;
    if (scene_.passive && unsaid > 1e-3 * scale_ + 1e-6)
      outcome_.fail("energy unsaid", fmt::format("{:.3g} J at {:.3f} s", unsaid, report.time));
  }
  /** [J] bound on the energy that is not known, by the fall of bodies in half a step: taken for a whole one. If a step is shortened, it
   * stays as it was until then. */
  double lag(const sim::StepReport& report) const {
    double energy = 0;
    for (std::size_t b = 0; b < report.bodies.size(); ++b)
      energy += report.dt * simulator_.world().bodySpec(static_cast<int>(b)).inertial.mass *
                std::abs(simulator_.gravity().dot(report.bodies[b].v_WCom));
    return energy;
  }
  void lookAtFloor(const sim::StepReport& report) {
    if (told_ & (sim::CONTACT_UNRELIABLE | sim::STATE_NOT_FINITE)) return;
    for (const sim::ModelInfo& model : simulator_.models()) {
      if (!model.alive || model.kind != sim::ModelKind::OBJECT) continue;
      const int body = model.bodies[0];
      const double height = report.bodies[body].X_WB.translation().z();
      if (above_[body] && height < scene_.floor)
        outcome_.fail("through the floor",
                      fmt::format("{} at {:.3f} s, speed {:.3g} m/s", model.name, report.time, report.bodies[body].v_WCom.norm()));
    }
  }

  void findWalls() {
    const std::vector<contact::Collider>& colliders = simulator_.colliders();
    for (std::size_t wall = 0; wall < colliders.size(); ++wall) {
      if (!colliders[wall].enabled || colliders[wall].body != dynamics::WORLD_BODY || colliders[wall].geometry->isHalfSpace()) continue;
      for (std::size_t i = 0; i < colliders.size(); ++i)
        if (colliders[i].enabled && colliders[i].body != dynamics::WORLD_BODY)
          paths_.emplace_back(static_cast<int>(i), static_cast<int>(wall));
    }
  }
  void lookAtWalls(const sim::StepReport& report) {
    for (CentrePath& path : paths_) {
      if (!path.goesThrough(simulator_) || (told_ & (sim::CONTACT_UNRELIABLE | sim::STATE_NOT_FINITE))) continue;
      const contact::Collider& thrown = simulator_.colliders()[path.thrown()];
      outcome_.fail("through a wall", fmt::format("{} at {:.3f} s", simulator_.models()[thrown.model].name, report.time));
    }
  }

  const RandomScene& scene_;
  const sim::Simulator& simulator_;
  SceneOutcome& outcome_;
  std::vector<bool> above_;
  std::vector<CentrePath> paths_;
  std::uint32_t told_ = 0;
  double start_ = 0, scale_ = 0, lag_ = 0, gained_before_ = 0;
};

/** @param duration [s] simulated @param out told step by step */
inline void runRandomScene(const RandomScene& scene, double duration, SceneOutcome* out) {
  SceneOutcome& outcome = *out;
  sim::Simulator simulator(scene.config, model::UriResolver());
  commandRobots(scene, &simulator);
  SceneWatch watch(scene, simulator, &outcome);
  const long steps = std::lround(duration / scene.config.time_step);
  for (long i = 0; i < steps && !outcome.failed(); ++i) {
    const double start = threadSeconds();
    const sim::StepReport& report = simulator.step();
    watch.look(report, threadSeconds() - start);
    outcome.of_energy = outcome.gained / std::max(watch.scale(), 1e-9);
  }
}

}  // namespace blem_sim
