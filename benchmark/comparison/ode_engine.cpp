// ODE as Gazebo classic uses it for meshes: OPCODE trimesh against trimesh, contact joints, the engine's own defaults.
#include "../peers/ode_mesh.h"
#include "engine.h"

namespace blem_sim {
namespace {

class Ode : public Engine {
 public:
  Ode(const StackScene& scene, bool quick)
      : scene_(scene),
        quick_(quick),
        cube_mesh_(scene.cube),
        ground_mesh_(scene.ground),
        world_(dWorldCreate()),
        space_(dHashSpaceCreate(nullptr)),
        contacts_(dJointGroupCreate(0)) {
    dWorldSetGravity(world_, 0, 0, -9.81);
    dCreateTriMesh(space_, ground_mesh_.data, nullptr, nullptr, nullptr);
    const double size = scene.cube.bounds().sizes().z();
    for (int i = 0; i < scene.cubes; ++i) {
      const dBodyID body = dBodyCreate(world_);
      dMass mass;
      dMassSetBoxTotal(&mass, scene.mass, size, size, size);
      dBodySetMass(body, &mass);
      dBodySetPosition(body, 0, 0, 0.5 * size + scene.gap + i * (size + scene.gap));
      dGeomSetBody(dCreateTriMesh(space_, cube_mesh_.data, nullptr, nullptr, nullptr), body);
      bodies_.push_back(body);
    }
  }
  ~Ode() override {
    dJointGroupDestroy(contacts_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
  }
  void step() override {
    dSpaceCollide(space_, this, &Ode::collide);
    quick_ ? dWorldQuickStep(world_, scene_.time_step) : dWorldStep(world_, scene_.time_step);
    dJointGroupEmpty(contacts_);
  }
  std::vector<CubeState> cubes() const override {
    std::vector<CubeState> states;
    for (const dBodyID body : bodies_) {
      const dReal *p = dBodyGetPosition(body), *v = dBodyGetLinearVel(body);
      states.push_back({{p[0], p[1], p[2]}, {v[0], v[1], v[2]}});
    }
    return states;
  }

 private:
  static void collide(void* self, dGeomID a, dGeomID b) {
    constexpr int MOST = 64;
    Ode& engine = *static_cast<Ode*>(self);
    const dBodyID body_a = dGeomGetBody(a), body_b = dGeomGetBody(b);
    dContactGeom points[MOST];
    const int count = dCollide(a, b, MOST, points, sizeof(dContactGeom));
    for (int i = 0; i < count; ++i) {
      dContact contact = {};
      contact.geom = points[i];
      contact.surface.mode = dContactApprox1;
      contact.surface.mu = engine.scene_.friction;
      dJointAttach(dJointCreateContact(engine.world_, engine.contacts_, &contact), body_a, body_b);
    }
  }

  const StackScene scene_;
  const bool quick_;
  OdeMesh cube_mesh_, ground_mesh_;
  dWorldID world_;
  dSpaceID space_;
  dJointGroupID contacts_;
  std::vector<dBodyID> bodies_;
};

std::unique_ptr<Engine> make(const StackScene& scene, bool quick) {
  return initialiseOde() ? std::make_unique<Ode>(scene, quick) : nullptr;
}

}  // namespace

std::unique_ptr<Engine> makeOdeWorldStep(const StackScene& scene) { return make(scene, false); }
std::unique_ptr<Engine> makeOdeQuickStep(const StackScene& scene) { return make(scene, true); }

}  // namespace blem_sim
