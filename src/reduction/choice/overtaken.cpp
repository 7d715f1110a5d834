#include "choice/overtaken.h"

#include "lanes/wrench_bounds.h"

namespace blem_sim::reduction {
namespace {

constexpr int PIVOTS = 7;

// The farthest along every axis, both ways, handicaps counted, and the one with the least handicap: they exceed most of those that can be.
void findPivots(const std::vector<WrenchPoint>& points, WrenchPoint* pivots) {
  float most[PIVOTS];
  for (std::size_t i = 0; i < points.size(); ++i) {
    const WrenchPoint& p = points[i];
    const float along[PIVOTS] = {p.x[0], -p.x[0], p.x[1], -p.x[1], p.x[2], -p.x[2], 0};
    for (int d = 0; d < PIVOTS; ++d) {
      const float reach = along[d] - p.handicap;
      if (i > 0 && reach <= most[d]) continue;
      most[d] = reach;
      pivots[d] = p;
    }
  }
}

bool isOvertaken(const WrenchPoint& point, const WrenchPoint* pivots) {
  for (int d = 0; d < PIVOTS; ++d) {
    const float lead = point.handicap - pivots[d].handicap - ROUNDING;
    if (lead > 0 && lead > PER_PLACE * distance(point.x, pivots[d].x) + PER_NORMAL * distance(point.n, pivots[d].n)) return true;
  }
  return false;
}

}  // namespace

void dropOvertaken(const std::vector<contact::Contact>& contacts, const ContactIds& spared, std::vector<int>* candidates,
                   std::vector<WrenchPoint>* points) {
  WrenchPoint pivots[PIVOTS];
  findPivots(*points, pivots);
  std::size_t left = 0;
  auto spare = spared.begin();
  for (std::size_t i = 0; i < candidates->size(); ++i) {
    const std::uint64_t id = contacts[(*candidates)[i]].id;
    while (spare != spared.end() && *spare < id) ++spare;
    const bool is_spared = spare != spared.end() && *spare == id;
    if (!is_spared && isOvertaken((*points)[i], pivots)) continue;
    (*candidates)[left] = (*candidates)[i];
    (*points)[left++] = (*points)[i];
  }
  candidates->resize(left);
  points->resize(left);
}

}  // namespace blem_sim::reduction
