#include "contacts/constraints/contact_ids.h"

namespace blem_sim::sim {
namespace {

std::uint64_t mixed(std::uint64_t x) {  // splitmix64's finalizer [Steele 2014]
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

}  // namespace

std::uint64_t worldContactId(int a, int b, std::uint64_t id) {
  return mixed(id + mixed((static_cast<std::uint64_t>(a) << 32) + static_cast<std::uint64_t>(b) + 1));
}

std::uint64_t stopId(std::uint64_t id) { return mixed(id); }

}  // namespace blem_sim::sim
