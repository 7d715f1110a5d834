// Replays tosses of a cube in other engines, for scripts/validate_tosses.
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>
#include <string>

#include "engine.h"

namespace blem_sim {
namespace {

struct Row {
  const char* name;
  MakeTossEngine make;
};

const Row ENGINES[] = {
    {"ODE", makeOdeToss},
#ifdef BLEM_SIM_WITH_BULLET
    {"Bullet", makeBulletToss},
#endif
#ifdef BLEM_SIM_WITH_MUJOCO
    {"MuJoCo", makeMujocoToss},
#endif
};

const char* const USAGE = R"(usage: toss_peers            names of the engines that were built in
       toss_peers ENGINE     replays the tosses of standard input, numbers separated by space:
         time_step floor side mass gravity[3] com[3] inertia[3], a count of surface settings, that many pairs NAME NUMBER,
         steps between samples, a count of tosses, and of each: samples, position[3], orientation w x y z, velocity[3], spin[3]
         (of the cube's middle, world axes). Out: a line x y z qw qx qy qz per sample behind the start
)";

Vector3 readVector(std::istream& in) {
  Vector3 v;
  in >> v.x() >> v.y() >> v.z();
  return v;
}

TossScene readScene(std::istream& in) {
  TossScene scene;
  in >> scene.time_step >> scene.floor >> scene.side >> scene.mass;
  scene.gravity = readVector(in);
  scene.com = readVector(in);
  scene.inertia = readVector(in);
  int settings = 0;
  in >> settings;
  for (int i = 0; i < settings; ++i) {
    std::string name;
    in >> name;
    in >> scene.surface[name];
  }
  return scene;
}

TossMotion readMotion(std::istream& in, const Vector3& com) {
  TossMotion motion;
  const Vector3 position = readVector(in);
  double w = 1;
  in >> w;
  const Vector3 v = readVector(in);
  motion.X_WM.linear() = Quaternion(w, v.x(), v.y(), v.z()).normalized().toRotationMatrix();
  motion.X_WM.translation() = position;
  motion.v_WCom = readVector(in);
  motion.w_WM = readVector(in);
  motion.v_WCom += motion.w_WM.cross(motion.X_WM.linear() * com);
  return motion;
}

bool replay(const Row& row, std::istream& in) {
  const TossScene scene = readScene(in);
  const std::unique_ptr<TossEngine> engine = row.make(scene);
  if (!engine) return false;
  int steps = 0, tosses = 0;
  in >> steps >> tosses;
  for (int toss = 0; toss < tosses && in; ++toss) {
    int samples = 0;
    in >> samples;
    engine->start(readMotion(in, scene.com));
    for (int sample = 1; sample < samples; ++sample) {
      for (int step = 0; step < steps; ++step) engine->step();
      const Pose X = engine->pose();
      const Quaternion q(X.linear());
      const Vector3 p = X.translation();
      std::printf("%.9g %.9g %.9g %.9g %.9g %.9g %.9g\n", p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z());
    }
  }
  return static_cast<bool>(in);
}

int run(int argc, char** argv) {
  if (argc == 1) {
    for (const Row& row : ENGINES) std::puts(row.name);
    return 0;
  }
  for (const Row& row : ENGINES)
    if (argc == 2 && std::strcmp(argv[1], row.name) == 0) return replay(row, std::cin) ? 0 : 1;
  std::fputs(USAGE, stderr);
  return 2;
}

}  // namespace
}  // namespace blem_sim

int main(int argc, char** argv) {
  try {
    return blem_sim::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "toss_peers: %s\n", error.what());
    return 1;
  }
}
