#include "blem_sim/sim/range_view.h"
#include "sensors/types/sensor.h"

namespace blem_sim::sim {
namespace {

/** Depth camera or lidar: copies where everything stands, and leaves the rays to who wants to see them. */
class RangeSensor : public Sensor {
 public:
  RangeSensor(const SimulatedWorld& world, const SensorInfo& info)
      : config_(info.config),
        model_(world.robots[info.robot].model),
        frame_(world, world.robots[info.robot], info.config.link, info.config.X_LS) {}

  void measure(const StepContext& step, SensorReading* out) override {
    auto view = std::make_shared<RangeView>();
    view->rays = config_.rays;
    view->rays.noise = RangeNoise::GAUSSIAN;
    view->rays.stddev = 0;
    view->X_WS = frame_.motion(step.bodies).X_WS;
    view->model = model_;
    view->noise_seed = random_.next();
    for (const contact::Collider& collider : step.world.colliders) {
      if (!collider.enabled) continue;
      const Pose X_WC = collider.body == dynamics::WORLD_BODY ? collider.X_BC : step.bodies[collider.body].X_WB * collider.X_BC;
      view->targets.push_back({collider.seen(), X_WC, collider.radius, collider.model});
    }
    if (config_.type == SensorType::DEPTH_CAMERA)
      *out = DepthCameraReading{std::move(view)};
    else
      *out = LidarReading{std::move(view)};
  }

  void addNoise(SensorReading* out) override {
    auto& view = config_.type == SensorType::DEPTH_CAMERA ? std::get<DepthCameraReading>(*out).view : std::get<LidarReading>(*out).view;
    auto noisy = std::make_shared<RangeView>(*view);
    noisy->rays = config_.rays;
    view = std::move(noisy);
  }

 private:
  const SensorConfig config_;
  const int model_;
  const MountedFrame frame_;
};

}  // namespace

std::unique_ptr<Sensor> makeRangeSensor(const SimulatedWorld& world, const SensorInfo& info) {
  return std::make_unique<RangeSensor>(world, info);
}

}  // namespace blem_sim::sim
