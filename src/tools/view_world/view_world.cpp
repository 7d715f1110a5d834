// view_world: pictures of the world of a YAML file, without rviz and without a display.
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "blem_sim/geometry/input_error.h"
#include "picture.h"
#include "run_setup.h"
#include "view_options.h"
#include "virtual_display.h"
#include "world_frames.h"
#include "world_renderer.h"
#include "world_shapes.h"

namespace {

using namespace blem_sim;

enum ExitStatus { DRAWN = 0, FAILED = 1, BAD_INPUT = 2 };

constexpr double WEIGHT_ARROW = 0.25;  // of the camera's distance

void drawWorld(const ViewOptions& options) {
  sim::Simulator simulator(readConfig(options.config, options.settings), model::UriResolver(options.packages));
  std::vector<std::string> notes;
  if (!options.trajectory.empty()) commandTrajectory(options.trajectory, &simulator, &notes);
  for (const std::string& note : notes) std::fprintf(stderr, "view_world: %s\n", note.c_str());
  PictureWriter writer(options);
  const std::vector<WorldFrame> frames = simulateFrames(options, &simulator);

  const Vector3 up = sim::upwards(simulator.gravity());
  const double aspect = static_cast<double>(options.size.width) / options.size.height;
  const ViewCamera camera = options.camera ? *options.camera : framing(worldBox(simulator, frames), up, aspect);
  const double scale = WEIGHT_ARROW * (camera.eye - camera.target).norm();
  const VirtualDisplay display(2 * options.size.width, 2 * options.size.height);
  WorldRenderer renderer(worldShapes(simulator, camera, options.layers), camera, up, options.size);
  for (const WorldFrame& frame : frames)
    writer.add(renderer.draw(frame, options.contacts ? contactShape(simulator, frame.contacts, scale) : DrawnShape()));
  writer.finish();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const ViewOptions options = parseViewOptions(std::vector<std::string>(argv + 1, argv + argc));
    if (options.help) {
      std::fputs(VIEW_USAGE, stdout);
    } else {
      drawWorld(options);
    }
    return DRAWN;
  } catch (const InputError& error) {
    std::fprintf(stderr, "view_world: %s\n", error.what());
    return BAD_INPUT;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "view_world: %s\n", error.what());
    return FAILED;
  }
}
