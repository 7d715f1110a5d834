#include "blem_sim/geometry/mesh_shrinking.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "blem_sim/geometry/bvh_traversal.h"
#include "blem_sim/geometry/mesh_topology.h"

namespace blem_sim::geometry {
namespace {

constexpr double SMALLEST_EIGENVALUE = 1e-4;  // part of the largest: planes that differ by less ask for the same
constexpr double FARTHEST = 3;                // longest move, in r
constexpr double LEAST_COSINE = 0.5;          // between a triangle's normals before and after
constexpr int MAX_HALVINGS = 6;

double signedVolume(const TriangleMesh& mesh) {
  const Vector3 origin = mesh.bounds().center();
  double sum = 0;
  for (const Vector3i& e : mesh.elements)
    sum += (mesh.vertices[e[0]] - origin).dot((mesh.vertices[e[1]] - origin).cross(mesh.vertices[e[2]] - origin));
  return sum / 6;
}

/** Reason why a mesh has no inside to move to; empty if it has one. */
std::string whyNot(const TriangleMesh& mesh, const MeshTopology& topology, double volume) {
  for (int e = 0; e < static_cast<int>(mesh.elements.size()); ++e)
    if (!mesh.isTriangle(e) || !topology.isFace(e)) return "it has segments or points";
  std::vector<int> forward(topology.edgeCount()), backward(topology.edgeCount());
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    for (int k = 0; k < 3; ++k)
      ++(mesh.elements[e][k] < mesh.elements[e][(k + 1) % 3] ? forward : backward)[topology.edgeOf(static_cast<int>(e), k)];
  for (int edge = 0; edge < topology.edgeCount(); ++edge) {
    if (forward[edge] + backward[edge] != 2) return "it is open or not a manifold";
    if (forward[edge] != 1) return "it is not wound consistently";
  }
  return volume == 0 ? "it encloses no volume" : "";
}

class Shrinking {
 public:
  Shrinking(const TriangleMesh& mesh, double r, double outward)
      : mesh_(mesh), r_(r), outward_(outward), part_(mesh.vertices.size(), 1), crossed_before_(mesh.elements.size(), false) {
    findMoves();
    findTriangles();
    for (const int triangle : crossingTriangles(mesh_)) crossed_before_[triangle] = true;
  }

  TriangleMesh run(MeshShrinking* what) {
    TriangleMesh shrunk = moved();
    for (int round = 0; round <= MAX_HALVINGS + 1; ++round) {
      std::vector<int> bad = turnedTriangles(shrunk);
      if (bad.empty()) bad = crossingTriangles(shrunk);
      if (bad.empty()) break;
      for (const int vertex : cornersAround(bad)) part_[vertex] = round < MAX_HALVINGS ? 0.5 * part_[vertex] : 0;
      shrunk = moved();
    }
    if (!turnedTriangles(shrunk).empty() || !crossingTriangles(shrunk).empty()) {
      std::fill(part_.begin(), part_.end(), 0.0);
      shrunk = mesh_;
      what->refused = "it would pass through itself";
    }
    describe(what);
    return shrunk;
  }

 private:
  /** Weighs each plane by the angle of its triangle: where they do not agree, tessellation must not decide. */
  void findMoves() {
    std::vector<Matrix3> square(mesh_.vertices.size(), Matrix3::Zero());
    std::vector<Vector3> sum(mesh_.vertices.size(), Vector3::Zero());
    for (std::size_t e = 0; e < mesh_.elements.size(); ++e) {
      const Vector3 normal = MeshTopology::normal(mesh_, static_cast<int>(e));
      for (int k = 0; k < 3; ++k) {
        const Vector3i& v = mesh_.elements[e];
        const Vector3 a = mesh_.vertices[v[(k + 1) % 3]] - mesh_.vertices[v[k]], b = mesh_.vertices[v[(k + 2) % 3]] - mesh_.vertices[v[k]];
        const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
        square[v[k]] += angle * normal * normal.transpose();
        sum[v[k]] -= angle * outward_ * r_ * normal;
      }
    }
    moves_.resize(mesh_.vertices.size());
    for (std::size_t v = 0; v < moves_.size(); ++v) {
      const Eigen::SelfAdjointEigenSolver<Matrix3> eigen(square[v]);
      Vector3 move = Vector3::Zero();
      for (int k = 0; k < 3; ++k) {
        if (eigen.eigenvalues()[k] <= SMALLEST_EIGENVALUE * eigen.eigenvalues()[2]) continue;
        const Vector3 axis = eigen.eigenvectors().col(k);
        move += axis.dot(sum[v]) / eigen.eigenvalues()[k] * axis;
      }
      if (move.norm() > FARTHEST * r_) {
        part_[v] = FARTHEST * r_ / move.norm();
      }
      moves_[v] = move;
    }
  }

  void findTriangles() {
    triangles_of_.resize(mesh_.vertices.size());
    for (std::size_t e = 0; e < mesh_.elements.size(); ++e)
      for (int k = 0; k < 3; ++k) triangles_of_[mesh_.elements[e][k]].push_back(static_cast<int>(e));
  }

  TriangleMesh moved() const {
    TriangleMesh out = mesh_;
    for (std::size_t v = 0; v < moves_.size(); ++v) out.vertices[v] += part_[v] * moves_[v];
    return out;
  }

  static Vector3 areaNormal(const TriangleMesh& mesh, const Vector3i& e) {
    return (mesh.vertices[e[1]] - mesh.vertices[e[0]]).cross(mesh.vertices[e[2]] - mesh.vertices[e[0]]);
  }

  std::vector<int> turnedTriangles(const TriangleMesh& shrunk) const {
    std::vector<int> turned;
    for (std::size_t e = 0; e < mesh_.elements.size(); ++e) {
      const Vector3 normal = areaNormal(shrunk, mesh_.elements[e]);
      if (!(normal.dot(MeshTopology::normal(mesh_, static_cast<int>(e))) > LEAST_COSINE * normal.norm()))
        turned.push_back(static_cast<int>(e));
    }
    return turned;
  }

  /** Triangles with a side that passes through another one, and these, unless they did before. Sides that share a corner with it do not
   * count. */
  std::vector<int> crossingTriangles(const TriangleMesh& mesh) const {
    std::vector<char> crosses(mesh.elements.size(), false);
    const Bvh tree(mesh);
    visitLeafPairs(tree, tree, Pose::Identity(), 0, [&](std::uint32_t leaf_a, std::uint32_t leaf_b) {
      const Bvh::Node &a = tree.nodes()[leaf_a], &b = tree.nodes()[leaf_b];
      for (std::uint32_t i = a.first; i < a.first + a.count; ++i)
        for (std::uint32_t j = b.first; j < b.first + b.count; ++j) {
          const std::uint32_t e = tree.order()[i], face = tree.order()[j];
          if (anySideCrosses(mesh, mesh.elements[e], mesh.elements[face])) crosses[e] = crosses[face] = true;
        }
    });
    std::vector<int> crossing;
    for (std::size_t e = 0; e < crosses.size(); ++e)
      if (crosses[e] && !crossed_before_[e]) crossing.push_back(static_cast<int>(e));
    return crossing;
  }

  static bool anySideCrosses(const TriangleMesh& mesh, const Vector3i& e, const Vector3i& face) {
    const auto is_corner = [&face](int v) { return v == face[0] || v == face[1] || v == face[2]; };
    for (int k = 0; k < 3; ++k) {
      const int p = e[k], q = e[(k + 1) % 3];
      if (!is_corner(p) && !is_corner(q) && sideCrosses(mesh, mesh.vertices[p], mesh.vertices[q], face)) return true;
    }
    return false;
  }

  static bool sideCrosses(const TriangleMesh& mesh, const Vector3& p, const Vector3& q, const Vector3i& face) {
    const Vector3 &a = mesh.vertices[face[0]], &b = mesh.vertices[face[1]], &c = mesh.vertices[face[2]];
    const Vector3 normal = (b - a).cross(c - a);
    const double height_p = normal.dot(p - a), height_q = normal.dot(q - a);
    if ((height_p > 0) == (height_q > 0)) return false;
    const Vector3 through = p + height_p / (height_p - height_q) * (q - p);
    return normal.dot((b - a).cross(through - a)) >= 0 && normal.dot((c - b).cross(through - b)) >= 0 &&
           normal.dot((a - c).cross(through - c)) >= 0;
  }

  /** Corners of the triangles and of their neighbours: a vertex held back alone would bend what is around it. */
  std::vector<int> cornersAround(const std::vector<int>& triangles) const {
    std::vector<int> corners;
    for (const int t : triangles)
      for (int k = 0; k < 3; ++k)
        for (const int neighbour : triangles_of_[mesh_.elements[t][k]])
          for (int l = 0; l < 3; ++l) corners.push_back(mesh_.elements[neighbour][l]);
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    return corners;
  }

  void describe(MeshShrinking* what) const {
    for (std::size_t v = 0; v < moves_.size(); ++v) {
      ++(part_[v] == 1 ? what->moved : what->held_back);
      for (const int t : triangles_of_[v]) {
        const double outside = r_ + outward_ * MeshTopology::normal(mesh_, t).dot(part_[v] * moves_[v]);
        what->excess = std::max(what->excess, outside);
        what->shortfall = std::max(what->shortfall, -outside);
      }
    }
  }

  const TriangleMesh& mesh_;
  const double r_, outward_;  // -1: the winding shows inwards
  std::vector<double> part_;  // per vertex: part of its move that is made
  std::vector<char> crossed_before_;
  std::vector<Vector3> moves_;
  std::vector<std::vector<int>> triangles_of_;
};

}  // namespace

TriangleMesh shrinkMesh(const TriangleMesh& mesh, double r, MeshShrinking* what) {
  *what = MeshShrinking();
  const MeshTopology topology(mesh);
  const double volume = signedVolume(mesh);
  what->refused = whyNot(mesh, topology, volume);
  if (!what->refused.empty()) {
    what->excess = r;
    return mesh;
  }
  return Shrinking(mesh, r, volume > 0 ? 1 : -1).run(what);
}

}  // namespace blem_sim::geometry
