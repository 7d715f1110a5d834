// Lengths and sines that the tests of simplices share. No Eigen here: the kernels include it.
#pragma once

namespace blem_sim::contact {

/** Bare meshes closer than this [m] touch: the direction between their points is rounding, and comes from their neighbourhoods instead. */
constexpr double TOUCH = 1e-9;
/** A foot this far [m] beyond the end of its domain still counts: domains overlap, never gape; contacts found twice are merged. */
constexpr double CLOSED = 1e-9;
/** Edges closer to parallel than this sine have no common perpendicular; their ends speak for them. */
constexpr double MIN_EDGE_SINE = 1e-8;
/** An edge-edge normal may point this far (sine) into a face beside either edge: nearly parallel edges blink beyond it (notes on
 * smoothness). */
constexpr double EDGE_CONE_SLACK = 0.02;
/** Slack of the test that a vertex or an edge is the other's local minimum (sine): rounding. */
constexpr double CONE_SLACK = 1e-6;
/** Depth lost per distance outside: a contact of depth p is gone p / FADE_SLOPE beyond the border. */
constexpr double FADE_SLOPE = 2;
/** Largest distance of an edge's fading contact inside a face beside its edge, as part of the range: one a fifth of the range deep has
 * faded then. */
constexpr double FADED = 0.1;
/** Faces whose planes differ by no more than this (cosine of 0.2 rad) go over into each other: a vertex that leaves one over such a convex
 * border belongs to the edge, then to the other face, however it is shaped itself. */
constexpr double ROUND_COSINE = 0.98;
/** Contacts closer than this [m], with normals closer than this (sine), are one. */
constexpr double MERGE_DISTANCE = 0.2e-6, MERGE_SINE = 1e-3;
/** A contact farther [m] than this from the border of its face and from the ends of its edges shares its place with no other. */
constexpr double NEAR_BORDER = 100 * MERGE_DISTANCE;

/** Largest distance [m] inside a face of both ends of an edge that has a contact within `range` with an edge of that face. */
inline constexpr double deepestInside(double range) { return (1.001 * EDGE_CONE_SLACK + FADED) * range + 10 * CLOSED; }

}  // namespace blem_sim::contact
