// ODE as a process-wide library: its start and end, its messages and errors.
#pragma once

#include <stdexcept>

namespace blem_sim::dynamics {

/** ODE met an internal error it would have ended the process for. */
class OdeFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/**
 * Keeps ODE initialised while one exists, and handles its messages, errors and debug assertions. ODE's handlers are process wide;
 * complaints are counted per thread, so worlds stepped in different threads do not get each other's.
 */
class OdeLibrary {
 public:
  OdeLibrary();
  ~OdeLibrary();
  OdeLibrary(const OdeLibrary&) = delete;
  OdeLibrary& operator=(const OdeLibrary&) = delete;

  /** Complaints of the complementarity solver in this thread since the last call. */
  static int takeLcpErrors();
};

}  // namespace blem_sim::dynamics
