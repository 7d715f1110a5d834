// Edges whose feet lie beyond an end of one or both, several pairs at once. Included by the kernels only.
#pragma once

#include "kernels/candidate_kernels.h"
#include "kernels/edge_records.h"

namespace blem_sim::contact::kernels {
namespace {

/** The edges of a batch of candidates. */
struct EdgeBatch {
  EdgeBatch(const Batch& batch, const EdgeRecord* moving, const EdgeRecord* fixed) {
    start_m = batch.field(moving, OF_FIRST, &EdgeRecord::start);
    start_f = batch.field(fixed, OF_SECOND, &EdgeRecord::start);
    along_m = batch.field(moving, OF_FIRST, &EdgeRecord::along);
    along_f = batch.field(fixed, OF_SECOND, &EdgeRecord::along);
    between = start_f.v - start_m.v;
  }
  void takeInwards(const Batch& batch, const EdgeRecord* moving, const EdgeRecord* fixed) {
    for (int k = 0; k < 2; ++k) {
      const Rows into_m = batch.inward(moving, OF_FIRST, k), into_f = batch.inward(fixed, OF_SECOND, k);
      inward_m[k] = into_m.v, end_m[k] = reinterpret_cast<Mask>(into_m.w);
      inward_f[k] = into_f.v, end_f[k] = reinterpret_cast<Mask>(into_f.w);
    }
  }

  Rows start_m, start_f, along_m, along_f;
  Vectors between;  ///< from start to start
  Vectors inward_m[2], inward_f[2];
  Mask end_m[2], end_f[2];  ///< names of their vertices
};

/** Witness points of contacts of edges, with their normals and gaps. */
struct EdgeFeet {
  Vectors point_m, point_f, normal;  ///< the normal from the fixed edge to the moving one
  Doubles distance, gap;             ///< [m] of the points; and with the depth that is lost beyond the ends
};

/** Common perpendiculars as findEdgePair of edge_pair.h finds them, with feet outside too. */
struct EdgesBeyond {
  EdgesBeyond(const EdgeBatch& edges, double range) {
    const Vectors &p0 = edges.start_m.v, &q0 = edges.start_f.v, r = edges.between;
    const Vectors p = p0 + edges.along_m.v - p0, q = q0 + edges.along_f.v - q0, n = cross(p, q);
    const Doubles n2 = dot(n, n), rn = dot(r, n), p2 = dot(p, p), q2 = dot(q, q);
    const Doubles s = dot(cross(r, q), n), t = dot(cross(r, p), n), over_s = beyondEnds(s, n2), over_t = beyondEnds(t, n2);
    const double most = range / FADE_SLOPE;
    const Doubles most2 = most * most * n2 * n2, over_p2 = over_s * over_s * p2, over_q2 = over_t * over_t * q2;
    const Mask near =
        (rn * rn <= range * range * n2) & (n2 > MIN_EDGE_SINE * MIN_EDGE_SINE * p2 * q2) & (over_p2 <= most2) & (over_q2 <= most2);
    const Doubles closed2 = CLOSED * CLOSED * n2 * n2;
    const Mask inside = near & (over_p2 <= closed2) & (over_q2 <= closed2);
    is_inside = bitsOf(inside);
    cones_known = bitsOf((maximum(edges.along_m.w, edges.along_f.w) <= 0) & (rn * rn > TOUCH * TOUCH * n2));
    feet.normal = (rn > 0 ? all(-1) : all(1)) / squareRoot(n2) * n;
    // Clamped one after the other: exact where one foot lies inside.
    feet.point_m = p0 + clampedToUnit(s / n2) * p;
    feet.point_f = q0 + clampedToUnit(dot(feet.point_m - q0, q) / q2) * q;
    feet.point_m = p0 + clampedToUnit(dot(feet.point_f - p0, p) / p2) * p;
    const Vectors d = feet.point_m - feet.point_f;
    feet.distance = squareRoot(dot(d, d));
    feet.gap = feet.distance + FADE_SLOPE * (squareRoot(maximum(over_p2, over_q2)) / n2);
    fades = bitsOf(near & ~inside & ~lieInside(edges, range) & (feet.distance > TOUCH) & (feet.gap <= range));
    const Mask none = Mask{} - 1;
    end_m = over_s == 0 ? none : s > 0 ? edges.end_m[1] : edges.end_m[0];
    end_f = over_t == 0 ? none : t > 0 ? edges.end_f[1] : edges.end_f[0];
  }

  /** Whether both ends of an edge lie farther inside one of the first two faces of the other edge than a contact within range could. */
  static Mask lieInside(const EdgeBatch& edges, double range) {
    const double limit = deepestInside(range);
    const Vectors &there = edges.between, back = edges.start_m.v - edges.start_f.v;
    Mask inside{};
    for (int k = 0; k < 2; ++k) {
      inside |= liesInside(there, there + edges.along_f.v, edges.inward_m[k], limit);
      inside |= liesInside(back, back + edges.along_m.v, edges.inward_f[k], limit);
    }
    return inside;
  }

  unsigned fades;                   ///< lanes with a contact, if nothing takes over where the edges end
  unsigned is_inside, cones_known;  ///< as FadingEdgesHit
  Mask end_m, end_f;                ///< as there
  EdgeFeet feet;
};

/** Writes a hit for every lane; where its bit is not set the next one is written over it. @return number of hits now */
inline std::uint32_t appendHits(std::uint32_t first, const EdgesBeyond& edges, unsigned bits, std::uint32_t found, FadingEdgesHit* hits) {
  const EdgeFeet& feet = edges.feet;
  transposed({feet.point_m.x, feet.point_m.y, feet.point_m.z, feet.point_f.x, feet.point_f.y, feet.point_f.z, feet.distance, feet.gap},
             [&](int lane) {
               FadingEdgesHit& hit = hits[found];
               hit.candidate = first + lane;
               hit.is_inside = edges.is_inside >> lane & 1;
               hit.cones_known = edges.cones_known >> lane & 1;
               hit.end_m = static_cast<std::int32_t>(edges.end_m[lane]);
               hit.end_f = static_cast<std::int32_t>(edges.end_f[lane]);
               hit.normal[0] = feet.normal.x[lane], hit.normal[1] = feet.normal.y[lane], hit.normal[2] = feet.normal.z[lane];
               found += bits >> lane & 1;
               return hit.point_m;
             });
  return found;
}

std::uint32_t fadingEdges(const EdgeRecord* moving, const EdgeRecord* fixed, CandidateRun run, double range, FadingEdgesHit* hits) {
  std::uint32_t found = 0;
  for (std::uint32_t first = 0; first < run.count; first += LANES) {
    const Batch batch(run, first);
    EdgeBatch edges(batch, moving, fixed);
    edges.takeInwards(batch, moving, fixed);
    const EdgesBeyond beyond(edges, range);
    const unsigned bits = (beyond.fades | beyond.is_inside) & batch.valid;
    if (bits != 0) found = appendHits(first, beyond, bits, found, hits);
  }
  return found;
}

}  // namespace
}  // namespace blem_sim::contact::kernels
