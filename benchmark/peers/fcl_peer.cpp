// FCL, meshes under trees of oriented boxes and swept spheres.
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include "peer.h"

namespace blem_sim {
namespace {

using FclMesh = fcl::BVHModel<fcl::OBBRSSd>;

std::shared_ptr<FclMesh> fclMesh(const geometry::TriangleMesh& mesh) {
  std::vector<fcl::Triangle> triangles;
  for (const Vector3i& e : mesh.elements)
    triangles.emplace_back(static_cast<std::size_t>(e[0]), static_cast<std::size_t>(e[1]), static_cast<std::size_t>(e[2]));
  auto out = std::make_shared<FclMesh>();
  out->beginModel(static_cast<int>(triangles.size()), static_cast<int>(mesh.vertices.size()));
  out->addSubModel(mesh.vertices, triangles);
  out->endModel();
  return out;
}

class FclPeer : public Peer {
 public:
  explicit FclPeer(const ContactScene& scene) : standing_(fclMesh(scene.standing.geometry->mesh())) {
    for (const contact::Collider& collider : scene.moving) moving_.push_back(fclMesh(collider.geometry->mesh()));
  }

 protected:
  const fcl::Transform3d X_standing_ = fcl::Transform3d::Identity();
  std::shared_ptr<FclMesh> standing_;
  std::vector<std::shared_ptr<FclMesh>> moving_;
};

class FclDistance : public FclPeer {
 public:
  using FclPeer::FclPeer;
  std::size_t query(std::size_t collider, const Pose& X) override {
    const fcl::DistanceRequestd request;
    fcl::DistanceResultd result;
    fcl::distance<double>(moving_[collider].get(), X, standing_.get(), X_standing_, request, result);
    return 1;
  }
};

class FclCollide : public FclPeer {
 public:
  using FclPeer::FclPeer;
  std::size_t query(std::size_t collider, const Pose& X) override {
    constexpr std::size_t MOST = 1000000;
    const fcl::CollisionRequestd request(MOST);
    fcl::CollisionResultd result;
    return fcl::collide<double>(moving_[collider].get(), X, standing_.get(), X_standing_, request, result);
  }
};

}  // namespace

std::unique_ptr<Peer> makeFclDistancePeer(const ContactScene& scene) { return std::make_unique<FclDistance>(scene); }
std::unique_ptr<Peer> makeFclCollidePeer(const ContactScene& scene) { return std::make_unique<FclCollide>(scene); }

}  // namespace blem_sim
