// Chains and spinning bodies that nothing drives, for a minute: energy and momenta against theory.
#include <gtest/gtest.h>

#include "soak/figures.h"
#include "support/chains.h"

namespace blem_sim {
namespace {

constexpr double SECONDS = 60, SHORT_SECONDS = 5;

struct LongChain {
  const char* name;
  std::vector<ChainLink> links;
  double dt = 1e-3;
  double fold = 0;  ///< [rad]
  bool alternates = false;
  double seconds = SECONDS;
};

std::vector<LongChain> longChains() {
  const std::vector<ChainLink> tapers = taper(6, {1, 0.3}, {0.02, 0.05});
  return {
      {"6 links, 1 kg to 20 g", tapers},
      {"6 links, 20 g to 1 kg", taper(6, {0.02, 0.05}, {1, 0.3})},
      {"4 links, 5 kg to 50 g", {{5, 0.3}, {2, 0.3}, {0.5, 0.3}, {0.05, 0.3}}},
      {"6 links, universal joints", tapers, 1e-3, 0, true},
      {"6 links, folded", tapers, 1e-3, 2.8},
      {"6 links, 0.1 ms", tapers, 1e-4, 0, false, 10},
      {"6 links, 2 ms", tapers, 2e-3},
      {"6 links, 5 ms", tapers, 5e-3},
      {"50 links, folded", taper(50, {0.1, 0.05}, {0.1, 0.05}), 1e-3, 2.8},
      {"200 links, folded", taper(200, {0.1, 0.05}, {0.1, 0.05}), 1e-3, 2.8},
  };
}

class FreeChain : public ::testing::TestWithParam<int> {};

TEST_P(FreeChain, KeepsItsEnergy) {
  const LongChain scene = longChains()[GetParam()];
  ChainOptions options;
  options.fold = scene.fold, options.alternates = scene.alternates, options.bend = scene.alternates ? 0.3 : 0;
  Chain chain(scene.links, options, soakSettings());
  const double whole = chain.energyAboveRest(scene.links);
  double worst = 0, fastest = 0;
  StepTimes times;
  const int steps = static_cast<int>(1e-3 / scene.dt * soakSteps(scene.seconds, SHORT_SECONDS));
  for (int i = 0; i < steps; ++i) {
    times.start();
    const dynamics::SolveResult& result = chain.step(scene.dt);
    times.stop(result);
    ASSERT_TRUE(result.finite) << i;
    worst = std::max(worst, std::abs(chain.energy() - chain.first_energy) / whole);
    for (int b = 0; b < chain.world.bodyCount(); ++b) fastest = std::max(fastest, chain.world.bodyState(b).w_WB.norm());
  }
  const std::string name = std::string("chain of ") + scene.name;
  figure(name + ": energy off, relative", worst, "");
  figure(name + ": at the end", (chain.energy() - chain.first_energy) / whole, "");
  figure(name + ": fastest link", fastest, "rad/s");
  figure(name + ": steps too fast", chain.too_fast, "");
  times.print(name);
  EXPECT_LE(worst, scene.dt <= 1e-3 ? 0.01 : 10 * scene.dt);
}
INSTANTIATE_TEST_SUITE_P(Scenes, FreeChain, ::testing::Range(0, 10));

class FreeSpin : public ::testing::TestWithParam<double> {};

TEST_P(FreeSpin, KeepsEnergyMomentumAndAxis) {
  for (int axis = 0; axis < 3; ++axis) {
    Spinner spinner(axis, GetParam());
    const double energy = spinner.world.kineticEnergy();
    const Vector3 momentum = spinner.momentum();
    double energy_off = 0, momentum_off = 0, tilt = 0;
    StepTimes times;
    for (int i = 0; i < soakSteps(SECONDS, SHORT_SECONDS); ++i) {
      times.start();
      times.stop(spinner.world.step(1e-3, {}, {}));
      energy_off = std::max(energy_off, std::abs(spinner.world.kineticEnergy() / energy - 1));
      momentum_off = std::max(momentum_off, (spinner.momentum() - momentum).norm() / momentum.norm());
      const Vector3 spin = spinner.bodySpin();
      tilt = std::max(tilt, std::acos(std::min(1.0, std::abs(spin[axis]) / spin.norm())));
    }
    char name[64];
    std::snprintf(name, sizeof name, "spin %g rad/s about axis %d of 1:2:3", GetParam(), axis + 1);
    figure(std::string(name) + ": energy off, relative", energy_off, "");
    figure(std::string(name) + ": momentum off, relative", momentum_off, "");
    figure(std::string(name) + ": axis off", tilt, "rad");
    times.print(name);
    EXPECT_LE(energy_off, 1e-3);
    EXPECT_LE(momentum_off, 1e-3);
    if (axis != 1) {
      EXPECT_LE(tilt, 0.01);
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Speeds, FreeSpin, ::testing::Values(100, 300, 1000));

}  // namespace
}  // namespace blem_sim
