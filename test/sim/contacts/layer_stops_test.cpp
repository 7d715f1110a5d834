// Soft layers that are nearly used up: a spring up to the stop, and no deeper whatever the load.
#include <algorithm>
#include <cmath>

#include "contacts/constraints/layer_stops.h"
#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

constexpr double STOP_LAYER = 0.0025;                   // [m] of a box on the ground
constexpr double STOP = LayerStops::STOP * STOP_LAYER;  // [m]
constexpr double STIFFNESS = 1e4, DAMPING = 200;        // of a box, per contact
constexpr double BEARS = 4 * STIFFNESS * STOP;          // [N] load that four corners bear as springs

void soften(ObjectConfig* object, double damping = DAMPING) {
  object->contact.stiffness = STIFFNESS;
  object->contact.damping = damping;
}

/** A soft cube on rigid ground, its layer touching. */
SimulationConfig softCube(double mass, const std::string& stepper = "articulated") {
  SimulationConfig config;
  config.solver.stepper = stepper;
  config.environments = {ground()};
  config.objects = {box("cube", Vector3::Constant(0.1), mass, {0, 0, 0.05 + STOP_LAYER})};
  soften(&config.objects[0]);
  return config;
}

double depthOf(const Simulator& simulator) { return 0.05 + STOP_LAYER - bodyOf(simulator, "cube").X_WB.translation().z(); }

Vector3 forceOn(const Simulator& simulator) {
  Vector3 sum = Vector3::Zero();
  for (const ContactReport& contact : simulator.report().contacts)
    sum += (simulator.bodyName(contact.body_a) == "world" ? -1 : 1) * contact.force;
  return sum;
}

/** Largest share of a layer that was used up, and whether meshes crossed, while it runs. */
struct Press {
  double max_of_layer = 0;
  bool unreliable = false;
};

Press press(Simulator* simulator, double seconds) {
  Press press;
  const long steps = std::lround(seconds / simulator->config().time_step);
  for (long i = 0; i < steps; ++i) {
    const StepReport& report = simulator->step();
    press.max_of_layer = std::max(press.max_of_layer, report.max_of_layer);
    press.unreliable = press.unreliable || (report.status & CONTACT_UNRELIABLE);
  }
  return press;
}

class LayerStop : public testing::TestWithParam<const char*> {};

TEST_P(LayerStop, DepthAtRestIsTheSpringsUpToTheStopAndNoMoreBeyond) {
  for (const double load : {0.1, 0.7, 0.99, 1.01, 2.0, 30.0}) {
    Simulator simulator(softCube(load * BEARS / G, GetParam()), model::UriResolver());
    const Press pressed = press(&simulator, 2);
    EXPECT_NEAR(depthOf(simulator), std::min(1.0, load) * STOP, 2e-3 * STOP) << load;
    EXPECT_LT(pressed.max_of_layer, LayerStops::STOP + 0.02) << load;
    EXPECT_FALSE(pressed.unreliable) << load;
    EXPECT_NEAR(forceOn(simulator).z() / (load * BEARS), 1, 1e-4) << load;
    EXPECT_LT(bodyOf(simulator, "cube").v_WCom.norm(), 1e-4) << load;
    for (const ContactReport& contact : simulator.report().contacts) {
      EXPECT_NEAR(contact.depth, depthOf(simulator), 1e-5);
      EXPECT_NEAR(contact.of_layer, contact.depth / STOP_LAYER, 1e-9);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Steppers, LayerStop, testing::Values("articulated", "world_step", "quick_step"));

TEST(LayerStops, RestIsAsExactAsThatOfRigidContacts) {
  Simulator simulator(softCube(10 * BEARS / G), model::UriResolver());
  stepFor(&simulator, 1);
  const Vector3 before = bodyOf(simulator, "cube").X_WB.translation();
  stepFor(&simulator, 1);
  EXPECT_NEAR(depthOf(simulator), STOP, 1e-9);
  EXPECT_LT((bodyOf(simulator, "cube").X_WB.translation() - before).norm(), 1e-9);
}

/** A manifold of `count` contacts on a circle, all of one depth. */
contact::ContactManifold ringOf(int count, double depth) {
  contact::ContactManifold ring;
  ring.a = 3;
  ring.b = 5;
  ring.layer = STOP_LAYER;
  ring.contacts.resize(count);
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * M_PI * i / count;
    ring.contacts[i].point = {0.05 * std::cos(angle), 0.05 * std::sin(angle), 0};
    ring.contacts[i].normal_BA = Vector3::UnitZ();
    ring.contacts[i].depth = depth;
    ring.contacts[i].id = i;
  }
  return ring;
}

std::vector<std::uint64_t> wordsOf(const LayerStops& stops) {
  geometry::StateContent content;
  geometry::StateWriter writer(&content);
  stops.save(&writer);
  return content.words;
}

void restore(const std::vector<std::uint64_t>& words, LayerStops* stops) {
  const geometry::StateContent content{{}, words};
  geometry::StateReader reader(content);
  stops->restore(std::vector<contact::Collider>(10), &reader);
  reader.finish();
}

TEST(LayerStops, NothingIsAddedWhereLayersAreNotUsedUp) {
  Simulator simulator(softCube(0.7 * BEARS / G), model::UriResolver());
  stepFor(&simulator, 1);
  EXPECT_EQ(simulator.report().contacts.size(), 4u);
  LayerStops stops;
  reduction::ReductionWorkspace workspace;
  stops.start();
  EXPECT_TRUE(stops.choose(ringOf(40, LayerStops::SEEN * STOP_LAYER), *reduction::findReduction("hull"), &workspace).empty());
  stops.remember();
  EXPECT_TRUE(wordsOf(stops).empty());
}

TEST(LayerStops, GoOnWithWhatTheyChoseEvenIfRestored) {
  reduction::ReductionWorkspace workspace;
  const auto choose = [&workspace](LayerStops* stops, const contact::ContactManifold& manifold) {
    stops->start();
    reduction::ContactIds ids;
    for (const contact::Contact& contact : stops->choose(manifold, *reduction::findReduction("hull"), &workspace))
      ids.push_back(contact.id);
    stops->remember();
    return ids;
  };
  LayerStops stops, restored, other;
  const reduction::ContactIds first = choose(&stops, ringOf(40, STOP));
  EXPECT_EQ(first.size(), static_cast<std::size_t>(LayerStops::MOST));
  const std::vector<std::uint64_t> words = wordsOf(stops);
  ASSERT_FALSE(words.empty());
  restore(words, &restored);
  EXPECT_EQ(wordsOf(restored), words);
  contact::ContactManifold trembled = ringOf(40, STOP);
  for (int i = 0; i < 40; i += 3) trembled.contacts[i].point *= 1 + 5e-3;
  EXPECT_EQ(choose(&stops, trembled), first);
  EXPECT_EQ(choose(&restored, trembled), first);
  EXPECT_NE(choose(&other, trembled), first);
  EXPECT_THROW(restore({words.begin(), words.end() - 1}, &restored), InputError);
  EXPECT_THROW(restore({0}, &restored), InputError);
}

TEST(LayerStops, FrictionBelongsToAllThatIsBorne) {
  for (const double slope : {0.9, 1.2}) {  // of the friction angle's tangent
    SimulationConfig config = softCube(3 * BEARS / G);
    const double angle = std::atan(slope * 0.5);
    config.gravity = G * Vector3(std::sin(angle), 0, -std::cos(angle));
    Simulator simulator(config, model::UriResolver());
    stepFor(&simulator, 0.2);
    const double before = bodyOf(simulator, "cube").v_WCom.x();
    stepFor(&simulator, 0.1);
    const double rate = (bodyOf(simulator, "cube").v_WCom.x() - before) / 0.1;
    EXPECT_NEAR(rate, std::max(0.0, G * (std::sin(angle) - 0.5 * std::cos(angle))), 1e-3 * G) << slope;
  }
}

TEST(LayerStops, AnImpactThatBottomsOutGainsNothing) {
  SimulationConfig config = softCube(0.2 * BEARS / G);
  soften(&config.objects[0], 1);
  config.objects[0].X_WO = makePose({0, 0, 0.05 + STOP_LAYER + 0.05});
  Simulator simulator(config, model::UriResolver());
  double gained = 0, deepest = 0, highest = -1;
  for (int i = 0; i < 2000; ++i) {
    const StepReport& report = simulator.step();
    gained += report.energy_gained;
    deepest = std::max(deepest, report.max_of_layer);
    if (simulator.time() > 0.15) highest = std::max(highest, -depthOf(simulator));
  }
  EXPECT_GT(deepest, LayerStops::STOP);
  EXPECT_LT(deepest, 1);
  EXPECT_LT(highest, 0.05);
  EXPECT_LT(gained, 1e-3 * config.objects[0].mass.value() * G * 0.05);
}

TEST(LayerStops, ATowerUnderAPressDoesNotCross) {
  SimulationConfig config = softCube(0.1);
  config.objects.push_back(box("second", Vector3::Constant(0.1), 0.1, {0, 0, 0.15 + 3 * STOP_LAYER}));
  config.objects.push_back(box("press", {0.1, 0.1, 0.2}, 200, {0, 0, 0.3 + 5 * STOP_LAYER}));
  for (ObjectConfig& object : config.objects) soften(&object, 3000);
  Simulator simulator(config, model::UriResolver());
  const Press pressed = press(&simulator, 2);
  EXPECT_FALSE(pressed.unreliable);
  EXPECT_GT(pressed.max_of_layer, LayerStops::STOP - 1e-6);
  EXPECT_LT(pressed.max_of_layer, LayerStops::STOP + 0.02);
}

// One contact alone would let the other corners sink in turn.
TEST(LayerStops, StandBesideTheBudget) {
  SimulationConfig config = softCube(5 * BEARS / G);
  config.contact.max_contacts_per_object = 1;
  Simulator simulator(config, model::UriResolver());
  const Press pressed = press(&simulator, 2);
  EXPECT_FALSE(pressed.unreliable);
  EXPECT_LT(pressed.max_of_layer, LayerStops::STOP + 0.05);
  EXPECT_EQ(simulator.report().reduced_contacts, 1);
  EXPECT_LE(simulator.report().contacts.size(), 1u + LayerStops::MOST);
}

TEST(LayerStops, ArePartOfTheState) {
  const SimulationConfig config = softCube(5 * BEARS / G);
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, 0.5);
  const SimulationState saved = simulator.save();
  stepFor(&simulator, 0.1);
  Simulator other(config, model::UriResolver());
  other.restore(saved);
  stepFor(&other, 0.1);
  EXPECT_EQ(other.stateHash(), simulator.stateHash());
  Simulator light(softCube(0.5 * BEARS / G), model::UriResolver());
  stepFor(&light, 0.5);
  EXPECT_EQ(saved.words.size(), light.save().words.size() + 1 + 3 + 4);  // pairs, one with its size, its four stops
  other.resetSimulation();
  EXPECT_EQ(other.stateHash(), Simulator(config, model::UriResolver()).stateHash());
}

}  // namespace
}  // namespace blem_sim::sim
