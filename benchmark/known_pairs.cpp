#include "known_pairs.h"

#include <algorithm>

#include "search/contact_search.h"

namespace blem_sim {
namespace {

using contact::kernels::Candidate;
using Candidates = contact::CandidatePairs::Candidates;

constexpr int REPEATS = 50;

/** The moving mesh is the one with fewer elements, as in the narrow phase. */
contact::MeshPair pairOf(const contact::Collider& a, const Pose& X_WA, const contact::Collider& standing) {
  const bool a_moves = a.geometry->mesh().elements.size() <= standing.geometry->mesh().elements.size();
  const double layer = a.radius + standing.radius;
  return {contact::MeshSide(a_moves ? *a.geometry : *standing.geometry),
          contact::MeshSide(a_moves ? *standing.geometry : *a.geometry),
          a_moves ? X_WA : X_WA.inverse(),
          layer,
          layer,
          {},
          Pose::Identity()};
}

/** Pairs of features that have a contact. Every pair is known once: a contact with a plane by one of its faces. */
class KnownContacts {
 public:
  KnownContacts(const std::vector<contact::Contact>& plain, const contact::ContactWriter& close) {
    // The moving mesh is A.
    for (const contact::Contact& c : plain) unseen_.push_back(c.id);
    for (const contact::Contact& c : close) unseen_.push_back(c.id);
    std::sort(unseen_.begin(), unseen_.end());
    unseen_.erase(std::unique(unseen_.begin(), unseen_.end()), unseen_.end());
    seen_.resize(unseen_.size());
  }
  /** Whether a pair is known, the first time that it is asked for; false from then on. */
  bool take(const contact::Feature& moving, const contact::Feature& fixed) {
    const auto at = std::lower_bound(unseen_.begin(), unseen_.end(), contact::contactId(moving, fixed));
    if (at == unseen_.end() || *at != contact::contactId(moving, fixed) || seen_[at - unseen_.begin()]) return false;
    return seen_[at - unseen_.begin()] = true;
  }

 private:
  std::vector<std::uint64_t> unseen_;
  std::vector<bool> seen_;
};

/** Drops the records that no candidate names, so that they lie as close as they can; `indices` follow their records. */
template <typename Record>
void compact(const std::vector<std::uint32_t*>& indices, contact::FeatureRecords<Record>* features,
             std::vector<contact::kernels::OpenSides>* open = nullptr) {
  constexpr std::uint32_t NOWHERE = 0xFFFFFFFF;
  std::vector<std::uint32_t> place(features->names.size(), NOWHERE);
  contact::FeatureRecords<Record> kept;
  std::vector<contact::kernels::OpenSides> kept_open;
  for (std::uint32_t* index : indices) {
    if (place[*index] == NOWHERE) {
      place[*index] = kept.add(features->records[*index], features->names[*index]);
      if (open) kept_open.push_back((*open)[*index]);
    }
    *index = place[*index];
  }
  *features = std::move(kept);
  if (open) *open = std::move(kept_open);
}

/** The pairs of features of two meshes that have a contact, and the kernels on them. */
class KnownPairs {
 public:
  KnownPairs(const contact::MeshPair& pair, contact::ContactSearchBuffers* buffers) : X_FM_(pair.X_FM), range_(pair.range) {
    std::vector<contact::Contact> plain;
    contact::EvaluatedContacts found;
    found.plain.overwrite(&plain);
    contact::searchContacts(pair, nullptr, buffers, &found);
    found.plain.finish();
    contact::CandidateListing listing;
    contact::findCandidates(pair, contact::CandidateKind::CONTACTS, {}, &buffers->search, &listing);
    lists_ = std::move(listing.lists);
    dropUnknown(KnownContacts(plain, found.close.placed(pair)));
    compactFeatures();
    vertex_faces_.resize(size() + 1);
    edge_edges_.resize(size() + 1);
    edges_left_.resize(size() + 1);
    vertex_edges_.resize(size());
    others_.resize(size());
  }

  std::size_t size() const { return lists_.pairs.contacts(); }

  /** @return hits */
  std::uint32_t run() {
    if (size() == 0) return 0;
    turned_.turnForContacts(lists_, X_FM_);
    const contact::kernels::Kernels& k = contact::kernels::kernels();
    const contact::CandidatePairs& pairs = lists_.pairs;
    const auto runOf = [](const Candidates& candidates) {
      return contact::kernels::CandidateRun{candidates.data(), static_cast<std::uint32_t>(candidates.size())};
    };
    const contact::NearFeatures& fixed = lists_.near.fixed;
    const contact::kernels::Vec4 *moving_vertices = turned_.vertices.data(), *fixed_vertices = fixed.vertices.records.data();
    const contact::kernels::EdgeRecord *moving_edges = turned_.edges.data(), *fixed_edges = fixed.edges.records.data();
    std::uint32_t hits = 0;
    for (const contact::Side side : contact::SIDES) {
      const Candidates &faces = pairs.vertex_face[side], &edges = pairs.vertex_edge[side];
      hits += k.vertexFaces(turned_.atFaces(lists_, side, X_FM_), {runOf(faces), nullptr}, range_, nullptr, vertex_faces_.data());
      hits += k.vertexEdges(side == contact::Side::MOVING ? moving_vertices : fixed_vertices,
                            side == contact::Side::MOVING ? fixed_edges : moving_edges, runOf(edges), range_, vertex_edges_.data());
    }
    contact::kernels::LeftEdges left{edges_left_.data(), 0};
    hits += k.edgeEdges(moving_edges, fixed_edges, runOf(pairs.edge_edge), range_, {nullptr, &left, edge_edges_.data()});
    hits += left.count;
    hits += k.vertexVertices(moving_vertices, fixed_vertices, runOf(pairs.vertex_vertex), range_, others_.data());
    return hits;
  }

 private:
  void dropUnknown(KnownContacts known) {
    const auto drop = [&](Candidates* candidates, auto&& first_of, auto&& second_of, contact::Side side) {
      const auto unknown = [&](const Candidate& c) {
        const contact::Feature first = first_of(c.first), second = second_of(c.second);
        return !(side == contact::Side::MOVING ? known.take(first, second) : known.take(second, first));
      };
      candidates->erase(std::remove_if(candidates->begin(), candidates->end(), unknown), candidates->end());
    };
    const auto vertexOf = [this](contact::Side side) {
      return [this, side](std::uint32_t i) { return contact::Feature{contact::FeatureKind::VERTEX, lists_.near[side].vertices.names[i]}; };
    };
    const auto edgeOf = [this](contact::Side side) {
      return [this, side](std::uint32_t i) { return contact::Feature{contact::FeatureKind::EDGE, lists_.near[side].edges.names[i]}; };
    };
    const auto patchOf = [this](contact::Side side) {
      return [this, side](std::uint32_t i) { return contact::Feature{contact::FeatureKind::FACE, lists_.near[side].patches[i]}; };
    };
    for (const contact::Side side : contact::SIDES) {
      drop(&lists_.pairs.vertex_face[side], vertexOf(side), patchOf(!side), side);
      drop(&lists_.pairs.vertex_edge[side], vertexOf(side), edgeOf(!side), side);
    }
    drop(&lists_.pairs.edge_edge, edgeOf(contact::Side::MOVING), edgeOf(contact::Side::FIXED), contact::Side::MOVING);
    drop(&lists_.pairs.vertex_vertex, vertexOf(contact::Side::MOVING), vertexOf(contact::Side::FIXED), contact::Side::MOVING);
  }

  void compactFeatures() {
    contact::CandidatePairs& pairs = lists_.pairs;
    contact::PerSide<std::vector<std::uint32_t*>> vertices, edges, faces;
    const auto note = [](Candidates* candidates, std::vector<std::uint32_t*>* firsts, std::vector<std::uint32_t*>* seconds) {
      for (Candidate& c : *candidates) {
        firsts->push_back(&c.first);
        seconds->push_back(&c.second);
      }
    };
    for (const contact::Side side : contact::SIDES) {
      note(&pairs.vertex_face[side], &vertices[side], &faces[!side]);
      note(&pairs.vertex_edge[side], &vertices[side], &edges[!side]);
    }
    note(&pairs.edge_edge, &edges.moving, &edges.fixed);
    note(&pairs.vertex_vertex, &vertices.moving, &vertices.fixed);
    for (const contact::Side side : contact::SIDES) {
      compact(vertices[side], &lists_.near[side].vertices);
      compact(edges[side], &lists_.near[side].edges);
      compact(faces[side], &lists_.near[side].faces, &lists_.near[side].open);
    }
  }

  const Pose X_FM_;
  const double range_;
  contact::CandidateLists lists_;
  contact::TurnedFeatures turned_;
  std::vector<contact::kernels::VertexFaceHit> vertex_faces_;
  std::vector<contact::kernels::EdgeEdgeHit> edge_edges_;
  Candidates edges_left_;
  std::vector<contact::kernels::VertexEdgeHit> vertex_edges_;
  std::vector<std::uint32_t> others_;
};

}  // namespace

PairSearch runKernelsOnKnownPairs(const ContactScene& scene) {
  const std::vector<int> steps = sampledSteps();
  const double count = static_cast<double>(steps.size());
  contact::ContactSearchBuffers buffers;
  PairSearch out;
  for (const int step : steps) {
    std::vector<KnownPairs> pairs;
    for (std::size_t i = 0; i < scene.moving.size(); ++i) {
      pairs.emplace_back(pairOf(scene.moving[i], scene.pose(static_cast<int>(i), step), scene.standing), &buffers);
      out.pairs += static_cast<double>(pairs.back().size()) / count;
    }
    for (KnownPairs& each : pairs) each.run();
    const double start = threadSeconds();
    for (int repeat = 0; repeat < REPEATS; ++repeat)
      for (KnownPairs& each : pairs) each.run();
    out.microseconds += 1e6 * (threadSeconds() - start) / REPEATS / count;
  }
  return out;
}

}  // namespace blem_sim
