#include "contact_generation.h"

#include "contact/contact_shapes.h"
#include "plain_tree.h"

namespace blem_sim {

std::vector<int> sampledSteps() {
  constexpr int SAMPLES = 10, PERIOD = 200;  // one oscillation
  std::vector<int> steps;
  for (int i = 0; i < SAMPLES; ++i) steps.push_back(i * PERIOD / SAMPLES);
  return steps;
}

Generation generate(const ContactScene& scene, bool remembers, int steps) {
  std::vector<contact::NarrowPhaseMemory> memories(scene.moving.size());
  std::vector<Pose> poses(scene.moving.size());
  std::vector<contact::ContactManifold> manifolds(scene.moving.size());  // of each pair its own, as a simulation keeps them
  Generation out;
  // One room for all searches of the program, as a simulation's thread has: leaves that an earlier search described are known to it.
  for (int step = -1; step < steps; ++step) {
    for (std::size_t i = 0; i < scene.moving.size(); ++i) poses[i] = scene.pose(static_cast<int>(i), step);
    std::size_t contacts = 0;
    out.times.start();
    for (std::size_t i = 0; i < scene.moving.size(); ++i) {
      contact::narrowPhase({scene.moving[i], poses[i]}, {scene.standing, Pose::Identity()},
                           {0, nullptr, remembers ? &memories[i] : nullptr}, contact::searchRoom(), &manifolds[i]);
      contacts += manifolds[i].contacts.size();
    }
    out.times.stop();
    if (step < 0) {
      out.times = StepTimes();
      continue;
    }
    out.contacts += static_cast<double>(contacts) / steps;
  }
  return out;
}

PairSearch searchPlainly(const ContactScene& scene) {
  const PlainTree standing(scene.standing.geometry->mesh());
  std::vector<std::unique_ptr<PlainTree>> moving;
  for (const contact::Collider& collider : scene.moving) moving.push_back(std::make_unique<PlainTree>(collider.geometry->mesh()));
  std::vector<std::pair<int, int>> pairs;
  std::size_t found = 0;
  const std::vector<int> steps = sampledSteps();
  const double start = threadSeconds();
  for (const int step : steps) {
    for (std::size_t i = 0; i < moving.size(); ++i) {
      const double range = scene.moving[i].radius + scene.standing.radius;
      PlainTree::trianglePairs(*moving[i], standing, scene.pose(static_cast<int>(i), step), range, &pairs);
      found += pairs.size();
    }
  }
  const double count = static_cast<double>(steps.size());
  return {1e6 * (threadSeconds() - start) / count, static_cast<double>(found) / count};
}

}  // namespace blem_sim
