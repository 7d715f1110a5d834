// At most k contacts per robot and per object, wrench kept.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "blem_sim/contact/collider.h"
#include "blem_sim/contact/manifold.h"
#include "blem_sim/geometry/state_stream.h"

namespace blem_sim::reduction {

/** Identities of contacts (Contact::id), ascending. */
using ContactIds = std::vector<std::uint64_t>;

/** Room of reductions; whoever reduces has one per thread. It changes no result. */
class ReductionWorkspace {
 public:
  ReductionWorkspace();
  ~ReductionWorkspace();
  ReductionWorkspace(ReductionWorkspace&&) noexcept;
  ReductionWorkspace& operator=(ReductionWorkspace&&) noexcept;

  struct Room;
  Room* operator->() { return room_.get(); }

 private:
  std::unique_ptr<Room> room_;
};

/**
 * Reduces `contacts` to at most k >= 1. Deterministic, whatever their order. Never invents a deeper contact than the deepest given.
 * @param contacts ids are their own
 * @param chosen_before ids of the contacts kept of the same pair in the step before: among equal choices that choice is gone on with
 * @param reduced overwritten; sorted by id; not `contacts` itself
 */
using ReduceFunction = void (*)(const std::vector<contact::Contact>& contacts, int k, const ContactIds& chosen_before,
                                ReductionWorkspace* workspace, std::vector<contact::Contact>* reduced);

/** One way to reduce contacts; a new one is one function and one row in the table. */
struct Reduction {
  const char* name;  ///< as in the parameter contact.reduction
  const char* what;  ///< one line for the manual
  ReduceFunction reduce;
};

/** hull | hierarchical | kmeans | none. */
const std::vector<Reduction>& reductionTable();

/** @return nullptr if there is no such name */
const Reduction* findReduction(const std::string& name);

/** Hull: within equal normals the corners of the convex hull (lossless, [Hauser 2013, 5]), points deeper than the hull's own interpolation
 * kept; beyond k the extremes that span the wrench cone best are kept. Allocates nothing once it has seen as many contacts. */
void reduceHull(const std::vector<contact::Contact>& contacts, int k, const ContactIds& chosen_before, ReductionWorkspace* workspace,
                std::vector<contact::Contact>* reduced);
/** Average-linkage clusters of (x, n, p), then their means [Hauser 2013, 3.4]. O(N^2 log N); above 300 contacts k-means, as the paper does.
 */
void reduceHierarchical(const std::vector<contact::Contact>& contacts, int k, const ContactIds& chosen_before,
                        ReductionWorkspace* workspace, std::vector<contact::Contact>* reduced);
/** Lloyd's k-means on (x, n, p), k iterations, farthest-point start (no random number). */
void reduceKmeans(const std::vector<contact::Contact>& contacts, int k, const ContactIds& chosen_before, ReductionWorkspace* workspace,
                  std::vector<contact::Contact>* reduced);
/** All contacts. */
void reduceNone(const std::vector<contact::Contact>& contacts, int k, const ContactIds& chosen_before, ReductionWorkspace* workspace,
                std::vector<contact::Contact>* reduced);

/** reduceHull in place, in room of its own. */
void reduceHull(std::vector<contact::Contact>& contacts, int k, const ContactIds& chosen_before = {});

/** Contacts that each pair of colliders kept in the last reduction. They decide between equal choices of the next one: state. */
class ReductionMemory {
 public:
  const ContactIds& of(const contact::ContactManifold& manifold) const;
  void remember(const std::vector<contact::ContactManifold>& manifolds);
  void clear() { choices_.clear(); }
  /** Forgets the pairs of a collider whose slot another one may take. */
  void forget(int collider);
  void save(geometry::StateWriter* writer) const;
  /** @param colliders whose pairs they may be */
  void restore(const std::vector<contact::Collider>& colliders, geometry::StateReader* reader);

  struct Choice {
    int a, b;
    ContactIds ids;
  };
  const std::vector<Choice>& choices() const { return choices_; }  ///< sorted by (a, b)

 private:
  std::vector<Choice> choices_;
};

/**
 * Sets Contact::weight where surfaces are compliant, for reduced contacts of one manifold: the springs at the corners of a rectangle, an
 * edge or a point count fully, those of a patch with more corners by the share of 96 directions in which each lies farthest out. A patch
 * is as stiff as five springs at most, whatever its tessellation; contacts at one place share.
 */
void weighSprings(std::vector<contact::Contact>& contacts, ReductionWorkspace* workspace);

/** Contacts a model should have: a wish. */
struct ContactBudget {
  int max_contacts = 20;  ///< k of this model; a static environment has none of its own: INT_MAX
};

/** Losses of a reduction: contacts left out, pairs cut, wrench given up. */
struct ReductionLoss {
  int contacts = 0;   ///< left out, those that others imply among them
  int cut_pairs = 0;  ///< pairs that budgets left with fewer contacts than `method` would keep of them without a limit
  /** Largest error of a wrench between two of a cut pair, of its normal force, torques by the radius of the pair's contacts: the most that
   * those kept lack, with friction 0.5 (of 256 directions, with a margin for others). Pierced pairs do not count. */
  double wrench = 0;
};

/** Manifolds that are to be reduced together. */
struct ManifoldsToReduce {
  const std::vector<contact::ContactManifold>& manifolds;  ///< sorted by (a, b)
  const std::vector<int>&model_a, &model_b;                ///< models of the two colliders of each, indices into budgets
  const std::vector<ContactBudget>& budgets;
};

/**
 * Reduces every manifold so that the contacts of each model sum to at most its k: each manifold asks for as many as `method` would keep
 * with the smaller k of its two models; where a model has too many then, manifolds that ask for few get all of them and the others equal
 * shares. But each keeps 3, if it asks for them, even where a model then has more than k: no pair ever loses its hold.
 * `hull` chooses once, when shares are known; others, and pierced contacts, are reduced again.
 * Pierced contacts are reduced apart, to the room that the others leave, a quarter of k at least if they are so many.
 * @param memory of the last reduction, overwritten by this one's
 * @param reduced overwritten, its memory used again; manifold by manifold the contacts kept
 */
ReductionLoss reduceManifolds(const ManifoldsToReduce& asked, const Reduction& method, ReductionMemory* memory,
                              ReductionWorkspace* workspace, std::vector<contact::ContactManifold>* reduced);

}  // namespace blem_sim::reduction
