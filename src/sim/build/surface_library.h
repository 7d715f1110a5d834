// Surfaces that several models share: a mesh that 18 mugs use is read once and has one tree.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "blem_sim/contact/collider.h"
#include "blem_sim/model/loaders.h"
#include "build/contact_settings.h"
#include "build/file_stamp.h"
#include "build/widths/chosen_width.h"

namespace blem_sim::sim {

/** A file's surface as the contact room takes it. */
struct SharedSurface {
  std::shared_ptr<const contact::CollisionGeometry> geometry;
  double radius = 0;  ///< [m] > 0 for clouds as points
  geometry::MeshReport report;
  /** Origin [m] of the geometry's frame in the file's: zero unless the file's coordinates are large, as those of a surveyor's grid. Search
   *  works in floats, which step by half a metre there. */
  Vector3 origin = Vector3::Zero();
};

/** Gives the same geometry for the same file, unless it was written since, and settings, or the same mesh, while anybody holds it. */
class SurfaceLibrary {
 public:
  /** @param time_step [s] by which boundary widths are chosen */
  explicit SurfaceLibrary(model::Mending mending = model::Mending::ON, double time_step = 0.001)
      : mending_(mending), time_step_(time_step) {}
  /** Gives what the other one knows, if it mends as this one does. Precondition: this one knows nothing. */
  void learnFrom(const SurfaceLibrary& other);
  /** @param time_step [s] of boundary widths that are chosen from now on */
  void setTimeStep(double time_step) { time_step_ = time_step; }
  /** @throws InputError as loadSurface does */
  SharedSurface load(const std::string& file, const Vector3& scale, const model::CloudOptions& cloud, const model::LoadProgress& progress);
  /** @param topology of the mesh, if it is at hand @param cylinder that the mesh stands for */
  std::shared_ptr<const contact::CollisionGeometry> geometry(const std::shared_ptr<const geometry::TriangleMesh>& mesh,
                                                             const std::shared_ptr<const geometry::MeshTopology>& topology = nullptr,
                                                             const std::optional<geometry::Cylinder>& cylinder = std::nullopt);
  /**
   * Chooses the boundary width where the settings leave it open, and narrows that of a cylinder to what it has room for inside.
   * @param needs of its use; those of the geometry and the settings are found here @param own_radius as in fit
   * @param report of the geometry: notes the choice and why
   */
  void chooseWidth(const contact::CollisionGeometry& geometry, WidthNeeds needs, double own_radius, ContactSettings* settings,
                   geometry::MeshReport* report);
  /**
   * Gives a collider the geometry, moved inwards by its boundary width if it is a cylinder or if the settings ask for it.
   * @param own_radius [m] > 0 if it is its own boundary: then it stays @param report notes what was done, and failures
   * @param collider gets geometry and outside
   */
  void fit(const std::shared_ptr<const contact::CollisionGeometry>& geometry, const ContactSettings& settings, double own_radius,
           geometry::MeshReport* report, contact::Collider* collider);

  /** Number of known surfaces, those that nobody holds any more included: at most twice as many as are held, or 48. */
  std::size_t remembered() const;

 private:
  void forgetWhatIsGone();
  double noiseOf(const contact::CollisionGeometry& geometry);

  struct Shrunk {
    std::weak_ptr<const contact::CollisionGeometry> original, geometry;
    bool refused = false;
    std::string note;
  };
  static std::shared_ptr<const contact::CollisionGeometry> makeShrunk(const std::shared_ptr<const contact::CollisionGeometry>& geometry,
                                                                      double r, Shrunk* held);
  struct Entry {
    std::weak_ptr<const contact::CollisionGeometry> geometry;
    double radius = 0;
    geometry::MeshReport report;
    Vector3 origin = Vector3::Zero();
    FileStamp stamp;
  };
  /** A mesh lives as long as its geometry. */
  struct OfMesh {
    std::weak_ptr<const contact::CollisionGeometry> geometry;
    std::optional<double> noise;  ///< [m] once somebody asked
  };
  const model::Mending mending_;
  double time_step_;
  std::map<std::string, Entry> files_;
  std::map<std::pair<const contact::CollisionGeometry*, double>, Shrunk> shrunk_;
  std::map<const geometry::TriangleMesh*, OfMesh> meshes_;
  std::size_t enough_files_ = 0, enough_shrunk_ = 0, enough_meshes_ = 0;  ///< entries at which to look for those that are gone
};

}  // namespace blem_sim::sim
