// Search for candidates by the trees of two meshes.
#pragma once

#include <memory>
#include <vector>

#include "kept/candidate_lists.h"
#include "kept/direction_ball.h"
#include "neighbourhood/leaf_features.h"

namespace blem_sim::contact {

/** Kind of a list: of candidates for contacts, or for crossings. */
enum class CandidateKind { CONTACTS, CROSSINGS };

/** Candidate lists and the progress of their making. */
struct CandidateListing {
  CandidateKind kind = CandidateKind::CONTACTS;
  CandidateLists lists;
  ListOrigin origin;

  static constexpr std::uint32_t NOWHERE = 0xFFFFFFFF;
  /** A leaf near the other mesh, and the first of its slots: places of its vertices, then faces and edges, among the near features. */
  struct Leaf {
    std::uint32_t node, slots = NOWHERE;  ///< slots: NOWHERE until it is described
  };
  struct LeafPair {
    std::uint32_t moving, fixed;  ///< indices into leaves.moving, leaves.fixed
  };
  PerSide<std::vector<Leaf>> leaves;
  std::vector<std::uint32_t> slots;
  std::vector<LeafPair> pairs;
  std::size_t done = 0;   ///< number of pairs that were looked at
  DirectionBall normals;  ///< of the fixed mesh where it is near the moving one; only of a list for contacts with a margin

  std::size_t left() const { return pairs.size() - done; }
  bool isComplete() const { return origin.known && left() == 0; }
  /** Makes room for so many leaves, features and candidates of each kind, and as many pairs of leaves. */
  void reserve(std::size_t count) {
    for (const Side side : SIDES) {
      leaves[side].reserve(count);
      lists.near[side].reserve(count);
    }
    slots.reserve(count);
    pairs.reserve(count);
    lists.pairs.reserve(count);
  }
};

/** A leaf of a listing. */
struct FoundLeaf {
  const LeafFeatures* features = nullptr;       ///< null: not found or not described yet
  const kernels::LeafShapes* shapes = nullptr;  ///< in the fixed mesh's frame; null: not looked at yet
};

struct LeafFeature {
  const LeafFeatures* leaf;
  std::uint32_t i;  ///< index among the leaf's features of a kind
};

/** Features of one mesh that are near and not copied yet. */
struct NewFeatures {
  std::vector<LeafFeature> vertices, faces, edges;
  void clear() {
    vertices.clear();
    faces.clear();
    edges.clear();
  }
};

/** Buffers of searches for candidates. */
struct CandidateSearchBuffers {
  LeafMemory leaves;
  SurroundingsMemory surroundings;                           ///< evaluations use it too
  PerSide<std::vector<FoundLeaf>> found;                     ///< per leaf of the listing
  std::vector<std::unique_ptr<kernels::LeafShapes>> turned;  ///< of the moving leaves that were looked at
  PerSide<NewFeatures> new_features;
  kernels::LeafHits hits;
  std::uint64_t searches = 0;
};

/**
 * Candidates for every contact within pair.range, or for every crossing, that there is at the pair's pose, or at one where no point of
 * either mesh near the other has moved, and no direction has turned, by more than the margin against it. Overwrites the listing.
 */
void findCandidates(const MeshPair& pair, CandidateKind kind, const ListMargin& margin, CandidateSearchBuffers* buffers,
                    CandidateListing* listing);

/** findCandidates in parts: the first finds the pairs of leaves, for the pair's pose, the next ones look at so many of them. @param pair
 * the same, at any pose */
void beginCandidates(const MeshPair& pair, CandidateKind kind, const ListMargin& margin, CandidateSearchBuffers* buffers,
                     CandidateListing* listing);
void findMoreCandidates(const MeshPair& pair, std::size_t leaf_pairs, CandidateSearchBuffers* buffers, CandidateListing* listing);

}  // namespace blem_sim::contact
