// Bullet's GImpact, mesh against mesh.
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>

#include "bullet_mesh.h"
#include "peer.h"

namespace blem_sim {
namespace {

struct BulletBody {
  BulletBody(const contact::Collider& collider) : mesh(bulletMesh(collider.geometry->mesh())), shape(mesh.get()) {
    shape.setMargin(static_cast<btScalar>(collider.radius));
    shape.updateBound();
    object.setCollisionShape(&shape);
  }
  std::unique_ptr<btTriangleMesh> mesh;
  btGImpactMeshShape shape;
  btCollisionObject object;
};

/** Counts the points instead of keeping four of them. */
class PointCounter : public btManifoldResult {
 public:
  using btManifoldResult::btManifoldResult;
  void addContactPoint(const btVector3&, const btVector3&, btScalar) override { ++count_; }
  std::size_t count() const { return count_; }

 private:
  std::size_t count_ = 0;
};

class BulletPeer : public Peer {
 public:
  explicit BulletPeer(const ContactScene& scene) : dispatcher_(&configuration_), standing_(scene.standing) {
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
    for (const contact::Collider& collider : scene.moving) moving_.push_back(std::make_unique<BulletBody>(collider));
  }
  std::size_t query(std::size_t collider, const Pose& X) override {
    const Matrix3 R = X.linear();
    const btMatrix3x3 turn(static_cast<btScalar>(R(0, 0)), static_cast<btScalar>(R(0, 1)), static_cast<btScalar>(R(0, 2)),
                           static_cast<btScalar>(R(1, 0)), static_cast<btScalar>(R(1, 1)), static_cast<btScalar>(R(1, 2)),
                           static_cast<btScalar>(R(2, 0)), static_cast<btScalar>(R(2, 1)), static_cast<btScalar>(R(2, 2)));
    moving_[collider]->object.setWorldTransform(btTransform(turn, toBullet(X.translation())));
    const btCollisionObjectWrapper a = wrapped(moving_[collider]->object), b = wrapped(standing_.object);
    PointCounter counter(&a, &b);
    btCollisionAlgorithm* algorithm = dispatcher_.findAlgorithm(&a, &b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
    algorithm->processCollision(&a, &b, {}, &counter);
    algorithm->~btCollisionAlgorithm();
    dispatcher_.freeCollisionAlgorithm(algorithm);
    return counter.count();
  }

 private:
  static btCollisionObjectWrapper wrapped(const btCollisionObject& object) {
    return {nullptr, object.getCollisionShape(), &object, object.getWorldTransform(), -1, -1};
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  BulletBody standing_;
  std::vector<std::unique_ptr<BulletBody>> moving_;
};

}  // namespace

std::unique_ptr<Peer> makeBulletPeer(const ContactScene& scene) { return std::make_unique<BulletPeer>(scene); }

}  // namespace blem_sim
