// Robots whose place on /tf is told by their drives.
#pragma once

#include <set>
#include <string>

namespace blem_sim::node {

/** Robots whose root link a running drive has in the frame of its odometry, so that truth leaves it there: a frame has one parent. */
class RootFrames {
 public:
  void take(const std::string& robot) { taken_.insert(robot); }
  /** Undoes one take. */
  void giveBack(const std::string& robot) {
    if (const auto one = taken_.find(robot); one != taken_.end()) taken_.erase(one);
  }
  bool taken(const std::string& robot) const { return taken_.count(robot) > 0; }

 private:
  std::multiset<std::string> taken_;  // once for each drive
};

}  // namespace blem_sim::node
