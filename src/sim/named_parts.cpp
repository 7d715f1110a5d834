#include "blem_sim/sim/named_parts.h"

#include <algorithm>
#include <utility>

#include "blem_sim/geometry/input_error.h"
#include "build/simulated_world.h"
#include "numbers/nearest_name.h"

namespace blem_sim::sim {
namespace {

const char* const SCOPE = "::";
const char* const ENVIRONMENT_LINK = "link";

LinkPart linkOfRobot(const Simulator& simulator, int robot, int link) {
  const RobotInfo& info = simulator.robots()[robot];
  const model::LinkPlacement& placement = info.lumped->link_placement[link];
  LinkPart part{
      info.name + SCOPE + info.description->links[link].name, info.model, robot, link, info.bodies[placement.body], placement.X_BL};
  if (part.body == dynamics::WORLD_BODY) part.X_BL = info.X_WR * placement.X_BL;
  return part;
}

/** The model's name in front of a scoped one; empty if there is no such model. */
std::string modelIn(const Simulator& simulator, const std::string& name) {
  const std::size_t scope = name.find(SCOPE);
  if (scope == std::string::npos || simulator.modelIndex(name.substr(0, scope)) < 0) return "";
  return name.substr(0, scope);
}

/** First link of that name, scoped or not; those of environments, which are all called link, only scoped. */
std::optional<LinkPart> linkNamed(const Simulator& simulator, const std::string& name) {
  const std::string scope = modelIn(simulator, name);
  const int models = static_cast<int>(simulator.models().size());
  for (int model = 0; model < models; ++model) {
    const ModelInfo& info = simulator.models()[model];
    if (scope.empty() ? info.kind == ModelKind::ENVIRONMENT : info.name != scope) continue;
    for (const LinkPart& part : linksOf(simulator, model))
      if (part.name == name || (scope.empty() && withoutModel(part.name) == name)) return part;
  }
  return std::nullopt;
}

[[noreturn]] void refuseName(const std::string& name, const std::vector<std::string>& known, const std::string& where,
                             const std::string& kind) {
  requireName(name, known, where, kind);
  throw InputError(where + ": no " + kind + " '" + name + "'");
}

std::vector<std::string> linkNames(const Simulator& simulator) {
  std::vector<std::string> names;
  for (int model = 0; model < static_cast<int>(simulator.models().size()); ++model)
    for (const LinkPart& part : linksOf(simulator, model)) names.push_back(part.name);
  return names;
}

}  // namespace

std::string withoutModel(const std::string& name) {
  const std::size_t scope = name.find(SCOPE);
  return scope == std::string::npos ? name : name.substr(scope + 2);
}

std::vector<LinkPart> linksOf(const Simulator& simulator, int index) {
  const ModelInfo& model = simulator.models()[index];
  std::vector<LinkPart> parts;
  if (!model.alive) return parts;
  if (model.kind == ModelKind::ENVIRONMENT)
    parts.push_back({model.name + SCOPE + ENVIRONMENT_LINK, index, -1, -1, dynamics::WORLD_BODY, model.X_WM});
  if (model.kind == ModelKind::OBJECT)
    for (const int body : model.bodies) parts.push_back({simulator.bodyName(body), index, -1, -1, body, Pose::Identity()});
  if (model.kind != ModelKind::ROBOT) return parts;
  const int robot = simulator.robotIndex(model.name), root = simulator.robots()[robot].description->root;
  const int links = static_cast<int>(simulator.robots()[robot].description->links.size());
  for (int link = 0; link < links; ++link) parts.push_back(linkOfRobot(simulator, robot, link));
  std::rotate(parts.begin(), parts.begin() + root, parts.begin() + root + 1);
  return parts;
}

int findModel(const Simulator& simulator, const std::string& name, const std::string& where) {
  if (simulator.modelIndex(name) < 0) refuseName(name, modelNames(simulator.models()), where, "model");
  return simulator.modelIndex(name);
}

LinkPart findLink(const Simulator& simulator, const std::string& name, const std::string& where) {
  if (std::optional<LinkPart> part = linkNamed(simulator, name)) return std::move(*part);
  refuseName(name, linkNames(simulator), where, "link");
}

JointPart findJoint(const Simulator& simulator, const std::string& name, const std::string& where) {
  const std::string scope = modelIn(simulator, name), own = scope.empty() ? name : withoutModel(name);
  std::vector<std::string> known;
  for (int robot = 0; robot < static_cast<int>(simulator.robots().size()); ++robot) {
    const RobotInfo& info = simulator.robots()[robot];
    const auto joint = std::find(info.joint_names.begin(), info.joint_names.end(), own);
    if ((scope.empty() || info.name == scope) && joint != info.joint_names.end())
      return {robot, static_cast<int>(joint - info.joint_names.begin())};
    for (const std::string& each : info.joint_names) known.push_back(info.name + SCOPE + each);
  }
  refuseName(name, known, where, "movable joint");
}

std::optional<LinkPart> findFrame(const Simulator& simulator, const std::string& name, const std::string& where) {
  if (name.empty() || name == "world" || name == "map" || name == "/world" || name == "/map") return std::nullopt;
  if (simulator.modelIndex(name) >= 0) return linksOf(simulator, simulator.modelIndex(name)).front();
  return findLink(simulator, name, where);
}

bool isWeightless(const Simulator& simulator, const LinkPart& part) {
  if (part.model < 0) return false;
  const std::set<WeightlessPart>& weightless = simulator.models()[part.model].weightless;
  return weightless.count({part.body, -1}) > 0 || weightless.count({part.body, part.link}) > 0;
}

}  // namespace blem_sim::sim
