#include "checks/urdf_tree_check.h"

#include <map>
#include <set>

#include <fmt/format.h>

#include "blem_sim/geometry/input_error.h"

namespace blem_sim::model {
namespace {

void checkNames(const std::vector<std::string>& names, const char* kind, const std::string& source) {
  std::set<std::string> seen;
  for (const std::string& name : names) {
    if (name.empty()) throw InputError(fmt::format("{}: a {} without a name; name every {}", source, kind, kind));
    if (!seen.insert(name).second) throw InputError(fmt::format("{}: {} '{}' is given twice; rename one of them", source, kind, name));
  }
}

/** Joint that moves each link. */
using JointOfChild = std::map<std::string, const JointOutline*>;

JointOfChild checkEnds(const std::vector<std::string>& links, const std::vector<JointOutline>& joints, const std::string& source) {
  const std::set<std::string> known(links.begin(), links.end());
  JointOfChild joint_of_child;
  for (const JointOutline& joint : joints) {
    for (const std::string& link : {joint.parent, joint.child})
      if (known.count(link) == 0)
        throw InputError(fmt::format("{}: joint '{}': there is no link '{}'; add it or correct the name", source, joint.name, link));
    if (joint.parent == joint.child)
      throw InputError(
          fmt::format("{}: joint '{}' joins link '{}' to itself; name another parent or child", source, joint.name, joint.parent));
    const auto [other, fresh] = joint_of_child.emplace(joint.child, &joint);
    if (!fresh)
      throw InputError(fmt::format("{}: link '{}' is the child of joints '{}' and '{}'; a link has one parent, so remove one of them",
                                   source, joint.child, other->second->name, joint.name));
  }
  return joint_of_child;
}

void checkRoots(const std::vector<std::string>& links, const JointOfChild& joint_of_child, const std::string& source) {
  std::vector<std::string> roots;
  for (const std::string& link : links)
    if (joint_of_child.count(link) == 0) roots.push_back(link);
  if (roots.size() > 1)
    throw InputError(fmt::format("{}: {} links have no parent ({}); join them, a robot has one root link", source, roots.size(),
                                 fmt::join(roots, ", ")));
  // Each link has at most one parent: following parents ends at a root or goes round a loop.
  for (const std::string& link : links) {
    std::set<std::string> passed;
    std::string at = link;
    while (joint_of_child.count(at) != 0) {
      if (!passed.insert(at).second)
        throw InputError(fmt::format("{}: links form a loop through '{}' (joint '{}'); remove one joint of the loop", source, at,
                                     joint_of_child.at(at)->name));
      at = joint_of_child.at(at)->parent;
    }
  }
}

bool hasOnePosition(const std::string& type) { return type == "revolute" || type == "continuous" || type == "prismatic"; }

void checkMimics(const std::vector<JointOutline>& joints, const std::string& source) {
  std::map<std::string, const JointOutline*> by_name;
  for (const JointOutline& joint : joints) by_name[joint.name] = &joint;
  for (const JointOutline& joint : joints) {
    if (joint.mimic.empty()) continue;
    const std::string where = fmt::format("{}: joint '{}'", source, joint.name);
    const auto master = by_name.find(joint.mimic);
    if (master == by_name.end()) throw InputError(fmt::format("{} mimics unknown joint '{}'; correct the name", where, joint.mimic));
    for (const JointOutline* end : {&joint, master->second})
      if (!hasOnePosition(end->type))
        throw InputError(fmt::format("{}: <mimic> with joint '{}', which is {}; only revolute, continuous and prismatic joints can mimic",
                                     where, end->name, end->type));
    std::set<std::string> passed;
    for (const JointOutline* at = &joint; !at->mimic.empty() && by_name.count(at->mimic) != 0; at = by_name.at(at->mimic))
      if (!passed.insert(at->name).second)
        throw InputError(fmt::format("{} mimics itself through '{}'; let one joint of the circle be free", where, joint.mimic));
  }
}

}  // namespace

void checkTree(const std::vector<std::string>& links, const std::vector<JointOutline>& joints, const std::string& source) {
  if (links.empty()) throw InputError(source + ": the robot has no link; add one");
  checkNames(links, "link", source);
  std::vector<std::string> joint_names;
  for (const JointOutline& joint : joints) joint_names.push_back(joint.name);
  checkNames(joint_names, "joint", source);
  checkRoots(links, checkEnds(links, joints, source), source);
  checkMimics(joints, source);
}

}  // namespace blem_sim::model
