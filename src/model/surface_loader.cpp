#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "blem_sim/geometry/mesh_mending.h"
#include "blem_sim/model/loaders.h"
#include "soup/surface_soup.h"

namespace blem_sim::model {
namespace {

/** Parts of a load that lie behind when these stages begin, about. */
constexpr double CLEANING_FRACTION = 0.35, MENDING_FRACTION = 0.5;

using Reader = SurfaceSoup (*)(const std::string& file, const std::string& extension);

/** One row per kind of file. */
const std::map<std::string, Reader>& readers() {
  static const std::map<std::string, Reader> READERS = {
      {"dae", readMesh}, {"obj", readMesh}, {"off", readMesh},
      {"ply", readMesh}, {"stl", readMesh}, {"pcd", [](const std::string& file, const std::string&) { return readPcd(file); }},
  };
  return READERS;
}

std::string extensionOf(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  extension.erase(0, std::min<std::size_t>(1, extension.size()));
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

SurfaceSoup readSurface(const std::string& file) {
  const std::string extension = extensionOf(file);
  const auto row = readers().find(extension);
  if (row == readers().end())
    throw InputError(fmt::format("{}: unknown kind of file '.{}'; use .stl, .ply, .obj, .off, .dae or .pcd", file, extension));
  return row->second(file, extension);
}

void checkOptions(const std::string& file, const Vector3& scale, const CloudOptions& cloud) {
  if (!scale.allFinite() || scale.cwiseAbs().minCoeff() == 0)
    throw InputError(fmt::format("{}: scale {} {} {}: every factor must be finite and not zero", file, scale.x(), scale.y(), scale.z()));
  if (!cloud.auto_radius && (!(cloud.point_radius > 0) || !std::isfinite(cloud.point_radius)))
    throw InputError(fmt::format("{}: point_radius {} m must be greater than zero", file, cloud.point_radius));
  for (const auto& [name, length] : {std::pair("max_edge", cloud.max_edge), std::pair("cell", cloud.cell)})
    if (!(length > 0) || !std::isfinite(length)) throw InputError(fmt::format("{}: {} {} m must be greater than zero", file, name, length));
  if (!(cloud.max_depth_jump > 0))
    throw InputError(fmt::format("{}: max_depth_jump {} must be greater than zero", file, cloud.max_depth_jump));
  if (cloud.viewpoint && !cloud.viewpoint->allFinite()) throw InputError(file + ": viewpoint: must be three finite numbers");
  checkFilters(cloud.filters, file);
}

/** Scales in place; a mirroring scale turns the winding, so that outside stays outside. */
void scaleSoup(const Vector3& scale, SurfaceSoup* soup) {
  if (scale == Vector3::Ones()) return;
  for (Vector3& p : soup->mesh.vertices) p = p.cwiseProduct(scale);
  if (soup->viewpoint) soup->viewpoint = soup->viewpoint->cwiseProduct(scale);
  if (scale.prod() < 0)
    for (Vector3i& e : soup->mesh.elements)
      if (e[0] != e[1] && e[1] != e[2]) std::swap(e[1], e[2]);
}

bool wantsPoints(const SurfaceSoup& soup, CloudOptions::As as) {
  return as == CloudOptions::As::POINTS || (as == CloudOptions::As::AUTO && soup.mesh.elements.empty());
}

/** cleanMesh, counting in the elements that were left out before. The soup is given up. */
geometry::TriangleMesh cleanSoup(SurfaceSoup&& soup, geometry::MeshReport* report) {
  const geometry::MeshReport before = *report;
  geometry::TriangleMesh cleaned = geometry::cleanMesh(std::move(soup.mesh), report);
  report->nonfinite += before.nonfinite;
  report->welded += before.welded;
  report->degenerate += soup.collapsed;
  return cleaned;
}

/** mendMesh, told in words. */
geometry::TriangleMesh mended(geometry::TriangleMesh&& cleaned, geometry::MeshReport* report, geometry::MeshTopology* topology) {
  constexpr double MICRO = 1e-6;
  geometry::MeshMending what;
  geometry::TriangleMesh mesh = geometry::mendMesh(std::move(cleaned), report, &what, topology);
  if (what.cracks > 0) report->notes.push_back(fmt::format("{} cracks up to {:.3g} um closed", what.cracks, what.widest_crack / MICRO));
  if (what.given_up) report->notes.push_back("T-junctions stay: too many open edges lie across each other; give a mesh that is a surface");
  if (what.split_edges > 0) report->notes.push_back(fmt::format("{} edges split at T-junctions", what.split_edges));
  if (what.flattened > 0)
    report->notes.push_back(
        fmt::format("{} vertices moved by up to {:.3g} um onto {} planes", what.flattened, what.farthest / MICRO, what.planes));
  return mesh;
}

/** Leaves the points that filters leave, without a pixel grid. */
void filterSoup(const std::vector<CloudFilter>& filters, bool points, SurfaceSoup* soup, geometry::MeshReport* report) {
  if (filters.empty()) return;
  if (!points && !soup->mesh.elements.empty())
    throw InputError(report->source + ": filters: are for points, and the file has faces; set as: points, or leave them out");
  soup->mesh.vertices = filtered(std::move(soup->mesh.vertices), filters, report->source, &report->notes);
  soup->width = static_cast<int>(soup->mesh.vertices.size());
  soup->height = 1;
}

/** A point is its own boundary. */
void setRadius(const CloudOptions& cloud, const geometry::TriangleMesh& mesh, LoadedSurface* surface) {
  const double spacing = cloud.auto_radius ? pointSpacing(mesh.vertices) : 0;
  surface->radius = surface->report.boundary_width = cloud.auto_radius ? pointRadius(spacing) : cloud.point_radius;
  surface->report.notes.push_back(fmt::format("simulated as points of radius {:.4g} m", surface->radius));
  if (cloud.auto_radius) surface->report.notes.back() += fmt::format(", from their spacing of {:.4g} m", spacing);
}

/** Cleans the soup's triangles and mends them, if asked for. */
void setTriangles(SurfaceSoup&& soup, Mending mending, const std::function<void(const char*, double)>& enter, LoadedSurface* surface) {
  geometry::TriangleMesh mesh = cleanSoup(std::move(soup), &surface->report);
  if (mending == Mending::ON) {
    enter("mending", MENDING_FRACTION);
    const auto topology = std::make_shared<geometry::MeshTopology>();
    mesh = mended(std::move(mesh), &surface->report, topology.get());
    surface->topology = topology;
  }
  surface->mesh = std::make_shared<const geometry::TriangleMesh>(std::move(mesh));
}

void setPoints(const std::vector<Vector3>& points, const CloudOptions& cloud, LoadedSurface* surface) {
  geometry::TriangleMesh mesh = geometry::pointCloudMesh(points, &surface->report);
  setRadius(cloud, mesh, surface);
  surface->mesh = std::make_shared<const geometry::TriangleMesh>(std::move(mesh));
}

void noteDropped(geometry::MeshReport* report) {
  if (report->nonfinite > 0)
    report->notes.push_back(fmt::format("{} elements with a coordinate that is not finite dropped", report->nonfinite));
  if (report->degenerate > 0) report->notes.push_back(fmt::format("{} triangles without area dropped", report->degenerate));
  if (report->duplicate > 0) report->notes.push_back(fmt::format("{} repeated triangles dropped", report->duplicate));
  if (report->triangles == 0 && report->welded > 0)
    report->notes.push_back(fmt::format("{} points merged with another at the same place", report->welded));
}

}  // namespace

LoadedSurface loadSurface(const std::string& file, const Vector3& scale, const CloudOptions& cloud, Mending mending,
                          const LoadProgress& progress) {
  checkOptions(file, scale, cloud);
  const auto enter = [&](const char* stage, double fraction) {
    if (progress) progress(fmt::format("{} {}", stage, std::filesystem::path(file).filename().string()), fraction);
  };
  enter("reading", 0);
  SurfaceSoup soup = readSurface(file);
  scaleSoup(scale, &soup);
  LoadedSurface surface;
  surface.report.name = std::filesystem::path(file).stem().string();
  surface.report.source = file;
  surface.report.notes = soup.notes;
  const bool points = wantsPoints(soup, cloud.as);
  filterSoup(cloud.filters, points, &soup, &surface.report);
  if (!points && soup.mesh.elements.empty()) {
    enter("joining the points of", CLEANING_FRACTION);
    joinCloud(cloud, &soup, &surface.report);
  }
  enter("cleaning", CLEANING_FRACTION);
  if (points)
    setPoints(soup.mesh.vertices, cloud, &surface);
  else
    setTriangles(std::move(soup), mending, enter, &surface);
  noteDropped(&surface.report);
  if (surface.mesh->elements.empty())
    throw InputError(fmt::format("{}: nothing is left after cleaning ({} not finite, {} without area); check the file and its scale", file,
                                 surface.report.nonfinite, surface.report.degenerate));
  return surface;
}

LoadedSurface cloudSurface(SensedCloud cloud, const CloudOptions& options, const std::string& source) {
  LoadedSurface surface;
  surface.report.name = surface.report.source = source;
  SurfaceSoup soup{{std::move(cloud.points), {}}, cloud.width, cloud.height, 0, cloud.viewpoint, {}};
  filterSoup(options.filters, true, &soup, &surface.report);
  if (std::none_of(soup.mesh.vertices.begin(), soup.mesh.vertices.end(), [](const Vector3& p) { return p.allFinite(); }))
    throw InputError(source + ": no finite point is left; check the sensor, and the filters");
  if (options.as == CloudOptions::As::MESH) {
    joinCloud(options, &soup, &surface.report);
    setTriangles(
        std::move(soup), Mending::ON, [](const char*, double) {}, &surface);
  } else {
    setPoints(soup.mesh.vertices, options, &surface);
  }
  noteDropped(&surface.report);
  if (surface.mesh->elements.empty()) throw InputError(source + ": nothing is left after cleaning; check the sensor, and the filters");
  return surface;
}

LoadedSurface meshSurface(geometry::TriangleMesh mesh, const std::string& source) {
  LoadedSurface surface;
  surface.report.name = surface.report.source = source;
  // A triangle of a message that names a vertex twice is malformed, as one of a file is: no segment.
  const auto collapsed = std::remove_if(mesh.elements.begin(), mesh.elements.end(),
                                        [](const Vector3i& e) { return e[0] == e[1] || e[1] == e[2] || e[2] == e[0]; });
  const int dropped = static_cast<int>(mesh.elements.end() - collapsed);
  mesh.elements.erase(collapsed, mesh.elements.end());
  setTriangles(
      {std::move(mesh), 0, 1, dropped, {}, {}}, Mending::ON, [](const char*, double) {}, &surface);
  noteDropped(&surface.report);
  if (surface.mesh->elements.empty()) throw InputError(source + ": no triangle with an area is left");
  return surface;
}

}  // namespace blem_sim::model
