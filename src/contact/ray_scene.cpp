#include "blem_sim/contact/ray_scene.h"

#include <utility>

namespace blem_sim::contact {
namespace {

constexpr double INFINITE = std::numeric_limits<double>::infinity();
constexpr double ROUNDING = 1e-14;  // of a box that is turned, relative to its coordinates

/** Box in the world that holds a target with its radius. */
Box worldBox(const RayTarget& target) {
  Box box;
  const Box& bounds = target.geometry->bounds();
  for (int corner = 0; corner < 8; ++corner) box.extend(target.X_WC * bounds.corner(static_cast<Box::CornerType>(corner)));
  const double wider = target.radius + ROUNDING * (box.min().cwiseAbs() + box.max().cwiseAbs()).maxCoeff();
  return Box(box.min().array() - wider, box.max().array() + wider);
}

}  // namespace

RayScene::RayScene(std::vector<RayTarget> targets) : targets_(std::move(targets)) {
  geometry::TriangleMesh diagonals;
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    X_CW_.push_back(targets_[i].X_WC.inverse());
    if (targets_[i].geometry->isHalfSpace()) {
      unbounded_.push_back(static_cast<int>(i));
    } else if (!targets_[i].geometry->bvh().empty()) {
      const Box box = worldBox(targets_[i]);
      const int first = static_cast<int>(diagonals.vertices.size());
      diagonals.vertices.insert(diagonals.vertices.end(), {box.min(), box.max()});
      diagonals.elements.emplace_back(first, first + 1, first + 1);
      bounded_.push_back(static_cast<int>(i));
    }
  }
  boxes_ = geometry::Bvh(diagonals, 1);
}

double RayScene::hit(int target, const geometry::Ray& ray, const geometry::RayRange& range) const {
  const CollisionGeometry& geometry = *targets_[target].geometry;
  const geometry::Ray ray_C{X_CW_[target] * ray.origin, X_CW_[target].linear() * ray.direction};
  if (!geometry.isHalfSpace()) return geometry::castRay({geometry.bvh(), geometry.mesh(), targets_[target].radius}, ray_C, range).t;
  const double fall = geometry.planeNormal().dot(ray_C.direction);
  const double t = (geometry.planeOffset() - geometry.planeNormal().dot(ray_C.origin)) / fall;
  return fall != 0 && t >= range.nearest && t <= range.farthest ? t : INFINITE;
}

void RayScene::add(int target, const geometry::Ray& ray, const Query& query, Hit* first) const {
  const bool own = targets_[target].model == query.own_model && query.own_model >= 0;
  const double t = hit(target, ray, {own ? query.own_nearest : 0, first->t});
  if (t == INFINITE || t > first->t) return;
  if (t < first->t || first->target < 0 || target < first->target) *first = {t, target};
}

RayScene::Hit RayScene::firstHit(const geometry::Ray& ray, const Query& query) const {
  Hit first{query.farthest, -1};
  for (const int target : unbounded_) add(target, ray, query, &first);
  geometry::visitLeavesAlong(geometry::RaySlabs(ray, 0, 0), boxes_, &first.t, [&](std::uint32_t leaf) {
    const geometry::Bvh::Node& node = boxes_.nodes()[leaf];
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) add(bounded_[boxes_.order()[i]], ray, query, &first);
  });
  return first.target < 0 ? Hit() : first;
}

}  // namespace blem_sim::contact
