// Tests of directions by the neighbourhood of a vertex or an edge.
#pragma once

#include "features/mesh_pair.h"
#include "features/tolerances.h"

namespace blem_sim::contact {

/** Whether the surface at the edge leads nowhere along `direction`: none of its faces has a larger part of it than `slack` (sine).
 * @param direction unit, the mesh's frame, towards the other mesh */
bool edgeConeAllows(const MeshSide& side, int edge, const Vector3& direction, double slack);

/** Whether an edge is round: not flat, its two faces go over into each other (ROUND_COSINE). */
bool isRoundEdge(const MeshSide& side, int edge);

/** Whether two faces of an edge go over into each other, by the unit directions into them. */
inline bool isRound(const Vector3& inward, const Vector3& other) { return inward.dot(other) <= -ROUND_COSINE; }

/** A contact that takes over where another leaves is no farther from it than this part of its length. */
constexpr double NEAR_SUCCESSOR = 0.01;

/** Sum of the unit directions from the vertex into the surface (edges) / from the edge into its faces; mesh's frame. */
Vector3 vertexLean(const MeshSide& side, int vertex);
Vector3 edgeLean(const MeshSide& side, int edge);

/**
 * Sides of two bodies where their surfaces at a point do not tell: the smaller body's middle is on its own side. Frame F.
 * @return not unit, from the fixed body's side to the moving one's; may be zero
 */
Vector3 bodySide(const MeshPair& pair, const Vector3& point);

/** The axis, turned so that the moving surface, where the meshes touch at features m and f, lies on its side. Frame F. */
Vector3 towardsMoving(const MeshPair& pair, const Vector3& axis, const Feature& m, const Feature& f, const Vector3& point);

/** Unit direction between the surfaces where a vertex touches an edge or a vertex. Frame F.
 *  @param along direction to which it is square; zero if there is none */
Vector3 touchNormal(const MeshPair& pair, const Feature& m, const Feature& f, const Vector3& point, const Vector3& along);

}  // namespace blem_sim::contact
