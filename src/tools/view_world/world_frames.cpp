#include "world_frames.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace blem_sim {

namespace {

WorldFrame frameOf(const sim::StepReport& report) { return {report.bodies, report.contacts}; }

/** Steps on until that many are made. */
void stepUntil(std::uint64_t steps, sim::Simulator* simulator) {
  while (simulator->steps() < steps) {
    if (simulator->step().status & sim::STATE_NOT_FINITE)
      throw std::runtime_error(fmt::format("the state stopped being finite at t = {:.6g} s", simulator->time()));
  }
}

}  // namespace

std::vector<WorldFrame> simulateFrames(const ViewOptions& options, sim::Simulator* simulator) {
  const double dt = simulator->config().time_step;
  const auto step_at = [dt](double time) { return static_cast<std::uint64_t>(std::llround(time / dt)); };
  std::vector<WorldFrame> frames;
  const auto last = static_cast<std::uint64_t>(std::floor(options.at * options.fps + 1e-9));
  for (std::uint64_t picture = 0; options.video && picture < last; ++picture) {
    stepUntil(step_at(static_cast<double>(picture) / options.fps), simulator);
    frames.push_back(frameOf(simulator->report()));
  }
  stepUntil(step_at(options.video ? static_cast<double>(last) / options.fps : options.at), simulator);
  frames.push_back(frameOf(simulator->report()));
  return frames;
}

}  // namespace blem_sim
