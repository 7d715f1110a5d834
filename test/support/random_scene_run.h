// Runs a random scene for a second and says what must not be.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <string>

#include "support/random_scene.h"

namespace blem_sim {

constexpr int STATUS_BITS = 9;

/** Plain, so that a process can hand it to another. */
struct SceneOutcome {
  std::uint64_t seed = 0;
  char failure[32] = "";   ///< its kind, empty if there is none
  char details[160] = "";  ///< in words
  int steps = 0;
  std::array<int, STATUS_BITS> bits{};  ///< steps with each
  double worst_step = 0;                ///< [s] wall time
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
  SceneWatch(const RandomScene& scene, const Simulator& simulator, SceneOutcome* outcome)
      : scene_(scene), simulator_(simulator), outcome_(*outcome) {
    start_ = simulator.report().energy;
    for (const BodyState& body : simulator.report().bodies) above_.push_back(body.X_WB.translation().z() > scene.floor);
  }

  void look(const StepReport& report, double seconds) {
    ++outcome_.steps;
    for (int bit = 0; bit < STATUS_BITS; ++bit) outcome_.bits[bit] += (report.status >> bit) & 1;
    told_ = told_ | report.status;
    outcome_.worst_step = std::max(outcome_.worst_step, seconds);
    outcome_.gained += report.energy_gained;
    if (report.status & STATE_NOT_FINITE) outcome_.fail("not finite", fmt::format("at {:.3f} s", report.time));
    lookAtEnergy(report);
    lookAtFloor(report);
  }
  /** [J] the larger of what moves and what fell since the start. */
  double scale() const { return scale_; }

 private:
  // Where nothing drives, energy is at most what it was and what the steps said.
  void lookAtEnergy(const StepReport& report) {
    scale_ = std::max({scale_, simulator_.world().kineticEnergy(), std::abs(report.energy - start_)});
    if (!scene_.passive || !std::isfinite(report.energy)) return;
    const double unsaid = report.energy - start_ - outcome_.gained;
    if (unsaid > 1e-3 * scale_ + 1e-6 + lag()) outcome_.fail("energy unsaid", fmt::format("{:.3g} J at {:.3f} s", unsaid, report.time));
  }
  /** [J] of a step of free fall, by which energy is not known. */
  double lag() const {
    double mass = 0;
    for (int b = 0; b < simulator_.world().bodyCount(); ++b) mass += simulator_.world().bodySpec(b).inertial.mass;
    const double step = simulator_.gravity().norm() * simulator_.config().time_step;
    return mass * step * step;
  }
  void lookAtFloor(const StepReport& report) {
    if (told_ & (CONTACT_UNRELIABLE | STATE_NOT_FINITE)) return;
    for (const ModelInfo& model : simulator_.models()) {
      if (model.kind != ModelKind::OBJECT) continue;
      const int body = model.bodies[0];
      const double height = report.bodies[body].X_WB.translation().z();
      if (above_[body] && height < scene_.floor)
        outcome_.fail("through the floor",
                      fmt::format("{} at {:.3f} s, speed {:.3g} m/s", model.name, report.time, report.bodies[body].v_WCom.norm()));
    }
  }

  const RandomScene& scene_;
  const Simulator& simulator_;
  SceneOutcome& outcome_;
  std::vector<bool> above_;
  std::uint32_t told_ = 0;
  double start_ = 0, scale_ = 0;
};

/** @param duration [s] simulated */
inline SceneOutcome runRandomScene(std::uint64_t seed, double duration = 1) {
  using Clock = std::chrono::steady_clock;
  SceneOutcome outcome;
  outcome.seed = seed;
  const RandomScene scene = randomScene(seed);
  Simulator simulator(scene.config, UriResolver());
  for (std::size_t i = 0; i < scene.commands.size(); ++i)
    if (!scene.commands[i].joints.empty()) simulator.commandJoints(static_cast<int>(i), scene.commands[i]);
  SceneWatch watch(scene, simulator, &outcome);
  const long steps = std::lround(duration / scene.config.time_step);
  for (long i = 0; i < steps && !outcome.failed(); ++i) {
    const Clock::time_point start = Clock::now();
    const StepReport& report = simulator.step();
    watch.look(report, std::chrono::duration<double>(Clock::now() - start).count());
  }
  outcome.of_energy = outcome.gained / std::max(watch.scale(), 1e-9);
  return outcome;
}

}  // namespace blem_sim
