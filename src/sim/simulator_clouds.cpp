// Live environments: clouds that are exchanged between steps.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include "blem_sim/geometry/input_error.h"
#include "build/contact_settings.h"
#include "build/widths/chosen_width.h"
#include "build/widths/scan_noise.h"
#include "clouds/leaving_triangles.h"
#include "contacts/constraints/carried_contacts.h"
#include "simulator_impl.h"

namespace blem_sim::sim {
namespace {

constexpr double TOUCH = 1e-5;             // [m] largest gap of a point that something stands on
constexpr std::size_t MOST_RISING = 5000;  // points below a body that is buried
constexpr std::size_t MOST_LEFT = 200;     // contacts of a pair without a choice of the last step
constexpr double BEGUN = 1e-9;             // [m] sink of what begins to leave: in the step of an exchange it bears as before
constexpr double LOOK_AHEAD = 0.2;         // [s] for which what moves shall find triangles ahead that fade as those below it
constexpr double FARTHEST_AHEAD = 0.1;     // [m] of them: an exchange must cost no step
constexpr double STAYS = 0.001;            // [m] in that time: no more is standing

/** Points that fade by vertex, one each: of two bodies the deeper one's. */
std::vector<SunkPoint> byVertex(std::vector<SunkPoint> points) {
  std::sort(points.begin(), points.end(),
            [](const SunkPoint& a, const SunkPoint& b) { return std::make_tuple(a.vertex, -a.sink) < std::make_tuple(b.vertex, -b.sink); });
  points.erase(std::unique(points.begin(), points.end(), [](const SunkPoint& a, const SunkPoint& b) { return a.vertex == b.vertex; }),
               points.end());
  return points;
}

bool isAnyOf(const Vector3i& corners, const std::vector<SunkPoint>& points) {
  return std::any_of(corners.data(), corners.data() + 3, [&](int corner) {
    const auto at = std::lower_bound(points.begin(), points.end(), corner, [](const SunkPoint& p, int v) { return p.vertex < v; });
    return at != points.end() && at->vertex == corner;
  });
}

/** Adds the other corners of triangles that have one of these. @param points sorted by vertex, sunk for good; stay sorted */
void addNeighbours(const geometry::TriangleMesh& mesh, std::vector<SunkPoint>* points) {
  if (points->empty()) return;
  std::vector<SunkPoint> all = *points;
  for (const Vector3i& corners : mesh.elements)
    if (isAnyOf(corners, *points))
      for (int k = 0; k < 3; ++k) all.push_back({corners[k], points->front().sink});
  *points = byVertex(std::move(all));
}

}  // namespace

void Simulator::Impl::addLive(const EnvironmentConfig& environment) {
  if (environment.live.topic.empty()) return;
  const ContactSettings settings = contactSettings(widthOfEnvironments(config_.contact), config_.contact, {&environment.contact});
  LiveGround& live = live_[environment.name];
  live.surface = settings.surface;
  live.width = settings.boundary_width;
  live.fade_speed = environment.live.fade_speed;
  live.is_mesh = environment.live.type != LiveConfig::Type::CLOUD || environment.cloud.as == model::CloudOptions::As::MESH;
  if (!live.is_mesh) return;
  const std::string& name = environment.name;
  if (settings.shrink)
    world_.notes.push_back(name +
                           ": shrink does not reach meshes of topics, which are surfaces without an inside; set shrink: false there");
  if (config_.contact.mending == model::Mending::OFF)
    world_.notes.push_back(name + ": contact.mend_meshes: false does not reach meshes of topics, which are mended beside the steps");
}

double Simulator::Impl::layerOf(const CloudSurface& surface, LiveGround* live) const {
  if (!surface.isMesh()) return surface.radius;
  if (live->width.automatic) {
    WidthNeeds needs = needsOfEnvironment();
    if (!surface.report.closed) needs.noise = scanNoise(surface.geometry->mesh(), surface.geometry->topology());
    needs.stiffness = live->surface.stiffness;
    needs.time_step = config_.time_step;
    live->width = chosenWidth(needs).width;
  }
  return live->width.metres;
}

/** Tells contacts by which something stands on a model: those of a pair that the last step chose, if it chose some. */
void Simulator::Impl::forStoodOn(int model, const std::function<void(const StoodOn&)>& tell) const {
  for (const contact::ContactManifold& manifold : at_hand_.manifolds)
    for (const bool is_a : {true, false}) {
      if (world_.colliders[is_a ? manifold.a : manifold.b].model != model) continue;
      const reduction::ContactIds& chosen = constraint_maker_.memory().of(manifold);
      std::size_t told = 0;
      for (const contact::Contact& contact : manifold.contacts) {
        if (contact.pierced || contact.depth < -TOUCH) continue;
        if (chosen.empty() ? told == MOST_LEFT : !std::binary_search(chosen.begin(), chosen.end(), contact.id)) continue;
        tell({contact, is_a ? manifold.a : manifold.b, is_a ? manifold.b : manifold.a, is_a});
        ++told;
      }
    }
}

SunkSurface Simulator::Impl::pointsStoodOn(int model, const Pose& X_CW) const {
  struct Point {
    Vector3 p_W;
    double sink, radius;
  };
  SunkSurface surface;
  std::vector<Point> points;
  forStoodOn(model, [&](const StoodOn& on) {
    const contact::Collider& collider = world_.colliders[on.live];
    const int vertex = contact::vertexOf(on.contact.id, on.is_a);
    points.push_back({collider.X_BC * collider.geometry->mesh().vertices[vertex], fading_.sinkOf(on.live, vertex), collider.radius});
    surface.radius = std::max(surface.radius, collider.radius);
  });
  for (Point& point : points) point.sink += surface.radius - point.radius;
  const auto key = [](const Point& p) { return std::make_tuple(p.p_W.x(), p.p_W.y(), p.p_W.z(), p.sink); };
  std::sort(points.begin(), points.end(), [&](const Point& a, const Point& b) { return key(a) < key(b); });
  points.erase(std::unique(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.p_W == b.p_W; }), points.end());
  std::vector<Vector3> places;
  for (const Point& point : points) {
    surface.sunk.push_back({static_cast<int>(places.size()), std::max(point.sink, BEGUN)});
    places.push_back(X_CW * point.p_W);
  }
  surface.mesh = geometry::pointCloudMesh(places, nullptr);
  return surface;
}

Vector3 Simulator::Impl::wayAhead(int collider, const Vector3& p_W) const {
  const int index = world_.colliders[collider].body;
  if (index == dynamics::WORLD_BODY) return Vector3::Zero();
  const dynamics::BodyState& body = bodies_[index];
  const Vector3 com = body.X_WB * world_.world.bodySpec(index).inertial.com;
  const Vector3 way = LOOK_AHEAD * (body.v_WCom + body.w_WB.cross(p_W - com));
  return way * std::min(1.0, FARTHEST_AHEAD / std::max(way.norm(), STAYS));
}

Vector3 Simulator::Impl::wayUp() const {
  const Vector3& gravity = world_.world.gravity();
  return gravity.isZero() ? Vector3::Zero() : Vector3(-gravity.normalized());
}

SunkSurface Simulator::Impl::trianglesStoodOn(int model, const Pose& X_CW) const {
  LeavingTriangles triangles(world_.colliders);
  forStoodOn(model, [&](const StoodOn& on) {
    const contact::Collider& live = world_.colliders[on.live];
    triangles.addTouched(on.live, touchedPlace(live, on.contact, on.is_a), wayAhead(on.other, on.contact.point),
                         fading_.sinkOf(live, on.live, on.contact, on.is_a));
  });
  return triangles.surface(X_CW, fading_, BEGUN);
}

std::map<int, double> Simulator::Impl::depthsOn(int model) const {
  std::map<int, double> depths;
  for (const contact::ContactManifold& manifold : at_hand_.manifolds)
    for (const bool is_a : {true, false}) {
      if (world_.colliders[is_a ? manifold.a : manifold.b].model != model) continue;
      double& depth = depths[is_a ? manifold.b : manifold.a];
      depth = std::max(depth, manifold.maxDepth());
    }
  return depths;
}

void Simulator::Impl::sinkBorders(int leaving, const std::map<int, double>& depths) {
  std::vector<SunkPoint> more;
  for (const contact::ContactManifold& manifold : found_.manifolds) {
    const bool is_a = manifold.a == leaving;
    if (!is_a && manifold.b != leaving) continue;
    const auto before = depths.find(is_a ? manifold.b : manifold.a);
    const double depth = before == depths.end() ? 0 : before->second;
    for (const contact::Contact& contact : manifold.contacts) {
      if (contact.depth < depth + TOUCH) continue;
      const contact::MeshPlace place = touchedPlace(world_.colliders[leaving], contact, is_a);
      for (int k = 0; k < 3; ++k)
        if (place.weights[k] > 0) more.push_back({place.corners[k], contact.depth - depth});
    }
  }
  fading_.deepen(leaving, byVertex(std::move(more)));
}

int Simulator::Impl::addFading(const LiveGround& live, SunkSurface surface, bool leaves) {
  if (surface.mesh.elements.empty()) return -1;
  contact::Collider fading = world_.colliders[live.cloud];
  fading.name += leaves ? "::leaving" : "::rising";
  fading.radius = surface.radius;
  geometry::MeshReport report;
  report.source = leaves ? "a surface that sinks away below what stood on it" : "points that rise below what has sunk into the surface";
  report.vertices = static_cast<int>(surface.mesh.vertices.size());
  (leaves && live.is_mesh ? report.triangles : report.points) = static_cast<int>(surface.mesh.elements.size());
  report.extents = surface.mesh.bounds();
  fading.geometry =
      std::make_shared<const contact::CollisionGeometry>(std::make_shared<const geometry::TriangleMesh>(std::move(surface.mesh)));
  const int collider = world_.addCollider(fading, fading.radius, fading.surface, report);
  layer_watch_.forget(collider);
  fading_.add(collider, leaves ? live.fade_speed : -live.fade_speed, std::move(surface.sunk));
  return collider;
}

SunkSurface Simulator::Impl::belowBuried(const LiveGround& live, const InnerPoints& inner) const {
  const contact::Collider& surface = world_.colliders[live.cloud];
  double farthest = 0;
  for (const BuriedPoints& buried : inner.buried) farthest = std::max(farthest, wayOut(buried, live));
  SunkSurface below;
  below.radius = surface.radius + farthest;
  std::vector<SunkPoint> points;
  for (const BuriedPoints& buried : inner.buried) {
    const std::size_t stride = 1 + buried.vertices.size() / MOST_RISING;
    for (std::size_t i = 0; i < buried.vertices.size(); i += stride)
      points.push_back({buried.vertices[i], wayOut(buried, live) - buried.way + buried.ways[i]});
  }
  // A point in two bodies is one.
  std::vector<Vector3> places;
  for (const SunkPoint& point : byVertex(std::move(points))) {
    below.sunk.push_back({static_cast<int>(places.size()), point.sink});
    places.push_back(surface.geometry->mesh().vertices[point.vertex] - farthest * (surface.X_BC.linear().transpose() * wayUp()));
  }
  below.mesh = geometry::pointCloudMesh(places, nullptr);
  return below;
}

double Simulator::Impl::wayOut(const BuriedPoints& buried, const LiveGround& live) const {
  return buried.way + world_.colliders[buried.body_collider].radius + world_.colliders[live.cloud].radius;
}

double Simulator::Impl::sinkTouched(const LiveGround& live, const contact::ContactManifold& manifold, const contact::Contact& contact,
                                    const BuriedPoints* buried) const {
  constexpr double FOR_GOOD = std::numeric_limits<double>::infinity();
  const bool is_a = manifold.a == live.cloud;
  const double upwards = (is_a ? -1 : 1) * contact.normal_BA.dot(wayUp());
  if (upwards >= FadingPoints::UPWARDS || !fading_.crosses(manifold.a, manifold.b))
    return buried ? std::max(contact.depth, wayOut(*buried, live)) : contact.depth;
  if (!buried) return FOR_GOOD;
  const Vector3i corners = touchedPlace(world_.colliders[live.cloud], contact, is_a).corners;
  const auto isBuried = [&](int vertex) { return std::binary_search(buried->vertices.begin(), buried->vertices.end(), vertex); };
  const bool is_above = upwards <= -FadingPoints::UPWARDS && std::none_of(corners.data(), corners.data() + 3, isBuried);
  return is_above ? FOR_GOOD : wayOut(*buried, live);
}

void Simulator::Impl::addSunk(const LiveGround& live, const contact::ContactManifold& manifold, const BuriedPoints* buried,
                              std::vector<SunkPoint>* sunk) const {
  const contact::Collider& surface = world_.colliders[live.cloud];
  const bool is_a = manifold.a == live.cloud;
  for (const contact::Contact& contact : manifold.contacts) {
    if (!(contact.depth > 0) || contact.pierced) continue;
    const contact::MeshPlace place = touchedPlace(surface, contact, is_a);
    // New places touch once old ones have begun to sink, in the step after the exchange.
    const double depth = sinkTouched(live, manifold, contact, buried) + live.fade_speed * config_.time_step;
    for (int k = 0; k < 3; ++k)
      if (place.weights[k] > 0) sunk->push_back({place.corners[k], depth});
    const Vector3 way = wayAhead(is_a ? manifold.b : manifold.a, contact.point);
    if (!live.is_mesh || way.norm() < STAYS) continue;
    visitTouched(surface, place, way, [&](int element) {
      const Vector3i& corners = surface.geometry->mesh().elements[element];
      for (int k = 0; k < 3; ++k) sunk->push_back({corners[k], depth});
    });
  }
}

void Simulator::Impl::sinkIntoTouch(const LiveGround& live, const InnerPoints& inner) {
  std::vector<SunkPoint> sunk = byVertex(inner.gone);
  if (live.is_mesh) addNeighbours(world_.colliders[live.cloud].geometry->mesh(), &sunk);
  for (const BuriedPoints& buried : inner.buried)
    for (const int vertex : buried.around) sunk.push_back({vertex, wayOut(buried, live)});
  for (const contact::ContactManifold& manifold : found_.manifolds) {
    if (manifold.a != live.cloud && manifold.b != live.cloud) continue;
    const int other = manifold.a == live.cloud ? manifold.b : manifold.a;
    const auto buried = std::find_if(inner.buried.begin(), inner.buried.end(), [&](const auto& b) { return b.body_collider == other; });
    addSunk(live, manifold, buried == inner.buried.end() ? nullptr : &*buried, &sunk);
  }
  fading_.add(live.cloud, -live.fade_speed, byVertex(std::move(sunk)));
}

void Simulator::Impl::searchBeside(int model) {
  const auto search = [this] {
    pair_watch_.find({world_, bodies_, nullptr, config_.time_step}, &pairs_);
    pair_searches_.find(world_, at_hand_, fading_, &pairs_, &found_);
  };
  search();
  bool crosses = false;
  for (const contact::ContactManifold& manifold : found_.manifolds) {
    if (!manifold.pierced || (world_.colliders[manifold.a].model != model && world_.colliders[manifold.b].model != model)) continue;
    fading_.addCrossing(manifold.a, manifold.b);
    crosses = true;
  }
  if (crosses) search();
}

CloudNeighbours Simulator::Impl::cloudNeighbours(const std::string& environment) const {
  CloudNeighbours neighbours;
  const auto known = live_.find(environment);
  if (known == live_.end()) return neighbours;
  if (known->second.is_mesh && !known->second.width.automatic) neighbours.width = known->second.width.metres;
  for (std::size_t i = 0; i < world_.colliders.size(); ++i) {
    const contact::Collider& collider = world_.colliders[i];
    if (!collider.enabled || collider.body == dynamics::WORLD_BODY || collider.geometry->isHalfSpace()) continue;
    neighbours.colliders.push_back(
        {static_cast<int>(i), collider.geometry, collider.radius, world_.world.bodyState(collider.body).X_WB * collider.X_BC});
  }
  return neighbours;
}

void Simulator::Impl::updateCloud(const std::string& environment, CloudSurface* surface, std::vector<SearchedAhead>* ahead) {
  const auto known = live_.find(environment);
  if (known == live_.end()) throw InputError(fmt::format("environments: {}: is no live one, or was unloaded", environment));
  LiveGround& live = known->second;
  if (surface->isMesh() != live.is_mesh)
    throw InputError(fmt::format("environments: {}: is made of {}, and these are {}; set cloud.as to what is sent", environment,
                                 live.is_mesh ? "triangles" : "points", live.is_mesh ? "points" : "triangles"));
  const int model = world_.modelIndex(environment);
  if (!surface->geometry) return clearCloud(model, &live, surface);
  world_.bodyStates(&bodies_);
  if (!at_hand_.known) findFirstContacts();
  contact::Collider cloud;
  cloud.name = environment;
  cloud.model = model;
  cloud.X_BC = makePose(surface->origin);
  cloud.geometry = surface->geometry;
  const Pose X_CW = cloud.X_BC.inverse();
  const std::map<int, double> depths = depthsOn(model);
  SunkSurface remains = live.is_mesh ? trianglesStoodOn(model, X_CW) : pointsStoodOn(model, X_CW);
  CloudSurface before;
  if (live.cloud >= 0) {
    before.geometry = world_.colliders[live.cloud].geometry;
    before.radius = surface->radius;
  }
  CarriedContacts carried;
  forStoodOn(model, [&](const StoodOn& on) { carried.add(on.live, on.other, on.contact, on.is_a); });
  const std::vector<std::uint64_t> gone = forgetPairs(world_.collidersOf(model));
  world_.removeShapes(model);
  live.cloud = world_.addCollider(cloud, layerOf(*surface, &live), live.surface, surface->report);
  layer_watch_.forget(live.cloud);
  for (SearchedAhead& searched : *ahead) pair_searches_.know(live.cloud, searched.collider, std::move(searched.memory));
  const int leaving = addFading(live, std::move(remains), true);
  const InnerPoints inner = innerPoints(world_, bodies_, live.cloud, live.is_mesh ? wayUp() : Vector3::Zero());
  const int rising = addFading(live, belowBuried(live, inner), false);
  partWelded();  // what is welded to the environment touches none of its new surfaces

  fading_.setUp(wayUp());
  searchBeside(model);
  world_.world.forgetContacts(gone, carried.onto(leaving, found_.manifolds));
  if (live.is_mesh) sinkBorders(leaving, depths);
  sinkBorders(rising, {});
  sinkIntoTouch(live, inner);
  at_hand_.known = false;
  findFirstContacts();  // in the time between steps
  layout_.clear();
  *surface = std::move(before);
}

void Simulator::Impl::clearCloud(int model, LiveGround* live, CloudSurface* surface) {
  if (live->cloud < 0) return;
  surface->geometry = world_.colliders[live->cloud].geometry;
  forgetContacts(world_.collidersOf(model));
  world_.removeShapes(model);
  live->cloud = -1;
  at_hand_.known = false;
  layout_.clear();
}

void Simulator::Impl::endFading() {
  fading_.clear();
  for (const auto& [name, live] : live_) {
    const int model = world_.modelIndex(name);
    for (const int collider : world_.collidersOf(model)) {
      if (collider == live.cloud) continue;
      forgetContacts({collider});
      world_.removeShape(collider);
      layout_.clear();
    }
  }
}

}  // namespace blem_sim::sim
