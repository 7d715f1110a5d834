// ODE's box on its plane, exact stepper. Surface: friction, restitution, erp, cfm.
#include <ode/ode.h>

#include "../peers/ode_mesh.h"
#include "engine.h"

namespace blem_sim {
namespace {

class Ode : public TossEngine {
 public:
  explicit Ode(const TossScene& scene)
      : scene_(scene), world_(dWorldCreate()), space_(dSimpleSpaceCreate(nullptr)), contacts_(dJointGroupCreate(0)) {
    dWorldSetGravity(world_, scene.gravity.x(), scene.gravity.y(), scene.gravity.z());
    plane_ = dCreatePlane(space_, 0, 0, 1, scene.floor);
    box_ = dCreateBox(space_, scene.side, scene.side, scene.side);
    body_ = dBodyCreate(world_);
    dBodySetGyroscopicMode(body_, 1);
    dMass mass;
    dMassSetParameters(&mass, scene.mass, 0, 0, 0, scene.inertia.x(), scene.inertia.y(), scene.inertia.z(), 0, 0, 0);
    dBodySetMass(body_, &mass);
    dGeomSetBody(box_, body_);
    dGeomSetOffsetPosition(box_, -scene.com.x(), -scene.com.y(), -scene.com.z());
  }
  ~Ode() override {
    dJointGroupDestroy(contacts_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
  }
  void start(const TossMotion& motion) override {
    const Vector3 at = motion.X_WM * scene_.com;
    const Quaternion q(motion.X_WM.linear());
    const dQuaternion turn = {q.w(), q.x(), q.y(), q.z()};
    dBodySetPosition(body_, at.x(), at.y(), at.z());
    dBodySetQuaternion(body_, turn);
    dBodySetLinearVel(body_, motion.v_WCom.x(), motion.v_WCom.y(), motion.v_WCom.z());
    dBodySetAngularVel(body_, motion.w_WM.x(), motion.w_WM.y(), motion.w_WM.z());
  }
  void step() override {
    constexpr int MOST = 8;
    dContactGeom points[MOST];
    const int count = dCollide(box_, plane_, MOST, points, sizeof(dContactGeom));
    for (int i = 0; i < count; ++i) {
      dContact contact = {};
      contact.geom = points[i];
      contact.surface.mode = dContactApprox1 | dContactBounce | dContactSoftERP | dContactSoftCFM;
      contact.surface.mu = scene_.surface.at("friction");
      contact.surface.bounce = scene_.surface.at("restitution");
      contact.surface.soft_erp = scene_.surface.at("erp");
      contact.surface.soft_cfm = scene_.surface.at("cfm");
      dJointAttach(dJointCreateContact(world_, contacts_, &contact), body_, nullptr);
    }
    dWorldStep(world_, scene_.time_step);
    dJointGroupEmpty(contacts_);
  }
  Pose pose() const override {
    const dReal *p = dBodyGetPosition(body_), *q = dBodyGetQuaternion(body_);
    Pose X = Pose::Identity();
    X.linear() = Quaternion(q[0], q[1], q[2], q[3]).toRotationMatrix();
    X.translation() = Vector3(p[0], p[1], p[2]) - X.linear() * scene_.com;
    return X;
  }

 private:
  const TossScene scene_;
  dWorldID world_;
  dSpaceID space_;
  dJointGroupID contacts_;
  dGeomID plane_, box_;
  dBodyID body_;
};

}  // namespace

std::unique_ptr<TossEngine> makeOdeToss(const TossScene& scene) { return initialiseOde() ? std::make_unique<Ode>(scene) : nullptr; }

}  // namespace blem_sim
