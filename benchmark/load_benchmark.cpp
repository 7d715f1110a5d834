// Loading a surface of about a million triangles: every stage alone, welding + topology + tree together, and whole files, on one thread and
// on two. Wall and processor time, the least of some repetitions; counters: triangles and bytes that stay per triangle. Arguments: Google
// Benchmark's.
#include <benchmark/benchmark.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>

#include "blem_sim/contact/collider.h"
#include "blem_sim/geometry/mesh_mending.h"
#include "blem_sim/model/loaders.h"
#include "geometry/random_shapes.h"

namespace blem_sim {
namespace {

constexpr int CELLS = 708, REPETITIONS = 5;  // 1,002,528 triangles
constexpr double SIZE = 3, NOISE = 2.5e-4;   // [m]

/** An open grid with noise: nothing in it is flat, nothing has to be mended. */
const geometry::TriangleMesh& terrain() {
  static const geometry::TriangleMesh mesh = [] {
    geometry::RandomShapes random(5);
    geometry::TriangleMesh grid = geometry::gridMesh(SIZE, SIZE, CELLS, CELLS);
    for (Vector3& v : grid.vertices) v.z() = random.uniform(-NOISE, NOISE);
    return grid;
  }();
  return mesh;
}

/** The same as an STL has it: every triangle with corners of its own. */
const geometry::TriangleMesh& soup() {
  static const geometry::TriangleMesh mesh = [] {
    geometry::TriangleMesh soup;
    for (const Vector3i& e : terrain().elements) {
      const int first = static_cast<int>(soup.vertices.size());
      for (int k = 0; k < 3; ++k) soup.vertices.push_back(terrain().vertices[e[k]]);
      soup.elements.emplace_back(first, first + 1, first + 2);
    }
    return soup;
  }();
  return mesh;
}

template <typename T>
void put(std::ofstream* stream, const T& value) {
  stream->write(reinterpret_cast<const char*>(&value), sizeof value);
}

void writePly(const std::string& file) {
  std::ofstream stream(file, std::ios::binary);
  stream << "ply\nformat binary_little_endian 1.0\nelement vertex " << terrain().vertices.size()
         << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << terrain().elements.size()
         << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vector3& v : terrain().vertices)
    for (int k = 0; k < 3; ++k) put(&stream, static_cast<float>(v[k]));
  for (const Vector3i& e : terrain().elements) {
    put(&stream, std::uint8_t{3});
    for (int k = 0; k < 3; ++k) put(&stream, static_cast<std::int32_t>(e[k]));
  }
}

void writeStl(const std::string& file) {
  std::ofstream stream(file, std::ios::binary);
  stream << std::string(80, ' ');
  put(&stream, static_cast<std::uint32_t>(terrain().elements.size()));
  for (const Vector3i& e : terrain().elements) {
    for (int k = 0; k < 3; ++k) put(&stream, 0.0f);
    for (int corner = 0; corner < 3; ++corner)
      for (int k = 0; k < 3; ++k) put(&stream, static_cast<float>(terrain().vertices[e[corner]][k]));
    put(&stream, std::uint16_t{0});
  }
}

/** A file that goes with the program. */
class TemporaryFile {
 public:
  TemporaryFile(const std::string& name, void (*write)(const std::string&))
      : path_((std::filesystem::temp_directory_path() / ("blem_sim_" + name)).string()) {
    write(path_);
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

void weldTopologyTree(const geometry::TriangleMesh& given) {
  const geometry::TriangleMesh mesh = geometry::cleanMesh(given, nullptr);
  const geometry::MeshTopology topology(mesh);
  const geometry::Bvh tree(mesh);
  benchmark::DoNotOptimize(tree.nodes().data());
}

/** A table has the same columns in every row. @param kept null: nothing */
void count(benchmark::State* state, std::size_t triangles, const contact::CollisionGeometry* kept) {
  const auto perTriangle = [&](const char* part, std::size_t bytes) {
    state->counters[part] = kept ? static_cast<double>(bytes) / static_cast<double>(triangles) : std::numeric_limits<double>::quiet_NaN();
  };
  perTriangle("bytes_per_triangle", kept ? kept->bytes() : 0);
  perTriangle("of_mesh", kept ? kept->mesh().bytes() : 0);
  perTriangle("of_topology", kept ? kept->topology().bytes() : 0);
  perTriangle("of_tree", kept ? kept->bvh().bytes() + kept->owners().capacity() : 0);
  state->counters["triangles"] = static_cast<double>(triangles);
}

/** One row per number of threads. */
void add(const std::string& name, std::function<void()> work) {
  for (const int threads : {1, 2}) {
    benchmark::RegisterBenchmark(("loading/" + name + "/threads:" + std::to_string(threads)).c_str(),
                                 [work, threads](benchmark::State& state) {
                                   tbb::task_arena arena(threads);
                                   for (auto _ : state) arena.execute(work);
                                   count(&state, terrain().elements.size(), nullptr);
                                 })
        ->Unit(benchmark::kMillisecond)
        ->Iterations(1)
        ->Repetitions(REPETITIONS)
        ->ReportAggregatesOnly()
        ->ComputeStatistics("least", [](const std::vector<double>& v) { return *std::min_element(v.begin(), v.end()); })
        ->MeasureProcessCPUTime()
        ->UseRealTime();
  }
}

void addFile(const std::string& name, const std::string& file) {
  add(name + "_to_ready", [file] {
    const model::LoadedSurface surface = model::loadSurface(file);
    contact::CollisionGeometry(surface.mesh, surface.topology);
  });
  add(name + "_read_and_mended", [file] { model::loadSurface(file); });
  add(name + "_as_it_is", [file] { model::loadSurface(file, Vector3::Ones(), {}, model::Mending::OFF); });
}

/** Memory that stays after loading, per triangle, by parts. */
void addMemory(const std::string& name, const std::function<geometry::TriangleMesh()>& surface) {
  benchmark::RegisterBenchmark(("loading/memory_" + name).c_str(),
                               [surface](benchmark::State& state) {
                                 const auto mesh = std::make_shared<const geometry::TriangleMesh>(surface());
                                 std::unique_ptr<contact::CollisionGeometry> geometry;
                                 for (auto _ : state) geometry = std::make_unique<contact::CollisionGeometry>(mesh);
                                 count(&state, mesh->elements.size(), geometry.get());
                               })
      ->Unit(benchmark::kMillisecond)
      ->Iterations(1);
}

geometry::TriangleMesh roughBall() {
  geometry::RandomShapes random(6);
  geometry::TriangleMesh ball = geometry::icosphereMesh(1, 8);
  for (Vector3& v : ball.vertices) v *= 1 + random.uniform(-NOISE, NOISE);
  return ball;
}

}  // namespace
}  // namespace blem_sim

int main(int argc, char** argv) {
  using namespace blem_sim;
  const TemporaryFile ply_file("terrain.ply", writePly), stl_file("terrain.stl", writeStl);
  const std::string ply = ply_file.path(), stl = stl_file.path();
  add("weld_topology_tree", [] { weldTopologyTree(terrain()); });
  add("weld_topology_tree_of_soup", [] { weldTopologyTree(soup()); });
  add("weld", [] { geometry::cleanMesh(terrain(), nullptr); });
  add("weld_soup", [] { geometry::cleanMesh(soup(), nullptr); });
  add("mend", [] { geometry::mendMesh(terrain(), nullptr); });
  add("topology", [] { geometry::MeshTopology topology(terrain()); });
  add("tree", [] { geometry::Bvh tree(terrain()); });
  add("collision_geometry", [] { contact::CollisionGeometry(std::make_shared<const geometry::TriangleMesh>(terrain())); });
  addFile("ply", ply);
  addFile("stl", stl);
  addMemory("terrain", [] { return geometry::cleanMesh(terrain(), nullptr); });
  addMemory("ball", [] { return geometry::cleanMesh(roughBall(), nullptr); });
  addMemory("gridded_box", [] { return geometry::cleanMesh(geometry::subdivided(geometry::boxMesh({1, 1, 1}), 8), nullptr); });
  addMemory("ply", [ply] { return *model::loadSurface(ply).mesh; });
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
