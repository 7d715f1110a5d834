// Lists of features of two meshes that may have a contact, good for as long as nothing has moved by more than a margin.
#pragma once

#include <cstddef>
#include <vector>

#include "features/mesh_pair.h"
#include "kept/fading_records.h"
#include "kept/list_margin.h"
#include "kernels/kernels.h"
#include "neighbourhood/leaf_features.h"
#include "neighbourhood/surroundings.h"

namespace blem_sim::contact {

/** Records of some features of a mesh, in its own frame, and their names in it. */
template <typename Record>
struct FeatureRecords {
  std::vector<Record> records;
  std::vector<int> names;

  std::uint32_t add(const Record& record, int name) {
    records.push_back(record);
    names.push_back(name);
    return static_cast<std::uint32_t>(names.size()) - 1;
  }
  void clear() {
    records.clear();
    names.clear();
  }
  void reserve(std::size_t count) {
    records.reserve(count);
    names.reserve(count);
  }
};

/** The features of one mesh that appear in candidates. */
struct NearFeatures {
  FeatureRecords<kernels::Vec4> vertices;
  FeatureRecords<kernels::EdgeRecord> edges;
  FeatureRecords<kernels::FaceRecord> faces;
  std::vector<int> patches;              ///< per face: its plane
  std::vector<kernels::OpenSides> open;  ///< per face: its open sides
  std::vector<BorderKinds> borders;      ///< per face: the kinds of its sides
  FadingRecords fading;

  void addFaceOf(const LeafFeatures& leaf, std::uint32_t i, bool near_points);  ///< appends patch, open sides and borders of a face
  void clear();
  void reserve(std::size_t count);  ///< room for so many features of each kind
};

/** Pairs of features, in an order that the meshes alone decide, by the side of the feature named first, which Candidate::first is. */
struct CandidatePairs {
  using Candidates = std::vector<kernels::Candidate>;
  PerSide<Candidates> vertex_face, vertex_edge, edge_face;
  /** Per candidate of vertex_face: 1 where the vertex is surely over its face, not near a border, while the list is good; empty: unknown */
  PerSide<std::vector<std::uint8_t>> inner;
  Candidates edge_edge, vertex_vertex;  ///< first is the moving mesh's

  void clear();
  void reserve(std::size_t count);  ///< room for so many candidates of each kind
  std::size_t contacts() const;     ///< number of candidates for contacts
};

struct CandidateLists {
  PerSide<NearFeatures> near;
  CandidatePairs pairs;

  void clear();
};

/** Features of lists in the other mesh's frame. */
struct TurnedFeatures {
  std::vector<kernels::Vec4> vertices;     ///< of the moving mesh
  std::vector<kernels::EdgeRecord> edges;  ///< of the moving mesh
  std::vector<kernels::FaceRecord> faces;  ///< of the moving mesh

  /** Turns the features that candidates for contacts are tested with. @param X_FM of the pair */
  void turnForContacts(const CandidateLists& lists, const Pose& X_FM);
  /** Turns the features that candidates for crossings are tested with. */
  void turnForCrossings(const CandidateLists& lists, const Pose& X_FM);

  /** The vertices of the moving mesh, or of the fixed one, near the other's faces, for kernels. */
  kernels::NearVertices nearFaces(const CandidateLists& lists, Side side, const Pose& X_FM) const;
  /** The same, with those faces. */
  kernels::VerticesAtFaces atFaces(const CandidateLists& lists, Side side, const Pose& X_FM) const {
    const NearFeatures& partner = lists.near[!side];
    return {nearFaces(lists, side, X_FM), partner.faces.records.data(), partner.open.data()};
  }
};

/** Lists, and their features as they are turned. */
struct TurnedLists {
  const CandidateLists& lists;
  const TurnedFeatures& turned;
};

/**
 * Selects the candidates for contacts that can have one within pair.range while nothing moves or turns by more than the margin, in their
 * order.
 * @param listed turned at the pair's pose
 * @return number of candidates that are near, with those that can have none since a vertex leads towards the other feature
 */
std::size_t findNearest(const MeshPair& pair, const TurnedLists& listed, const ListMargin& margin, SurroundingsMemory* surroundings,
                        CandidatePairs* nearest);

}  // namespace blem_sim::contact
