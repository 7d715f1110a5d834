// Runs a random scene to which random things happen, and sees whether what is refused changes nothing and what is saved comes back.
#pragma once

#include <optional>
#include <string>

#include "support/random/random_events.h"
#include "support/random/random_scene_run.h"

namespace blem_sim {

class EventfulScene {
 public:
  /** @param outcome told step by step */
  EventfulScene(std::uint64_t seed, SceneOutcome* outcome)
      : scene_(randomScene(seed)),
        simulator_(scene_.config, model::UriResolver()),
        events_(seed + 1000003, sizeOf(seed)),
        when_(seed + 77),
        outcome_(*outcome) {
    outcome_.seed = seed;
    commandRobots(scene_, &simulator_);
  }

  void run(double duration) {
    const long steps = std::lround(duration / scene_.config.time_step);
    for (long i = 0; i < steps && !outcome_.failed(); ++i) {
      if (when_.chance(0.06)) happen();
      if (when_.chance(0.02)) comeBack();
      if (!outcome_.failed()) step();
    }
  }

 private:
  static double sizeOf(std::uint64_t seed) {
    SceneNumbers numbers(seed);
    return randomTraits(&numbers).size;
  }

  void happen() {
    const std::uint64_t before = simulator_.stateHash();
    const Event event = events_.happen(&simulator_);
    if (event.refused) {
      if (simulator_.stateHash() != before) fail("refused, but changed");
      return;
    }
    last_ = event.name;
    watch_.reset();
    scene_.floor = -INFINITY;
    scene_.passive = scene_.passive && event.passive;
  }

  // Saves, goes on, comes back, and goes on in the same way.
  void comeBack() {
    const sim::SimulationState state = simulator_.save();
    const std::size_t welds = simulator_.attachments().size();
    const std::uint64_t saved = simulator_.stateHash(), gone_on = goOn();
    if (simulator_.attachments().size() < welds) return;  // no state mends a weld that has broken
    simulator_.restore(state);
    if (simulator_.stateHash() != saved) return fail("comes back changed");
    if (goOn() != gone_on) return fail("goes on by other bits");
    simulator_.restore(state);
  }
  std::uint64_t goOn() {
    for (int i = 0; i < 4; ++i) simulator_.step();
    return simulator_.stateHash();
  }

  void step() {
    const double start = threadSeconds();
    const sim::StepReport& report = simulator_.step();
    const double seconds = threadSeconds() - start;
    if (!watch_)
      watch_.emplace(scene_, simulator_, &outcome_);
    else
      watch_->look(report, seconds);
    if (report.status & sim::STATE_NOT_FINITE) fail("not finite");
  }
  void fail(const std::string& kind) { outcome_.fail(kind, fmt::format("at {:.3f} s, after: {}", simulator_.time(), last_)); }

  RandomScene scene_;
  sim::Simulator simulator_;
  RandomEvents events_;
  SceneNumbers when_;
  SceneOutcome& outcome_;
  std::optional<SceneWatch> watch_;  ///< since the last event
  std::string last_ = "start";
};

}  // namespace blem_sim
