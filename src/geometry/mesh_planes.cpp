#include "mesh_planes.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <utility>

#include "blem_sim/geometry/collected.h"
#include "blem_sim/geometry/for_all.h"
#include "curved_patches.h"
#include "threads/disjoint_sets.h"

namespace blem_sim::geometry {
namespace {

/** Two triangles of height h whose corners are off a plane by PLANE_DEVIATION bend by up to this [m] / h [rad] ... */
constexpr double BEND_HEIGHT = 4 * PLANE_DEVIATION;
/** ... but by no more than this [rad], however low they are: a chamfer is no noise. */
constexpr double MAX_BEND = 0.5;
/** A crease bends by this many times as much as noise can, or by MIN_CREASE [rad]; between the two a curved surface is likelier. */
constexpr double CREASE = 3;
constexpr double MIN_CREASE = 0.7;
/** Part of a patch's outline that may be neither crease nor open border. */
constexpr double MAX_DOUBTFUL = 0.2;
/** Width of a patch over its deviation, at least. */
constexpr double MIN_WIDTH = 500;
/** A few triangles of a scan or a curved surface lie in a plane by chance now and then; so many triangles do not. */
constexpr int MANY_FACES = 24;
/** Fewer must be flat but for the rounding of floats in files, and no more than this part of their outline bend by less than MIN_CREASE. */
constexpr double MIN_WIDTH_OF_FEW = 3e5;
constexpr double MAX_BLUNT = 0.1;
/** Vertices that no crack moves go no farther than this many times the deviation of their patches. */
constexpr double MAX_MOVE = 4;
/** Planes whose normals differ by less than this have no intersection worth the name. */
constexpr double PARALLEL = 1e-3;

/** Sums over triangles for their least-squares plane. */
struct Moments {
  double area = 0;
  Vector3 first = Vector3::Zero();   ///< [m^3]
  Matrix3 second = Matrix3::Zero();  ///< [m^4]

  /** Those of one triangle. */
  static Moments of(const Vector3& a, const Vector3& b, const Vector3& c) {
    const Vector3 sum = a + b + c;
    const double area = 0.5 * (b - a).cross(c - a).norm();
    return {area, area / 3 * sum, area / 12 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose())};
  }
  void add(const Moments& other) {
    area += other.area;
    first += other.first;
    second += other.second;
  }
};

/** Triangles that continue one another. */
struct Patch {
  Vector3 reference = Vector3::Zero();  ///< [m] near the patch, to sum from
  Moments moments;
  Vector3 centre = Vector3::Zero(), normal = Vector3::Zero();
  double width = 0;                             ///< [m] shorter side of the rectangle that has the same second moments
  double deviation = 0;                         ///< [m] distance of the farthest vertex from the plane
  double outline = 0, doubtful = 0, blunt = 0;  ///< [m]
  double noise = 0;                             ///< [m] twice the largest noise known of its vertices
  int faces = 0;
  bool rough = false;  ///< whether an edge inside is not flat
  bool plane = false;
};

class PlaneFinder {
 public:
  PlaneFinder(const MeshTopology& topology, const TriangleMesh& mesh, const std::vector<double>& noise)
      : topology_(topology), mesh_(mesh), noise_(noise), bends_(topology.edgeCount(), Bend::NONE) {}

  /** @return false if nothing is to be done */
  bool find() {
    if (!joinFaces()) return false;
    numberPatches();
    describeEdges();
    if (std::none_of(patches_.begin(), patches_.end(), [this](const Patch& patch) { return patch.rough && mayBePlane(patch); }))
      return false;
    addFaces();
    for (Patch& patch : patches_) fit(&patch);
    measureDeviations();
    for (Patch& patch : patches_) patch.plane = isPlane(patch);
    dropCurved();
    return std::any_of(patches_.begin(), patches_.end(), [](const Patch& patch) { return patch.plane && patch.rough; });
  }

  std::vector<Patch>& patches() { return patches_; }
  static constexpr int NO_PATCH = -1;
  int patchOf(int element) const { return patch_of_[element]; }

 private:
  enum class Bend : std::uint8_t { NONE, SMOOTH, DOUBTFUL, CREASE, SHARP };

  double height(int edge, int face, const Vector3& inward) const {
    const auto [start, end] = topology_.ends(mesh_, edge);
    const int opposite = mesh_.elements[face].sum() - start - end;
    return (mesh_.vertices[opposite] - mesh_.vertices[start]).dot(inward);
  }

  Bend bendOf(int edge, int face, int other) const {
    static const double CREASE_COSINE = std::cos(MIN_CREASE);
    const Vector3 normal = MeshTopology::normal(mesh_, face), other_normal = MeshTopology::normal(mesh_, other);
    if (std::abs(normal.dot(other_normal)) < CREASE_COSINE) return Bend::SHARP;
    const Vector3 u = topology_.inward(mesh_, edge, face, normal), v = topology_.inward(mesh_, edge, other, other_normal);
    if (u.dot(v) > 0) return Bend::SHARP;
    const double bend = (u + v).norm(), noise = BEND_HEIGHT / std::min(height(edge, face, u), height(edge, other, v));
    if (bend <= std::min(noise, MAX_BEND)) return Bend::SMOOTH;
    if (bend <= std::min(CREASE * noise, MIN_CREASE)) return Bend::DOUBTFUL;
    return bend <= MIN_CREASE ? Bend::CREASE : Bend::SHARP;
  }

  bool isRough(int edge) const { return bends_[edge] == Bend::SMOOTH && topology_.facesOf(edge).size() == 2; }

  /** Finds the bends; faces that continue each other become one patch, from the flat patches of the topology on. @return whether there is
   * a patch with an edge inside that is not flat */
  bool joinFaces() {
    sets_.emplace(static_cast<int>(mesh_.elements.size()), [this](int face) { return topology_.patchOf(face); });
    std::atomic<bool> some_rough{false};
    forAll(topology_.edgeCount(), [&](int edge) {
      if (topology_.isFlatEdge(edge)) return;
      joinFacesOf(edge);
      if (isRough(edge) && !some_rough.load(std::memory_order_relaxed)) some_rough.store(true, std::memory_order_relaxed);
    });
    return some_rough;
  }

  void joinFacesOf(int edge) {
    const EdgeFaces faces = topology_.facesOf(edge);
    for (int i = 0; i < faces.size(); ++i) {
      for (int j = i + 1; j < faces.size(); ++j) {
        const Bend bend = bendOf(edge, faces[i], faces[j]);
        bends_[edge] = std::max(bends_[edge], bend);
        if (bend == Bend::SMOOTH) sets_->join(faces[i], faces[j]);
      }
    }
  }

  /** Triangles alone are no patches. */
  void numberPatches() {
    const int count = static_cast<int>(mesh_.elements.size());
    patch_of_.resize(mesh_.elements.size());  // first the first face of each patch
    forAll(count, [this](int i) { patch_of_[i] = sets_->first(i); });
    sets_.reset();
    std::vector<int> faces(patch_of_.size(), 0);
    for (const int first : patch_of_) ++faces[first];
    for (int i = 0; i < count; ++i) {
      const int first = patch_of_[i];
      if (faces[first] == 1) {
        patch_of_[i] = NO_PATCH;
      } else if (first < i) {
        patch_of_[i] = patch_of_[first];
      } else {
        patch_of_[i] = static_cast<int>(patches_.size());
        patches_.emplace_back();
        patches_.back().reference = mesh_.vertices[mesh_.elements[i][0]];
        patches_.back().faces = faces[i];
      }
    }
  }

  bool isInsidePatch(const EdgeFaces& faces) const {
    const int patch = patch_of_[faces[0]];
    return faces.size() > 1 && std::all_of(faces.begin(), faces.end(), [&](int face) { return patch_of_[face] == patch; });
  }

  /** Which patches are rough, and their outlines. */
  void describeEdges() {
    std::vector<std::atomic<bool>> rough(patches_.size());
    const std::vector<int> outlines = collected<int>(topology_.edgeCount(), [&](int edge, std::vector<int>* edges) {
      const EdgeFaces faces = topology_.facesOf(edge);
      if (topology_.isFlatEdge(edge) || faces.size() == 0) return;
      if (!isInsidePatch(faces)) {
        edges->push_back(edge);
      } else if (isRough(edge) && !rough[patch_of_[faces[0]]].load(std::memory_order_relaxed)) {
        rough[patch_of_[faces[0]]].store(true, std::memory_order_relaxed);
      }
    });
    for (std::size_t i = 0; i < patches_.size(); ++i) patches_[i].rough = rough[i];
    for (const int edge : outlines) addOutline(edge);
  }

  /** Adds an edge's length [m] to its patches' outlines, to their doubtful parts, where a curved surface might go on, and to the blunt
   * ones, which bend by less than MIN_CREASE or are borders. */
  void addOutline(int edge) {
    const auto [start, end] = topology_.ends(mesh_, edge);
    const double length = (mesh_.vertices[end] - mesh_.vertices[start]).norm();
    for (const int face : topology_.facesOf(edge)) {
      if (patch_of_[face] == NO_PATCH) continue;
      Patch& own = patches_[patch_of_[face]];
      own.outline += length;
      if (bends_[edge] == Bend::DOUBTFUL) own.doubtful += length;
      if (bends_[edge] != Bend::SHARP) own.blunt += length;
    }
  }

  /** Some faces at a time: their moments by several threads, the sums in order. */
  void addFaces() {
    constexpr std::size_t SOME = 1 << 13;
    std::vector<Moments> moments(std::min(SOME, patch_of_.size()));
    for (std::size_t begin = 0, end = 0; begin < patch_of_.size(); begin = end) {
      end = std::min(begin + SOME, patch_of_.size());
      forAll(end - begin, [&](std::size_t i) {
        if (patch_of_[begin + i] != NO_PATCH) moments[i] = momentsOf(begin + i);
      });
      for (std::size_t i = begin; i < end; ++i) {
        if (patch_of_[i] != NO_PATCH) patches_[patch_of_[i]].moments.add(moments[i - begin]);
      }
    }
  }

  /** About its patch's reference. */
  Moments momentsOf(std::size_t face) const {
    const Vector3i& e = mesh_.elements[face];
    const Vector3& reference = patches_[patch_of_[face]].reference;
    return Moments::of(mesh_.vertices[e[0]] - reference, mesh_.vertices[e[1]] - reference, mesh_.vertices[e[2]] - reference);
  }

  static void fit(Patch* patch) {
    const Moments& moments = patch->moments;
    const Vector3 mean = moments.first / moments.area;
    const Matrix3 covariance = moments.second / moments.area - mean * mean.transpose();
    const Eigen::SelfAdjointEigenSolver<Matrix3> eigen(covariance);
    patch->centre = patch->reference + mean;
    patch->normal = eigen.eigenvectors().col(0);
    patch->width = std::sqrt(12 * std::max(0.0, eigen.eigenvalues()[1]));
  }

  void measureDeviations() {
    for (std::size_t i = 0; i < patch_of_.size(); ++i) {
      if (patch_of_[i] == NO_PATCH) continue;
      Patch& patch = patches_[patch_of_[i]];
      if (patch.deviation > PLANE_DEVIATION) continue;  // no plane, whatever the others are
      for (int k = 0; k < 3; ++k) {
        const int vertex = mesh_.elements[i][k];
        const double off = std::abs(patch.normal.dot(mesh_.vertices[vertex] - patch.centre));
        patch.deviation = std::max(patch.deviation, off);
        if (!noise_.empty()) patch.noise = std::max(patch.noise, 2 * noise_[vertex]);
      }
    }
  }

  static bool isDoubtful(const Patch& patch) { return patch.doubtful > MAX_DOUBTFUL * patch.outline; }
  static bool hasEdges(const Patch& patch) { return patch.blunt <= MAX_BLUNT * patch.outline; }

  /** Whether a patch may be a plane, before its plane is known; with few faces and no known noise only if it has edges, as those that are
   * flat to the last bit need. */
  bool mayBePlane(const Patch& patch) const {
    return !isDoubtful(patch) && (patch.faces >= MANY_FACES || !noise_.empty() || hasEdges(patch));
  }

  static bool isPlane(const Patch& patch) {
    if (patch.deviation > PLANE_DEVIATION || MIN_WIDTH * patch.deviation > patch.width) return false;
    if (isDoubtful(patch)) return false;
    return patch.faces >= MANY_FACES || isKnownNoise(patch) || isFlatToTheLastBit(patch);
  }

  static bool isKnownNoise(const Patch& patch) { return patch.deviation <= patch.noise; }
  static bool isFlatToTheLastBit(const Patch& patch) { return MIN_WIDTH_OF_FEW * patch.deviation <= patch.width && hasEdges(patch); }

  /** Curved patches are no planes, unless their deviation is surely noise or rounding. */
  void dropCurved() {
    std::vector<PatchPlane> planes;
    planes.reserve(patches_.size());
    for (const Patch& patch : patches_)
      planes.push_back({patch.centre, patch.normal, patch.plane && patch.rough && !isKnownNoise(patch) && !isFlatToTheLastBit(patch)});
    const std::vector<char> curved = findCurved(topology_, mesh_, patch_of_, planes);
    for (std::size_t i = 0; i < patches_.size(); ++i) patches_[i].plane = patches_[i].plane && !curved[i];
  }

  const MeshTopology& topology_;
  const TriangleMesh& mesh_;
  const std::vector<double>& noise_;
  std::optional<DisjointSets> sets_;
  std::vector<Bend> bends_;
  std::vector<int> patch_of_;
  std::vector<Patch> patches_;
};

/** Planes that each vertex lies on. */
class VertexPlanes {
 public:
  VertexPlanes(const TriangleMesh& mesh, const std::vector<double>& noise, PlaneFinder* finder)
      : mesh_(mesh), noise_(noise), patches_(finder->patches()) {
    for (int i = 0; i < static_cast<int>(mesh.elements.size()); ++i) {
      const int patch = finder->patchOf(i);
      if (patch == PlaneFinder::NO_PATCH || !patches_[patch].plane) continue;
      for (int k = 0; k < 3; ++k) pairs_.emplace_back(mesh.elements[i][k], patch);
    }
    std::sort(pairs_.begin(), pairs_.end());
    pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
  }

  /** Places on the planes; patches that would move a vertex too far are given up, until none does. */
  std::vector<std::pair<int, Vector3>> targets() {
    while (true) {
      std::vector<std::pair<int, Vector3>> places;
      bool given_up = false;
      for (std::size_t begin = 0, end = 0; begin < pairs_.size(); begin = end) {
        while (end < pairs_.size() && pairs_[end].first == pairs_[begin].first) ++end;
        if (!onRoughPlane(begin, end)) continue;
        const Vector3 move = moveOnto(begin, end);
        if (move.norm() <= longestMove(begin, end)) {
          places.emplace_back(pairs_[begin].first, mesh_.vertices[pairs_[begin].first] + move);
        } else {
          given_up = true;
          for (std::size_t i = begin; i < end; ++i) doomed_.push_back(pairs_[i].second);
        }
      }
      if (!given_up) return places;
      for (const int patch : doomed_) patches_[patch].plane = patches_[patch].plane && !patches_[patch].rough;
      doomed_.clear();
    }
  }

 private:
  bool onRoughPlane(std::size_t begin, std::size_t end) const {
    return std::any_of(pairs_.begin() + begin, pairs_.begin() + end,
                       [this](const auto& pair) { return patches_[pair.second].plane && patches_[pair.second].rough; });
  }

  double longestMove(std::size_t begin, std::size_t end) const {
    if (!noise_.empty() && noise_[pairs_[begin].first] > 0) return 2 * PLANE_DEVIATION;
    double deviation = 0;
    for (std::size_t i = begin; i < end; ++i) deviation = std::max(deviation, patches_[pairs_[i].second].deviation);
    return std::min(MAX_MOVE * deviation, 2 * PLANE_DEVIATION);
  }

  /** The shortest way onto all planes of a vertex, or as near as they let. */
  Vector3 moveOnto(std::size_t begin, std::size_t end) const {
    const Vector3& p = mesh_.vertices[pairs_[begin].first];
    // Rows as curved_patches.cpp has them: a second kind of decomposition takes a compiler ten seconds more.
    Eigen::MatrixXd normals(end - begin, 3);
    Eigen::VectorXd gaps(end - begin);
    int count = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Patch& patch = patches_[pairs_[i].second];
      if (!patch.plane) continue;
      normals.row(count) = patch.normal.transpose();
      gaps[count++] = patch.normal.dot(patch.centre - p);
    }
    if (count == 1) return gaps[0] * normals.row(0).transpose();
    normals.conservativeResize(count, Eigen::NoChange);
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> onto;
    onto.setThreshold(PARALLEL);
    onto.compute(normals);
    const Eigen::VectorXd here = gaps.head(count), move = onto.solve(here), left = here - normals * move;
    return move + onto.solve(left);
  }

  const TriangleMesh& mesh_;
  const std::vector<double>& noise_;
  std::vector<Patch>& patches_;
  std::vector<std::pair<int, int>> pairs_;  // vertex, patch
  std::vector<int> doomed_;
};

}  // namespace

void flattenPlanes(const MeshTopology& topology, const std::vector<double>& noise, TriangleMesh* mesh, MeshMending* what) {
  PlaneFinder finder(topology, *mesh, noise);
  if (!finder.find()) return;
  for (const auto& [vertex, place] : VertexPlanes(*mesh, noise, &finder).targets()) {
    const double move = (place - mesh->vertices[vertex]).norm();
    if (move == 0) continue;
    ++what->flattened;
    what->farthest = std::max(what->farthest, move);
    mesh->vertices[vertex] = place;
  }
  for (const Patch& patch : finder.patches()) what->planes += patch.plane && patch.rough;
}

}  // namespace blem_sim::geometry
