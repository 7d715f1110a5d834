#include <iomanip>
#include <sstream>

#include "blem_sim/sim/simulator.h"
#include "engine.h"
#include "support/temporary_folder.h"

namespace blem_sim {
namespace {

std::string textOf(const geometry::TriangleMesh& mesh) {
  std::ostringstream out;
  out << std::setprecision(17) << "OFF\n" << mesh.vertices.size() << " " << mesh.elements.size() << " 0\n";
  for (const Vector3& v : mesh.vertices) out << v.x() << " " << v.y() << " " << v.z() << "\n";
  for (const Vector3i& e : mesh.elements) out << "3 " << e[0] << " " << e[1] << " " << e[2] << "\n";
  return out.str();
}

class BlemSim : public Engine {
 public:
  BlemSim(const StackScene& scene, const std::string& stepper)
      : simulator_(configOf(scene, stepper, TemporaryFolder()), model::UriResolver()) {}
  void step() override { simulator_.step(); }
  std::vector<CubeState> cubes() const override {
    std::vector<CubeState> states;
    for (const sim::ObjectConfig& object : simulator_.config().objects) {
      const int body = simulator_.models()[simulator_.modelIndex(object.name)].bodies[0];
      const dynamics::BodyState& state = simulator_.report().bodies[body];
      states.push_back({state.X_WB.translation(), state.v_WCom});
    }
    return states;
  }
  double layer() const override { return LAYER; }

 private:
  static constexpr double LAYER = 0.0025;

  static sim::SimulationConfig configOf(const StackScene& scene, const std::string& stepper, const TemporaryFolder& folder) {
    sim::SimulationConfig config;
    config.solver.stepper = stepper;
    config.time_step = scene.time_step;
    config.contact.boundary_width = LAYER;
    config.contact.surface.friction = scene.friction;
    sim::EnvironmentConfig ground;
    ground.name = "ground";
    ground.uri = folder.write("ground.off", textOf(scene.ground));
    config.environments = {ground};
    const double size = scene.cube.bounds().sizes().z();
    for (int i = 0; i < scene.cubes; ++i) {
      sim::ObjectConfig cube;
      cube.name = "cube" + std::to_string(i);
      cube.uri = folder.write("cube.off", textOf(scene.cube));
      cube.mass = scene.mass;
      cube.X_WO = makePose({0, 0, 0.5 * size + LAYER + scene.gap + i * (size + 2 * LAYER + scene.gap)});
      config.objects.push_back(cube);
    }
    return config;
  }

  sim::Simulator simulator_;
};

}  // namespace

std::unique_ptr<Engine> makeBlemSimArticulated(const StackScene& scene) { return std::make_unique<BlemSim>(scene, "articulated"); }
std::unique_ptr<Engine> makeBlemSimWorldStep(const StackScene& scene) { return std::make_unique<BlemSim>(scene, "world_step"); }

}  // namespace blem_sim
