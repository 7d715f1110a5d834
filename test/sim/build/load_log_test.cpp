// Messages of long loads while they last, and at their end.
#include <algorithm>
#include <atomic>
#include <fstream>
#include <regex>
#include <thread>

#include "blem_sim/geometry/input_error.h"
#include "build/load_watch.h"
#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

using std::chrono::milliseconds;

/** Lines as they come, from whichever thread. */
class Lines {
 public:
  LoadLog log(double interval) {
    return {[this](const std::string& line) {
              const int at_once = ++inside_;
              EXPECT_EQ(at_once, 1);
              lines_.push_back(line);
              --inside_;
            },
            interval};
  }
  int matching(const std::string& pattern) const {
    const std::regex expression(pattern);
    return static_cast<int>(std::count_if(lines_.begin(), lines_.end(), [&](const auto& l) { return std::regex_match(l, expression); }));
  }
  const std::vector<std::string>& all() const { return lines_; }

 private:
  std::vector<std::string> lines_;
  std::atomic<int> inside_{0};
};

SimulationConfig terrain() {
  SimulationConfig config;
  config.environments = {ground()};
  config.environments[0].name = "terrain";
  config.environments[0].uri = meshFile("terrain_of_80000", geometry::gridMesh(4, 4, 200, 200));
  return config;
}

TEST(LoadWatch, TellsTheStageWhileItLastsAndTheSizeAtTheEnd) {
  Lines lines;
  const LoadLog log = lines.log(0.02);
  {
    LoadWatch watch(log, "terrain");
    watch.progress()("reading t.ply", 0);
    std::this_thread::sleep_for(milliseconds(100));
    watch.enter("mending t.ply", 0.5);
    std::this_thread::sleep_for(milliseconds(100));
    watch.loaded("12 triangles, 0.1 MB");
  }
  EXPECT_GE(lines.matching("loading terrain: reading t\\.ply, 0 % done, 0\\.\\d s so far"), 1);
  EXPECT_GE(lines.matching("loading terrain: mending t\\.ply, 50 % done, 0\\.\\d s so far"), 1);
  EXPECT_EQ(lines.matching("loaded terrain: 12 triangles, 0\\.1 MB, \\d\\.\\d s"), 1);
  EXPECT_EQ(lines.all().back().rfind("loaded terrain", 0), 0u);
}

TEST(LoadWatch, AShortLoadAndNobodyWhoListensAreSilent) {
  Lines lines;
  const LoadLog log = lines.log(1000), nobody;
  for (int i = 0; i < 50; ++i) {
    LoadWatch watch(log, "cube");
    watch.enter("reading", 0);
    if (i % 2 == 0) watch.loaded("12 triangles");
  }
  EXPECT_TRUE(lines.all().empty());
  LoadWatch unheard(nobody, "cube");
  unheard.loaded("12 triangles");
}

TEST(LoadLog, ALongLoadTellsItsProgressAndMemory) {
  Lines lines;
  Simulator simulator(terrain(), model::UriResolver(), lines.log(1e-4));
  EXPECT_GE(lines.matching("loading terrain: (reading|cleaning|mending) terrain_of_80000\\.off, \\d+ % done, .*"), 1);
  EXPECT_GE(lines.matching("loading terrain: topology and tree of terrain_of_80000, 70 % done, .*"), 1);
  const double megabytes = static_cast<double>(simulator.loadReport()[0].bytes) / 1e6;
  EXPECT_GT(megabytes, 80000 * 40e-6);
  EXPECT_LT(megabytes, 80000 * 90e-6);
  char size[40];
  std::snprintf(size, sizeof size, "%.1f MB", megabytes);
  EXPECT_EQ(lines.matching("loaded terrain: 80000 triangles, " + std::string(size) + ", \\d\\.\\d s"), 1);
  EnvironmentConfig added = terrain().environments[0];
  added.name = "later";
  added.scale = Vector3::Constant(2);
  simulator.loadEnvironment(added);
  simulator.unloadEnvironment("terrain");
  added.name = "last";
  added.scale = Vector3::Constant(3);
  simulator.loadEnvironment(added);
  for (const char* name : {"later", "last"}) EXPECT_EQ(lines.matching(std::string("loaded ") + name + ": 80000 triangles, .*"), 1);
}

TEST(LoadLog, RobotsAndObjectsAreTold) {
  Lines lines;
  SimulationConfig config = terrain();
  const std::string file = config.environments[0].uri;
  config.environments.clear();
  config.objects = {box("mat", Vector3::Constant(0.1), 1, {0, 0, 3})};
  config.objects[0].uri = file;
  config.robots = {robot("rover",
                         "<robot name='rover'><link name='base'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' "
                         "ixz='0' iyz='0'/></inertial><collision><geometry><mesh filename='" +
                             file + "'/></geometry></collision></link></robot>",
                         false)};
  const Simulator simulator(config, model::UriResolver(), lines.log(1e-4));
  EXPECT_GE(lines.matching("loading rover: reading link 'base', 0 % done, .*"), 1);
  for (const char* name : {"rover", "mat"}) EXPECT_EQ(lines.matching(std::string("loaded ") + name + ": 80000 triangles, .* MB, .*"), 1);
}

TEST(LoadLog, ALoadThatFailsInTheMiddleSaysWhereAndTellsNoMore) {
  Lines lines;
  Simulator simulator(terrain(), model::UriResolver(), lines.log(1e-4));
  const std::size_t before = lines.all().size(), reports = simulator.loadReport().size();
  EnvironmentConfig broken = terrain().environments[0];
  broken.name = "broken";
  // All triangles are read and found to be without area.
  geometry::TriangleMesh line = geometry::gridMesh(4, 4, 200, 200);
  for (Vector3& v : line.vertices) v.y() = v.z() = 0;
  broken.uri = meshFile("terrain_without_area", line);
  EXPECT_THROW(simulator.loadEnvironment(broken), InputError);
  const std::size_t after = lines.all().size();
  EXPECT_GT(after, before + 1);
  EXPECT_EQ(lines.matching("loading broken: given up after \\d\\.\\d s, (reading|cleaning|mending) terrain_without_area\\.off"), 1);
  EXPECT_EQ(lines.matching("loaded broken.*"), 0);
  EXPECT_EQ(lines.all().back().rfind("loading broken: given up", 0), 0u);
  std::this_thread::sleep_for(milliseconds(20));
  EXPECT_EQ(lines.all().size(), after);
  EXPECT_EQ(simulator.loadReport().size(), reports);
  simulator.step();
}

}  // namespace
}  // namespace blem_sim::sim
