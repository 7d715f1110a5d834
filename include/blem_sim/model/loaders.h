// The doors of the model room: URIs, meshes, clouds, URDF. Each throws InputError with one line: file, field, cure.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/geometry/mesh_topology.h"
#include "blem_sim/model/cloud.h"
#include "blem_sim/model/file_roots.h"
#include "blem_sim/model/robot_model.h"

namespace blem_sim::model {

/** Resolves package://NAME/path, file://path, absolute and relative paths to a file that exists. */
class UriResolver {
 public:
  /** @param packages NAME -> directory, asked first; then ROS_PACKAGE_PATH (each entry is a package, or holds them at any depth),
   *                  then share/NAME below CMAKE_PREFIX_PATH and /usr. */
  explicit UriResolver(std::map<std::string, std::string> packages = {});

  /** @param base directory against which a relative path is meant; empty: the working directory. @throws InputError naming every
   *  place that was tried. */
  std::string resolve(const std::string& uri, const std::string& base = "") const;

  /** Refuses files elsewhere from now on. */
  void restrictTo(const FileRoots& roots) { roots_ = roots; }

 private:
  std::string find(const std::string& uri, const std::string& base) const;

  std::map<std::string, std::string> packages_;
  std::optional<FileRoots> roots_;
};

/** Whether meshes for contact are mended after cleaning (mendMesh), or taken as they are. */
enum class Mending { ON, OFF };

/** Called when a stage of a load begins, with its name and the part of the load that lies behind, 0 to 1. */
using LoadProgress = std::function<void(const std::string& stage, double fraction)>;

/** Part of a load that topology and tree take, about; both are made from the loader's surface. */
constexpr double TREE_FRACTION = 0.3;

/** A mesh or a cloud as the contact room takes it. */
struct LoadedSurface {
  std::shared_ptr<const geometry::TriangleMesh> mesh;      ///< scaled, cleaned, mended, mesh frame
  std::shared_ptr<const geometry::MeshTopology> topology;  ///< of the mesh, if mending has found it; else null
  double radius = 0;                                       ///< [m] > 0 for clouds as points: their boundary
  geometry::MeshReport report;
};

/**
 * Loads triangles (STL, PLY, OBJ, OFF, DAE by assimp: node transforms, DAE units, polygons split) or points (PCD, PLY
 * without faces), scales, cleans and mends them. A mirroring scale or node keeps the outside outside.
 * COLLADA as in rviz and MoveIt: `<unit meter>` is applied, `<up_axis>` is not, so that x, y, z of the file stay x, y, z of the link.
 * A PCD's VIEWPOINT is not applied either; the report says so.
 * @param file resolved path @param scale factors per axis, none zero @param cloud for files of points, or a mesh's vertices as points
 * @param progress may be empty
 * @throws InputError: missing, unreadable, truncated, damaged, empty after cleaning, unknown extension.
 */
LoadedSurface loadSurface(const std::string& file, const Vector3& scale = Vector3::Ones(), const CloudOptions& cloud = {},
                          Mending mending = Mending::ON, const LoadProgress& progress = {});

/** Points of a sensor. */
struct SensedCloud {
  SensedCloud(std::vector<Vector3> all) : points(std::move(all)), width(static_cast<int>(points.size())) {}

  std::vector<Vector3> points;       ///< [m] in the surface's frame; NaN where nothing was measured
  int width = 0, height = 1;         ///< > 1 both: a pixel grid, point (row, column) is row * width + column
  std::optional<Vector3> viewpoint;  ///< [m] of the sensor, unless the options name one
};

/**
 * Points that do not come from a file, filtered, as loadSurface makes a surface of a file of points: triangles as: mesh, else points.
 * @param source for messages and the report
 * @throws InputError: filters that cannot be met, no finite point left, a mesher that the cloud does not suit, no triangle
 */
LoadedSurface cloudSurface(SensedCloud cloud, const CloudOptions& options, const std::string& source);

/** A mesh that does not come from a file, cleaned and mended as loadSurface does. @throws InputError: nothing is left */
LoadedSurface meshSurface(geometry::TriangleMesh mesh, const std::string& source);

/** Choices for loading a URDF. */
struct UrdfOptions {
  std::string base;               ///< directory for relative mesh paths; empty: the working directory, or that of the file
  Mending mending = Mending::ON;  ///< of its meshes
  LoadProgress progress = {};     ///< told link by link; may be empty
};

/**
 * Parses URDF text. Limits of 1e6 and more mean none. Elements that are not simulated are noted; `<gazebo>` blocks are kept as texts.
 * @param source for messages @throws InputError
 */
RobotModel loadUrdf(const std::string& xml, const std::string& source, const UriResolver& resolver, const UrdfOptions& options = {});

/** Reads the file and parses it. */
RobotModel loadUrdfFile(const std::string& file, const UriResolver& resolver, UrdfOptions options = {});

}  // namespace blem_sim::model
