// URDF collision elements as contact shapes.
#pragma once

#include <urdf_model/link.h>

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "blem_sim/model/loaders.h"

namespace blem_sim::model {

/** Pose of URDF's origin. */
Pose toPose(const urdf::Pose& pose);

/** Makes the collision shapes of links; a mesh that several links use is read once. */
class CollisionShapeReader {
 public:
  /** @param base directory for relative mesh paths; both must outlive the reader */
  CollisionShapeReader(const UriResolver& resolver, const std::string& base, Mending mending)
      : resolver_(resolver), base_(base), mending_(mending) {}

  /**
   * Spheres become points, a cylinder with a sphere of its radius at each end becomes a segment, the rest triangles; in the link's frame.
   * @param where names the link in messages @param notes shapes that were merged, in words @throws InputError
   */
  std::vector<CollisionShape> read(const urdf::Link& link, const std::string& where, std::vector<std::string>* notes);

 private:
  CollisionShape readOne(const urdf::Collision& collision, const std::string& where);
  CollisionShape readMesh(const urdf::Mesh& mesh, const Pose& X_LC, const std::string& where);

  const UriResolver& resolver_;
  const std::string& base_;
  const Mending mending_;
  std::map<std::tuple<std::string, double, double, double>, LoadedSurface> loaded_;  // by file and scale
};

}  // namespace blem_sim::model
