// Mesh collision of other engines on the scenes of contact_scenes.h. None of them finds the contacts of contact generation; each row names
// its own result.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "../contact_scenes.h"

namespace blem_sim {

/** The meshes of a scene in another engine. */
class Peer {
 public:
  virtual ~Peer() = default;
  /** @param X pose of the moving collider in the standing one's frame @return contacts found, of the kind that the engine knows */
  virtual std::size_t query(std::size_t collider, const Pose& X) = 0;
};

struct PeerRow {
  std::string name;
  std::string computes;  ///< in words, for the row's label
  bool pushed_in;        ///< it knows no layer: bare meshes are moved into each other by it
  std::unique_ptr<Peer> (*make)(const ContactScene& scene);
};

/** Peers that were installed at build time. */
std::vector<PeerRow> peers();
/** Peers that were missing at build time, and the packages to install. */
std::vector<std::string> missingPeers();

std::unique_ptr<Peer> makeOdePeer(const ContactScene& scene);
std::unique_ptr<Peer> makeBulletPeer(const ContactScene& scene);
std::unique_ptr<Peer> makeFclDistancePeer(const ContactScene& scene);
std::unique_ptr<Peer> makeFclCollidePeer(const ContactScene& scene);

}  // namespace blem_sim
