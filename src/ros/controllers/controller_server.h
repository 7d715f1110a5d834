// Interface of controllers as ROS sees them: each has names of its own.
#pragma once

#include <string>
#include <vector>

namespace blem_sim::node {

/** Commands come in the thread that steps, between two steps. A faulty one changes nothing, and is told in one error line. */
class ControllerServer {
 public:
  virtual ~ControllerServer() = default;
  /** Joints that it commands while it runs. */
  virtual std::vector<std::string> joints() const = 0;
  virtual void start() = 0;
  /** A goal ends as pre-empted. */
  virtual void stop() = 0;
  /** To be called after each step. @param time [s] simulated */
  virtual void step(double time) = 0;
  virtual void restartTime() = 0;
};

}  // namespace blem_sim::node
