#include "peer.h"

namespace blem_sim {

std::vector<PeerRow> peers() {
  std::vector<PeerRow> rows = {{"ode_opcode",
                                "contacts of crossing triangles only; bare meshes pushed together by the layer; at most 4096 a pair", true,
                                makeOdePeer}};
#if defined(BLEM_SIM_WITH_BULLET)
  rows.push_back({"bullet_gimpact", "triangle pairs within the shapes' margins (set to the layers), clipped; single precision", false,
                  makeBulletPeer});
#endif
#if defined(BLEM_SIM_WITH_FCL)
  rows.push_back({"fcl_distance", "one closest pair of triangles per pair of meshes", false, makeFclDistancePeer});
  rows.push_back({"fcl_collide", "crossing triangles only, without contact points; bare meshes pushed together by the layer", true,
                  makeFclCollidePeer});
#endif
  return rows;
}

std::vector<std::string> missingPeers() {
  std::vector<std::string> missing;
#if !defined(BLEM_SIM_WITH_BULLET)
  missing.push_back("Bullet GImpact: apt-get install libbullet-dev");
#endif
#if !defined(BLEM_SIM_WITH_FCL)
  missing.push_back("FCL: apt-get install libfcl-dev");
#endif
  return missing;
}

}  // namespace blem_sim
