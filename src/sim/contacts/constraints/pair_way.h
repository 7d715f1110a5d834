// A pair of colliders on its way through a solve, while its velocities stay.
#pragma once

#include <cstdint>
#include <vector>

#include "blem_sim/contact/manifold.h"
#include "blem_sim/contact/narrow_phase.h"
#include "clouds/fading_points.h"
#include "contacts/motion/body_twist.h"
#include "contacts/search/flush_surfaces.h"

namespace blem_sim::sim {

constexpr double TOUCHING = 1e-6;  ///< [m] a contact with no larger gap touches; a touch on the way that is no deeper is none
constexpr double ACROSS = 0.01;    ///< layers that a pair moves across a normal until its gap is used up: less turns no normal

inline bool touches(const contact::Contact& contact) { return contact.depth > -TOUCHING; }

/**
 * Whether a contact of a pair touches, or pushed in the last solve. That solve closed its gap along straight paths: what is left is how far
 * they bent, as where a cam turns away from what rides on it.
 */
bool bears(const SimulatedWorld& world, const contact::ContactManifold& pair, const contact::Contact& contact);

/** A collider at the start of the solve. */
struct ColliderWay {
  const contact::Collider* collider;
  Pose X_WC;
  Vector3 com;      ///< [m] its body's, world
  BodyTwist twist;  ///< its body's way
};

/** First state of a pair, and the time for which it is followed. */
struct WayOfPair {
  const SimulatedWorld& world;
  const contact::ContactManifold& now;  ///< its contacts
  ColliderWay a, b;
  double known = 0;                                    ///< [m] distance beyond the layers within which contacts are known
  double depth = 0;                                    ///< [m] of the deepest contact that touches, of both bodies; at least 0
  double dt = 0;                                       ///< [s]
  const FadingPoints* fading = nullptr;                ///< applied to what is found on the way
  contact::NarrowPhaseWorkspace* workspace = nullptr;  ///< for searches on the way
  double swing = 0;                                    ///< [m/s] by which velocities may change within dt though nothing touches
};

/** Follows pairs on their ways, in memory that is kept between pairs. */
class PairWay {
 public:
  /** Whether a contact before touch would act while the pair moves across its normal. */
  bool isDoubtful(const WayOfPair& pair) const;
  /**
   * Follows a pair to the pose where it first touches anew, or else to the nearest pose.
   * @param flush, colliders, motion as FlushSurfaces takes them
   * @param contacts to be solved, sorted by id; unchanged if all that would act are met as they are
   * @return false, and nothing is written, if contacts stay as they are: also where bare meshes cross on the way
   */
  bool follow(const WayOfPair& pair, const FlushSurfaces& flush, const std::vector<contact::Collider>& colliders,
              const std::vector<contact::ColliderMotion>& motion, std::vector<contact::Contact>* contacts);

 private:
  bool search(const WayOfPair& pair, const FlushSurfaces& flush, const std::vector<contact::Collider>& colliders,
              const std::vector<contact::ColliderMotion>& motion);
  double freeTime(const WayOfPair& pair, const std::vector<contact::Contact>& contacts, double time) const;
  double newDepth(const std::vector<contact::Contact>& contacts) const;
  bool touchesNow(std::uint64_t id) const;
  bool isMetAsItIs(const contact::Contact& contact) const;

  std::vector<std::uint64_t> touching_;  // ids, ascending
  contact::SurfaceCover cover_;
  contact::ContactManifold at_, met_;
  double met_time_ = 0;  // [s] of met_
  bool touches_ = false;
};

}  // namespace blem_sim::sim
