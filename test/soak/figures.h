// Output of the long runs: figures on lines of their own, times of single steps; and their environment variables.
#pragma once

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "blem_sim/dynamics/world.h"
#include "support/range.h"

namespace blem_sim {

/** One line that scripts/validate_solver puts into its table. */
inline void figure(const std::string& name, double value, const std::string& unit) {
  std::printf("figure: %s = %.6g %s\n", name.c_str(), value, unit.c_str());
  std::fflush(stdout);
}

/** Stepper under test: environment variable BLEM_SIM_SOAK_STEPPER, else articulated. */
inline dynamics::SolverSettings soakSettings() {
  dynamics::SolverSettings settings;
  const char* stepper = std::getenv("BLEM_SIM_SOAK_STEPPER");
  settings.stepper = stepper && *stepper ? stepper : "articulated";
  return settings;
}

/** Whether a short run is asked for (environment variable BLEM_SIM_SOAK_SHORT). */
inline bool soakShort() {
  const char* set = std::getenv("BLEM_SIM_SOAK_SHORT");
  return set && *set && *set != '0';
}

/** Number of simulated steps of 1 ms: for the seconds that must be shown, or for the short run's. */
inline int soakSteps(double seconds, double short_seconds) {
  return static_cast<int>(std::lround(1000 * (soakShort() ? short_seconds : seconds)));
}

/** Processor time [s] of this thread. */
inline double threadSeconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/** [s] by the wall's clock, from some moment on. */
inline double wallSeconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/** Anything, to a template that looks for a member it may not have. */
struct StatesNothing {
  template <typename Any>
  StatesNothing(const Any&) {}
};

/** [N] and count that the solver states of a step, or NaN where it states none. */
template <typename Result>
auto residualOf(const Result& result, int) -> decltype(static_cast<double>(result.residual)) {
  return result.residual;
}
inline double residualOf(const StatesNothing&, long) { return NAN; }
template <typename Result>
auto iterationsOf(const Result& result, int) -> decltype(static_cast<double>(result.iterations)) {
  return result.iterations;
}
inline double iterationsOf(const StatesNothing&, long) { return NAN; }

/** Processor times of single steps, and the solver's own account of them. */
class StepTimes {
 public:
  void start() { start_ = threadSeconds(); }
  void stop() { microseconds_.push_back(1e6 * (threadSeconds() - start_)); }
  /** @param result SolveResult or StepReport of the step */
  template <typename Result>
  void stop(const Result& result) {
    stop();
    residual_ = std::fmax(residual_, residualOf(result, 0));
    iterations_ = std::fmax(iterations_, iterationsOf(result, 0));
  }
  /** [us] below which this fraction of the steps stayed. Precondition: a step was timed. */
  double quantile(double fraction) const {
    std::vector<double> sorted = microseconds_;
    std::sort(sorted.begin(), sorted.end());
    return sorted[static_cast<std::size_t>(fraction * static_cast<double>(sorted.size() - 1))];
  }
  double median() const { return quantile(0.5); }
  double mean() const {
    double total = 0;
    for (const double each : microseconds_) total += each;
    return total / static_cast<double>(microseconds_.size());
  }
  double worst() const { return quantile(1); }
  bool empty() const { return microseconds_.empty(); }
  void print(const std::string& name) const {
    figure(name + " step median", median(), "us");
    figure(name + " step p99", quantile(0.99), "us");
    figure(name + " worst step", worst(), "us");
    if (!std::isnan(residual_)) figure(name + " worst residual", residual_, "N");
    if (!std::isnan(iterations_)) figure(name + " most iterations", iterations_, "");
  }

 private:
  double start_ = 0, residual_ = NAN, iterations_ = NAN;
  std::vector<double> microseconds_;
};

}  // namespace blem_sim
