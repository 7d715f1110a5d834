// make_demo_scenes OUT_DIR: writes the meshes and clouds of the demos. The same files on every run.
#include <cstdio>
#include <exception>
#include <string>

#include "mesh_files.h"
#include "room_scene.h"
#include "shells.h"

using namespace blem_sim;
using namespace blem_sim::demo;

namespace {

void report(const std::string& file, std::size_t count, const char* what) { std::printf("%s: %zu %s\n", file.c_str(), count, what); }

void saveStl(const std::string& folder, const std::string& name, const geometry::TriangleMesh& mesh) {
  writeStl(folder + "/" + name + ".stl", mesh);
  report(name + ".stl", mesh.elements.size(), "triangles");
}

void makeScenes(const std::string& folder) {
  const Scene floor = workshopFloor();
  const geometry::TriangleMesh scan = scannedFloor(floor);
  writePly(folder + "/scanned_floor.ply", scan);
  report("scanned_floor.ply", scan.elements.size(), "triangles");
  const std::vector<Vector3> points = scannedFloorPoints(floor);
  writePcd(folder + "/scanned_floor.pcd", points);
  report("scanned_floor.pcd", points.size(), "points");

  saveStl(folder, "shell_mug", shellMug());
  saveStl(folder, "cube_10cm", geometry::subdivided(geometry::boxMesh(Vector3::Constant(0.1)), 2));
  saveStl(folder, "ground_2m", geometry::gridMesh(2, 2, 8, 8));
  for (const NamedMesh& part : humanoidShells()) saveStl(folder, std::string("humanoid_") + part.name, part.mesh);
  for (const NamedMesh& part : gripperShells()) saveStl(folder, part.name, part.mesh);
  for (const NamedMesh& part : watcherShells()) saveStl(folder, part.name, part.mesh);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: make_demo_scenes OUT_DIR\n");
    return 2;
  }
  try {
    makeScenes(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "make_demo_scenes: %s\n", error.what());
    return 2;
  }
  return 0;
}
