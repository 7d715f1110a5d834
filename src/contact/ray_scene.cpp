#include "blem_sim/contact/ray_scene.h"

#include <utility>

#include "kernels/kernels.h"
#include "ray_turns.h"

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

static_assert(RayFan::WIDTH == kernels::FAN, "a lane each");
static_assert(kernels::DEEPEST_TREE == geometry::Bvh::MAX_DEPTH && kernels::FAN_ROUNDING == geometry::bvh_detail::ROUNDING,
              "walks are the same");
static_assert(sizeof(geometry::Bvh::Node) == 2 * 3 * sizeof(float) + 2 * sizeof(std::uint32_t), "as the kernels read it");
static_assert(sizeof(Vector3i) == 3 * sizeof(int) && sizeof(Vector3) == 3 * sizeof(double), "as the kernels read them");

kernels::FanTree treeOf(const geometry::Bvh& tree, double wider) {
  return {reinterpret_cast<const unsigned char*>(tree.nodes().data()), wider};
}

RayFan moved(const Pose& X, const RayFan& fan) {
  RayFan out;
  out.origin = X * fan.origin;
  for (int ray = 0; ray < RayFan::WIDTH; ++ray) out.directions[ray] = turned(X.linear(), fan.directions[ray]);
  return out;
}

kernels::FanRays numbersOf(const RayFan& fan, double nearest) {
  kernels::FanRays numbers;
  numbers.nearest = nearest;
  for (int k = 0; k < 3; ++k) {
    numbers.origin[k] = fan.origin[k];
    for (int ray = 0; ray < RayFan::WIDTH; ++ray) numbers.directions[k][ray] = fan.directions[ray][k];
  }
  return numbers;
}

/** Coordinate along which all directions are longest; -1: not the same one, or a direction is zero. */
int commonAxis(const RayFan& fan) {
  const int axis = geometry::longestAxis(fan.directions[0]);
  for (const Vector3& direction : fan.directions)
    if (geometry::longestAxis(direction) != axis || direction[axis] == 0) return -1;
  return axis;
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

/** The first hits of one fan. */
class RayScene::Search {
 public:
  Search(const RayScene& scene, const RayFan& fan, const Query& query) : scene_(scene), fan_(fan), query_(query) {
    hits_.fill({query.farthest, -1});
  }

  Hits firstHits() {
    for (const int target : scene_.unbounded_) addRays(target, kernels::ALL_OF_FAN);
    keepEnds();
    if (!scene_.boxes_.empty()) kernels::kernels().fanLeaves(treeOf(scene_.boxes_, 0), numbersOf(fan_, 0), ends_, {addLeaf, this});
    for (Hit& hit : hits_)
      if (hit.target < 0) hit = Hit();
    return hits_;
  }

 private:
  static void addLeaf(void* self, std::uint32_t leaf, unsigned lanes) {
    Search& search = *static_cast<Search*>(self);
    const geometry::Bvh& boxes = search.scene_.boxes_;
    const geometry::Bvh::Node& node = boxes.nodes()[leaf];
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) search.addFan(search.scene_.bounded_[boxes.order()[i]], lanes);
    search.keepEnds();
  }

  /** @param lanes bits of the rays that count */
  void addFan(int target, unsigned lanes) {
    const RayFan fan_C = moved(scene_.X_CW_[target], fan_);
    const int axis = commonAxis(fan_C);
    if (axis < 0) return addRays(target, lanes);
    const RayTarget& of = scene_.targets_[target];
    const geometry::TriangleMesh& mesh = of.geometry->mesh();
    const kernels::FanMesh triangles{treeOf(of.geometry->bvh(), of.radius), of.geometry->bvh().order().data(), mesh.elements.data()->data(),
                                     mesh.vertices.data()->data(), axis};
    kernels::FanHits found = endsOf(lanes);
    const bool others = kernels::kernels().fanTriangles(triangles, numbersOf(fan_C, nearest(target)), &found);
    if (others && of.radius > 0) return addRays(target, lanes);
    for (int ray = 0; ray < RayFan::WIDTH; ++ray)
      if (found.element[ray] >= 0) add(target, ray, found.t[ray]);
  }

  /** One by one: what is no triangle, and rays that lead apart. */
  void addRays(int target, unsigned lanes) {
    for (int ray = 0; ray < RayFan::WIDTH; ++ray)
      if (lanes >> ray & 1) add(target, ray, hit(target, {fan_.origin, fan_.directions[ray]}, {nearest(target), hits_[ray].t}));
  }

  double hit(int target, const geometry::Ray& ray, const geometry::RayRange& range) const {
    const CollisionGeometry& geometry = *scene_.targets_[target].geometry;
    const Pose& X_CW = scene_.X_CW_[target];
    const geometry::Ray ray_C{X_CW * ray.origin, turned(X_CW.linear(), ray.direction)};
    if (!geometry.isHalfSpace()) {
      return geometry::castRay({geometry.bvh(), geometry.mesh(), scene_.targets_[target].radius}, ray_C, range).t;
    }
    const double fall = geometry.planeNormal().dot(ray_C.direction);
    const double t = (geometry.planeOffset() - geometry.planeNormal().dot(ray_C.origin)) / fall;
    return fall != 0 && t >= range.nearest && t <= range.farthest ? t : INFINITE;
  }

  double nearest(int target) const { return query_.nearestOf(scene_.targets_[target].model); }

  void add(int target, int ray, double t) {
    Hit& first = hits_[ray];
    if (t == INFINITE || t > first.t) return;
    if (t < first.t || first.target < 0 || target < first.target) first = {t, target};
  }

  void keepEnds() {
    for (int ray = 0; ray < RayFan::WIDTH; ++ray) ends_[ray] = hits_[ray].t;
  }

  kernels::FanHits endsOf(unsigned lanes) const {
    kernels::FanHits ends;
    for (int ray = 0; ray < RayFan::WIDTH; ++ray) {
      ends.t[ray] = lanes >> ray & 1 ? hits_[ray].t : -INFINITE;
      ends.element[ray] = -1;
    }
    return ends;
  }

  const RayScene& scene_;
  const RayFan& fan_;
  const Query& query_;
  Hits hits_;
  double ends_[RayFan::WIDTH];  // where each ray ends to count
};

RayScene::Hits RayScene::firstHits(const RayFan& fan, const Query& query) const { return Search(*this, fan, query).firstHits(); }

}  // namespace blem_sim::contact
