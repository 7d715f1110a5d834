// What the neighbourhood of a vertex or an edge says about directions.
#pragma once

#include "mesh_pair.h"
#include "tolerances.h"

namespace blem_sim {

/** Does the surface at the vertex lead nowhere along `direction`? No edge there has a larger part of it than `slack` (sine).
 *  @param direction unit, the mesh's frame, towards the other mesh */
bool vertexConeAllows(const MeshSide& side, int vertex, const Vector3& direction, double slack);

/** The same for the faces of an edge. */
bool edgeConeAllows(const MeshSide& side, int edge, const Vector3& direction, double slack);

/** Do the two faces of an edge, which is not flat, go over into each other (ROUND_COSINE)? */
bool isRoundEdge(const MeshSide& side, int edge);

/** Is the surface around a vertex convex as seen from `direction` (mesh's frame, not unit), with round or flat edges only? */
bool isRoundVertex(const MeshSide& side, int vertex, const Vector3& direction);

/** A contact that takes over where another leaves is no farther from it than this part of its length. */
constexpr double NEAR_SUCCESSOR = 0.01;

/** A vertex whose contact with an edge of the other mesh, or with a plane that ends there, leaves over that edge. */
struct LeavingVertex {
  const MeshSide &side, &partner;
  int vertex, edge;  ///< of `side`, of `partner`
  Matrix3 R_PS;      ///< directions of side's frame in partner's
  Vector3 normal;    ///< unit, side's frame, towards the partner, square to the edge
};

/**
 * Does another contact take over where it leaves? The vertex's own with the edge, where no edge at the vertex leads towards the partner;
 * else that of such an edge with the partner's, if it is there and not far: a plane's inner edges have none, nor have edges whose contact
 * would point into a face.
 */
bool isTakenOver(const LeavingVertex& leaving);

/** Largest part (sine) along `direction` (unit, mesh's frame) of the faces of an edge: how steeply its surface goes that way; -1 without
 * faces. */
double edgeSlope(const MeshSide& side, int edge, const Vector3& direction);

/** Sum of the unit directions from the vertex into the surface (edges) / from the edge into its faces; mesh's frame. */
Vector3 vertexLean(const MeshSide& side, int vertex);
Vector3 edgeLean(const MeshSide& side, int edge);

/**
 * On which side of each other two bodies are, where their surfaces at a point do not tell: the smaller body's middle is on its own side.
 * Frame F.
 * @return not unit, from the fixed body's side to the moving one's; may be zero
 */
Vector3 bodySide(const MeshPair& pair, const Vector3& point);

/** The axis, turned so that the moving surface, where the meshes touch at features m and f, lies on its side. Frame F. */
Vector3 towardsMoving(const MeshPair& pair, const Vector3& axis, const Feature& m, const Feature& f, const Vector3& point);

/** Unit direction between the surfaces where a vertex touches an edge or a vertex. Frame F.
 *  @param along direction to which it is square; zero if there is none */
Vector3 touchNormal(const MeshPair& pair, const Feature& m, const Feature& f, const Vector3& point, const Vector3& along);

}  // namespace blem_sim
