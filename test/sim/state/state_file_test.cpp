// Files of states: whole, or not there.
#include "blem_sim/sim/state_file.h"

#include <sys/resource.h>

#include <csignal>

#include "sim/state/saved_scene.h"
#include "support/input_errors.h"
#include "support/temporary_folder.h"

namespace blem_sim::sim {
namespace {

/** Lets files grow no further than this, as a full disk does, while it lives. */
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit less{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &less);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_;
  void (*handler_)(int);
};

TEST(StateFile, ComesBackBitForBit) {
  Simulator simulator(sceneOfAllKinds(), model::UriResolver());
  setOut(&simulator);
  const TemporaryFolder folder;
  saveState(simulator.save(), folder.path("state"));
  const SimulationState loaded = loadState(folder.path("state"));
  EXPECT_EQ(wordsOf(loaded), wordsOf(simulator.save()));
  EXPECT_EQ(loaded.layout, simulator.save().layout);
}

TEST(StateFile, FullDiskIsToldInOneLineAndTheOldFileStays) {
  Simulator simulator(sceneOfAllKinds(), model::UriResolver());
  const TemporaryFolder folder;
  const std::string file = folder.path("state");
  saveState(simulator.save(), file);
  const std::vector<std::uint64_t> old = wordsOf(loadState(file));
  setOut(&simulator);
  std::string why;
  {
    const FullDisk full(1000);
    why = refusal([&] { saveState(simulator.save(), file); });
  }
  EXPECT_TRUE(isOneLineWith(why, {file, "cannot be written", "too large", "disk"})) << why;
  EXPECT_EQ(wordsOf(loadState(file)), old);
  EXPECT_FALSE(std::filesystem::exists(file + ".part"));
}

TEST(StateFile, LinkInTheWayOfTheDraftIsNotFollowed) {
  Simulator simulator(sceneOfAllKinds(), model::UriResolver());
  const TemporaryFolder folder;
  const std::string other = folder.write("other", "mine");
  std::filesystem::create_symlink(other, folder.path("state.part"));
  saveState(simulator.save(), folder.path("state"));
  std::ifstream stream(other);
  std::string text;
  stream >> text;
  EXPECT_EQ(text, "mine");
}

TEST(StateFile, CutAnywhereOrWithABitTurnedItIsRefused) {
  Simulator simulator(sceneOfAllKinds(), model::UriResolver());
  setOut(&simulator);
  const std::string bytes = stateBytes(simulator.save());
  const auto load = [&](const std::string& given) { return refusal([&] { simulator.restore(stateOf(given, "file")); }); };
  EXPECT_EQ(load(bytes), "");
  for (std::size_t size = 0; size < bytes.size(); size += 97) EXPECT_TRUE(isOneLineWith(load(bytes.substr(0, size)), {})) << size;
  for (std::size_t at = 0; at < bytes.size(); at += 89) {
    std::string turned = bytes;
    turned[at] = static_cast<char>(turned[at] ^ 4);
    EXPECT_TRUE(isOneLineWith(load(turned), {})) << at;
  }
}

}  // namespace
}  // namespace blem_sim::sim
