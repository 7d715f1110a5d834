#include "bullet_heap.h"

#ifdef BLEM_SIM_WITH_BULLET

#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>

namespace blem_sim {
namespace {

constexpr int SWEEPS = 50;
constexpr double MARGIN = 0.001;        // [m], inside of boxes; the default of 4 cm would round them
constexpr double WALL_THICKNESS = 0.2;  // [m]

btVector3 toBullet(const Vector3& v) { return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())}; }

class Heap : public BulletHeap {
 public:
  explicit Heap(const HeapScene& scene)
      : scene_(scene), dispatcher_(&configuration_), world_(&dispatcher_, &broad_phase_, &solver_, &configuration_) {
    world_.setGravity({0, 0, static_cast<btScalar>(-9.81)});
    world_.getSolverInfo().m_numIterations = SWEEPS;
    addBin();
    btCollisionShape* piece = scene.spheres ? addShape(std::make_unique<btSphereShape>(static_cast<btScalar>(0.5 * scene.size)))
                                            : addShape(std::make_unique<btBoxShape>(toBullet(Vector3::Constant(0.5 * scene.size))));
    if (!scene.spheres) piece->setMargin(static_cast<btScalar>(MARGIN));
    for (const Pose& X_WC : scene.poses) addBody(piece, scene.mass, X_WC);
  }
  ~Heap() override {
    for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  }
  void step() override { world_.stepSimulation(static_cast<btScalar>(scene_.time_step), 0); }
  double deepest() const override {
    double deepest = 0;
    for (int m = 0; m < dispatcher_.getNumManifolds(); ++m) {
      const btPersistentManifold& manifold = *const_cast<btCollisionDispatcher&>(dispatcher_).getManifoldByIndexInternal(m);
      for (int i = 0; i < manifold.getNumContacts(); ++i)
        deepest = std::max(deepest, -static_cast<double>(manifold.getContactPoint(i).getDistance()));
    }
    return deepest;
  }
  double fastest() const override {
    double fastest = 0;
    for (const auto& body : bodies_) fastest = std::max(fastest, static_cast<double>(body->getLinearVelocity().length()));
    return fastest;
  }

 private:
  btCollisionShape* addShape(std::unique_ptr<btCollisionShape> shape) {
    shapes_.push_back(std::move(shape));
    return shapes_.back().get();
  }

  void addBody(btCollisionShape* shape, double mass, const Pose& X_WC) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(static_cast<btScalar>(mass), inertia);
    btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(mass), nullptr, shape, inertia);
    info.m_friction = static_cast<btScalar>(std::sqrt(scene_.friction));  // Bullet multiplies the two
    const Quaternion q(X_WC.linear());
    info.m_startWorldTransform = btTransform(btQuaternion(static_cast<btScalar>(q.x()), static_cast<btScalar>(q.y()),
                                                          static_cast<btScalar>(q.z()), static_cast<btScalar>(q.w())),
                                             toBullet(X_WC.translation()));
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
    world_.addRigidBody(bodies_.back().get());
  }

  void addBox(const Vector3& lower, const Vector3& upper) {
    addBody(addShape(std::make_unique<btBoxShape>(toBullet(0.5 * (upper - lower)))), 0, Pose(Eigen::Translation3d(0.5 * (lower + upper))));
  }

  void addBin() {
    const double half = 0.5 * scene_.bin_width, outer = half + WALL_THICKNESS, height = scene_.bin_height;
    addBox({-outer, -outer, -WALL_THICKNESS}, {outer, outer, 0});
    addBox({-outer, -outer, 0}, {-half, outer, height});
    addBox({half, -outer, 0}, {outer, outer, height});
    addBox({-half, -outer, 0}, {half, -half, height});
    addBox({-half, half, 0}, {half, outer, height});
  }

  const HeapScene scene_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broad_phase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

}  // namespace

std::unique_ptr<BulletHeap> makeBulletHeap(const HeapScene& scene) { return std::make_unique<Heap>(scene); }

}  // namespace blem_sim

#else

namespace blem_sim {
std::unique_ptr<BulletHeap> makeBulletHeap(const HeapScene&) { return nullptr; }
}  // namespace blem_sim

#endif
