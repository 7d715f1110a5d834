#include "build/world_builder.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <climits>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <optional>
#include <set>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/geometry/mesh_winding.h"
#include "build/contact_settings.h"
#include "build/robot_builder.h"
#include "config/scene_limits.h"
#include "gazebo/gazebo_robot.h"

namespace blem_sim::sim {
namespace {

// Half the size [m] that a body's mass is spread over at least, so that a point or a line can turn.
constexpr double SMALLEST_EXTENT = 0.001;

/** Mass properties in the object's frame from its shape, and in words their source. */
geometry::MassProperties massFromShape(const geometry::TriangleMesh& mesh_O, bool closed, double mass, std::string* from) {
  geometry::MassProperties properties;
  if (closed && geometry::massFromVolume(geometry::woundOutward(mesh_O), mass, &properties)) {
    *from = "the enclosed volume";
    return properties;
  }
  *from = closed ? "the surface, as a thin shell (the enclosed volume is not positive)" : "the surface, as a thin shell (it is open)";
  return geometry::massFromSurface(mesh_O, mass);
}

/** An inertia too small about some axis, as a line's or a point's, gets that of a small ball there. */
bool floorInertia(double radius, geometry::MassProperties* properties) {
  const double r = std::max(radius, SMALLEST_EXTENT);
  const double least = 0.4 * properties->mass * r * r;
  Eigen::SelfAdjointEigenSolver<Matrix3> eigen(properties->inertia);
  const Vector3 moments = eigen.eigenvalues();
  if (moments.minCoeff() >= 1e-3 * least) return false;
  const Matrix3 axes = eigen.eigenvectors();
  properties->inertia = axes * moments.cwiseMax(least).asDiagonal() * axes.transpose();
  return true;
}

std::string words(const Vector3& v) { return fmt::format("[{:.4g}, {:.4g}, {:.4g}]", v.x(), v.y(), v.z()); }

/** Size in words of a model's colliders, the last ones of the load report; a geometry that several of them share counts once. */
std::string sizeOf(const SimulatedWorld& world, int model) {
  constexpr double MEGA = 1e6;
  const std::vector<int> own = world.collidersOf(model);
  const geometry::MeshReport* report = world.load_report.data() + world.load_report.size() - own.size();
  std::set<const contact::CollisionGeometry*> counted;
  std::size_t triangles = 0, points = 0, bytes = 0;
  for (const int collider : own) {
    const geometry::MeshReport& shape = *report++;
    if (!counted.insert(world.colliders[collider].geometry.get()).second) continue;
    triangles += static_cast<std::size_t>(shape.triangles);
    points += static_cast<std::size_t>(shape.points);
    bytes += shape.bytes;
  }
  const std::string words = fmt::format("{} triangles, {:.1f} MB", triangles, static_cast<double>(bytes) / MEGA);
  return points > 0 ? fmt::format("{} points, {}", points, words) : words;
}

/** The file, if its faces are the surface: no joined points, none that is no triangle, not mirrored, and so near that floats tell its
 * coordinates. */
std::optional<SurfaceFile> fileThatShows(const SharedSurface& surface, const EnvironmentConfig& config) {
  const bool sound = surface.report.nonfinite == 0 && surface.report.invalid == 0;
  const bool faces =
      sound && !config.uri.empty() && config.cloud.as == model::CloudOptions::As::AUTO && surface.geometry->hasOnlyTriangles();
  if (!faces || !surface.origin.isZero(0) || config.scale.minCoeff() <= 0) return std::nullopt;
  const std::string path = std::filesystem::absolute(surface.report.source).string();
  return SurfaceFile{path, config.uri.rfind("package://", 0) == 0 ? config.uri : "file://" + path, config.scale};
}

UrdfSource sourceOf(const RobotConfig& config) {
  return {"robots: " + config.name, config.urdf, config.urdf_xml, config.description_param};
}

/** Files that a description was read from, as they are now. */
std::vector<std::pair<std::string, FileStamp>> filesOf(const model::RobotModel& model) {
  std::set<std::string> files = {model.source};
  for (const model::LinkModel& link : model.links)
    for (const model::CollisionShape& shape : link.collisions) files.insert(shape.report.source);
  std::vector<std::pair<std::string, FileStamp>> stamps;
  for (const std::string& file : files) stamps.emplace_back(file, stampOf(file));
  return stamps;
}

int addFreeBody(const std::string& name, const geometry::MassProperties& inertial, const ObjectConfig& config, SimulatedWorld* world) {
  dynamics::BodySpec spec;
  spec.name = name;
  spec.inertial = inertial;
  spec.X_WB = config.X_WO;
  const Vector3 v_WCom = config.linear_velocity + config.angular_velocity.cross(config.X_WO.linear() * inertial.com);
  return world->addBody(spec, v_WCom, config.angular_velocity);
}

}  // namespace

void WorldBuilder::learnFrom(const WorldBuilder& other) {
  surfaces_.learnFrom(other.surfaces_);
  if (contact_.mending == other.contact_.mending) descriptions_ = other.descriptions_;
}

SharedSurface WorldBuilder::load(const std::string& uri, const Vector3& scale, const model::CloudOptions& cloud, const std::string& where,
                                 LoadWatch* watch) {
  try {
    return surfaces_.load(resolver_.resolve(uri, base_directory_), scale, cloud, watch->progress());
  } catch (const InputError& error) {
    throw InputError(where + ": " + error.what());
  }
}

void WorldBuilder::addEnvironment(const EnvironmentConfig& config, SimulatedWorld* world) {
  world->checkNewName(config.name, "environments");
  const std::string where = "environments: " + config.name;
  if (!config.live.topic.empty()) {
    world->addModel(config.name, ModelKind::ENVIRONMENT, INT_MAX);  // its points come later
    return;
  }
  LoadWatch watch(log_, config.name);
  SharedSurface surface;
  if (config.plane) {
    const Vector3 normal = config.plane->head<3>();
    if (!config.plane->allFinite() || !(normal.norm() > 0))
      throw InputError(where + ": plane: a x + b y + c z = d needs finite numbers and a direction (a, b, c) that is not zero");
    surface.geometry = contact::CollisionGeometry::halfSpace(normal, (*config.plane)[3] / normal.norm());
    surface.report.source = fmt::format("half-space below the plane {} . x = {:g}", words(normal), (*config.plane)[3]);
  } else if (!config.uri.empty()) {
    surface = load(config.uri, config.scale, config.cloud, where, &watch);
  } else {
    throw InputError(where + ": nothing to load; give a uri or a plane");
  }
  ContactSettings settings = contactSettings(widthOfEnvironments(contact_), contact_, {&config.contact});
  contact::Collider collider;
  collider.name = config.name;
  collider.X_BC = config.X_WE * Eigen::Translation3d(surface.origin);
  surfaces_.chooseWidth(*surface.geometry, needsOfEnvironment(), surface.radius, &settings, &surface.report);
  if (settings.shrink) watch.enter("shrinking", 1 - model::TREE_FRACTION);
  surfaces_.fit(surface.geometry, settings, surface.radius, &surface.report, &collider);
  collider.model = world->addModel(config.name, ModelKind::ENVIRONMENT, INT_MAX);
  const double width = surface.radius > 0 ? surface.radius : settings.boundary_width.metres;
  world->models[collider.model].X_WM = config.X_WE;
  world->models[collider.model].file = fileThatShows(surface, config);
  world->addCollider(collider, width, settings.surface, surface.report);
  watch.loaded(sizeOf(*world, collider.model));
}

std::shared_ptr<const model::RobotModel> WorldBuilder::description(const UrdfSource& urdf, LoadWatch* watch) {
  const bool text = !urdf.xml.empty();
  if (!text && urdf.file.empty()) {
    throw InputError(fmt::format("{}: no description; give urdf{}", urdf.where,
                                 urdf.parameter.empty() ? "" : " (the parameter " + urdf.parameter + " is not read here)"));
  }
  const std::string key = text ? urdf.xml : resolver_.resolve(urdf.file, base_directory_);
  const std::string place = text ? base_directory_ + '\n' + key : key;
  const auto known = descriptions_.find(place);
  if (known != descriptions_.end()) {
    const auto model = known->second.model.lock();
    const auto isSame = [](const auto& file) { return file.second == stampOf(file.first); };
    if (model && std::all_of(known->second.files.begin(), known->second.files.end(), isSame)) return model;
  }
  for (auto old = descriptions_.begin(); old != descriptions_.end();)
    old = old->second.model.expired() ? descriptions_.erase(old) : std::next(old);
  const std::string source = urdf.parameter.empty() ? urdf.where : urdf.parameter;
  model::UrdfOptions options;
  options.mending = contact_.mending;
  if (watch) options.progress = watch->progress();
  if (text) options.base = base_directory_;
  const auto model = std::make_shared<const model::RobotModel>(text ? model::loadUrdf(key, source, resolver_, options)
                                                                    : model::loadUrdfFile(key, resolver_, options));
  descriptions_[place] = {model, filesOf(*model)};
  return model;
}

std::shared_ptr<const model::RobotModel> WorldBuilder::describe(const RobotConfig& config) {
  return description(sourceOf(config), nullptr);
}

void WorldBuilder::addRobot(const RobotConfig& config, SimulatedWorld* world) {
  world->checkNewName(config.name, "robots");
  LoadWatch watch(log_, config.name);
  RobotBuilder builder(config, contact_, description(sourceOf(config), &watch));
  watch.enter("topology and trees of its links", 1 - model::TREE_FRACTION);
  builder.addTo(world, &surfaces_);
  watch.loaded(sizeOf(*world, world->modelIndex(config.name)));
}

void WorldBuilder::addObject(const ObjectConfig& config, SimulatedWorld* world) {
  world->checkNewName(config.name, "objects");
  const auto isVelocity = [](const Vector3& v) { return (v.array().abs() <= FASTEST).all(); };
  if (!isVelocity(config.linear_velocity) || !isVelocity(config.angular_velocity))
    throw InputError(fmt::format("objects: {}: velocity: needs finite numbers, not beyond {:g} m/s and rad/s", config.name, FASTEST));
  LoadWatch watch(log_, config.name);
  if (config.urdf.empty() && config.urdf_xml.empty())
    addMeshObject(config, &watch, world);
  else
    addUrdfObject(config, &watch, world);
  const int model = world->modelIndex(config.name);
  world->models[model].X_WM = config.X_WO;
  watch.loaded(sizeOf(*world, model));
}

void WorldBuilder::addMeshObject(const ObjectConfig& config, LoadWatch* watch, SimulatedWorld* world) {
  const std::string where = "objects: " + config.name;
  if (config.uri.empty()) throw InputError(where + ": nothing to load; give a uri or a urdf");
  if (!config.mass || !(*config.mass > 0) || !std::isfinite(*config.mass))
    throw InputError(where + ": mass: needs a finite number of kg above 0");
  SharedSurface surface = load(config.uri, config.scale, config.cloud, where, watch);
  const Pose X_OC = config.X_OM * Eigen::Translation3d(surface.origin);
  ContactSettings settings = contactSettings(contact_.boundary_width, contact_, {&config.contact});
  const WidthNeeds needs = needsOfMeshObject(*config.mass * world->gravityToHold());
  surfaces_.chooseWidth(*surface.geometry, needs, surface.radius, &settings, &surface.report);
  const double width = surface.radius > 0 ? surface.radius : settings.boundary_width.metres;

  std::string from = "the configuration";
  geometry::MassProperties inertial;
  if (!config.com || !config.inertia)
    inertial = massFromShape(geometry::transformed(surface.geometry->mesh(), X_OC), surface.report.closed, *config.mass, &from);
  inertial.mass = *config.mass;
  if (config.com) inertial.com = *config.com;
  if (config.inertia) inertial.inertia = *config.inertia;
  if (!config.inertia && floorInertia(width, &inertial)) from += ", made turnable as a small ball would be";
  if (!inertial.com.allFinite() || !inertial.inertia.allFinite() || inertial.inertia.llt().info() != Eigen::Success)
    throw InputError(where + ": inertia: is not positive definite; correct [ixx, ixy, ixz, iyy, iyz, izz] and com");
  const char* what = config.com ? "inertia" : config.inertia ? "centre of mass" : "centre of mass and inertia";
  surface.report.notes.push_back(fmt::format("{} from {}: com {}", what, from, words(inertial.com)));

  const int body = addFreeBody(config.name + "::link", inertial, config, world);
  contact::Collider collider;
  collider.name = config.name;
  collider.model = world->addModel(config.name, ModelKind::OBJECT, config.max_contacts.value_or(contact_.max_contacts_per_object));
  collider.body = body;
  collider.X_BC = X_OC;
  if (settings.shrink) watch->enter("shrinking", 1 - model::TREE_FRACTION);
  surfaces_.fit(surface.geometry, settings, surface.radius, &surface.report, &collider);
  world->addCollider(collider, width, settings.surface, surface.report);
  world->models[collider.model].bodies = {body};
}

void WorldBuilder::addUrdfObject(const ObjectConfig& config, LoadWatch* watch, SimulatedWorld* world) {
  const std::string where = "objects: " + config.name;
  const std::shared_ptr<const model::RobotModel> held = description({where, config.urdf, config.urdf_xml, ""}, watch);
  const model::RobotModel& model = *held;
  watch->enter("topology and trees of its links", 1 - model::TREE_FRACTION);
  const model::LumpedRobot lumped = model::lumpFixedJoints(model, {}, false);
  if (lumped.bodies.size() != 1)
    throw InputError(fmt::format("{}: urdf: {} has {} bodies that move against each other; load it under robots", where, model.source,
                                 lumped.bodies.size()));
  geometry::MassProperties inertial = lumped.bodies[0].inertial;
  if (config.mass) {
    inertial.inertia *= *config.mass / inertial.mass;
    inertial.mass = *config.mass;
  }
  if (config.com) inertial.com = *config.com;
  if (config.inertia) inertial.inertia = *config.inertia;
  const GazeboRobot described = withGazeboBlocks({}, model);
  const std::string name = config.name + "::" + lumped.bodies[0].name;
  const int body = addFreeBody(name, inertial, config, world);
  const int index = world->addModel(config.name, ModelKind::OBJECT, config.max_contacts.value_or(contact_.max_contacts_per_object));
  world->models[index].bodies = {body};
  const std::set<std::string>& weightless = described.config.weightless_links;
  if (weightless.size() == model.links.size()) world->models[index].weightless = {{body, -1}};
  if (!weightless.empty() && weightless.size() < model.links.size())
    world->notes.push_back(config.name +
                           ": gravity acts on all links of an object or on none; load it under robots, or turn it off for all");
  const WidthNeeds needs = needsOfLink(inertial.mass * world->gravityToHold());
  for (std::size_t link = 0; link < model.links.size(); ++link) {
    const ContactSettings of_link = contactSettings(
        contact_.boundary_width, contact_, {overridesOf(described.config.described_links, model.links[link].name), &config.contact});
    for (const model::CollisionShape& shape : model.links[link].collisions) {
      contact::Collider collider;
      collider.name = config.name + "::" + model.links[link].name;
      collider.model = index;
      collider.body = body;
      collider.X_BC = lumped.link_placement[link].X_BL;
      geometry::MeshReport report = shape.report;
      ContactSettings settings = of_link;
      const auto geometry = surfaces_.geometry(shape.mesh, nullptr, shape.cylinder);
      surfaces_.chooseWidth(*geometry, needs, shape.radius, &settings, &report);
      surfaces_.fit(geometry, settings, shape.radius, &report, &collider);
      world->addCollider(collider, shape.radius > 0 ? shape.radius : settings.boundary_width.metres, settings.surface, report);
    }
  }
  if (!described.config.sensors.empty())
    world->notes.push_back(config.name + ": objects have no sensors; load it under robots to have them");
  for (const auto* notes : {&model.notes, &lumped.notes, &described.notes})
    for (const std::string& note : *notes) world->notes.push_back(config.name + ": " + note);
}

}  // namespace blem_sim::sim
