#include "wheels/undercarriage.h"

#include "wheels/differential_wheels.h"
#include "wheels/steered_wheels.h"

namespace blem_sim::sim {
namespace {

/** Undercarriage of a robot that is pushed. */
class NoWheels : public Undercarriage {
 public:
  double angleFor(const DriveTwist&, double) const override { return 0; }
  std::vector<double> velocities(const DriveTwist&, const Steering&) const override { return {}; }
  std::vector<double> positions(double) const override { return {}; }
  double angleOf(const std::vector<dynamics::JointState>&) const override { return 0; }
  DriveTwist rolled(const std::vector<dynamics::JointState>&) const override { return {}; }
};

}  // namespace

std::shared_ptr<const Undercarriage> undercarriageOf(const ControllerConfig& config, const model::RobotModel& robot) {
  if (config.kind == ControllerKind::PLANAR_DRIVE) return std::make_shared<NoWheels>();
  if (config.kind == ControllerKind::STEERED_DRIVE) return std::make_shared<SteeredWheels>(config, robot);
  return std::make_shared<DifferentialWheels>(config.drive);
}

}  // namespace blem_sim::sim
