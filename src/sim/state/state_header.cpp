#include "state/state_header.h"

#include <fmt/format.h>

#include "blem_sim/geometry/input_error.h"
#include "numbers/content_hash.h"

namespace blem_sim::sim {
namespace {

// "BLEM" and the version, to be raised whenever the content of a state changes.
constexpr std::uint64_t MAGIC = 0x424c454d00000000u, VERSION = 3, VERSION_BITS = 0xffffffffu;

std::uint64_t lengthOf(const SimulationState& state) {
  std::uint64_t length = 1 + state.world.numbers.size() + state.world.words.size() + state.numbers.size() + state.words.size();
  for (const auto& [robot, controllers] : state.memories)
    for (const auto& [controller, memory] : controllers) length += memory.size();
  return length;
}

std::uint64_t checksumOf(const SimulationState& state, std::uint64_t layout) {
  ContentHash hash;
  hash.add(layout).add(state.step);
  hash.add(state.world.numbers).add(state.world.words).add(state.numbers).add(state.words);
  for (const auto& [robot, controllers] : state.memories)
    for (const auto& [controller, memory] : controllers) hash.add(robot).add(controller).add(memory);
  return hash.value();
}

[[noreturn]] void refuse(const std::string& why) { throw InputError("restore: the state " + why); }

}  // namespace

StateHeader headerOf(const SimulationState& state) {
  const std::uint64_t layout = ContentHash().add(state.layout).value();
  return {MAGIC | VERSION, layout, lengthOf(state), checksumOf(state, layout)};
}

void checkHeader(const SimulationState& state) {
  const StateHeader &has = state.header, should = headerOf(state);
  if (has.format != should.format) {
    if ((has.format & ~VERSION_BITS) != MAGIC) refuse("has no header of a saved state; restore what save() gave");
    refuse(fmt::format("is of format {}, this version restores {}; save it again with this version", has.format & VERSION_BITS, VERSION));
  }
  if (has.length != should.length)
    refuse(fmt::format("is cut short, or longer than it was: {} words of {}; save it again", should.length, has.length));
  if (has.layout != should.layout || has.checksum != should.checksum)
    refuse("was changed after it was saved, its checksum does not fit; save it again");
}

}  // namespace blem_sim::sim
