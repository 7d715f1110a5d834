// Pairs searched at once.
#include <algorithm>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "contacts/search/pair_searches.h"
#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

SimulationConfig heap(int threads) {
  SimulationConfig config;
  config.solver.threads = threads;
  config.environments = {ground()};
  for (int i = 0; i < 12; ++i) {
    config.objects.push_back(box("box" + std::to_string(i), {0.1, 0.08, 0.06}, 1, {0.06 * (i % 3), 0.07 * (i % 2), 0.05 + 0.08 * i}));
    config.objects.back().X_WO = config.objects.back().X_WO * makePose(Vector3::Zero(), {0.1 * i, 0.2, 0.3 * i});
  }
  return config;
}

TEST(PairSearches, AnyNumberOfThreadsGivesTheSameBits) {
  Simulator one(heap(1), model::UriResolver()), three(heap(3), model::UriResolver());
  stepFor(&one, 0.6);
  stepFor(&three, 0.6);
  EXPECT_GT(one.report().contacts.size(), 5u);
  EXPECT_EQ(one.stateHash(), three.stateHash());
}

// Memories of searches are no part of it.
TEST(PairSearches, AStateRestoredElsewhereGoesOnTheSame) {
  Simulator first(heap(1), model::UriResolver()), second(heap(1), model::UriResolver());
  stepFor(&first, 0.4);
  second.restore(first.save());
  stepFor(&first, 0.2);
  stepFor(&second, 0.2);
  EXPECT_EQ(first.stateHash(), second.stateHash());
}

constexpr double THIN_LAYER = 0.0001;  // [m] of each collider

void addMesh(geometry::TriangleMesh mesh, int body, SimulatedWorld* world) {
  contact::Collider collider;
  collider.name = body == dynamics::WORLD_BODY ? "sheet" : "box";
  collider.body = body;
  collider.model = world->addModel(collider.name, ModelKind::OBJECT, 20);
  collider.geometry = std::make_shared<const contact::CollisionGeometry>(std::make_shared<const geometry::TriangleMesh>(std::move(mesh)));
  world->addCollider(collider, THIN_LAYER, {}, {});
}

void addBox(double width, const Vector3& place, SimulatedWorld* world) {
  dynamics::BodySpec spec;
  spec.inertial = {1, Vector3::Zero(), Matrix3::Identity()};
  spec.X_WB.translation() = place;
  addMesh(geometry::boxMesh(Vector3::Constant(width)), world->world.addBody(spec), world);
}

/** Adds a box and a sheet through its middle. */
void addCrossing(SimulatedWorld* world) {
  addMesh(geometry::gridMesh(1, 1, 1, 1), dynamics::WORLD_BODY, world);
  addBox(0.1, Vector3::Zero(), world);
}

// At 8 m/s two boxes of a millimetre would see all of each other, and thousands of contacts where meshes are rough.
TEST(PairSearches, SmallThingsLookNoFartherThanTheirLength) {
  for (const double width : {0.001, 0.1}) {
    SimulatedWorld world(Vector3::Zero(), dynamics::SolverSettings());
    addBox(width, Vector3::Zero(), &world);
    addBox(width, Vector3(0, 0, width + 0.003), &world);
    std::vector<dynamics::BodyState> bodies;
    world.bodyStates(&bodies);
    bodies[1].v_WCom.z() = -8;
    StepThreads threads(1);
    PairWatch watch(&threads);
    WatchedPairs pairs;
    watch.find({world, bodies, nullptr, 0.001}, &pairs);
    ASSERT_EQ(pairs.pairs.size(), 1u);
    EXPECT_NEAR(pairs.pairs[0].known, std::min(width + 2 * THIN_LAYER, 0.005), 1e-12);
  }
}

TEST(PairSearches, APairWhosePiercedContactsHaveFadedAwayStillCrosses) {
  SimulatedWorld world(Vector3::Zero(), dynamics::SolverSettings());
  addCrossing(&world);
  std::vector<dynamics::BodyState> bodies;
  world.bodyStates(&bodies);
  FadingPoints fading;
  constexpr double AWAY = std::numeric_limits<double>::infinity();
  fading.add(0, -THIN_LAYER, {{0, AWAY}, {1, AWAY}, {2, AWAY}, {3, AWAY}});
  StepThreads threads(1);
  PairWatch watch(&threads);
  PairSearches searches(&threads);
  WatchedPairs pairs;
  FoundContacts before, found;
  watch.find({world, bodies, nullptr, 0.001}, &pairs);
  searches.find(world, before, fading, &pairs, &found);
  EXPECT_TRUE(found.manifolds.empty());
  EXPECT_NE(found.crossings.find(0, 1), nullptr);
  fading.addCrossing(0, 1);
  watch.find({world, bodies, nullptr, 0.001}, &pairs);
  searches.find(world, before, fading, &pairs, &found);
  EXPECT_TRUE(found.crossings.empty()) << "crossed when the sheet came";
}

}  // namespace
}  // namespace blem_sim::sim
