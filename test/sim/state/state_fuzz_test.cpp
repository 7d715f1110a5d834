// Saved states that were changed: refused with nothing changed, or at least restored into something that steps.
#include "blem_sim/geometry/input_error.h"
#include "sim/state/saved_scene.h"
#include "state/state_header.h"
#include "support/sanitizers.h"

namespace blem_sim::sim {
namespace {

class StateFuzz : public testing::TestWithParam<const char*> {};

TEST_P(StateFuzz, TheSceneHasEveryKindOfState) {
  Simulator simulator(sceneOfAllKinds(GetParam()), model::UriResolver());
  setOut(&simulator);
  EXPECT_GT(simulator.report().contacts.size(), 8u);
  EXPECT_TRUE(simulator.report().status & CONTACT_UNRELIABLE);
  EXPECT_GT(simulator.report().max_of_layer, 1);
  EXPECT_FALSE(simulator.report().samples.empty());
  EXPECT_GT(std::abs(simulator.desiredState(0, 0).velocity), 0.1);
}

TEST_P(StateFuzz, OneChangedWordIsRefusedAndNothingIsChanged) {
  Simulator simulator(sceneOfAllKinds(GetParam()), model::UriResolver()), other(sceneOfAllKinds(GetParam()), model::UriResolver());
  setOut(&simulator);
  stepFor(&other, 0.01);
  const SimulationState saved = simulator.save();
  const std::uint64_t untouched = other.stateHash();
  const std::vector<std::uint64_t> words = wordsOf(saved);
  for (std::size_t i = 0; i < words.size(); ++i) {
    for (const std::uint64_t word : otherWords(words[i])) {
      EXPECT_THROW(other.restore(withWord(saved, i, word)), InputError)
          << "word " << i << " of " << words.size() << ": " << std::hex << word;
      ASSERT_EQ(other.stateHash(), untouched) << "word " << i << " of " << words.size() << ": " << std::hex << word;
    }
  }
  other.restore(saved);
  EXPECT_EQ(other.stateHash(), simulator.stateHash());
}

TEST_P(StateFuzz, OneChangedLetterOfTheLayoutIsRefused) {
  Simulator simulator(sceneOfAllKinds(GetParam()), model::UriResolver());
  const SimulationState saved = simulator.save();
  const std::uint64_t untouched = simulator.stateHash();
  for (std::size_t i = 0; i < saved.layout.size(); ++i) {
    SimulationState changed = saved;
    changed.layout[i] = static_cast<char>(changed.layout[i] ^ 1);
    EXPECT_THROW(simulator.restore(changed), InputError) << i;
    changed.header = headerOf(changed);
    EXPECT_THROW(simulator.restore(changed), InputError) << i;
    ASSERT_EQ(simulator.stateHash(), untouched) << i;
  }
}

/** A state that is changed together with its checksum is refused in one line with nothing changed, or can be stepped on. */
TEST_P(StateFuzz, OneChangedWordUnderItsOwnChecksumBreaksNothing) {
  Simulator simulator(sceneOfAllKinds(GetParam()), model::UriResolver()), other(sceneOfAllKinds(GetParam()), model::UriResolver());
  setOut(&simulator);
  const SimulationState saved = simulator.save();
  const std::vector<std::uint64_t> words = wordsOf(saved);
  constexpr int STRIDE = SANITIZED ? 23 : 3;
  other.restore(saved);
  stepFor(&other, 0.01);
  const std::uint64_t end = other.stateHash();
  int refused = 0, restored = 0;
  for (std::size_t i = HEADER_WORDS, n = 0; i < words.size(); ++i) {
    for (const std::uint64_t word : otherWords(words[i])) {
      if (n++ % STRIDE != 0) continue;
      SCOPED_TRACE(testing::Message() << "word " << i << " of " << words.size() << ": " << std::hex << word);
      SimulationState changed = withWord(saved, i, word);
      changed.header = headerOf(changed);
      const std::uint64_t before = other.stateHash();
      try {
        other.restore(changed);
        ++restored;
        for (int step = 0; step < 10; ++step) other.step();
      } catch (const InputError& error) {
        ++refused;
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        ASSERT_EQ(other.stateHash(), before);
      }
    }
  }
  EXPECT_GT(refused * STRIDE, 300);
  EXPECT_GT(restored * STRIDE, 300);
  // Nothing is left of all these states.
  other.restore(saved);
  stepFor(&other, 0.01);
  EXPECT_EQ(other.stateHash(), end);
}

INSTANTIATE_TEST_SUITE_P(Steppers, StateFuzz, testing::Values("articulated", "world_step", "quick_step"));

}  // namespace
}  // namespace blem_sim::sim
