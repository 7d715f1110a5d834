#include "build/surface_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "blem_sim/geometry/far_origin.h"
#include "blem_sim/geometry/mesh_shrinking.h"
#include "build/widths/scan_noise.h"

namespace blem_sim::sim {
namespace {

std::string wordsFor(const geometry::MeshShrinking& what, double r) {
  if (!what.refused.empty())
    return fmt::format("not shrunk: {}; every side stands out by its boundary_width, {:.3g} mm", what.refused, 1e3 * r);
  std::string words = fmt::format("shrunk by {:.3g} mm", 1e3 * r);
  if (what.held_back > 0)
    words += fmt::format("; {} of {} vertices less, where it is thin or sharp", what.held_back, what.moved + what.held_back);
  constexpr double SAME = 1e-6;  // [m]
  if (what.excess > SAME) words += fmt::format("; outside stands out by up to {:.3g} mm", 1e3 * what.excess);
  if (what.shortfall > SAME) words += fmt::format("; lies inside by up to {:.3g} mm", 1e3 * what.shortfall);
  return what.excess > SAME || what.shortfall > SAME ? words : words + "; outer dimensions stay";
}

/** All settings of a cloud: equal words, equal clouds. */
std::string wordsFor(const model::CloudOptions& cloud) {
  std::string words = fmt::format("{} {} {} {} {} {} {} {}", static_cast<int>(cloud.as), cloud.point_radius, cloud.auto_radius,
                                  static_cast<int>(cloud.mesher), cloud.max_edge, cloud.max_depth_jump, cloud.cell, cloud.fill_holes);
  if (cloud.viewpoint) words += fmt::format(" {} {} {}", cloud.viewpoint->x(), cloud.viewpoint->y(), cloud.viewpoint->z());
  for (const model::CloudFilter& f : cloud.filters)
    words += fmt::format("|{} {} {} {} {} {} {} {}", static_cast<int>(f.kind), f.size, f.neighbours, f.factor, f.axis, f.lower, f.upper,
                         f.order);
  return words;
}

/** Forgets surfaces that nobody holds any more once they are half of all, so that the cost per surface stays the same. */
template <typename Map, typename Expired>
void forgetExpired(Map* known, std::size_t* enough, const Expired& expired) {
  constexpr std::size_t LEAST = 16;
  if (known->size() < std::max(LEAST, *enough)) return;
  for (auto it = known->begin(); it != known->end();) it = expired(it->second) ? known->erase(it) : std::next(it);
  *enough = 2 * known->size();
}

std::shared_ptr<const geometry::TriangleMesh> movedBy(const geometry::TriangleMesh& mesh, const Vector3& way) {
  const auto moved = std::make_shared<geometry::TriangleMesh>(mesh);
  for (Vector3& p : moved->vertices) p += way;
  return moved;
}

std::string farAway(const Vector3& origin) {
  const double farthest = origin.cwiseAbs().maxCoeff(), step = std::nextafter(static_cast<float>(farthest), INFINITY) - farthest;
  return fmt::format(
      "lies around ({:.0f}, {:.0f}, {:.0f}) m: searched about that place; where the file is read as floats (all but .pcd and binary .ply) "
      "it is rounded to {:.2g} m: take that place off its coordinates and add it to the pose",
      origin.x(), origin.y(), origin.z(), step);
}

}  // namespace

std::size_t SurfaceLibrary::remembered() const { return files_.size() + meshes_.size() + shrunk_.size(); }

void SurfaceLibrary::forgetWhatIsGone() {
  const auto gone = [](const auto& entry) { return entry.geometry.expired(); };
  forgetExpired(&files_, &enough_files_, gone);
  forgetExpired(&shrunk_, &enough_shrunk_, gone);
  forgetExpired(&meshes_, &enough_meshes_, gone);
}

void SurfaceLibrary::learnFrom(const SurfaceLibrary& other) {
  if (mending_ != other.mending_) return;
  files_ = other.files_;
  shrunk_ = other.shrunk_;
  meshes_ = other.meshes_;
}

SharedSurface SurfaceLibrary::load(const std::string& file, const Vector3& scale, const model::CloudOptions& cloud,
                                   const model::LoadProgress& progress) {
  const std::string key = fmt::format("{}|{} {} {}|{}", file, scale.x(), scale.y(), scale.z(), wordsFor(cloud));
  forgetWhatIsGone();
  Entry& entry = files_[key];
  const FileStamp stamp = stampOf(file);
  const auto held = entry.geometry.lock();
  if (held && entry.stamp == stamp) return {held, entry.radius, entry.report, entry.origin};
  model::LoadedSurface surface = model::loadSurface(file, scale, cloud, mending_, progress);
  progress("topology and tree of " + surface.report.name, 1 - model::TREE_FRACTION);
  const Vector3 origin = geometry::farOrigin(surface.mesh->bounds());
  if (!origin.isZero(0)) {
    surface.mesh = movedBy(*surface.mesh, -origin);
    surface.report.notes.push_back(farAway(origin));
  }
  const auto made = geometry(surface.mesh, surface.topology);
  entry = {made, surface.radius, surface.report, origin, stamp};
  return {made, surface.radius, surface.report, origin};
}

std::shared_ptr<const contact::CollisionGeometry> SurfaceLibrary::geometry(const std::shared_ptr<const geometry::TriangleMesh>& mesh,
                                                                           const std::shared_ptr<const geometry::MeshTopology>& topology,
                                                                           const std::optional<geometry::Cylinder>& cylinder) {
  OfMesh& held = meshes_[mesh.get()];
  if (auto known = held.geometry.lock()) return known;
  const auto made = std::make_shared<const contact::CollisionGeometry>(mesh, topology, cylinder);
  held = {made, std::nullopt};
  return made;
}

double SurfaceLibrary::noiseOf(const contact::CollisionGeometry& geometry) {
  if (geometry.isHalfSpace()) return 0;
  std::optional<double>& noise = meshes_.at(&geometry.mesh()).noise;
  if (!noise) noise = scanNoise(geometry.mesh(), geometry.topology());
  return *noise;
}

void SurfaceLibrary::chooseWidth(const contact::CollisionGeometry& geometry, WidthNeeds needs, double own_radius, ContactSettings* settings,
                                 geometry::MeshReport* report) {
  if (own_radius > 0) return;
  if (settings->boundary_width.automatic) {
    needs.side = geometry.isHalfSpace() ? 0 : smallestSide(geometry.mesh(), report->closed);
    // Scans have borders; small parts of closed CAD models bend from vertex to vertex as noise does.
    needs.noise = needs.drawn || report->closed ? 0 : noiseOf(geometry);
    needs.stiffness = settings->surface.stiffness;
    needs.time_step = time_step_;
    const ChosenWidth chosen = chosenWidth(needs);
    settings->boundary_width = chosen.width;
    report->notes.push_back(fmt::format("boundary_width: auto is {:.3g} mm: {}", 1e3 * chosen.width, chosen.why));
  }
  if (!geometry.cylinder()) return;
  const double widest = geometry::widestLayerInside(*geometry.cylinder());
  if (settings->boundary_width.metres <= widest) return;
  report->notes.push_back(fmt::format("boundary_width: {:.3g} mm is narrowed to {:.3g} mm, half of the cylinder's radius or half length",
                                      1e3 * settings->boundary_width.metres, 1e3 * widest));
  settings->boundary_width = widest;
}

std::shared_ptr<const contact::CollisionGeometry> SurfaceLibrary::makeShrunk(
    const std::shared_ptr<const contact::CollisionGeometry>& geometry, double r, Shrunk* held) {
  std::shared_ptr<const contact::CollisionGeometry> made;
  if (const geometry::Cylinder* cylinder = geometry->cylinder()) {
    geometry::CylinderCore core = geometry::coreOf(geometry->mesh(), *cylinder, r);
    made = std::make_shared<const contact::CollisionGeometry>(std::make_shared<const geometry::TriangleMesh>(std::move(core.mesh)), nullptr,
                                                              core.cylinder);
    *held = {geometry, made, false, fmt::format("layer of {:.3g} mm inside; outer dimensions stay", 1e3 * r)};
  } else {
    geometry::MeshShrinking what;
    made = std::make_shared<const contact::CollisionGeometry>(
        std::make_shared<const geometry::TriangleMesh>(geometry::shrinkMesh(geometry->mesh(), r, &what)));
    *held = {geometry, made, !what.refused.empty(), wordsFor(what, r)};
  }
  return made;
}

void SurfaceLibrary::fit(const std::shared_ptr<const contact::CollisionGeometry>& geometry, const ContactSettings& settings,
                         double own_radius, geometry::MeshReport* report, contact::Collider* collider) {
  collider->geometry = geometry;
  const double r = settings.boundary_width.metres;
  if (geometry->isHalfSpace() || own_radius > 0 || !(r > 0) || (!settings.shrink && !geometry->cylinder())) return;
  Shrunk& held = shrunk_[{geometry.get(), r}];
  std::shared_ptr<const contact::CollisionGeometry> made = held.geometry.lock();
  // Another geometry may have got the address of one that is gone.
  if (!made || held.original.lock() != geometry) made = makeShrunk(geometry, r, &held);
  report->notes.push_back(held.note);
  if (held.refused) return;
  collider->geometry = made;
  collider->outside = geometry;
}

}  // namespace blem_sim::sim
