#include <yaml-cpp/yaml.h>

#include <cmath>

#include "config/config_sections.h"

namespace blem_sim::sim {
namespace {

using Kind = model::CloudFilter::Kind;

model::CloudFilter readOutliers(YamlReader reader, Kind kind) {
  model::CloudFilter filter;
  filter.kind = kind;
  filter.neighbours = 16;
  filter.factor = 2;
  filter.size = 0.02;
  reader.read("neighbours", &filter.neighbours, 1);
  if (kind == Kind::STATISTICAL_OUTLIERS) reader.read("factor", &filter.factor, NumberRange::notNegative());
  if (kind == Kind::RADIUS_OUTLIERS) reader.read("radius", &filter.size, NumberRange::positive());
  reader.finish();
  return filter;
}

model::CloudFilter readPassThrough(YamlReader reader) {
  model::CloudFilter filter;
  filter.kind = Kind::PASS_THROUGH;
  const auto axis = reader.choice("axis", {"x", "y", "z"});
  if (!axis) reader.refuse("axis", "is missing; give it x, y or z");
  filter.axis = *axis;
  const YAML::Node range = reader.node("range");
  const char* const wanted = "must be a list of two numbers, also -.inf and .inf, the lower first";
  if (!range.IsDefined() || !range.IsSequence() || range.size() != 2) reader.refuse("range", wanted);
  try {
    filter.lower = range[0].as<double>();
    filter.upper = range[1].as<double>();
  } catch (const YAML::Exception&) {
    reader.refuse("range", wanted);
  }
  if (!(filter.lower <= filter.upper)) reader.refuse("range", wanted);
  reader.finish();
  return filter;
}

model::CloudFilter readLeastSquares(YamlReader reader) {
  model::CloudFilter filter;
  filter.kind = Kind::MOVING_LEAST_SQUARES;
  filter.size = 0.02;
  reader.read("radius", &filter.size, NumberRange::positive());
  reader.read("order", &filter.order, 1);
  reader.finish();
  return filter;
}

model::CloudFilter readFilter(YamlReader& reader) {
  int given = 0;
  for (const char* key : {"voxel_grid", "statistical_outliers", "radius_outliers", "pass_through", "moving_least_squares"})
    given += reader.has(key) ? 1 : 0;
  reader.finish();
  if (given != 1)
    reader.refuse("", "needs exactly one of voxel_grid, statistical_outliers, radius_outliers, pass_through or moving_least_squares");
  if (reader.has("moving_least_squares")) return readLeastSquares(reader.section("moving_least_squares"));
  if (reader.has("statistical_outliers")) return readOutliers(reader.section("statistical_outliers"), Kind::STATISTICAL_OUTLIERS);
  if (reader.has("radius_outliers")) return readOutliers(reader.section("radius_outliers"), Kind::RADIUS_OUTLIERS);
  if (reader.has("pass_through")) return readPassThrough(reader.section("pass_through"));
  model::CloudFilter filter;
  reader.read("voxel_grid", &filter.size, NumberRange::positive());
  return filter;
}

model::VoxelMapOptions readMap(YamlReader reader) {
  model::VoxelMapOptions map;
  reader.read("voxel", &map.voxel, NumberRange::positive());
  reader.read("min_hits", &map.min_hits, 1);
  reader.read("memory", &map.memory, 1);
  reader.read("expire_after", &map.expire_after, NumberRange::positiveOrInfinite());
  int most = static_cast<int>(map.max_voxels);
  reader.read("max_voxels", &most, 1);
  map.max_voxels = static_cast<std::size_t>(most);
  reader.finish();
  return map;
}

/** Kind of the messages, and keys that belong to one kind. */
void readType(YamlReader& reader, LiveConfig* live) {
  using Type = LiveConfig::Type;
  const std::vector<Type> types = {Type::CLOUD, Type::MESH, Type::GRID};
  if (const auto type = reader.choice("type", {"cloud", "mesh", "grid"})) live->type = types[*type];
  for (const char* key : {"cloud", "update", "map"})
    if (live->type != Type::CLOUD && reader.has(key)) reader.refuse(key, "belongs to type: cloud; leave it out");
  for (const char* key : {"occupied", "wall_height"})
    if (live->type != Type::GRID && reader.has(key)) reader.refuse(key, "belongs to type: grid; leave it out");
  reader.read("occupied", &live->occupied, 1);
  if (live->occupied > 100) reader.refuse("occupied", "must be from 1 to 100, as cells of a nav_msgs/OccupancyGrid are");
  reader.read("wall_height", &live->wall_height, NumberRange::positive());
}

}  // namespace

model::CloudOptions readCloud(YamlReader reader) {
  model::CloudOptions cloud;
  const std::vector<model::CloudOptions::As> ways = {model::CloudOptions::As::AUTO, model::CloudOptions::As::POINTS,
                                                     model::CloudOptions::As::MESH};
  if (const auto as = reader.choice("as", {"auto", "points", "mesh"})) cloud.as = ways[*as];
  const YAML::Node radius = reader.node("point_radius");
  cloud.auto_radius = radius.IsDefined() && radius.IsScalar() && radius.Scalar() == "auto";
  if (!cloud.auto_radius) reader.read("point_radius", &cloud.point_radius, NumberRange::positive());
  using Mesher = model::CloudOptions::Mesher;
  const std::vector<Mesher> meshers = {Mesher::AUTO, Mesher::ORGANIZED, Mesher::GREEDY_PROJECTION, Mesher::MARCHING_CUBES, Mesher::POISSON};
  std::vector<std::string> names;
  for (const Mesher mesher : meshers) names.push_back(model::mesherName(mesher));
  if (const auto mesher = reader.choice("mesher", names)) cloud.mesher = meshers[*mesher];
  if (reader.has("mesher") && cloud.as != model::CloudOptions::As::MESH) reader.refuse("mesher", "belongs to as: mesh");
  reader.read("max_edge", &cloud.max_edge, NumberRange::positive());
  reader.read("max_depth_jump", &cloud.max_depth_jump, NumberRange::positiveOrInfinite());
  reader.read("cell", &cloud.cell, NumberRange::positive());
  reader.read("fill_holes", &cloud.fill_holes);
  Vector3 viewpoint = Vector3::Zero();
  reader.read("viewpoint", &viewpoint);
  if (reader.has("viewpoint")) cloud.viewpoint = viewpoint;
  reader.forEachItem("filters", [&](YamlReader& filter) { cloud.filters.push_back(readFilter(filter)); });
  reader.finish();
  return cloud;
}

LiveConfig readLive(YamlReader& reader, const model::CloudOptions& cloud) {
  LiveConfig live;
  reader.read("topic", &live.topic);
  reader.read("frame", &live.frame);
  for (const char* key : {"type", "frame", "update", "map", "fade_speed", "occupied", "wall_height"})
    if (live.topic.empty() && reader.has(key)) reader.refuse(key, "belongs to topic: a file does not change, and its place is its pose");
  if (live.topic.empty()) return live;
  for (const char* key : {"scale", "pose"})
    if (reader.has(key)) reader.refuse(key, "is a file's: a topic's points are placed by tf");
  readType(reader, &live);
  if (const auto update = reader.choice("update", {"replace", "accumulate"}))
    live.update = *update == 0 ? LiveConfig::Update::REPLACE : LiveConfig::Update::ACCUMULATE;
  if (live.update == LiveConfig::Update::REPLACE && reader.has("map")) reader.refuse("map", "belongs to update: accumulate");
  live.map = readMap(reader.section("map"));
  reader.read("fade_speed", &live.fade_speed, NumberRange::positive());
  const bool has_grid = cloud.filters.empty() && live.update == LiveConfig::Update::REPLACE;
  if (cloud.mesher == model::CloudOptions::Mesher::ORGANIZED && !has_grid)
    reader.refuse("cloud.mesher", "must be another than organized: filters and update: accumulate give up the pixel grid");
  return live;
}

}  // namespace blem_sim::sim
