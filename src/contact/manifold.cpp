#include "blem_sim/contact/manifold.h"

#include <algorithm>

namespace blem_sim::contact {

double ContactManifold::maxDepth() const {
  // Several maxima at once: one alone would wait for the last comparison.
  constexpr std::size_t CHAINS = 4;
  constexpr double NONE = -std::numeric_limits<double>::infinity();
  double deepest[CHAINS] = {NONE, NONE, NONE, NONE};
  std::size_t i = 0;
  for (; i + CHAINS <= contacts.size(); i += CHAINS) {
    for (std::size_t chain = 0; chain < CHAINS; ++chain) deepest[chain] = std::max(deepest[chain], contacts[i + chain].depth);
  }
  for (; i < contacts.size(); ++i) deepest[0] = std::max(deepest[0], contacts[i].depth);
  return *std::max_element(deepest, deepest + CHAINS);
}

}  // namespace blem_sim::contact
