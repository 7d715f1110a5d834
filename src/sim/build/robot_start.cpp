// Links of a robot that are near each other where it starts.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "build/robot_builder.h"

namespace blem_sim::sim {
namespace {

constexpr double CROSSED = 0.1;      // of the layers: what crosses by less, as fingers that are closed, contacts part
constexpr double GAP_FILLED = 0.9;   // share of a gap that narrowed layers take
constexpr double LEAST_SHARE = 0.1;  // of a layer that is left; links nearer than that are meant to touch
constexpr double TO_MILLI = 1000;

/** Two links, some of whose colliders are nearer to each other than layers can be narrowed. */
struct TightLinks {
  std::vector<std::pair<int, int>> colliders;
  std::vector<contact::Contact> contacts;
};

/** Whether contacts push one link both ways, so that no motion parts them all: it lies in a recess of the other. */
bool isCaught(const std::vector<contact::Contact>& contacts) {
  for (const contact::Contact& one : contacts)
    for (const contact::Contact& other : contacts)
      if (one.normal_BA.dot(other.normal_BA) < 0) return true;
  return false;
}

}  // namespace

contact::ContactManifold RobotBuilder::meetingAtStart(const contact::Collider& a, const contact::Collider& b,
                                                      contact::NarrowPhaseWorkspace* workspace) const {
  const auto start = [this](const contact::Collider& c) -> Pose {
    return c.body == dynamics::WORLD_BODY ? c.X_BC : X_WB_[lumped_->link_placement[c.link].body] * c.X_BC;
  };
  const Pose X_WA = start(a), X_WB = start(b);
  contact::ContactManifold found;
  contact::narrowPhase({a, X_WA}, {b, X_WB}, {}, workspace, &found);
  return found;
}

// Contacts of links that cross from the start, as neighbours' neighbours in wrists do, or of one that is caught between the other's sides,
// would tear at joints that cannot part them; layers wider than the gaps between fingers would press at motors that hold them.
void RobotBuilder::partAtStart() {
  contact::NarrowPhaseWorkspace workspace;
  std::vector<double> shares(own_.size(), 1);
  std::vector<std::pair<int, int>> crossing;        // colliders
  std::map<std::pair<int, int>, TightLinks> tight;  // by links
  for (std::size_t i = 0; i < own_.size(); ++i) {
    for (std::size_t j = i + 1; j < own_.size(); ++j) {
      const contact::Collider &a = world_->colliders[own_[i].collider], &b = world_->colliders[own_[j].collider];
      const std::pair<int, int> pair = std::minmax(own_[i].collider, own_[j].collider), links{a.link, b.link};
      if (!world_->filter.allows(a, b) || world_->disabled_pairs.count(pair) > 0) continue;
      const contact::ContactManifold found = meetingAtStart(a, b, &workspace);
      const double depth = found.maxDepth(), layers = own_[i].layer + own_[j].layer;
      if (!(depth > 0)) continue;
      const double share = layers > 0 ? GAP_FILLED * (layers - depth) / layers : 0;
      if (found.pierced && depth >= (1 + CROSSED) * (a.radius + b.radius)) {
        crossing.push_back(pair);
      } else if (share >= LEAST_SHARE) {
        for (const std::size_t own : {i, j}) shares[own] = std::min(shares[own], share);
      } else {
        tight[links].colliders.push_back(pair);
        std::copy_if(found.contacts.begin(), found.contacts.end(), std::back_inserter(tight[links].contacts),
                     [](const contact::Contact& contact) { return contact.depth > 0; });
      }
    }
  }
  for (const auto& [links, of_links] : tight)
    if (isCaught(of_links.contacts)) crossing.insert(crossing.end(), of_links.colliders.begin(), of_links.colliders.end());
  separate(crossing);
  narrowLayers(shares);
}

/** @param pairs of colliders that never touch */
void RobotBuilder::separate(const std::vector<std::pair<int, int>>& pairs) {
  std::set<std::pair<std::string, std::string>> links;
  for (const auto& [a, b] : pairs) links.emplace(linkOf(world_->colliders[a]), linkOf(world_->colliders[b]));
  world_->disabled_pairs.insert(pairs.begin(), pairs.end());
  std::string words;
  for (const auto& [a, b] : links) words += fmt::format("{}{} and {}", words.empty() ? "" : ", ", a, b);
  if (!words.empty())
    note("links that cross where the robot starts, or are caught in each other, never touch each other: " + words +
         "; initial_positions may part them");
}

/** @param shares of their layers that the robot's colliders keep */
void RobotBuilder::narrowLayers(const std::vector<double>& shares) {
  geometry::MeshReport* report = world_->load_report.data() + world_->load_report.size() - own_.size();
  std::map<std::string, double> narrowed;  // [m] by link
  for (std::size_t i = 0; i < own_.size(); ++i, ++report) {
    if (!(own_[i].layer > 0) || shares[i] == 1) continue;
    contact::Collider& collider = world_->colliders[own_[i].collider];
    collider.radius = report->boundary_width = shares[i] * own_[i].layer;
    double& least = narrowed.emplace(linkOf(collider), collider.radius).first->second;
    least = std::min(least, collider.radius);
  }
  if (narrowed.empty()) return;
  std::string words;
  for (const auto& [link, width] : narrowed) words += fmt::format("{}{} {:.3g} mm", words.empty() ? "" : ", ", link, TO_MILLI * width);
  note("layers of links that start within each other's are narrower than boundary_width: " + words + "; initial_positions may part them");
}

}  // namespace blem_sim::sim
