#include "contact_scenes.h"

#include <cmath>

#include "blem_sim/model/loaders.h"
#include "blem_sim/model/robot_model.h"
#include "contact/contact_shapes.h"
#include "support/shared_data.h"
#include "support/shared_packages.h"

namespace blem_sim {
namespace {

constexpr double LAYER = 0.0025, NOISE = 2.5e-4, CLEARANCE = 2e-4, SIZE = 3;  // [m]
constexpr double DT = 1e-3;                                                   // [s]
constexpr double TURN_RATE = 31.4159265358979312;                             // [rad/s] 5 Hz
const char* const MUG = "meshes/klampt/object_srimugsmooth.stl";
const char* const FRACTAL = "meshes/klampt/terrain_fractal_terrain_1.stl";

/** Translation and a small turn, different for every collider. */
Pose oscillation(int collider, int step) {
  const double phase = TURN_RATE * DT * step + 1.7 * collider, reach = SCENE_SPEED / TURN_RATE;
  const Vector3 direction = Vector3(std::cos(2.1 * collider), std::sin(2.1 * collider), 0.05).normalized();
  return makePose(reach * std::sin(phase) * direction, {0, 0, 0.01 * std::sin(phase)});
}

/** Pose of a collider that oscillates about its own middle, where it stands. */
Pose moved(const Pose& X, const Vector3& middle, int collider, int step) {
  const Pose about = makePose(X * middle);
  return about * oscillation(collider, step) * about.inverse() * X;
}

void raise(const std::vector<Box>& raised, geometry::TriangleMesh* mesh) {
  for (Vector3& v : mesh->vertices) {
    for (const Box& patch : raised)
      if ((v.head<2>().array() > patch.min().head<2>().array()).all() && (v.head<2>().array() < patch.max().head<2>().array()).all())
        v.z() += patch.min().z() - NOISE - CLEARANCE;
  }
}

geometry::TriangleMesh noisyGrid(int triangles) {
  geometry::RandomShapes random(5);
  const int cells = static_cast<int>(std::lround(std::sqrt(0.5 * triangles)));
  geometry::TriangleMesh mesh = geometry::gridMesh(SIZE, SIZE, cells, cells);
  for (Vector3& v : mesh.vertices) v.z() = random.uniform(-NOISE, NOISE);
  return mesh;
}

/** Noise in [-1, 1), the same for a place of the grid however large the grid is. */
double noiseAt(int i, int j) {
  const std::int64_t row = i, column = j;
  return geometry::RandomShapes(static_cast<std::uint64_t>(row * 1000003 + column)).uniform(-1, 1);
}

/** A grid of about as many triangles as asked for, `cell` [m] wide: the middle of a larger grid is a smaller one, to the last bit. */
geometry::TriangleMesh growingGrid(int triangles, double cell) {
  const int cells = 2 * static_cast<int>(std::lround(0.5 * std::sqrt(0.5 * triangles)));
  geometry::TriangleMesh mesh = geometry::gridMesh(cells, cells, cells, cells);
  for (Vector3& v : mesh.vertices) {
    const int i = static_cast<int>(std::lround(v.x())), j = static_cast<int>(std::lround(v.y()));
    v = {cell * i, cell * j, NOISE * noiseAt(i, j)};
  }
  return mesh;
}

geometry::TriangleMesh pointsOf(geometry::TriangleMesh mesh) {
  mesh.elements.clear();
  for (int i = 0; i < static_cast<int>(mesh.vertices.size()); ++i) mesh.elements.push_back({i, i, i});
  return mesh;
}

Box boundsOf(const geometry::TriangleMesh& mesh, const Pose& X) {
  Box box;
  for (const Vector3& v : mesh.vertices) box.extend(X * v);
  return box;
}

struct PosedLink {
  std::string name;
  std::shared_ptr<const geometry::TriangleMesh> mesh;
  Pose X_WL;
};

/** The links at zero joint angles, the lowest vertex of the robot just above the noise. */
std::vector<PosedLink> huboLinks() {
  const model::RobotModel robot =
      model::loadUrdfFile(*sharedData("robots/klampt/huboplus/huboplus.urdf"), model::UriResolver(sharedPackages()));
  std::vector<Pose> X_WL(robot.links.size(), Pose::Identity());
  for (const model::JointModel& joint : robot.joints) X_WL[joint.child] = X_WL[joint.parent] * joint.X_PJ;
  std::vector<PosedLink> links;
  Box all;
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    for (const model::CollisionShape& shape : robot.links[i].collisions) {
      links.push_back({robot.links[i].name, shape.mesh, X_WL[i]});
      all.extend(boundsOf(*shape.mesh, X_WL[i]));
    }
  }
  for (PosedLink& link : links) link.X_WL.pretranslate(Vector3(-all.center().x(), -all.center().y(), NOISE + CLEARANCE - all.min().z()));
  return links;
}

geometry::TriangleMesh loadedMesh(const char* file) {
  return *model::loadSurface(*sharedData(file), Vector3::Ones(), model::CloudOptions()).mesh;
}

/** @param terrain raised under the hands here; @param points its vertices alone */
std::unique_ptr<ContactScene> huboOn(geometry::TriangleMesh terrain, bool points) {
  auto scene = std::make_unique<ContactScene>();
  scene->name = "hubo on " + std::to_string(terrain.elements.size());
  const std::vector<PosedLink> links = huboLinks();
  std::vector<Box> raised;
  for (const PosedLink& link : links)
    if (link.name.find("Hand") != std::string::npos || link.name.find("Finger") != std::string::npos)
      raised.push_back(boundsOf(*link.mesh, link.X_WL));
  raise(raised, &terrain);
  scene->standing = contact::makeCollider(points ? pointsOf(std::move(terrain)) : std::move(terrain), 0);
  std::vector<Pose> poses;
  std::vector<Vector3> middles;
  for (const PosedLink& link : links) {
    scene->moving.push_back(contact::makeCollider(*link.mesh, LAYER));
    poses.push_back(link.X_WL);
    middles.push_back(link.mesh->bounds().center());
  }
  scene->pose = [poses, middles](int collider, int step) { return moved(poses[collider], middles[collider], collider, step); };
  return scene;
}

std::unique_ptr<ContactScene> boxOn(geometry::TriangleMesh terrain, const Vector3& size) {
  auto scene = std::make_unique<ContactScene>();
  scene->name = "box on " + std::to_string(terrain.elements.size());
  scene->standing = contact::makeCollider(std::move(terrain), 0);
  scene->moving = {contact::makeCollider(geometry::boxMesh(size), LAYER)};
  const Vector3 centre(0.01, 0.02, 0.5 * size.z() + NOISE + CLEARANCE);
  scene->pose = [centre](int collider, int step) { return moved(makePose(centre), Vector3::Zero(), collider, step); };
  return scene;
}

constexpr double HUBO_CELL = 0.01, CUBE_CELL = 0.0075, SLAB_CELL = 0.01;             // [m]
const Vector3 CUBE = Vector3::Constant(0.183), SMALL_CUBE = Vector3::Constant(0.1);  // [m]

bool haveHubo() { return sharedData("robots/klampt/huboplus/huboplus.urdf").has_value(); }

}  // namespace

std::unique_ptr<ContactScene> huboOnTerrain(int triangles, bool points) {
  return haveHubo() ? huboOn(noisyGrid(triangles), points) : nullptr;
}

std::unique_ptr<ContactScene> huboOnGrowingTerrain(int triangles) {
  return haveHubo() ? huboOn(growingGrid(triangles, HUBO_CELL), false) : nullptr;
}

std::unique_ptr<ContactScene> cubeOnTerrain(int triangles) { return boxOn(noisyGrid(triangles), CUBE); }

std::unique_ptr<ContactScene> cubeOnGrowingTerrain(int triangles) { return boxOn(growingGrid(triangles, CUBE_CELL), SMALL_CUBE); }

std::unique_ptr<ContactScene> slabOnTerrain(int contacts) {
  const double cells = std::sqrt(contacts), beside = 10;
  const Vector3 slab(SLAB_CELL * cells, SLAB_CELL * cells, 0.05);
  return boxOn(growingGrid(static_cast<int>(2 * (cells + beside) * (cells + beside)), SLAB_CELL), slab);
}

std::unique_ptr<ContactScene> mugOnFractalTerrain(int triangles) {
  if (!sharedData(MUG) || !sharedData(FRACTAL)) return nullptr;
  auto scene = std::make_unique<ContactScene>();
  geometry::TriangleMesh terrain = loadedMesh(FRACTAL);
  int level = 0;
  while ((terrain.elements.size() << 2 * (level + 1)) <= 1.1 * triangles) ++level;
  scene->standing = contact::makeCollider(geometry::subdivided(terrain, level), 0);
  scene->name = "mug on fractal " + std::to_string(scene->standing.geometry->mesh().elements.size());
  const geometry::TriangleMesh mug = loadedMesh(MUG);
  scene->moving = {contact::makeCollider(mug, LAYER)};
  // The body is lowered until the layers overlap by half.
  Pose X = makePose({0.3, 0.2, 2});
  for (double step = 1; step > 1e-5; step *= 0.5) {
    X.translation().z() -= step;
    if (contact::contactsOf(scene->moving[0], X, scene->standing, Pose::Identity(), 0).maxDepth() > 0.5 * LAYER)
      X.translation().z() += step;
  }
  const Vector3 middle = mug.bounds().center();
  scene->pose = [X, middle](int collider, int step) { return moved(X, middle, collider, step); };
  return scene;
}

std::unique_ptr<ContactScene> mugBesideMug() {
  if (!sharedData(MUG)) return nullptr;
  auto scene = std::make_unique<ContactScene>();
  scene->name = "mug beside mug";
  const geometry::TriangleMesh mug = loadedMesh(MUG);
  scene->standing = contact::makeCollider(mug, LAYER);
  scene->moving = {contact::makeCollider(mug, LAYER)};
  scene->approach = -Vector3::UnitY();
  const Pose X = makePose({0, mug.bounds().sizes().y() + 0.002, 0});
  const Vector3 middle = mug.bounds().center();
  scene->pose = [X, middle](int, int step) {
    const double along = SCENE_SPEED / TURN_RATE * std::sin(TURN_RATE * DT * step);
    return Pose(Eigen::Translation3d(0.7 * along, 0, 0.7 * along) * X * makePose(middle) * makePose(Vector3::Zero(), {0, 0, 0.01 * along}) *
                makePose(-middle));
  };
  return scene;
}

}  // namespace blem_sim
