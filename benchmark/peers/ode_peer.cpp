// OPCODE as Gazebo classic uses it for meshes.
#include "ode_mesh.h"
#include "peer.h"

namespace blem_sim {
namespace {

class OdePeer : public Peer {
 public:
  explicit OdePeer(const ContactScene& scene) : standing_(scene.standing.geometry->mesh()), contacts_(MOST) {
    standing_geom_ = dCreateTriMesh(nullptr, standing_.data, nullptr, nullptr, nullptr);
    for (const contact::Collider& collider : scene.moving) {
      moving_.push_back(std::make_unique<OdeMesh>(collider.geometry->mesh()));
      geoms_.push_back(dCreateTriMesh(nullptr, moving_.back()->data, nullptr, nullptr, nullptr));
    }
  }
  ~OdePeer() override {
    dGeomDestroy(standing_geom_);
    for (const dGeomID geom : geoms_) dGeomDestroy(geom);
  }
  std::size_t query(std::size_t collider, const Pose& X) override {
    const Vector3 p = X.translation();
    dMatrix3 R = {};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) R[4 * i + j] = X.linear()(i, j);
    dGeomSetPosition(geoms_[collider], p.x(), p.y(), p.z());
    dGeomSetRotation(geoms_[collider], R);
    return static_cast<std::size_t>(dCollide(geoms_[collider], standing_geom_, MOST, contacts_.data(), sizeof(dContactGeom)));
  }

 private:
  static constexpr int MOST = 4096;
  OdeMesh standing_;
  std::vector<std::unique_ptr<OdeMesh>> moving_;
  dGeomID standing_geom_;
  std::vector<dGeomID> geoms_;
  std::vector<dContactGeom> contacts_;
};

}  // namespace

std::unique_ptr<Peer> makeOdePeer(const ContactScene& scene) {
  if (!initialiseOde()) return nullptr;
  // Silences ODE, which says for every pair that its table of contacts to merge is too small.
  dSetMessageHandler([](int, const char*, va_list) {});
  return std::make_unique<OdePeer>(scene);
}

}  // namespace blem_sim
