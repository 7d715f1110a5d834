#include "simplex_search.h"

#include <algorithm>

#include "blem_sim/geometry/bvh_traversal.h"
#include "border_fade.h"
#include "candidates.h"
#include "edge_pair.h"
#include "feature_cones.h"

namespace blem_sim {
namespace {

/** A surface along a plane leaves it if its lean has this part (sine) off it. */
constexpr double MIN_LEAN_INSIDE = 1e-3;

class SimplexSearch {
 public:
  SimplexSearch(const MeshPair& pair, SearchBuffers* buffers) : pair_(pair), R_FM_(pair.X_FM.linear()), buffers_(*buffers) {}

  void run() {
    buffers_.contacts.clear();
    buffers_.crossings.clear();
    buffers_.leaf_pairs.clear();
    for (SearchBuffers::FixedLeaf& held : buffers_.fixed_leaves) held.leaf = SearchBuffers::NO_LEAF;
    const auto matters = [this](std::uint32_t m, std::uint32_t f) { return (pair_.moving.owners[m] | pair_.fixed.owners[f]) != 0; };
    visitLeafPairsIf(pair_.moving.bvh, pair_.fixed.bvh, pair_.X_FM, pair_.range, matters,
                     [this](std::uint32_t m, std::uint32_t f) { buffers_.leaf_pairs.emplace_back(m, f); });
    // Sorted, so that each leaf of the moving mesh is turned once.
    std::sort(buffers_.leaf_pairs.begin(), buffers_.leaf_pairs.end());
    std::uint32_t turned_leaf = SearchBuffers::NO_LEAF;
    for (const auto& [m, f] : buffers_.leaf_pairs) {
      if (m != turned_leaf) turnLeaf(turned_leaf = m);
      testLeaf(f);
    }
  }

 private:
  void turnLeaf(std::uint32_t leaf) {
    const Bvh::Node& node = pair_.moving.bvh.nodes()[leaf];
    buffers_.moving_leaf.resize(node.count);
    for (std::uint32_t i = 0; i < node.count; ++i) {
      ElementShape& shape = buffers_.moving_leaf[i];
      shape.element = static_cast<int>(pair_.moving.bvh.order()[node.first + i]);
      const Vector3i& e = pair_.moving.mesh.elements[shape.element];
      for (int k = 0; k < 3; ++k) shape.corners[k] = pair_.X_FM * pair_.moving.mesh.vertices[e[k]];
      findBox(&shape);
      buffers_.leaf_lower = i == 0 ? shape.lower : Vector3(buffers_.leaf_lower.cwiseMin(shape.lower));
      buffers_.leaf_upper = i == 0 ? shape.upper : Vector3(buffers_.leaf_upper.cwiseMax(shape.upper));
      describe(pair_.moving.topology, &R_FM_, &shape);
    }
  }

  std::vector<ElementShape>& fixedLeaf(std::uint32_t leaf) {
    SearchBuffers::FixedLeaf& held = buffers_.fixed_leaves[leaf % buffers_.fixed_leaves.size()];
    if (held.leaf == leaf) return held.shapes;
    held.leaf = leaf;
    const Bvh::Node& node = pair_.fixed.bvh.nodes()[leaf];
    held.shapes.resize(node.count);
    for (std::uint32_t i = 0; i < node.count; ++i) {
      ElementShape& shape = held.shapes[i];
      shape.element = static_cast<int>(pair_.fixed.bvh.order()[node.first + i]);
      const Vector3i& e = pair_.fixed.mesh.elements[shape.element];
      for (int k = 0; k < 3; ++k) shape.corners[k] = pair_.fixed.mesh.vertices[e[k]];
      findBox(&shape);
      shape.is_described = false;
    }
    return held.shapes;
  }

  void testLeaf(std::uint32_t leaf) {
    for (ElementShape& shape : fixedLeaf(leaf)) {
      if (!boxesWithin(buffers_.leaf_lower, buffers_.leaf_upper, shape, pair_.range)) continue;
      if (!shape.is_described) describe(pair_.fixed.topology, nullptr, &shape);
      for (const ElementShape& m : buffers_.moving_leaf) {
        if (boxesWithin(m.lower, m.upper, shape, pair_.range)) testElements(m, shape);
      }
    }
  }

  void testElements(const ElementShape& m, const ElementShape& f) {
    const bool m_owns = m.vertices | m.edges, f_owns = f.vertices | f.edges;
    if (!m_owns && !f_owns) return;
    double heights_m[3], heights_f[3];  // of the corners over the other's plane
    if (f.is_face) {
      for (int k = 0; k < 3; ++k) heights_m[k] = f.normal.dot(m.corners[k] - f.corners[0]);
      if (oneSided(heights_m, pair_.range)) return;
    }
    if (m.is_face) {
      for (int k = 0; k < 3; ++k) heights_f[k] = m.normal.dot(f.corners[k] - m.corners[0]);
      if (oneSided(heights_f, pair_.range)) return;
    }
    if (f.is_face && m_owns) testOverFace(m, heights_m, f, true);
    if (m.is_face && f_owns) testOverFace(f, heights_f, m, false);
    if (!m_owns || !f_owns) return;
    const Candidates of_m = candidatesOf(m, f.is_face ? heights_m : nullptr, f, pair_.range),
                     of_f = candidatesOf(f, m.is_face ? heights_f : nullptr, m, pair_.range);
    testEdges(m, of_m, f, of_f);
    testVertices(m, of_m, f, of_f);
  }

  // ---- vertices and edges over a face

  void testOverFace(const ElementShape& e, const double heights[3], const ElementShape& face, bool e_moves) {
    for (int k = 0; k < 3; ++k) {
      if (e.vertices >> k & 1) testVertexFace(e, k, heights[k], face, e_moves);
      if (e.edges >> k & 1 && passesThrough(heights[k], heights[NEXT[k]]) && crosses(e, k, heights, face, e_moves)) {
        buffers_.crossings.push_back({e_moves, side(e_moves).topology.element_edges[e.element][k], face.element});
      }
    }
  }

  void testVertexFace(const ElementShape& e, int k, double height, const ElementShape& face, bool e_moves) {
    const double most = pair_.range - std::abs(height);
    if (most < 0 || !mayHoldProjection(face, e.corners[k], most / FADE_SLOPE)) return;
    if (holdsProjection(face, e.corners[k])) {
      addVertexFace(e, k, height, face, e_moves);
    } else {
      addFading(e, k, height, face, e_moves);
    }
  }

  static bool passesThrough(double height_p, double height_q) {
    return std::min(height_p, height_q) < -TOUCH && std::max(height_p, height_q) > TOUCH;
  }

  /** Does side k of e, which passes through the face's plane, pass through the face? What only touches it, or only grazes a border, is an
   * ordinary contact. */
  bool crosses(const ElementShape& e, int k, const double heights[3], const ElementShape& face, bool e_moves) const {
    const double height_p = heights[k], height_q = heights[NEXT[k]];
    const Vector3 &p = e.corners[k], &q = e.corners[NEXT[k]], through = p + height_p / (height_p - height_q) * (q - p);
    if (!holdsProjection(face, through)) return false;
    const int edge = side(e_moves).topology.element_edges[e.element][k];
    const Vector3 lean = turned(edgeLean(side(e_moves), edge), e_moves), face_inward = middle(face.corners) - through;
    // At a border it only grazes an edge or a corner, unless it runs down along a neighbour's plane, its own surface within: so aligned
    // boxes sink into each other.
    bool enters = true, along_neighbour = false;
    const bool at_border = forEachNeighbourAt(face, through, !e_moves, [&](const Vector3& inward, const Vector3& normal) {
      const Vector3& end = (face.normal.dot(inward) > 0) == (height_p > 0) ? p : q;
      double inside = normal.dot(end - through);
      if (std::abs(inside) <= TOUCH) {
        along_neighbour = true;
        inside = std::abs(normal.dot(lean)) > MIN_LEAN_INSIDE ? normal.dot(lean) : 0;
      }
      enters = enters && (normal.dot(face_inward) < 0 ? -inside : inside) > TOUCH;
    });
    return !at_border || (enters && along_neighbour);
  }

  /** Does the plane of `face` end within CLOSED of p? Then calls visit(direction into it, unit normal) for each face of other planes there.
   */
  template <typename Visit>
  bool forEachNeighbourAt(const ElementShape& face, const Vector3& p, bool face_moves, Visit&& visit) const {
    const MeshSide& face_side = side(face_moves);
    const MeshTopology& topology = face_side.topology;
    const auto visitFacesOf = [&](int edge) {
      for (int i = topology.edge_face_begin[edge]; i < topology.edge_face_begin[edge + 1]; ++i) {
        const int neighbour = topology.edge_faces[i];
        if (topology.patch[neighbour] == topology.patch[face.element]) continue;
        const Vector3i& v = face_side.mesh.elements[neighbour];
        const Vector3 middle = (face_side.mesh.vertices[v[0]] + face_side.mesh.vertices[v[1]] + face_side.mesh.vertices[v[2]]) / 3;
        visit(placed(middle, face_moves) - p, turned(topology.normals[neighbour], face_moves));
      }
    };
    const int corner = cornerAt(face, p);
    if (corner >= 0) {
      const int vertex = face_side.mesh.elements[face.element][corner];
      const auto begin = topology.vertex_edges.begin() + topology.vertex_edge_begin[vertex];
      std::for_each(begin, topology.vertex_edges.begin() + topology.vertex_edge_begin[vertex + 1], visitFacesOf);
      return !topology.vertex_flat[vertex];
    }
    bool at_border = false;
    forEachBorderAt(face, p, face_moves, [&](int edge, int) {
      at_border = true;
      visitFacesOf(edge);
    });
    return at_border;
  }

  static int cornerAt(const ElementShape& face, const Vector3& p) {
    for (int k = 0; k < 3; ++k) {
      if ((p - face.corners[k]).squaredNorm() <= 16 * CLOSED * CLOSED) return k;
    }
    return -1;
  }

  /** Calls visit(edge, face) for each edge where the plane of `face` ends within CLOSED of p, with the plane's face there. */
  template <typename Visit>
  void forEachBorderAt(const ElementShape& face, const Vector3& p, bool face_moves, Visit&& visit) const {
    const MeshSide& face_side = side(face_moves);
    const MeshTopology& topology = face_side.topology;
    const int corner = cornerAt(face, p);
    if (corner >= 0) {
      // The plane's borders there may belong to its other faces.
      const int vertex = face_side.mesh.elements[face.element][corner];
      for (int i = topology.vertex_edge_begin[vertex]; i < topology.vertex_edge_begin[vertex + 1]; ++i) {
        visitIfBorder(topology, topology.vertex_edges[i], topology.patch[face.element], visit);
      }
      return;
    }
    // A border that p lies on need not be a side of this face where two sides meet at a small angle, but it ends at one of its corners.
    for (int k = 0; k < 3; ++k) {
      const int vertex = face_side.mesh.elements[face.element][k];
      for (int i = topology.vertex_edge_begin[vertex]; i < topology.vertex_edge_begin[vertex + 1]; ++i) {
        const int edge = topology.vertex_edges[i];
        if (liesOn(face_side, edge, p, face_moves)) visitIfBorder(topology, edge, topology.patch[face.element], visit);
      }
    }
  }

  /** Is p within CLOSED of the edge? */
  bool liesOn(const MeshSide& edge_side, int edge, const Vector3& p, bool edge_moves) const {
    const std::array<int, 2>& ends = edge_side.topology.edges[edge];
    const Vector3 q = placed(edge_side.mesh.vertices[ends[0]], edge_moves),
                  along = placed(edge_side.mesh.vertices[ends[1]], edge_moves) - q;
    const double length2 = along.squaredNorm(), part = std::min(std::max((p - q).dot(along), 0.0), length2);
    return (p - q - part / length2 * along).squaredNorm() <= CLOSED * CLOSED;
  }

  template <typename Visit>
  static void visitIfBorder(const MeshTopology& topology, int edge, int patch, Visit&& visit) {
    if (topology.edge_flat[edge]) return;
    for (int i = topology.edge_face_begin[edge]; i < topology.edge_face_begin[edge + 1]; ++i) {
      if (topology.patch[topology.edge_faces[i]] == patch) return visit(edge, topology.edge_faces[i]);
    }
  }

  void addVertexFace(const ElementShape& e, int k, double height, const ElementShape& face, bool e_moves) {
    const Vector3 &p = e.corners[k], foot = p - height * face.normal;
    const Feature vertex{FeatureKind::VERTEX, side(e_moves).mesh.elements[e.element][k]};
    const Feature patch{FeatureKind::FACE, side(!e_moves).topology.patch[face.element]};
    if (std::abs(height) <= TOUCH && !reachesOver(vertex.index, p, face, e_moves)) return;
    // From fixed to moving: towards the vertex if it is the moving mesh's.
    Vector3 normal = (height > 0) == e_moves ? face.normal : Vector3(-face.normal);
    if (std::abs(height) <= TOUCH)
      normal = e_moves ? towardsMoving(pair_, normal, vertex, patch, p) : towardsMoving(pair_, normal, patch, vertex, p);
    if (e_moves) {
      buffers_.contacts.push_back({vertex, patch, p, foot, normal, std::abs(height)});
    } else {
      buffers_.contacts.push_back({patch, vertex, foot, p, normal, std::abs(height)});
    }
  }

  void addFading(const ElementShape& e, int k, double height, const ElementShape& face, bool e_moves) {
    const Vector3& p = e.corners[k];
    const Feature vertex{FeatureKind::VERTEX, side(e_moves).mesh.elements[e.element][k]};
    BorderFade fade;
    if (!fadeOverBorder(pair_, e_moves, vertex.index, p, height, face, pair_.range - std::abs(height), &fade)) return;
    const Vector3 d = e_moves ? Vector3(p - fade.foot) : Vector3(fade.foot - p);
    const double gap = d.norm();
    if (gap <= TOUCH || gap + fade.lost > pair_.range) return;
    const Feature patch{FeatureKind::FACE, side(!e_moves).topology.patch[face.element]};
    if (e_moves) {
      buffers_.contacts.push_back({vertex, patch, p, fade.foot, d / gap, gap + fade.lost});
    } else {
      buffers_.contacts.push_back({patch, vertex, fade.foot, p, d / gap, gap + fade.lost});
    }
  }

  /** Where a vertex touches a face's border: does its surface extend over the face, or only beside it? */
  bool reachesOver(int vertex, const Vector3& p, const ElementShape& face, bool vertex_moves) const {
    const MeshSide& vertex_side = side(vertex_moves);
    if (vertex_side.topology.vertex_edge_begin[vertex] == vertex_side.topology.vertex_edge_begin[vertex + 1]) return true;
    bool reaches = true;
    forEachBorderAt(face, p, !vertex_moves, [&](int border, int border_face) {
      Vector3 inward = turned(side(!vertex_moves).topology.inward(side(!vertex_moves).mesh, border, border_face), !vertex_moves);
      if (vertex_moves) inward = R_FM_.transpose() * inward;
      reaches = reaches && !vertexConeAllows(vertex_side, vertex, inward, CONE_SLACK);
    });
    return reaches;
  }

  // ---- edge and edge

  void testEdges(const ElementShape& m, const Candidates& of_m, const ElementShape& f, const Candidates& of_f) {
    if (of_m.edges == 0 || of_f.edges == 0) return;
    for (int k = 0; k < 3; ++k) {
      if (!(of_m.edges >> k & 1)) continue;
      for (int l = 0; l < 3; ++l) {
        if (of_f.edges >> l & 1 && mayMeetSide(of_m, k, l) && mayMeetSide(of_f, l, k)) testEdgePair(m, k, f, l);
      }
    }
  }

  void testEdgePair(const ElementShape& m, int k, const ElementShape& f, int l) {
    const Vector3 &p0 = m.corners[k], &q0 = f.corners[l];
    LinePair lines;
    if (!lines.find(p0, m.corners[NEXT[k]], q0, f.corners[NEXT[l]], pair_.range, pair_.range / FADE_SLOPE)) return;
    const Feature edge_m{FeatureKind::EDGE, pair_.moving.topology.element_edges[m.element][k]},
        edge_f{FeatureKind::EDGE, pair_.fixed.topology.element_edges[f.element][l]};
    EdgePair feet;
    EdgesBeyond beyond;
    if (findEdgePair(lines, p0, q0, &feet)) {
      addEdgeEdge(edge_m, edge_f, feet);
    } else {
      findEdgesBeyond(lines, p0, q0, &beyond);
      const int end_m = beyond.end_p < 0 ? -1 : pair_.moving.mesh.elements[m.element][(k + beyond.end_p) % 3];
      const int end_f = beyond.end_q < 0 ? -1 : pair_.fixed.mesh.elements[f.element][(l + beyond.end_q) % 3];
      addFadingEdges(edge_m, end_m, edge_f, end_f, beyond);
    }
  }

  void addEdgeEdge(const Feature& m, const Feature& f, const EdgePair& feet) {
    Vector3 normal = feet.offset < 0 ? Vector3(-feet.axis) : feet.axis;
    if (std::abs(feet.offset) <= TOUCH) normal = towardsMoving(pair_, normal, m, f, feet.point_q);
    const double gap = std::abs(feet.offset);
    if (gap <= pair_.range && conesAllow(m, f, normal, EDGE_CONE_SLACK))
      buffers_.contacts.push_back({m, f, feet.point_p, feet.point_q, normal, gap});
  }

  /** The feet have left the edges over these vertices (-1: not). */
  void addFadingEdges(const Feature& m, int end_m, const Feature& f, int end_f, const EdgesBeyond& edges) {
    const Vector3 d = edges.point_p - edges.point_q;
    const double distance = d.norm(), gap = distance + FADE_SLOPE * edges.beyond;
    if (distance <= TOUCH || gap > pair_.range || !conesAllow(m, f, edges.normal, EDGE_CONE_SLACK)) return;
    const bool fades =
        (end_m >= 0 && !isTakenOver({pair_.moving, pair_.fixed, end_m, f.index, R_FM_, -(R_FM_.transpose() * edges.normal)})) ||
        (end_f >= 0 && !isTakenOver({pair_.fixed, pair_.moving, end_f, m.index, R_FM_.transpose(), edges.normal}));
    if (fades) buffers_.contacts.push_back({m, f, edges.point_p, edges.point_q, d / distance, gap});
  }

  // ---- vertex and edge, vertex and vertex: where each is the other's local minimum

  void testVertices(const ElementShape& m, const Candidates& of_m, const ElementShape& f, const Candidates& of_f) {
    for (int k = 0; k < 3; ++k) {
      if (of_m.vertices >> k & 1) {
        testVertexEdges(m, k, f, of_f, true);
        for (int l = 0; l < 3; ++l) {
          if (of_f.vertices >> l & 1) testVertexVertex(m, k, f, l);
        }
      }
      if (of_f.vertices >> k & 1) testVertexEdges(f, k, m, of_m, false);
    }
  }

  void testVertexEdges(const ElementShape& v, int k, const ElementShape& e, const Candidates& of_e, bool v_moves) {
    const Vector3& p = v.corners[k];
    for (int l = 0; l < 3; ++l) {
      if (!mayMeetCorner(of_e, l, k)) continue;
      const Vector3 &q = e.corners[l], along = e.corners[NEXT[l]] - q, r = p - q;
      const double length2 = along.squaredNorm(), part = r.dot(along);
      if (!edge_pair_detail::isInside(part, length2, length2)) continue;
      const Vector3 foot = q + part / length2 * along;
      if ((p - foot).squaredNorm() > pair_.range * pair_.range) continue;
      const Feature vertex{FeatureKind::VERTEX, side(v_moves).mesh.elements[v.element][k]};
      const Feature edge{FeatureKind::EDGE, side(!v_moves).topology.element_edges[e.element][l]};
      if (v_moves) {
        addLocalMinimum(vertex, edge, p, foot, along);
      } else {
        addLocalMinimum(edge, vertex, foot, p, along);
      }
    }
  }

  void testVertexVertex(const ElementShape& m, int k, const ElementShape& f, int l) {
    if ((m.corners[k] - f.corners[l]).squaredNorm() > pair_.range * pair_.range) return;
    addLocalMinimum({FeatureKind::VERTEX, pair_.moving.mesh.elements[m.element][k]},
                    {FeatureKind::VERTEX, pair_.fixed.mesh.elements[f.element][l]}, m.corners[k], f.corners[l], Vector3::Zero());
  }

  /** @param along direction of the edge, to which the normal is square; zero if there is none */
  void addLocalMinimum(const Feature& m, const Feature& f, const Vector3& point_M, const Vector3& point_F, const Vector3& along) {
    const Vector3 d = point_M - point_F;
    const double gap = d.norm();
    const Vector3 normal = gap > TOUCH ? Vector3(d / gap) : touchNormal(pair_, m, f, point_F, along);
    if (conesAllow(m, f, normal, CONE_SLACK)) buffers_.contacts.push_back({m, f, point_M, point_F, normal, gap});
  }

  // ---- directions

  const MeshSide& side(bool moving) const { return moving ? pair_.moving : pair_.fixed; }

  /** Direction of either mesh in frame F. */
  Vector3 turned(const Vector3& direction, bool of_moving) const { return of_moving ? Vector3(R_FM_ * direction) : direction; }

  Vector3 placed(const Vector3& p, bool of_moving) const { return of_moving ? Vector3(pair_.X_FM * p) : p; }

  static bool coneAllows(const MeshSide& side, const Feature& feature, const Vector3& direction, double slack) {
    return feature.kind == FeatureKind::VERTEX ? vertexConeAllows(side, feature.index, direction, slack)
                                               : edgeConeAllows(side, feature.index, direction, slack);
  }

  /** Does neither surface come closer to the other beside its feature? */
  bool conesAllow(const Feature& m, const Feature& f, const Vector3& normal, double slack) const {
    return coneAllows(pair_.fixed, f, normal, slack) && coneAllows(pair_.moving, m, -(R_FM_.transpose() * normal), slack);
  }

  const MeshPair& pair_;
  const Matrix3 R_FM_;
  SearchBuffers& buffers_;
};

}  // namespace

void searchSimplexPairs(const MeshPair& pair, SearchBuffers* buffers) { SimplexSearch(pair, buffers).run(); }

}  // namespace blem_sim
