// Runs a random scene to which random things happen, and sees whether what is refused changes nothing, what is saved comes back, and, with
// live surfaces, a twin on two threads that hears of the calls goes on alike.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "blem_sim/sim/simulator_input.h"
#include "support/random/random_events.h"
#include "support/random/random_scene_run.h"
#include "support/random/random_surfaces.h"

namespace blem_sim {

/** A simulation that hears of what is done to another one. */
class Twin : public sim::SimulatorWatcher {
 public:
  /** @param events whose calls it hears of */
  Twin(sim::SimulationConfig config, const RandomEvents& events)
      : simulator(withThreads(std::move(config)), model::UriResolver()), events_(events) {}
  void told(const sim::SimulatorInput& input) override {
    if (input.call == "spawn")
      simulator.spawn(events_.lastSpawned());
    else
      applyInput(input, &simulator);
  }
  void stepped() override { simulator.step(); }

  sim::Simulator simulator;

 private:
  static sim::SimulationConfig withThreads(sim::SimulationConfig config) {
    config.solver.threads = 2;
    return config;
  }

  const RandomEvents& events_;
};

class EventfulScene {
 public:
  /** @param scene of that seed @param live there are live surfaces as well, and a twin @param outcome told step by step */
  EventfulScene(RandomScene scene, std::uint64_t seed, bool live, SceneOutcome* outcome)
      : scene_(std::move(scene)),
        surfaces_(seed + 500009, scene_.size),
        simulator_(configOf(live), model::UriResolver()),
        events_(seed + 1000003, scene_.size),
        when_(seed + 77),
        outcome_(*outcome) {
    outcome_.seed = seed;
    if (live) simulator_.watch(&twin_.emplace(scene_.config, events_));
    commandRobots(scene_, &simulator_);
  }

  void run(double duration) {
    const long steps = std::lround(duration / scene_.config.time_step);
    for (long i = 0; i < steps && !outcome_.failed(); ++i) {
      if (when_.chance(0.06)) happen([this] { return events_.happen(&simulator_); });
      if (twin_ && when_.chance(0.06)) happen([this] { return surfaces_.happen(&simulator_); });
      if (when_.chance(0.02)) comeBack();
      if (!outcome_.failed()) step();
    }
  }

 private:
  const sim::SimulationConfig& configOf(bool live) {
    if (live) surfaces_.addTo(&scene_.config);
    return scene_.config;
  }

  template <typename Call>
  void happen(const Call& call) {
    const std::uint64_t before = simulator_.stateHash();
    const Event event = call();
    if (event.refused) {
      if (simulator_.stateHash() != before) fail("refused, but changed");
      return;
    }
    last_ = event.name;
    watch_.reset();
    scene_.floor = -INFINITY;
    scene_.watches_walls = false;
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
    if (twin_ && twin_->simulator.stateHash() != simulator_.stateHash()) fail("its twin goes on by other bits");
  }
  void fail(const std::string& kind) { outcome_.fail(kind, fmt::format("at {:.3f} s, after: {}", simulator_.time(), last_)); }

  RandomScene scene_;
  RandomSurfaces surfaces_;
  std::optional<Twin> twin_;
  sim::Simulator simulator_;
  RandomEvents events_;
  SceneNumbers when_;
  SceneOutcome& outcome_;
  std::optional<SceneWatch> watch_;  ///< since the last event
  std::string last_ = "start";
};

}  // namespace blem_sim
