#include "clouds/mesh_message.h"

#include <fmt/format.h>

#include <cstdint>
#include <utility>

#include "blem_sim/geometry/input_error.h"

namespace blem_sim::node {

geometry::TriangleMesh meshOf(const shape_msgs::Mesh& message) {
  if (message.triangles.empty()) throw InputError("triangles: there is none");
  for (const auto& [name, size] :
       {std::make_pair("triangles", message.triangles.size()), std::make_pair("vertices", message.vertices.size())})
    if (size > MOST_MESH_TRIANGLES)
      throw InputError(
          fmt::format("{}: {} are more than the {} that are taken; simplify the mesh before it is sent", name, size, MOST_MESH_TRIANGLES));
  geometry::TriangleMesh mesh;
  for (const auto& p : message.vertices) mesh.vertices.emplace_back(p.x, p.y, p.z);
  for (std::size_t i = 0; i < message.triangles.size(); ++i) {
    const auto& corners = message.triangles[i].vertex_indices;
    for (const std::uint32_t corner : corners) {
      if (corner >= mesh.vertices.size())
        throw InputError(fmt::format("triangles[{}]: index {} is out of range: there are {} vertices", i, corner, mesh.vertices.size()));
      if (!mesh.vertices[corner].allFinite()) throw InputError(fmt::format("triangles[{}]: vertices[{}] is not finite", i, corner));
    }
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;  // no area
    mesh.elements.emplace_back(static_cast<int>(corners[0]), static_cast<int>(corners[1]), static_cast<int>(corners[2]));
  }
  return mesh;
}

}  // namespace blem_sim::node
