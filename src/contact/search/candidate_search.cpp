#include "search/candidate_search.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "blem_sim/geometry/bvh_traversal.h"
#include "features/tolerances.h"
#include "kernels/vectors.h"

namespace blem_sim::contact {
namespace {

using kernels::Candidate;
using kernels::LeafHit;

/** Rounding of float coordinates and of numbers reckoned from them, relative to the largest one. */
constexpr double FLOAT_ROUNDING = 1e-6;
/** Rounding of directions: unit vectors, and products of edges relative to their lengths. */
constexpr double FLOAT_TURN = 1e-5;
constexpr std::uint32_t NOWHERE = CandidateListing::NOWHERE;
/** Leaves of a fine mesh that a listing has room for at once: those of teeth, which come one by one. */
constexpr std::size_t FIRST_LEAVES = 32;

/** The pair as it was where the listing began. */
MeshPair pairAt(const MeshPair& pair, const ListOrigin& origin) {
  MeshPair then = pair;
  then.X_FM = origin.X_FM;
  then.range = origin.range;
  return then;
}

/** A leaf of the listing, its features and their shapes in the fixed mesh's frame. */
struct LeafInUse {
  const LeafFeatures& features;
  const kernels::LeafShapes& shapes;
  std::uint32_t slots;
};

bool isPoints(const MeshSide& side) { return side.topology.edgeCount() == 0; }

/** Works on a listing. */
class Search {
 public:
  Search(const MeshPair& pair, CandidateSearchBuffers* buffers, CandidateListing* listing)
      : pair_(pairAt(pair, listing->origin)),
        motion_(motionOf(pair_.X_FM)),
        reach_((listing->kind == CandidateKind::CONTACTS ? pair_.range : 0) + listing->origin.margin.motion),
        rounding_(findRounding()),
        buffers_(*buffers),
        listing_(*listing),
        search_(++buffers->searches) {
    for (const Side side : SIDES) buffers_.found[side].assign(listing_.leaves[side].size(), {});
  }

  void findLeafPairs() {
    const auto matters = [this](std::uint32_t m, std::uint32_t f) { return (pair_.moving.owners[m] | pair_.fixed.owners[f]) != 0; };
    geometry::visitLeafPairsIf({pair_.moving.bvh, pair_.fixed.bvh, pair_.X_FM}, reach_ + rounding_, matters,
                               [this](std::uint32_t m, std::uint32_t f) {
                                 const std::uint32_t moving = use(Side::MOVING, m), fixed = use(Side::FIXED, f);
                                 listing_.pairs.emplace_back() = {moving, fixed};
                               });
  }

  void lookAt(std::size_t leaf_pairs) {
    const kernels::Kernels& kernels = kernels::kernels();
    const kernels::LeafReach reach = leafReach();
    const bool contacts = listing_.kind == CandidateKind::CONTACTS;
    forEachLeafPair(leaf_pairs, [&](const LeafInUse& m, const LeafInUse& f) {
      (contacts ? kernels.leafContacts : kernels.leafCrossings)(m.shapes, f.shapes, reach, &buffers_.hits);
      if (contacts) {
        appendContacts(m, f);
      } else {
        appendCrossings(m, f);
      }
    });
    copyNew();
    if (contacts && listing_.origin.margin.motion > 0) addNormals();
  }

 private:
  /** Calls visit(moving leaf, fixed leaf) for the next pairs of leaves. */
  template <typename Visit>
  void forEachLeafPair(std::size_t count, Visit&& visit) {
    const std::size_t end = std::min(listing_.done + count, listing_.pairs.size());
    for (std::size_t& i = listing_.done; i < end; ++i) {
      const CandidateListing::LeafPair& pair = listing_.pairs[i];
      const LeafInUse moving = leaf(Side::MOVING, pair.moving), fixed = leaf(Side::FIXED, pair.fixed);
      if (i + 1 < end) prefetch(listing_.pairs[i + 1], pair);
      visit(moving, fixed);
    }
  }

  /** Reach of the kernels, with room for the rounding of floats. */
  kernels::LeafReach leafReach() const {
    const ListMargin& margin = listing_.origin.margin;
    const double wider = margin.motion + rounding_;
    kernels::LeafReach reach{static_cast<float>(reach_ + rounding_),
                             static_cast<float>(wider),
                             static_cast<float>(margin.turn + FLOAT_TURN),
                             static_cast<float>(deepestInside(reach_) + wider),
                             static_cast<float>(rounding_),
                             isPoints(pair_.moving) || isPoints(pair_.fixed) ? kernels::OPEN_TO_POINTS : 0,
                             {}};
    const Matrix3 ways = margin.ways.isZero(0) ? Matrix3(margin.motion * Matrix3::Identity()) : margin.ways;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) reach.ways[i][k] = static_cast<float>((1 + FLOAT_TURN) * ways(i, k));
    return reach;
  }

  // Place of a leaf's feature among the near features of its mesh.
  std::uint32_t vertex(Side side, const LeafInUse& leaf, std::uint32_t i) {
    return place(leaf, leaf.slots + i, i, listing_.lists.near[side].vertices, &buffers_.new_features[side].vertices);
  }
  std::uint32_t face(Side side, const LeafInUse& leaf, std::uint32_t i) {
    return place(leaf, leaf.slots + leaf.features.shapes.vertex_count + i, i, listing_.lists.near[side].faces,
                 &buffers_.new_features[side].faces);
  }
  std::uint32_t edge(Side side, const LeafInUse& leaf, std::uint32_t i) {
    const kernels::LeafShapes& shapes = leaf.features.shapes;
    return place(leaf, leaf.slots + shapes.vertex_count + shapes.face_count + i, i, listing_.lists.near[side].edges,
                 &buffers_.new_features[side].edges);
  }

  /** Appends visit(i, j) for the features i of the moving leaf and j of the fixed one: in place, for a copy of both numbers at once would
   * wait until each is written. */
  template <typename Visit>
  static void append(const LeafHit* hits, int count, std::vector<Candidate>* candidates, Visit&& visit) {
    for (int h = 0; h < count; ++h) {
      for (std::uint32_t bits = hits[h].bits; bits != 0; bits &= bits - 1)
        candidates->emplace_back() = visit(hits[h].feature, static_cast<std::uint32_t>(__builtin_ctz(bits)));
    }
  }

  void appendContacts(const LeafInUse& m, const LeafInUse& f) {
    const kernels::LeafHits& hits = buffers_.hits;
    CandidatePairs& pairs = listing_.lists.pairs;
    for (const Side side : SIDES) {
      const LeafInUse &own = side == Side::MOVING ? m : f, &partner = side == Side::MOVING ? f : m;
      append(hits.vertex_face[side], hits.vertex_faces[side], &pairs.vertex_face[side], [&](auto i, auto j) -> Candidate {
        return {vertex(side, own, i), face(!side, partner, j)};
      });
      append(hits.vertex_edge[side], hits.vertex_edges[side], &pairs.vertex_edge[side], [&](auto i, auto j) -> Candidate {
        return {vertex(side, own, i), edge(!side, partner, j)};
      });
    }
    append(hits.vertex_vertex, hits.vertex_vertices, &pairs.vertex_vertex, [&](auto i, auto j) -> Candidate {
      return {vertex(Side::MOVING, m, i), vertex(Side::FIXED, f, j)};
    });
    append(hits.edge_edge, hits.edge_edges, &pairs.edge_edge, [&](auto i, auto j) -> Candidate {
      return {edge(Side::MOVING, m, i), edge(Side::FIXED, f, j)};
    });
  }

  void appendCrossings(const LeafInUse& m, const LeafInUse& f) {
    const kernels::LeafHits& hits = buffers_.hits;
    for (const Side side : SIDES) {
      append(hits.edge_face[side], hits.edge_faces[side], &listing_.lists.pairs.edge_face[side], [&](auto i, auto j) -> Candidate {
        return {edge(side, side == Side::MOVING ? m : f, i), face(!side, side == Side::MOVING ? f : m, j)};
      });
    }
  }

  /** Room [m] for the rounding of float coordinates in either frame, and for CLOSED. */
  double findRounding() const {
    const auto largest = [](const Box& box) { return std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff()); };
    const double shift = pair_.X_FM.translation().cwiseAbs().maxCoeff();
    return FLOAT_ROUNDING * (std::max(largest(pair_.fixed.bounds), largest(pair_.moving.bounds) + shift) + reach_) + 3 * CLOSED;
  }

  KeptLeaf& find(Side side, std::uint32_t node) { return buffers_.leaves.find(pair_.side(side), node, search_); }

  /** Index of the node among the listing's leaves. */
  std::uint32_t use(Side side, std::uint32_t node) {
    LeafUsed& last = last_[side];
    if (last.node != node) last = {node, indexOf(side, node)};
    return last.index;
  }

  std::uint32_t indexOf(Side side, std::uint32_t node) {
    KeptLeaf& found = find(side, node);
    std::uint32_t& index = found.index[side];
    if (index != KeptLeaf::NO_INDEX) return index;
    std::vector<CandidateListing::Leaf>& leaves = listing_.leaves[side];
    index = static_cast<std::uint32_t>(leaves.size());
    if (leaves.capacity() == 0) leaves.reserve(std::min(FIRST_LEAVES, pair_.side(side).mesh.elements.size()));
    leaves.push_back({node});
    buffers_.found[side].push_back({found.is_described ? &describe(side, &found, &leaves.back()) : nullptr, nullptr});
    return index;
  }

  LeafInUse leaf(Side side, std::uint32_t index) {
    FoundLeaf& found = buffers_.found[side][index];
    CandidateListing::Leaf& leaf = listing_.leaves[side][index];
    if (!found.shapes) {
      if (!found.features) found.features = &describe(side, &find(side, leaf.node), &leaf);
      found.shapes = side == Side::MOVING ? turned(found.features->shapes, index) : &found.features->shapes;
    }
    return {*found.features, *found.shapes, leaf.slots};
  }

  const LeafFeatures& describe(Side side, KeptLeaf* kept, CandidateListing::Leaf* leaf) {
    const LeafFeatures& features = buffers_.leaves.describe(pair_.side(side), leaf->node, &buffers_.surroundings, kept);
    if (leaf->slots == NOWHERE) {
      leaf->slots = static_cast<std::uint32_t>(listing_.slots.size());
      listing_.slots.resize(leaf->slots + kept->feature_count, NOWHERE);
    }
    return features;
  }

  /** The shapes of a moving leaf in the fixed mesh's frame. */
  const kernels::LeafShapes* turned(const kernels::LeafShapes& shapes, std::uint32_t index) {
    std::vector<std::unique_ptr<kernels::LeafShapes>>& all = buffers_.turned;
    if (all.size() <= index) all.resize(index + 1);
    if (!all[index]) all[index] = std::make_unique<kernels::LeafShapes>();
    kernels::kernels().turnLeaf(shapes, motion_, all[index].get());
    return all[index].get();
  }

  void prefetch(const CandidateListing::LeafPair& next, const CandidateListing::LeafPair& now) {
    if (next.moving != now.moving) prefetch(Side::MOVING, next.moving);
    if (next.fixed != now.fixed) prefetch(Side::FIXED, next.fixed);
  }
  /** New leaves lie far away in memory; of others only the part that is always read does. */
  void prefetch(Side side, std::uint32_t index) {
    using Shapes = kernels::LeafShapes;
    constexpr std::size_t LINE = 64, FEW = offsetof(Shapes, faces), MOST = offsetof(Shapes, edges) + sizeof(kernels::LeafEdges);
    const std::size_t size = buffers_.found[side][index].shapes ? FEW : MOST;
    const char* const begin = reinterpret_cast<const char*>(&leaf(side, index).shapes);
    for (std::size_t at = 0; at < size; at += LINE) __builtin_prefetch(begin + at);
  }

  template <typename Record>
  std::uint32_t place(const LeafInUse& leaf, std::uint32_t slot, std::uint32_t i, const FeatureRecords<Record>& features,
                      std::vector<LeafFeature>* added) {
    std::uint32_t& place = listing_.slots[slot];
    if (place == NOWHERE) {
      place = static_cast<std::uint32_t>(features.names.size() + added->size());
      added->emplace_back() = {&leaf.features, i};
    }
    return place;
  }

  /** Copies the features that were placed, at once: records lie far away in memory, and so they are fetched side by side. */
  void copyNew() {
    for (const Side side : SIDES) {
      NearFeatures& near = listing_.lists.near[side];
      const bool near_points = isPoints(pair_.side(!side));
      NewFeatures& added = buffers_.new_features[side];
      for (const LeafFeature& v : added.vertices) near.vertices.add(v.leaf->vertices.records[v.i], v.leaf->vertices.names[v.i]);
      for (const LeafFeature& e : added.edges) near.edges.add(e.leaf->edges.records[e.i], e.leaf->edges.names[e.i]);
      for (const LeafFeature& f : added.faces) {
        near.faces.add(f.leaf->faces.records[f.i], f.leaf->faces.names[f.i]);
        near.addFaceOf(*f.leaf, f.i, near_points);
      }
      added.clear();
    }
  }

  /** Adds the normals of the fixed leaves that were looked at: directions within an angle of an axis are in a ball. */
  void addNormals() {
    for (const FoundLeaf& found : buffers_.found.fixed) {
      if (!found.shapes) continue;
      const kernels::LeafRegion& region = found.shapes->region;
      const double lean = region.lean;
      const Vector3 up(region.axes[2][0], region.axes[2][1], region.axes[2][2]);
      listing_.normals.add(std::sqrt(std::max(1 - lean * lean, 0.0)) * up, lean);
    }
  }

  const MeshPair pair_;
  const kernels::Motion motion_;
  const double reach_, rounding_;
  CandidateSearchBuffers& buffers_;
  CandidateListing& listing_;
  const std::uint64_t search_;
  struct LeafUsed {
    std::uint32_t node = NOWHERE, index = NOWHERE;
  };
  PerSide<LeafUsed> last_;
};

void clear(const MeshPair& pair, CandidateKind kind, const ListMargin& margin, CandidateListing* listing) {
  listing->kind = kind;
  listing->lists.clear();
  listing->origin = {true, pair.X_FM, pair.range, margin};
  for (const Side side : SIDES) listing->leaves[side].clear();
  listing->slots.clear();
  listing->pairs.clear();
  listing->done = 0;
  listing->normals = DirectionBall();
}

}  // namespace

void findCandidates(const MeshPair& pair, CandidateKind kind, const ListMargin& margin, CandidateSearchBuffers* buffers,
                    CandidateListing* listing) {
  clear(pair, kind, margin, listing);
  Search search(pair, buffers, listing);
  search.findLeafPairs();
  search.lookAt(listing->pairs.size());
}

void beginCandidates(const MeshPair& pair, CandidateKind kind, const ListMargin& margin, CandidateSearchBuffers* buffers,
                     CandidateListing* listing) {
  clear(pair, kind, margin, listing);
  Search(pair, buffers, listing).findLeafPairs();
}

void findMoreCandidates(const MeshPair& pair, std::size_t leaf_pairs, CandidateSearchBuffers* buffers, CandidateListing* listing) {
  Search(pair, buffers, listing).lookAt(leaf_pairs);
}

}  // namespace blem_sim::contact
