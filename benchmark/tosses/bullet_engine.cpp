// Bullet's rounded box (hull of its corners, moved inwards by the margin) on its plane. Surface: friction, restitution, margin.
#include <btBulletDynamicsCommon.h>

#include <cmath>

#include "engine.h"

namespace blem_sim {
namespace {

btVector3 toBullet(const Vector3& v) { return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())}; }

class Bullet : public TossEngine {
 public:
  explicit Bullet(const TossScene& scene)
      : scene_(scene),
        dispatcher_(&configuration_),
        world_(&dispatcher_, &broad_phase_, &solver_, &configuration_),
        plane_({0, 0, 1}, static_cast<btScalar>(scene.floor)) {
    world_.setGravity(toBullet(scene.gravity));
    const double margin = scene.surface.at("margin"), half = 0.5 * scene.side - margin;
    for (int i = 0; i < 8; ++i)
      hull_.addPoint(toBullet(Vector3(i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half) - scene.com));
    hull_.setMargin(static_cast<btScalar>(margin));
    plane_.setMargin(0);
    floor_ = body(0, &plane_, Vector3::Zero());
    world_.addRigidBody(floor_.get());
  }
  ~Bullet() override {
    if (cube_) world_.removeRigidBody(cube_.get());
    world_.removeRigidBody(floor_.get());
  }
  void start(const TossMotion& motion) override {
    if (cube_) world_.removeRigidBody(cube_.get());
    cube_ = body(scene_.mass, &hull_, scene_.inertia);
    const Quaternion q(motion.X_WM.linear());
    const btQuaternion turn(static_cast<btScalar>(q.x()), static_cast<btScalar>(q.y()), static_cast<btScalar>(q.z()),
                            static_cast<btScalar>(q.w()));
    cube_->setWorldTransform(btTransform(turn, toBullet(motion.X_WM * scene_.com)));
    cube_->setLinearVelocity(toBullet(motion.v_WCom));
    cube_->setAngularVelocity(toBullet(motion.w_WM));
    cube_->setActivationState(DISABLE_DEACTIVATION);
    world_.addRigidBody(cube_.get());
  }
  void step() override { world_.stepSimulation(static_cast<btScalar>(scene_.time_step), 0); }
  Pose pose() const override {
    const btTransform& T = cube_->getWorldTransform();
    const btQuaternion q = T.getRotation();
    Pose X = Pose::Identity();
    X.linear() = Quaternion(q.w(), q.x(), q.y(), q.z()).normalized().toRotationMatrix();
    X.translation() = Vector3(T.getOrigin().x(), T.getOrigin().y(), T.getOrigin().z()) - X.linear() * scene_.com;
    return X;
  }

 private:
  std::unique_ptr<btRigidBody> body(double mass, btCollisionShape* shape, const Vector3& inertia) const {
    btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(mass), nullptr, shape, toBullet(inertia));
    info.m_friction = static_cast<btScalar>(std::sqrt(scene_.surface.at("friction")));  // Bullet multiplies the two
    info.m_restitution = static_cast<btScalar>(std::sqrt(scene_.surface.at("restitution")));
    auto made = std::make_unique<btRigidBody>(info);
    made->setFlags(BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY);
    return made;
  }

  const TossScene scene_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broad_phase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_;
  btConvexHullShape hull_;
  btStaticPlaneShape plane_;
  std::unique_ptr<btRigidBody> floor_, cube_;
};

}  // namespace

std::unique_ptr<TossEngine> makeBulletToss(const TossScene& scene) { return std::make_unique<Bullet>(scene); }

}  // namespace blem_sim
