#include "clouds/fading_points.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace blem_sim::sim {
namespace {

constexpr double SUNK_AWAY = 0.05;  // [m] points that leave have gone: thicker layers are none

std::uint64_t bitsOf(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

double fromBits(std::uint64_t bits) {
  double value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

double sinkIn(const std::vector<SunkPoint>& points, int vertex) {
  const auto at = std::lower_bound(points.begin(), points.end(), vertex, [](const SunkPoint& p, int v) { return p.vertex < v; });
  return at != points.end() && at->vertex == vertex ? at->sink : 0;
}

/** The contact as a smaller ball about the same point has it. @param to_b the ball is B's */
void sinkContact(double sink, bool to_b, contact::Contact* contact) {
  contact->depth -= sink;
  contact->point += (to_b ? -0.5 : 0.5) * sink * contact->normal_BA;
}

}  // namespace

const FadingPoints::Fading* FadingPoints::of(int collider) const {
  const auto at = std::lower_bound(fading_.begin(), fading_.end(), collider, [](const Fading& f, int c) { return f.collider < c; });
  return at != fading_.end() && at->collider == collider ? &*at : nullptr;
}

void FadingPoints::add(int collider, double speed, std::vector<SunkPoint> points) {
  if (points.empty()) return;
  const auto at = std::lower_bound(fading_.begin(), fading_.end(), collider, [](const Fading& f, int c) { return f.collider < c; });
  fading_.insert(at, {collider, speed, std::move(points)});
}

double FadingPoints::sinkOf(int collider, int vertex) const {
  const Fading* fading = of(collider);
  return fading ? sinkIn(fading->points, vertex) : 0;
}

void FadingPoints::apply(contact::ContactManifold* manifold) const {
  if (fading_.empty()) return;
  for (const bool to_b : {false, true}) {
    const Fading* fading = of(to_b ? manifold->b : manifold->a);
    if (!fading) continue;
    std::vector<contact::Contact>& contacts = manifold->contacts;
    const auto gone = std::remove_if(contacts.begin(), contacts.end(), [&](contact::Contact& contact) {
      const int vertex = contact::vertexOf(contact.id, !to_b);
      const double sink = vertex < 0 || contact.pierced ? 0 : sinkIn(fading->points, vertex);
      if (std::isfinite(sink)) sinkContact(sink, to_b, &contact);
      return !std::isfinite(sink);
    });
    contacts.erase(gone, contacts.end());
  }
}

void FadingPoints::advance(double dt) {
  for (Fading& fading : fading_) {
    std::vector<SunkPoint>& points = fading.points;
    for (SunkPoint& point : points) {
      point.sink += fading.speed * dt;
      if (fading.speed > 0 && point.sink > SUNK_AWAY) point.sink = std::numeric_limits<double>::infinity();
    }
    points.erase(std::remove_if(points.begin(), points.end(), [](const SunkPoint& p) { return !(p.sink > 0); }), points.end());
  }
  fading_.erase(std::remove_if(fading_.begin(), fading_.end(), [](const Fading& f) { return f.points.empty(); }), fading_.end());
}

void FadingPoints::forget(int collider) {
  fading_.erase(std::remove_if(fading_.begin(), fading_.end(), [=](const Fading& f) { return f.collider == collider; }), fading_.end());
}

void FadingPoints::append(std::vector<std::uint64_t>* words) const {
  words->push_back(fading_.size());
  for (const Fading& fading : fading_) {
    words->insert(words->end(), {static_cast<std::uint64_t>(fading.collider), bitsOf(fading.speed), fading.points.size()});
    for (const SunkPoint& point : fading.points)
      words->insert(words->end(), {static_cast<std::uint64_t>(point.vertex), bitsOf(point.sink)});
  }
}

bool FadingPoints::read(const std::vector<contact::Collider>& colliders, const std::uint64_t** words, const std::uint64_t* end) {
  const std::uint64_t* word = *words;
  const auto next = [&](std::uint64_t* value) { return word != end && (*value = *word++, true); };
  std::vector<Fading> read;
  std::uint64_t count = 0, collider = 0, speed = 0, points = 0;
  if (!next(&count)) return false;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (!next(&collider) || !next(&speed) || !next(&points)) return false;
    if (collider >= colliders.size() || !colliders[collider].enabled || !std::isfinite(fromBits(speed))) return false;
    if (!read.empty() && read.back().collider >= static_cast<int>(collider)) return false;
    if (points == 0 || points > static_cast<std::uint64_t>(end - word) / 2) return false;
    Fading fading{static_cast<int>(collider), fromBits(speed), {}};
    const std::size_t vertices = colliders[collider].geometry->isHalfSpace() ? 0 : colliders[collider].geometry->mesh().vertices.size();
    for (; points > 0; --points, word += 2) {
      if (word[0] >= vertices || !(fromBits(word[1]) > 0)) return false;
      const int vertex = static_cast<int>(word[0]);
      if (!fading.points.empty() && fading.points.back().vertex >= vertex) return false;
      fading.points.push_back({vertex, fromBits(word[1])});
    }
    read.push_back(std::move(fading));
  }
  fading_ = std::move(read);
  *words = word;
  return true;
}

}  // namespace blem_sim::sim
