// Silence while PCL works.
#pragma once

#include <pcl/console/print.h>

namespace blem_sim {

/** PCL speaks on stderr; one line of ours is what the user is to see. */
class QuietPcl {
 public:
  QuietPcl() : level_(pcl::console::getVerbosityLevel()) { pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS); }
  ~QuietPcl() { pcl::console::setVerbosityLevel(level_); }
  QuietPcl(const QuietPcl&) = delete;
  QuietPcl& operator=(const QuietPcl&) = delete;

 private:
  pcl::console::VERBOSITY_LEVEL level_;
};

}  // namespace blem_sim
