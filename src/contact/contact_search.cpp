#include "contact_search.h"

#include <algorithm>
#include <cmath>

#include "border_fade.h"
#include "exact_tests.h"
#include "vectors.h"

namespace blem_sim {
namespace {

using kernels::Candidate;
using kernels::Vec4;

// A list is made for so many steps of the present motion: longer ones cost more in every step, shorter ones are made anew too often.
constexpr double MARGIN_STEPS = 14, FEWEST_STEPS = 3;
constexpr double LEAST_PART = 0.7;  // of MARGIN_STEPS, see partOf
// Of long lists those that matter for so few steps are listed again.
constexpr double NEAREST_STEPS = 4;
// Candidates for crossings are listed for so many.
constexpr double CROSSING_STEPS = 8;
constexpr std::size_t FEW_CANDIDATES = 200;
constexpr double LEAST_MARGIN = 0.02, MOST_MARGIN = 0.8, LEAST_NEAREST_MARGIN = 0.005;  // of the range
constexpr double FIRST_MARGIN = 0.1;                                                    // of the range, where the motion is not known yet
// The same of directions.
constexpr double LEAST_TURN = 0.005, LEAST_NEAREST_TURN = 0.001, FIRST_TURN = 0.05;
/** What a distance may be wrong by [m]. */
constexpr double DISTANCE_ROUNDING = 1e-7;

/** What of the moving mesh's frame is near the fixed mesh: its box there, where the other's box is, both wider by the range. */
Box commonRegion(const MeshPair& pair) {
  const Pose X_MF = pair.X_FM.inverse();
  const Box& fixed = pair.fixed.bounds;
  const Vector3 half = X_MF.linear().cwiseAbs() * (0.5 * fixed.sizes()) + Vector3::Constant(2 * pair.range), centre = X_MF * fixed.center();
  const Vector3 wider = Vector3::Constant(pair.range);
  return Box(centre - half, centre + half).intersection(Box(pair.moving.bounds.min() - wider, pair.moving.bounds.max() + wider));
}

/** How far [m] a point of the region moves at most from one pose to the other: a convex function of place. */
double largestMotion(const Box& region, const Pose& X, const Pose& Y) {
  if (region.isEmpty()) return 0;
  const Matrix3 turn = X.linear() - Y.linear();
  const Vector3 shift = X.translation() - Y.translation();
  double largest2 = 0;
  for (int corner = 0; corner < 8; ++corner)
    largest2 = std::max(largest2, (turn * region.corner(static_cast<Box::CornerType>(corner)) + shift).squaredNorm());
  return std::sqrt(largest2);
}

/** How far the end of a unit vector moves at most from one orientation to the other. */
double largestTurn(const Pose& X, const Pose& Y) { return (X.linear() - Y.linear()).norm() / std::sqrt(2.0); }

/** A number from LEAST_PART to 1 that is another for every pose: pairs that set out together shall not all need new lists in one step. */
double partOf(const Pose& X) {
  constexpr double GRAIN = 1e-7;  // [m]
  const double grains = X.translation().sum() / GRAIN;
  return LEAST_PART + (1 - LEAST_PART) * (grains - std::floor(grains));
}

/** The planes that vertices lie over. */
class PlanesBelow {
 public:
  explicit PlanesBelow(std::vector<kernels::Candidate>* runs, std::vector<std::uint32_t>* last, std::size_t vertices)
      : entries_(*runs), last_(*last) {
    entries_.clear();
    last_.assign(vertices, NONE);
  }
  void add(std::uint32_t vertex, int patch) {
    entries_.push_back({static_cast<std::uint32_t>(patch), last_[vertex]});
    last_[vertex] = static_cast<std::uint32_t>(entries_.size()) - 1;
  }
  bool has(std::uint32_t vertex, int patch) const {
    for (std::uint32_t i = last_[vertex]; i != NONE; i = entries_[i].b)
      if (entries_[i].a == static_cast<std::uint32_t>(patch)) return true;
    return false;
  }

 private:
  static constexpr std::uint32_t NONE = 0xFFFFFFFF;
  std::vector<kernels::Candidate>& entries_;  // a: patch; b: the entry before of the same vertex
  std::vector<std::uint32_t>& last_;
};

/** Turns candidates into contacts. */
class Evaluation {
 public:
  /** @param pairs of the lists, all or those that matter; the features of the lists must have been turned */
  Evaluation(const MeshPair& pair, CandidateLists* lists, const CandidatePairs& pairs, ContactSearchBuffers* buffers, FoundContacts* found)
      : pair_(pair), lists_(*lists), pairs_(pairs), buffers_(*buffers), found_(*found), exact_(pair, &found->close), fades_(pair, lists) {}

  void findContacts() {
    const auto& vertices = buffers_.turned.vertices;
    const auto& edges = buffers_.turned.edges;
    for (const bool moves : {true, false}) {
      vertexFaces(moves);
      vertexEdges(moves, moves ? vertices[1].data() : lists_.near[0].vertices.records.data(),
                  moves ? lists_.near[0].edges.records.data() : edges.data());
    }
    edgeEdges(edges.data(), lists_.near[0].edges.records.data());
    vertexVertices(vertices[1].data(), lists_.near[0].vertices.records.data());
  }

  void findCrossings() {
    const TurnedFeatures& turned = buffers_.turned;
    for (const bool moves : {true, false}) {
      const std::vector<Candidate>& candidates = pairs_.edge_face[moves];
      const auto& edges = moves ? turned.edges : lists_.near[0].edges.records;
      const auto& faces = moves ? lists_.near[0].faces.records : turned.faces;
      forEachHit(candidates,
                 kernels::kernels().edgeFaces(edges.data(), faces.data(), candidates.data(), candidates.size(), room(candidates)),
                 [&](const Candidate& c) {
                   const Crossing crossing{moves, lists_.near[moves].edges.names[c.a], lists_.near[!moves].faces.names[c.b]};
                   if (crosses(pair_, crossing)) found_.crossings.push_back(crossing);
                 });
    }
  }

 private:
  std::uint32_t* room(const std::vector<Candidate>& candidates) {
    buffers_.hits.resize(std::max(buffers_.hits.size(), candidates.size()));
    return buffers_.hits.data();
  }

  template <typename Visit>
  void forEachHit(const std::vector<Candidate>& candidates, std::uint32_t count, Visit&& visit) const {
    for (std::uint32_t i = 0; i < count; ++i) visit(candidates[buffers_.hits[i]]);
  }

  void vertexFaces(bool moves) {
    const std::vector<Candidate>& candidates = pairs_.vertex_face[moves];
    const auto& vertices = lists_.near[moves].vertices;
    const auto& faces = lists_.near[!moves].faces;
    auto& hits = buffers_.vertex_faces;
    hits.resize(std::max(hits.size(), candidates.size()));
    const std::uint32_t count =
        kernels::kernels().vertexFaces(buffers_.turned.vertices[moves].data(), faces.records.data(), lists_.near[!moves].open.data(),
                                       candidates.data(), candidates.size(), pair_.range, hits.data());
    const std::vector<int>& patches = lists_.near[!moves].patches;
    PlanesBelow below(&buffers_.planes_below, &buffers_.last_plane, vertices.names.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      kernels::VertexFaceHit& hit = hits[i];
      const Candidate& c = candidates[hit.candidate];
      if (!hit.is_plain) {
        hit.is_beside = hit.is_beside || !exact_.vertexFace(moves, vertices.names[c.a], faces.names[c.b]);
        if (hit.is_beside) continue;
      } else {
        addPlain(moves, c, hit);
      }
      below.add(c.a, patches[c.b]);
    }
    // Beside one face of a plane but over another it does not fade.
    for (std::uint32_t i = 0; i < count; ++i) {
      const Candidate& c = candidates[hits[i].candidate];
      if (hits[i].is_beside && !below.has(c.a, patches[c.b])) addFading(moves, c, hits[i].height);
    }
  }

  void addPlain(bool moves, const Candidate& c, const kernels::VertexFaceHit& hit) {
    const auto& faces = lists_.near[!moves].faces;
    const Feature vertex{FeatureKind::VERTEX, lists_.near[moves].vertices.names[c.a]},
        patch{FeatureKind::FACE, lists_.near[!moves].patches[c.b]};
    const Vector3 p = vector3(moves ? buffers_.turned.vertices[1][c.a] : lists_.near[0].vertices.records[c.a]);
    const Vector3 up = pair_.turned(vector3(faces.records[c.b].plane), !moves), foot = p - hit.height * up;
    const Vector3 normal = (hit.height > 0) == moves ? up : Vector3(-up);
    (hit.near_border ? found_.close : found_.plain).push_back(featureContact(moves, vertex, patch, p, foot, normal, std::abs(hit.height)));
  }

  void addFading(bool moves, const Candidate& c, double height) {
    BorderFade fade;
    const double most = pair_.range - std::abs(height);
    if (!fades_.find(moves, c.a, c.b, vector3(buffers_.turned.vertices[moves][c.a]), height, most, &fade)) return;
    const Vector3 p = vector3(moves ? buffers_.turned.vertices[1][c.a] : lists_.near[0].vertices.records[c.a]);
    const Vector3 d = moves ? Vector3(p - fade.foot) : Vector3(fade.foot - p);
    const double distance = d.norm(), gap = distance + fade.lost;
    if (distance <= TOUCH || gap > pair_.range) return;
    const Feature vertex{FeatureKind::VERTEX, lists_.near[moves].vertices.names[c.a]},
        patch{FeatureKind::FACE, lists_.near[!moves].patches[c.b]};
    found_.close.push_back(featureContact(moves, vertex, patch, p, fade.foot, d / distance, gap));
  }

  void edgeEdges(const kernels::EdgeRecord* moving, const kernels::EdgeRecord* fixed) {
    const std::vector<Candidate>& candidates = pairs_.edge_edge;
    auto& hits = buffers_.edge_edges;
    hits.resize(std::max(hits.size(), candidates.size()));
    const std::uint32_t count = kernels::kernels().edgeEdges(moving, fixed, candidates.data(), candidates.size(), pair_.range, hits.data());
    for (std::uint32_t i = 0; i < count; ++i) {
      const kernels::EdgeEdgeHit& hit = hits[i];
      const Candidate& c = candidates[hit.candidate];
      const int m = lists_.near[1].edges.names[c.a], f = lists_.near[0].edges.names[c.b];
      if (!hit.is_plain) {
        exact_.edgeEdge(m, f, moving[c.a], fixed[c.b]);
        continue;
      }
      const auto foot = [](const kernels::EdgeRecord& edge, double part) {
        return Vector3(vector3(edge.start) + part * vector3(edge.along));
      };
      (hit.near_border ? found_.close : found_.plain)
          .push_back({{FeatureKind::EDGE, m},
                      {FeatureKind::EDGE, f},
                      foot(moving[c.a], hit.part_a),
                      foot(fixed[c.b], hit.part_b),
                      Vector3(hit.normal[0], hit.normal[1], hit.normal[2]),
                      hit.gap});
    }
  }

  void vertexEdges(bool moves, const Vec4* vertices, const kernels::EdgeRecord* edges) {
    const std::vector<Candidate>& candidates = pairs_.vertex_edge[moves];
    forEachHit(candidates,
               kernels::kernels().vertexEdges(vertices, edges, candidates.data(), candidates.size(), pair_.range, room(candidates)),
               [&](const Candidate& c) {
                 exact_.vertexEdge(moves, lists_.near[moves].vertices.names[c.a], lists_.near[!moves].edges.names[c.b],
                                   vector3(vertices[c.a]), edges[c.b]);
               });
  }

  void vertexVertices(const Vec4* moving, const Vec4* fixed) {
    const std::vector<Candidate>& candidates = pairs_.vertex_vertex;
    forEachHit(candidates,
               kernels::kernels().vertexVertices(moving, fixed, candidates.data(), candidates.size(), pair_.range, room(candidates)),
               [&](const Candidate& c) { exact_.vertexVertex(lists_.near[1].vertices.names[c.a], lists_.near[0].vertices.names[c.b]); });
  }

  const MeshPair& pair_;
  CandidateLists& lists_;
  const CandidatePairs& pairs_;
  ContactSearchBuffers& buffers_;
  FoundContacts& found_;
  ExactTests exact_;
  BorderFades fades_;
};

/** One search with what is known. */
class ContactSearch {
 public:
  ContactSearch(const MeshPair& pair, ContactSearchMemory* memory, ContactSearchBuffers* buffers, FoundContacts* found)
      : pair_(pair), memory_(*memory), buffers_(*buffers), found_(*found), region_(commonRegion(pair)) {
    if (memory->moving != pair.moving.identity || memory->fixed != pair.fixed.identity) forget();
    if (memory_.visited) motion_ = {largestMotion(region_, pair.X_FM, memory_.X_FM), largestTurn(pair.X_FM, memory_.X_FM)};
  }

  void run(bool keeps) {
    const bool apart = memory_.visited && motion_.motion + DISTANCE_ROUNDING < memory_.distance;
    refreshLists(keeps ? chooseMargin() : ListMargin());
    buffers_.turned.turnForContacts(memory_.lists, pair_.X_FM);
    Evaluation(pair_, &memory_.lists, nearestPairs(), &buffers_, &found_).findContacts();
    if (!apart) {
      refreshCrossingLists(keeps && !isFast() ? marginOf(CROSSING_STEPS) : ListMargin());
      CandidateLists& lists = memory_.crossing_lists;
      buffers_.turned.turnForCrossings(lists, pair_.X_FM);
      Evaluation(pair_, &lists, lists.pairs, &buffers_, &found_).findCrossings();
    }
    memory_.visited = keeps;
    memory_.X_FM = pair_.X_FM;
    memory_.distance = found_.crossings.empty() ? leastGap() : 0;
  }

 private:
  void forget() {
    memory_.visited = memory_.lists_origin.known = memory_.nearest_origin.known = memory_.crossings_origin.known = false;
    memory_.moving = pair_.moving.identity;
    memory_.fixed = pair_.fixed.identity;
  }

  /** Too fast for lists to last. */
  bool isFast() const { return FEWEST_STEPS * motion_.motion > MOST_MARGIN * pair_.range; }

  ListMargin chooseMargin() const {
    if (!memory_.visited) return {FIRST_MARGIN * pair_.range, FIRST_TURN};
    if (isFast()) return {};
    const double steps = MARGIN_STEPS * partOf(pair_.X_FM);
    return {std::clamp(steps * motion_.motion, LEAST_MARGIN * pair_.range, MOST_MARGIN * pair_.range),
            std::max(steps * motion_.turn, LEAST_TURN)};
  }

  bool isGood(const ListOrigin& origin) const {
    if (!origin.known) return false;
    const double motion = largestMotion(region_, pair_.X_FM, origin.X_FM);
    return motion <= origin.margin.motion && pair_.range + motion <= origin.range + origin.margin.motion &&
           largestTurn(pair_.X_FM, origin.X_FM) <= origin.margin.turn;
  }

  void refreshLists(const ListMargin& margin) {
    if (isGood(memory_.lists_origin)) return;
    findCandidates(pair_, margin, &buffers_.search, &memory_.lists);
    memory_.lists_origin = {true, pair_.X_FM, pair_.range, margin};
    memory_.nearest_origin.known = false;
  }

  void refreshCrossingLists(const ListMargin& margin) {
    if (isGood(memory_.crossings_origin)) return;
    findCrossingCandidates(pair_, margin, &buffers_.search, &memory_.crossing_lists);
    memory_.crossings_origin = {true, pair_.X_FM, pair_.range, margin};
  }

  /** For so many steps of the present motion. */
  ListMargin marginOf(double steps) const {
    return {std::clamp(steps * motion_.motion, LEAST_NEAREST_MARGIN * pair_.range, MOST_MARGIN * pair_.range),
            std::max(steps * motion_.turn, LEAST_NEAREST_TURN)};
  }

  /** The candidates to test, good lists given. */
  const CandidatePairs& nearestPairs() {
    if (isGood(memory_.nearest_origin)) return memory_.nearest;
    const ListMargin margin = marginOf(NEAREST_STEPS);
    if (memory_.lists.pairs.contacts() <= FEW_CANDIDATES || 2 * margin.motion >= memory_.lists_origin.margin.motion)
      return memory_.lists.pairs;
    findNearest(pair_, buffers_.turned, margin, &memory_.lists, &memory_.nearest);
    memory_.nearest_origin = {true, pair_.X_FM, pair_.range, margin};
    return memory_.nearest;
  }

  double leastGap() const {
    double least = pair_.range;
    for (const FeatureContact& c : found_.plain) least = std::min(least, c.gap);
    for (const FeatureContact& c : found_.close) least = std::min(least, c.gap);
    return least;
  }

  const MeshPair& pair_;
  ContactSearchMemory& memory_;
  ContactSearchBuffers& buffers_;
  FoundContacts& found_;
  const Box region_;
  ListMargin motion_;  // since the last search
};

}  // namespace

void FoundContacts::clear() {
  plain.clear();
  close.clear();
  crossings.clear();
}

void searchContacts(const MeshPair& pair, ContactSearchMemory* memory, ContactSearchBuffers* buffers, FoundContacts* found) {
  found->clear();
  if (!memory) {
    buffers->unknown.moving = 0;
    ContactSearch(pair, &buffers->unknown, buffers, found).run(false);
  } else {
    ContactSearch(pair, memory, buffers, found).run(true);
  }
}

}  // namespace blem_sim
