// The paper's two ways: clusters of (x, n, p) and their means [Hauser 2013, 3.4].
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "blem_sim/contact/contact_order.h"
#include "blem_sim/reduction/reduction.h"

namespace blem_sim::reduction {

namespace {

constexpr double NORMAL_WEIGHT = 0.1;  // [m] distance that a unit change of normal counts as; points and depths count as they are
constexpr std::size_t MANY = 300;      // contacts from which linkage costs too much

using Feature = Eigen::Matrix<double, 7, 1>;

std::vector<Feature> featuresOf(const std::vector<contact::Contact>& contacts) {
  std::vector<Feature> features(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    features[i] << contacts[i].point, NORMAL_WEIGHT * contacts[i].normal_BA, contacts[i].depth;
  }
  return features;
}

bool deeper(const contact::Contact& a, const contact::Contact& b) {
  return a.depth != b.depth ? a.depth > b.depth : contact::contactBefore(a, b);
}

// Mean point, direction and depth of a cluster; the deepest member gives the id, and the normal where the members' cancel out.
contact::Contact meanContact(const std::vector<contact::Contact>& contacts, const std::vector<int>& members) {
  contact::Contact deepest = contacts[members[0]];
  Vector3 point = Vector3::Zero(), normal = Vector3::Zero();
  Box box;
  double depth = 0;
  for (int i : members) {
    const contact::Contact& contact = contacts[i];
    if (deeper(contact, deepest)) deepest = contact;
    point += contact.point;
    normal += contact.normal_BA;
    depth += contact.depth;
    box.extend(contact.point);
  }
  contact::Contact mean = deepest;
  const double count = static_cast<double>(members.size());
  // Rounding of the sums must not carry a mean out of its members' range.
  mean.point = (point / count).cwiseMax(box.min()).cwiseMin(box.max());
  mean.depth = std::min(depth / count, deepest.depth);
  if (normal.norm() > 1e-6 * count) mean.normal_BA = normal.normalized();
  return mean;
}

// Replaces contacts by the means of their clusters. @param cluster_of one cluster number per contact, 0 .. count - 1
void takeMeans(std::vector<contact::Contact>& contacts, const std::vector<int>& cluster_of, int count) {
  std::vector<std::vector<int>> members(count);
  for (std::size_t i = 0; i < contacts.size(); ++i) members[cluster_of[i]].push_back(static_cast<int>(i));
  std::vector<contact::Contact> means;
  for (const std::vector<int>& cluster : members) {
    if (!cluster.empty()) means.push_back(meanContact(contacts, cluster));
  }
  contacts = std::move(means);
  std::sort(contacts.begin(), contacts.end(), contact::contactBefore);
}

// The deepest contact, then always the one farthest from those taken so far.
std::vector<Feature> farthestPoints(const std::vector<contact::Contact>& contacts, const std::vector<Feature>& features, int k) {
  std::size_t next = 0;
  for (std::size_t i = 1; i < contacts.size(); ++i) {
    if (deeper(contacts[i], contacts[next])) next = i;
  }
  std::vector<Feature> centres;
  std::vector<double> distance(features.size(), std::numeric_limits<double>::infinity());
  while (static_cast<int>(centres.size()) < k) {
    centres.push_back(features[next]);
    for (std::size_t i = 0; i < features.size(); ++i) distance[i] = std::min(distance[i], (features[i] - centres.back()).squaredNorm());
    next = std::max_element(distance.begin(), distance.end()) - distance.begin();
  }
  return centres;
}

int nearestCentre(const std::vector<Feature>& centres, const Feature& feature) {
  int nearest = 0;
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < centres.size(); ++c) {
    const double distance = (centres[c] - feature).squaredNorm();
    if (distance < smallest) {
      smallest = distance;
      nearest = static_cast<int>(c);
    }
  }
  return nearest;
}

// One round of Lloyd: assign, then move the centres. A centre without members stays. @return whether an assignment changed
bool improve(const std::vector<Feature>& features, std::vector<Feature>& centres, std::vector<int>& cluster_of) {
  bool changed = false;
  std::vector<Feature> sums(centres.size(), Feature::Zero());
  std::vector<int> counts(centres.size(), 0);
  for (std::size_t i = 0; i < features.size(); ++i) {
    const int nearest = nearestCentre(centres, features[i]);
    changed = changed || nearest != cluster_of[i];
    cluster_of[i] = nearest;
    sums[nearest] += features[i];
    ++counts[nearest];
  }
  for (std::size_t c = 0; c < centres.size(); ++c) {
    if (counts[c] > 0) centres[c] = sums[c] / counts[c];
  }
  return changed;
}

// Distances between clusters, with every row's nearest later cluster remembered.
class Linkage {
 public:
  explicit Linkage(const std::vector<Feature>& features)
      : count_(features.size()), distance_(count_, count_), size_(count_, 1), nearest_(count_) {
    for (int i = 0; i < count_; ++i) {
      for (int j = 0; j < count_; ++j) distance_(i, j) = (features[i] - features[j]).norm();
    }
    for (int i = 0; i < count_; ++i) findNearest(i);
  }

  /** Merges the two closest clusters, the later into the earlier. @return {kept, merged} */
  std::pair<int, int> mergeClosest() {
    int kept = -1;
    for (int i = 0; i < count_; ++i) {
      if (size_[i] == 0 || nearest_[i] < 0) continue;
      if (kept < 0 || distance_(i, nearest_[i]) < distance_(kept, nearest_[kept])) kept = i;
    }
    const int merged = nearest_[kept];
    const double weight = static_cast<double>(size_[kept]) / (size_[kept] + size_[merged]);
    for (int i = 0; i < count_; ++i) {  // mean distance of all member pairs [Lance and Williams 1967]
      distance_(kept, i) = distance_(i, kept) = weight * distance_(kept, i) + (1 - weight) * distance_(merged, i);
    }
    size_[kept] += size_[merged];
    size_[merged] = 0;
    for (int i = 0; i < count_; ++i) {
      if (size_[i] > 0 && (i == kept || nearest_[i] == kept || nearest_[i] == merged)) findNearest(i);
    }
    return {kept, merged};
  }

 private:
  void findNearest(int i) {
    nearest_[i] = -1;
    for (int j = i + 1; j < count_; ++j) {
      if (size_[j] > 0 && (nearest_[i] < 0 || distance_(i, j) < distance_(i, nearest_[i]))) nearest_[i] = j;
    }
  }

  int count_;
  Eigen::MatrixXd distance_;
  std::vector<int> size_, nearest_;
};

}  // namespace

void reduceKmeans(const std::vector<contact::Contact>& contacts, int k, const ContactIds&, ReductionWorkspace*,
                  std::vector<contact::Contact>* reduced) {
  *reduced = contacts;
  contact::makeCanonical(*reduced);
  if (static_cast<int>(reduced->size()) <= k) return;
  const std::vector<Feature> features = featuresOf(*reduced);
  std::vector<Feature> centres = farthestPoints(*reduced, features, k);
  std::vector<int> cluster_of(reduced->size(), -1);
  for (int round = 0; round < k && improve(features, centres, cluster_of); ++round) {
  }
  takeMeans(*reduced, cluster_of, k);
}

void reduceHierarchical(const std::vector<contact::Contact>& contacts, int k, const ContactIds&, ReductionWorkspace* workspace,
                        std::vector<contact::Contact>* reduced) {
  *reduced = contacts;
  contact::makeCanonical(*reduced);
  const int count = static_cast<int>(reduced->size());
  if (count <= k) return;
  if (reduced->size() > MANY) return reduceKmeans(contacts, k, {}, workspace, reduced);
  Linkage linkage(featuresOf(*reduced));
  std::vector<int> cluster_of(reduced->size());
  for (int i = 0; i < count; ++i) cluster_of[i] = i;
  for (int left = count; left > k; --left) {
    const auto [kept, merged] = linkage.mergeClosest();
    for (int& cluster : cluster_of) {
      if (cluster == merged) cluster = kept;
    }
  }
  takeMeans(*reduced, cluster_of, count);
}

}  // namespace blem_sim::reduction
