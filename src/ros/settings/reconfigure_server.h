// Settings that clients of dynamic_reconfigure see and change.
#pragma once

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/ConfigDescription.h>
#include <dynamic_reconfigure/Reconfigure.h>

#include <functional>
#include <string>
#include <vector>

#include "services/door/service_group.h"

namespace blem_sim::node {

/** A number that can be set between steps. */
struct Setting {
  std::string name, description;
  double least = 0, most = 0;
  std::function<double()> get;
  std::function<void(double)> set;  ///< takes every number from least to most
};

/**
 * `set_parameters`, `parameter_descriptions` and `parameter_updates` of dynamic_reconfigure, of a list of settings that may change. A
 * request with a setting that is unknown or out of range changes nothing: it is answered with the values that hold, and one line says why.
 */
class ReconfigureServer {
 public:
  explicit ReconfigureServer(ros::NodeHandle node);

  /** Tells all clients of these settings. */
  void offer(std::vector<Setting> settings);
  /** Tells all clients the values that hold now. */
  void tellValues();

 private:
  void serve(const dynamic_reconfigure::Config& request);
  const Setting& settingOf(const std::string& name) const;
  dynamic_reconfigure::Config values(const std::function<double(const Setting&)>& value) const;
  dynamic_reconfigure::ConfigDescription describe() const;

  std::vector<Setting> settings_;
  ros::Publisher descriptions_, updates_;
  ServiceGroup services_;
};

}  // namespace blem_sim::node
