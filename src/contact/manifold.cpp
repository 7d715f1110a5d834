#include "blem_sim/contact/manifold.h"

#include <algorithm>

namespace blem_sim {

double ContactManifold::maxDepth() const {
  double deepest = -std::numeric_limits<double>::infinity();
  for (const Contact& contact : contacts) deepest = std::max(deepest, contact.depth);
  return deepest;
}

}  // namespace blem_sim
