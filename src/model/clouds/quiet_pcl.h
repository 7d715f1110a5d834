// Silence while PCL works.
#pragma once

#include <pcl/console/print.h>

namespace blem_sim::model {

/** Keeps PCL from writing on stderr while one lives: the user shall see one line of blem_sim's own. */
class QuietPcl {
 public:
  QuietPcl() : level_(pcl::console::getVerbosityLevel()) { pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS); }
  ~QuietPcl() { pcl::console::setVerbosityLevel(level_); }
  QuietPcl(const QuietPcl&) = delete;
  QuietPcl& operator=(const QuietPcl&) = delete;

 private:
  pcl::console::VERBOSITY_LEVEL level_;
};

}  // namespace blem_sim::model
