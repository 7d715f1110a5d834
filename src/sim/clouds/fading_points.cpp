#include "clouds/fading_points.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "blem_sim/contact/collider_pairs.h"

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

[[noreturn]] void refusePoints(const geometry::StateReader& reader) {
  reader.refuseContent("points that come or go are of no cloud that is there");
}

double sinkIn(const std::vector<SunkPoint>& points, int vertex) {
  const auto at = std::lower_bound(points.begin(), points.end(), vertex, [](const SunkPoint& p, int v) { return p.vertex < v; });
  return at != points.end() && at->vertex == vertex ? at->sink : 0;
}

/** Mean sink at a place; infinite if that of one of its corners is. */
double sinkAt(const std::vector<SunkPoint>& points, const contact::MeshPlace& place) {
  double sink = 0;
  for (int k = 0; k < 3; ++k) {
    const double of_corner = sinkIn(points, place.corners[k]);
    if (!std::isfinite(of_corner)) return of_corner;
    sink += place.weights[k] * of_corner;
  }
  return sink;
}

/** The contact as a thinner layer about the same place has it. @param to_b the layer is B's */
void sinkContact(double sink, bool to_b, contact::Contact* contact) {
  contact->depth -= sink;
  contact->point += (to_b ? -0.5 : 0.5) * sink * contact->normal_BA;
}

void dropPierced(contact::ContactManifold* manifold) {
  const auto isPierced = [](const contact::Contact& contact) { return contact.pierced; };
  manifold->contacts.erase(std::remove_if(manifold->contacts.begin(), manifold->contacts.end(), isPierced), manifold->contacts.end());
  manifold->pierced = false;
}

}  // namespace

contact::MeshPlace touchedPlace(const contact::Collider& collider, const contact::Contact& contact, bool is_a) {
  const double way = collider.radius - 0.5 * contact.depth;  // a sink shifts it along the normal, which moves no foot
  const Vector3 p_W = contact.point + (is_a ? way : -way) * contact.normal_BA;
  return contact::placeOf(contact.id, is_a, *collider.geometry, collider.X_BC.inverse() * p_W);
}

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

double FadingPoints::sinkOf(const contact::Collider& collider, int index, const contact::Contact& contact, bool is_a) const {
  const Fading* fading = of(index);
  return fading ? sinkAt(fading->points, touchedPlace(collider, contact, is_a)) : 0;
}

void FadingPoints::apply(const std::vector<contact::Collider>& colliders, contact::ContactManifold* manifold) const {
  if (empty()) return;
  const bool crossing = crosses(manifold->a, manifold->b);
  if (manifold->pierced && crossing) dropPierced(manifold);
  for (const bool to_b : {false, true}) {
    const Fading* fading = of(to_b ? manifold->b : manifold->a);
    if (!fading) continue;
    const contact::Collider& collider = colliders[fading->collider];
    std::vector<contact::Contact>& contacts = manifold->contacts;
    const auto gone = std::remove_if(contacts.begin(), contacts.end(), [&](contact::Contact& contact) {
      const double sink = sinkAt(fading->points, touchedPlace(collider, contact, !to_b));
      if (!std::isfinite(sink)) return true;
      sinkContact(sink, to_b, &contact);
      if (!(fading->speed < 0 && sink > 0) || mayPush(contact, !to_b)) return false;
      if (contact.depth > 0) sinkContact(contact.depth, to_b, &contact);
      return crossing;  // what lies in each other pushes inwards
    });
    if (gone == contacts.end()) continue;
    contacts.erase(gone, contacts.end());
    manifold->pierced = std::any_of(contacts.begin(), contacts.end(), [](const contact::Contact& c) { return c.pierced; });
  }
}

/** Whether a contact pushes a body upwards. @param is_a what comes is the contact's A */
bool FadingPoints::mayPush(const contact::Contact& contact, bool is_a) const {
  return (is_a ? -1 : 1) * contact.normal_BA.dot(up_) >= UPWARDS;
}

/** Colliders and vertices that wait, sorted: they touch, or would within the time [s]. */
std::vector<std::pair<int, int>> FadingPoints::waiting(double dt, const std::vector<contact::Collider>& colliders,
                                                       const std::vector<contact::ContactManifold>& manifolds) const {
  std::vector<std::pair<int, int>> waiting;
  for (const contact::ContactManifold& manifold : manifolds)
    for (const bool is_a : {true, false}) {
      const Fading* fading = of(is_a ? manifold.a : manifold.b);
      if (!fading || !(fading->speed < 0)) continue;
      for (const contact::Contact& contact : manifold.contacts) {
        if (contact.depth < dt * fading->speed || mayPush(contact, is_a)) continue;
        const contact::MeshPlace place = touchedPlace(colliders[fading->collider], contact, is_a);
        for (int k = 0; k < 3; ++k) waiting.emplace_back(fading->collider, place.corners[k]);
      }
    }
  std::sort(waiting.begin(), waiting.end());
  return waiting;
}

void FadingPoints::advance(double dt, const std::vector<contact::Collider>& colliders,
                           const std::vector<contact::ContactManifold>& manifolds) {
  if (fading_.empty()) return;
  const std::vector<std::pair<int, int>> waits = waiting(dt, colliders, manifolds);
  for (Fading& fading : fading_) {
    std::vector<SunkPoint>& points = fading.points;
    for (SunkPoint& point : points) {
      if (std::binary_search(waits.begin(), waits.end(), std::make_pair(fading.collider, point.vertex))) continue;
      point.sink += fading.speed * dt;
      if (fading.speed > 0 && point.sink > SUNK_AWAY) point.sink = std::numeric_limits<double>::infinity();
    }
    points.erase(std::remove_if(points.begin(), points.end(), [](const SunkPoint& p) { return !(p.sink > 0); }), points.end());
  }
  fading_.erase(std::remove_if(fading_.begin(), fading_.end(), [](const Fading& f) { return f.points.empty(); }), fading_.end());
}

void FadingPoints::deepen(int collider, const std::vector<SunkPoint>& more) {
  for (Fading& fading : fading_)
    if (fading.collider == collider)
      for (SunkPoint& point : fading.points) point.sink += sinkIn(more, point.vertex);
}

void FadingPoints::addCrossing(int a, int b) {
  crossings_.emplace_back(a, b);
  std::sort(crossings_.begin(), crossings_.end());
}

void FadingPoints::forget(int collider) {
  const auto has_it = [=](const std::pair<int, int>& pair) { return pair.first == collider || pair.second == collider; };
  crossings_.erase(std::remove_if(crossings_.begin(), crossings_.end(), has_it), crossings_.end());
  fading_.erase(std::remove_if(fading_.begin(), fading_.end(), [=](const Fading& f) { return f.collider == collider; }), fading_.end());
}

void FadingPoints::save(geometry::StateWriter* writer) const {
  writer->word(fading_.size());
  for (const Fading& fading : fading_) {
    writer->integer(fading.collider);
    writer->word(bitsOf(fading.speed));
    writer->word(fading.points.size());
    for (const SunkPoint& point : fading.points) {
      writer->integer(point.vertex);
      writer->word(bitsOf(point.sink));
    }
  }
  writer->word(crossings_.size());
  for (const auto& [a, b] : crossings_) {
    writer->integer(a);
    writer->integer(b);
  }
}

FadingPoints::Fading FadingPoints::fadingFrom(const std::vector<contact::Collider>& colliders, geometry::StateReader* reader) {
  const std::uint64_t collider = reader->word();
  const double speed = fromBits(reader->word());
  if (collider >= colliders.size() || !colliders[collider].enabled || !std::isfinite(speed)) refusePoints(*reader);
  const std::size_t vertices = colliders[collider].geometry->isHalfSpace() ? 0 : colliders[collider].geometry->mesh().vertices.size();
  Fading fading{static_cast<int>(collider), speed, {}};
  for (std::size_t points = reader->count(2, 0); points > 0; --points) {
    const std::uint64_t vertex = reader->word();
    const double sink = fromBits(reader->word());
    if (vertex >= vertices || !(sink > 0)) refusePoints(*reader);
    if (!fading.points.empty() && fading.points.back().vertex >= static_cast<int>(vertex)) refusePoints(*reader);
    fading.points.push_back({static_cast<int>(vertex), sink});
  }
  if (fading.points.empty()) refusePoints(*reader);
  return fading;
}

void FadingPoints::restore(const std::vector<contact::Collider>& colliders, geometry::StateReader* reader) {
  fading_.clear();
  for (std::size_t left = reader->count(3, 0); left > 0; --left) {
    Fading fading = fadingFrom(colliders, reader);
    if (!fading_.empty() && fading_.back().collider >= fading.collider) refusePoints(*reader);
    fading_.push_back(std::move(fading));
  }
  crossings_.clear();
  for (std::size_t left = reader->count(2, 0); left > 0; --left) {
    const std::pair<int, int> pair = contact::readSlots(colliders, reader);
    if (!crossings_.empty() && pair <= crossings_.back()) refusePoints(*reader);
    crossings_.push_back(pair);
  }
}

}  // namespace blem_sim::sim
