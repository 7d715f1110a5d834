#include "build/load_watch.h"

#include <fmt/format.h>

namespace blem_sim::sim {

LoadWatch::LoadWatch(const LoadLog& log, std::string model) : log_(log), model_(std::move(model)) {
  if (log_.tell) teller_ = std::thread([this] { tellStages(); });
}

LoadWatch::~LoadWatch() {
  if (!teller_.joinable()) return;
  stop();
  if (seconds() >= log_.interval) log_.tell(fmt::format("loading {}: given up after {:.1f} s, {}", model_, seconds(), stage_));
}

void LoadWatch::enter(const std::string& stage, double fraction) {
  const std::lock_guard<std::mutex> lock(mutex_);
  stage_ = stage;
  fraction_ = fraction;
}

model::LoadProgress LoadWatch::progress() {
  return [this](const std::string& stage, double fraction) { enter(stage, fraction); };
}

void LoadWatch::loaded(const std::string& what) {
  if (!teller_.joinable()) return;
  stop();
  if (seconds() >= log_.interval) log_.tell(fmt::format("loaded {}: {}, {:.1f} s", model_, what, seconds()));
}

void LoadWatch::tellStages() {
  const auto interval = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(log_.interval));
  Clock::time_point next = start_ + interval;
  std::unique_lock<std::mutex> lock(mutex_);
  while (!ended_.wait_until(lock, next, [this] { return over_; })) {
    log_.tell(fmt::format("loading {}: {}, {:.0f} % done, {:.1f} s so far", model_, stage_, 100 * fraction_, seconds()));
    next = Clock::now() + interval;
  }
}

void LoadWatch::stop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    over_ = true;
  }
  ended_.notify_all();
  teller_.join();
}

}  // namespace blem_sim::sim
