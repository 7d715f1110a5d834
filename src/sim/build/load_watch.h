// Progress messages of long loads.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "blem_sim/sim/simulator_types.h"

namespace blem_sim::sim {

/**
 * Lives while one model is loaded. Once that has taken log.interval, and each time it passes again, a thread of its own tells the stage, so
 * that a file that is read for long does not look like a program that hangs; at the end it tells the size loaded, or the stage in which the
 * load was given up. A short load says nothing.
 */
class LoadWatch {
 public:
  /** @param model in messages; log must outlive this */
  LoadWatch(const LoadLog& log, std::string model);
  /** Without loaded() before, the load counts as given up. */
  ~LoadWatch();
  LoadWatch(const LoadWatch&) = delete;
  LoadWatch& operator=(const LoadWatch&) = delete;

  /** @param fraction of the load that lies behind, 0 to 1 */
  void enter(const std::string& stage, double fraction);
  model::LoadProgress progress();
  /** @param what in words: triangles and memory */
  void loaded(const std::string& what);

 private:
  using Clock = std::chrono::steady_clock;

  void tellStages();
  void stop();
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  const LoadLog& log_;
  const std::string model_;
  const Clock::time_point start_ = Clock::now();
  std::mutex mutex_;
  std::condition_variable ended_;
  bool over_ = false;  // guarded by the mutex, like the next two
  std::string stage_ = "starting";
  double fraction_ = 0;
  std::thread teller_;
};

}  // namespace blem_sim::sim
