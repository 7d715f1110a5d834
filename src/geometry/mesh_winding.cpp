#include "blem_sim/geometry/mesh_winding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

namespace blem_sim::geometry {
namespace {

constexpr int MOST_NESTED = 1000;  // parts up to which it is asked which lies in which; of more, as in foam, each keeps its sense

/** A triangle beside another, over an edge. */
struct Neighbour {
  int triangle;
  bool same_sense;  ///< both show the same side: they run along the edge in opposite directions
};

/** Triangles that edges join. */
struct Part {
  std::vector<int> triangles;
  Box box;
  double volume = 0;
};

struct HalfEdge {
  int low, high, triangle;
  bool upward;
  bool operator<(const HalfEdge& o) const { return std::tie(low, high, triangle) < std::tie(o.low, o.high, o.triangle); }
};

/** Three neighbours per triangle. @return none if some edge has not two triangles */
std::vector<std::array<Neighbour, 3>> findNeighbours(const TriangleMesh& mesh) {
  std::vector<HalfEdge> edges;
  for (int i = 0; i < static_cast<int>(mesh.elements.size()); ++i) {
    if (!mesh.isTriangle(i)) return {};
    for (int k = 0; k < 3; ++k) {
      const int p = mesh.elements[i][k], q = mesh.elements[i][(k + 1) % 3];
      edges.push_back({std::min(p, q), std::max(p, q), i, p < q});
    }
  }
  std::sort(edges.begin(), edges.end());
  if (edges.size() % 2 != 0) return {};
  std::vector<std::array<Neighbour, 3>> neighbours(mesh.elements.size());
  std::vector<int> found(mesh.elements.size(), 0);
  const auto sameEdge = [](const HalfEdge& a, const HalfEdge& b) { return a.low == b.low && a.high == b.high; };
  for (std::size_t i = 0; i < edges.size(); i += 2) {
    const HalfEdge &a = edges[i], &b = edges[i + 1];
    if (!sameEdge(a, b) || (i + 2 < edges.size() && sameEdge(b, edges[i + 2]))) return {};
    neighbours[a.triangle][found[a.triangle]++] = {b.triangle, a.upward != b.upward};
    neighbours[b.triangle][found[b.triangle]++] = {a.triangle, a.upward != b.upward};
  }
  return neighbours;
}

void turn(Vector3i* element) { std::swap((*element)[1], (*element)[2]); }

double sixVolumes(const TriangleMesh& mesh, int triangle, const Vector3& apex) {
  const Vector3i& e = mesh.elements[triangle];
  return (mesh.vertices[e[0]] - apex).dot((mesh.vertices[e[1]] - apex).cross(mesh.vertices[e[2]] - apex));
}

/** Walks over a part from one of its triangles, and turns those that are not as most are. @return false if it has but one side */
bool walk(const std::vector<std::array<Neighbour, 3>>& neighbours, int start, std::vector<int>* sense, TriangleMesh* mesh, Part* part) {
  part->triangles = {start};
  (*sense)[start] = 1;
  int balance = 0;
  for (std::size_t i = 0; i < part->triangles.size(); ++i) {
    const int triangle = part->triangles[i];
    balance += (*sense)[triangle];
    for (const Neighbour& n : neighbours[triangle]) {
      const int wanted = n.same_sense ? (*sense)[triangle] : -(*sense)[triangle];
      if ((*sense)[n.triangle] == 0) {
        (*sense)[n.triangle] = wanted;
        part->triangles.push_back(n.triangle);
      } else if ((*sense)[n.triangle] != wanted) {
        return false;
      }
    }
  }
  const int most = balance >= 0 ? 1 : -1;
  for (const int triangle : part->triangles) {
    if ((*sense)[triangle] != most) turn(&mesh->elements[triangle]);
    for (int k = 0; k < 3; ++k) part->box.extend(mesh->vertices[mesh->elements[triangle][k]]);
  }
  for (const int triangle : part->triangles) part->volume += sixVolumes(*mesh, triangle, part->box.center()) / 6;
  return true;
}

/** Whether a point that is not on a part is enclosed by it: the solid angles of its triangles add up to a whole sphere [van Oosterom]. */
bool encloses(const TriangleMesh& mesh, const Part& part, const Vector3& point) {
  double half_angles = 0;
  for (const int triangle : part.triangles) {
    const Vector3i& e = mesh.elements[triangle];
    const Vector3 a = mesh.vertices[e[0]] - point, b = mesh.vertices[e[1]] - point, c = mesh.vertices[e[2]] - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    half_angles += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return std::abs(half_angles) > M_PI;
}

const Part& outermostAround(const TriangleMesh& mesh, const std::vector<Part>& parts, const Part& inner) {
  const Part* outermost = &inner;
  for (const Part& part : parts) {
    if (!(std::abs(part.volume) > std::abs(outermost->volume)) || !part.box.contains(inner.box)) continue;
    if (encloses(mesh, part, mesh.vertices[mesh.elements[inner.triangles[0]][0]])) outermost = &part;
  }
  return *outermost;
}

}  // namespace

TriangleMesh woundOutward(TriangleMesh mesh) {
  const std::vector<std::array<Neighbour, 3>> neighbours = findNeighbours(mesh);
  if (neighbours.empty()) return mesh;
  TriangleMesh wound = mesh;
  std::vector<int> sense(mesh.elements.size(), 0);  // against the mesh as it was; 0: not met yet
  std::vector<Part> parts;
  for (int i = 0; i < static_cast<int>(mesh.elements.size()); ++i) {
    if (sense[i] != 0) continue;
    parts.emplace_back();
    if (!walk(neighbours, i, &sense, &wound, &parts.back())) return mesh;
  }
  const bool asks = parts.size() <= MOST_NESTED;
  for (const Part& part : parts)
    if ((asks ? outermostAround(wound, parts, part).volume : 1) < 0)
      for (const int triangle : part.triangles) turn(&wound.elements[triangle]);
  return wound;
}

}  // namespace blem_sim::geometry
