// A stepper solves one step: given bodies, joints, contacts and drives, it moves the bodies.
#pragma once

#include <cstdint>
#include <vector>

#include "blem_sim/geometry/state_stream.h"
#include "scene/contact_law.h"
#include "scene/scene.h"

namespace blem_sim::dynamics {

struct StepInput {
  double dt;  ///< [s]
  const std::vector<ContactConstraint>& contacts;
  const std::vector<JointDrive>& drives;                ///< one per joint slot
  double of_step = 0;                                   ///< [s] step of which dt is a part, if it is longer
  const std::vector<RootDrive>* root_drives = nullptr;  ///< null: none
};

/** Places among the six velocities of a free root. */
struct RootAxis {
  static constexpr int SPIN = 2, X = 3, Y = 4;
};

/** Index of a body's root drive; -1: it has none. */
inline int rootDriveOf(const StepInput& input, int body) {
  if (!input.root_drives) return -1;
  for (std::size_t i = 0; i < input.root_drives->size(); ++i)
    if ((*input.root_drives)[i].body == body) return static_cast<int>(i);
  return -1;
}

/**
 * The scene is the one store of bodies and joints: a stepper reads poses, velocities and pending wrenches from it and writes poses and
 * velocities back; its memory beside that (a warm start, a seed) is private and part of its saved state.
 */
class Stepper {
 public:
  virtual ~Stepper() = default;
  /** Advances the bodies by input.dt under gravity, pending wrenches, drives and contacts, and fills the result.
   *  A stepper that notices that a step broke down says finite = false and leaves the scene as it was. */
  virtual void step(Scene* scene, const StepInput& input, SolveResult* result) = 0;
  /** Saves its memory as the next step would find it: of bodies and joints that came or went since the last one, too. */
  virtual void save(const Scene& scene, geometry::StateWriter* writer) = 0;
  /** The scene is already restored. */
  virtual void restore(const Scene& scene, geometry::StateReader* reader) = 0;
  /** Whether, after a restore, the stepper's memory of bodies agrees with their states. */
  virtual bool agreesWith(const Scene&) const { return true; }
  /** Forgets the contacts with these ids. @param ids ascending @param go_on as World::forgetContacts has it */
  virtual void forgetContacts(const std::vector<std::uint64_t>& ids, const ContactRenames& go_on) = 0;
  /** Whether the contact of this id pushed in the last step. */
  virtual bool pushed(std::uint64_t contact) const = 0;
};

}  // namespace blem_sim::dynamics
