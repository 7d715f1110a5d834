// Bullet's GImpact meshes, with the engine's own defaults.
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>

#include "../peers/bullet_mesh.h"
#include "engine.h"

namespace blem_sim {
namespace {

Vector3 fromBullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

class Bullet : public Engine {
 public:
  explicit Bullet(const StackScene& scene)
      : scene_(scene),
        dispatcher_(&configuration_),
        world_(&dispatcher_, &broad_phase_, &solver_, &configuration_),
        cube_mesh_(bulletMesh(scene.cube)),
        ground_mesh_(bulletMesh(scene.ground)),
        cube_(cube_mesh_.get()),
        ground_(ground_mesh_.get(), true) {
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
    world_.setGravity({0, 0, static_cast<btScalar>(-9.81)});
    cube_.setMargin(MARGIN);
    ground_.setMargin(MARGIN);
    cube_.updateBound();
    add(&ground_, 0, 0);
    const double size = scene.cube.bounds().sizes().z();
    for (int i = 0; i < scene.cubes; ++i) add(&cube_, scene.mass, 0.5 * size + scene.gap + i * (size + scene.gap));
  }
  ~Bullet() override {
    for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  }
  void step() override { world_.stepSimulation(static_cast<btScalar>(scene_.time_step), 0); }
  std::vector<CubeState> cubes() const override {
    std::vector<CubeState> states;
    for (std::size_t i = 1; i < bodies_.size(); ++i)
      states.push_back({fromBullet(bodies_[i]->getWorldTransform().getOrigin()), fromBullet(bodies_[i]->getLinearVelocity())});
    return states;
  }

 private:
  // The best margin here from 0.5 to 10 mm; the shape's own default of 4 cm throws cubes of 10 cm away.
  static constexpr btScalar MARGIN = static_cast<btScalar>(0.001);  // [m]

  void add(btCollisionShape* shape, double mass, double height) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) {
      const double size = scene_.cube.bounds().sizes().z();
      inertia = toBullet(Vector3::Constant(mass * size * size / 6));
    }
    btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(mass), nullptr, shape, inertia);
    info.m_friction = static_cast<btScalar>(std::sqrt(scene_.friction));  // Bullet multiplies the two
    info.m_startWorldTransform = btTransform(btQuaternion::getIdentity(), toBullet({0, 0, height}));
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
    world_.addRigidBody(bodies_.back().get());
  }

  const StackScene scene_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broad_phase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_;
  std::unique_ptr<btTriangleMesh> cube_mesh_, ground_mesh_;
  btGImpactMeshShape cube_;
  btBvhTriangleMeshShape ground_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

}  // namespace

std::unique_ptr<Engine> makeBulletGimpact(const StackScene& scene) { return std::make_unique<Bullet>(scene); }

}  // namespace blem_sim
