#include "wheels/undercarriage.h"

#include "wheels/differential_wheels.h"
#include "wheels/steered_wheels.h"

namespace blem_sim::sim {

std::shared_ptr<const Undercarriage> undercarriageOf(const ControllerConfig& config, const model::RobotModel& robot) {
  if (config.kind == ControllerKind::STEERED_DRIVE) return std::make_shared<SteeredWheels>(config, robot);
  return std::make_shared<DifferentialWheels>(config.drive);
}

}  // namespace blem_sim::sim
