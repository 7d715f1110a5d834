// Turns that the threads of a Python program take at one simulation.
#pragma once

#include <pybind11/pybind11.h>

#include <mutex>

namespace blem_sim::python {

/** A thread's turn, from its making to its end; waits for others' without the interpreter's lock, which they may need to end theirs. */
class ThreadTurn {
 public:
  explicit ThreadTurn(std::mutex* turn) : lock_(*turn, std::defer_lock) {
    const pybind11::gil_scoped_release others_go_on;
    lock_.lock();
  }

 private:
  std::unique_lock<std::mutex> lock_;
};

}  // namespace blem_sim::python
