#include <fmt/format.h>

#include <utility>

#include "blem_sim/geometry/input_error.h"
#include "clouds/cloud_meshers.h"
#include "soup/surface_soup.h"

namespace blem_sim::model {
namespace {

using Mesher = CloudOptions::Mesher;

Mesher mesherFor(const SurfaceSoup& soup, Mesher wanted, const std::string& source) {
  if (wanted == Mesher::AUTO) return soup.hasPixelGrid() ? Mesher::ORGANIZED : Mesher::GREEDY_PROJECTION;
  if (wanted == Mesher::ORGANIZED && !soup.hasPixelGrid())
    throw InputError(source + ": mesher organized: the cloud has no pixel grid (filters give it up); use another mesher");
  return wanted;
}

/** The sensor's place, if it is known. */
std::optional<Vector3> viewpointOf(const SurfaceSoup& soup, const CloudOptions& options) {
  if (options.viewpoint) return options.viewpoint;
  if (soup.viewpoint) return soup.viewpoint;
  return soup.hasPixelGrid() ? std::optional<Vector3>(Vector3::Zero()) : std::nullopt;
}

/** @param unique finite points, each place once */
geometry::TriangleMesh meshOf(SurfaceSoup* soup, std::vector<Vector3> unique, const CloudOptions& options, const std::string& source) {
  const std::optional<Vector3> viewpoint = viewpointOf(*soup, options);
  geometry::TriangleMesh mesh;
  if (options.mesher == Mesher::ORGANIZED) {
    PixelGrid grid{std::move(soup->mesh.vertices), soup->width, soup->height};
    mesh.elements = gridTriangles(grid, *viewpoint, options);
    mesh.vertices = std::move(grid.points);
  } else if (options.mesher == Mesher::GREEDY_PROJECTION) {
    mesh.elements = projectionTriangles(unique, options.max_edge);
    mesh.vertices = std::move(unique);
  } else {
    const SeenPoints seen{std::move(unique), viewpoint};
    mesh = options.mesher == Mesher::POISSON ? poissonMesh(seen, options, source) : marchingCubesMesh(seen, options, source);
  }
  return mesh;
}

}  // namespace

const char* mesherName(Mesher mesher) {
  switch (mesher) {
    case Mesher::AUTO:
      return "auto";
    case Mesher::ORGANIZED:
      return "organized";
    case Mesher::GREEDY_PROJECTION:
      return "greedy_projection";
    case Mesher::MARCHING_CUBES:
      return "marching_cubes";
    case Mesher::POISSON:
      return "poisson";
  }
  return "";
}

void joinCloud(const CloudOptions& options, SurfaceSoup* soup, geometry::MeshReport* report) {
  geometry::MeshReport points;
  geometry::TriangleMesh unique = geometry::pointCloudMesh(soup->mesh.vertices, &points);
  report->nonfinite = points.nonfinite;
  report->welded = points.welded;
  CloudOptions chosen = options;
  chosen.mesher = mesherFor(*soup, options.mesher, report->source);
  soup->mesh = meshOf(soup, std::move(unique.vertices), chosen, report->source);
  if (soup->mesh.elements.empty())
    throw InputError(fmt::format("{}: mesher {} joins none of its {} points, max_edge {} m; raise it or load the cloud as points",
                                 report->source, mesherName(chosen.mesher), points.points, options.max_edge));
  report->notes.push_back(fmt::format("{} triangles joined from {} points by {}, max_edge {} m", soup->mesh.elements.size(), points.points,
                                      mesherName(chosen.mesher), options.max_edge));
}

}  // namespace blem_sim::model
