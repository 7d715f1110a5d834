// Wheels on two sides, of which the left ones roll otherwise than the right ones.
#pragma once

#include "wheels/undercarriage.h"

namespace blem_sim::sim {

class DifferentialWheels : public Undercarriage {
 public:
  explicit DifferentialWheels(const DriveConfig& config);

  double angleFor(const DriveTwist&, double) const override { return 0; }
  std::vector<double> velocities(const DriveTwist& twist, const Steering& steering) const override;
  std::vector<double> positions(double) const override { return {}; }
  double angleOf(const std::vector<dynamics::JointState>&) const override { return 0; }
  DriveTwist rolled(const std::vector<dynamics::JointState>& joints) const override;

 private:
  std::size_t left_, right_;  ///< numbers of wheels; left ones come first
  double separation_, radius_;
};

}  // namespace blem_sim::sim
