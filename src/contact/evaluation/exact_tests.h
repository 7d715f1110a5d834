// Tests of one pair of features at a time, where kernels cannot tell: it touches, has left its face or edge, or asks for neighbourhoods.
#pragma once

#include "evaluation/close_contacts.h"
#include "features/face_shape.h"
#include "features/mesh_pair.h"
#include "kernels/edge_records.h"
#include "neighbourhood/surroundings.h"

namespace blem_sim::contact {

/** Appends the contact of a pair of features, if they have one, to a list. */
class ExactTests {
 public:
  ExactTests(const MeshPair& pair, SurroundingsMemory* surroundings, CloseContacts* contacts)
      : pair_(pair), R_FM_(pair.X_FM.linear()), surroundings_(*surroundings), contacts_(*contacts) {}

  /** @param face element of the other mesh @return false if the vertex projects beside the face by more than CLOSED */
  bool vertexFace(Side side, int vertex, int face);
  /** Contact of edges whose feet lie inside both. @param record_m, record_f of the two edges in frame F */
  void edgeEdge(int moving, int fixed, const kernels::EdgeRecord& record_m, const kernels::EdgeRecord& record_f);
  /** Contact of edges of which a foot lies beyond an end: it fades. @param hit of the two edges, the moving one named first */
  void fadingEdges(int moving, int fixed, const kernels::FadingEdgesHit& hit);
  /** Whether the surface at the vertex surely leads towards the edge, so that the vertex is no local minimum. Most vertices are told by
   * this, without a foot on the edge. @param d from the edge's line to the vertex, frame F */
  bool leadsTo(Side side, int vertex, const Vector3& d) const;
  /** Contact where each is the other's local minimum; at a round edge wherever the vertex is nearer to it than to its faces.
   * @param p, record the vertex and the edge in frame F */
  void vertexEdge(Side side, int vertex, int edge, const Vector3& p, const kernels::EdgeRecord& record);
  void vertexVertex(int moving, int fixed);

 private:
  bool reachesOver(Side side, int vertex, const Vector3& p, const FaceShape& face) const;
  bool addAtRoundEdge(Side side, int vertex, int edge, const Vector3& p, const kernels::EdgeRecord& record);
  void addLocalMinimum(const Feature& m, const Feature& f, const Vector3& point_M, const Vector3& point_F, const Vector3& along);
  /** Whether neither surface comes closer to the other beside its feature. */
  bool conesAllow(const Feature& m, const Feature& f, const Vector3& normal, double slack) const;
  bool coneAllows(Side side, const Feature& feature, const Vector3& direction, double slack) const;
  Vector3 position(Side side, int vertex) const { return pair_.placed(pair_.side(side).mesh.vertices[vertex], side); }

  const MeshPair& pair_;
  const Matrix3 R_FM_;
  SurroundingsMemory& surroundings_;
  CloseContacts& contacts_;
};

}  // namespace blem_sim::contact
