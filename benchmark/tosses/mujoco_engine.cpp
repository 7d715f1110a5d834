// MuJoCo's box on its plane, elliptic cones. Surface: friction, and of its contacts' springs time_constant and damping_ratio.
#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "engine.h"

namespace blem_sim {
namespace {

std::string described(const TossScene& s) {
  return fmt::format(
      R"(<mujoco><option timestep="{}" gravity="{} {} {}" cone="elliptic" iterations="100" tolerance="1e-12"/><worldbody>
<geom type="plane" pos="0 0 {}" size="0 0 1" friction="{} 0 0" condim="3" solref="{} {}"/>
<body><freejoint/><inertial pos="{} {} {}" mass="{}" diaginertia="{} {} {}"/>
<geom type="box" size="{} {} {}" friction="{} 0 0" condim="3" solref="{} {}"/></body></worldbody></mujoco>)",
      s.time_step, s.gravity.x(), s.gravity.y(), s.gravity.z(), s.floor, s.surface.at("friction"), s.surface.at("time_constant"),
      s.surface.at("damping_ratio"), s.com.x(), s.com.y(), s.com.z(), s.mass, s.inertia.x(), s.inertia.y(), s.inertia.z(), 0.5 * s.side,
      0.5 * s.side, 0.5 * s.side, s.surface.at("friction"), s.surface.at("time_constant"), s.surface.at("damping_ratio"));
}

class Mujoco : public TossEngine {
 public:
  explicit Mujoco(const TossScene& scene) : scene_(scene) {
    const std::string text = described(scene);
    mjVFS files;
    mj_defaultVFS(&files);
    mj_makeEmptyFileVFS(&files, "toss.xml", static_cast<int>(text.size()));
    std::memcpy(files.filedata[mj_findFileVFS(&files, "toss.xml")], text.data(), text.size());
    char error[1000] = "";
    model_.reset(mj_loadXML("toss.xml", &files, error, sizeof(error)));
    mj_deleteVFS(&files);
    if (!model_) throw std::runtime_error(error);
    data_.reset(mj_makeData(model_.get()));
  }
  void start(const TossMotion& motion) override {
    mj_resetData(model_.get(), data_.get());
    const Matrix3 R = motion.X_WM.linear();
    const Quaternion q(R);
    const Vector3 p = motion.X_WM.translation(), w = R.transpose() * motion.w_WM;  // spins of free joints are in the body's axes
    const Vector3 v = motion.v_WCom - motion.w_WM.cross(R * scene_.com);
    const double positions[] = {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()}, velocities[] = {v.x(), v.y(), v.z(), w.x(), w.y(), w.z()};
    std::copy(positions, positions + 7, data_->qpos);
    std::copy(velocities, velocities + 6, data_->qvel);
  }
  void step() override { mj_step(model_.get(), data_.get()); }
  Pose pose() const override {
    const double* q = data_->qpos;
    Pose X = Pose::Identity();
    X.linear() = Quaternion(q[3], q[4], q[5], q[6]).toRotationMatrix();
    X.translation() = Vector3(q[0], q[1], q[2]);
    return X;
  }

 private:
  struct Deleter {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };
  const TossScene scene_;
  std::unique_ptr<mjModel, Deleter> model_;
  std::unique_ptr<mjData, Deleter> data_;
};

}  // namespace

std::unique_ptr<TossEngine> makeMujocoToss(const TossScene& scene) { return std::make_unique<Mujoco>(scene); }

}  // namespace blem_sim
