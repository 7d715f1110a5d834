#include "checks/urdf_check.h"

#include <tinyxml2.h>

#include <cmath>
#include <locale>
#include <map>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/geometry/one_line.h"
#include "checks/urdf_gazebo.h"
#include "checks/urdf_text.h"
#include "checks/urdf_transmissions.h"
#include "checks/urdf_tree_check.h"

namespace blem_sim::model {
namespace {

using Element = tinyxml2::XMLElement;

[[noreturn]] void refuse(const std::string& where, const std::string& what) { throw InputError(geometry::oneLine(where + ": " + what)); }

std::string attribute(const Element& element, const char* name) {
  const char* value = element.Attribute(name);
  return value ? value : "";
}

/** Calls visit(child) for each child element, by name if one is given. */
template <typename Visit>
void forChildren(const Element& element, const char* name, Visit&& visit) {
  for (const Element* child = element.FirstChildElement(name); child; child = child->NextSiblingElement(name)) visit(*child);
}

/** Numbers of an attribute, each finite. @param count expected @param where "robot.urdf: link 'x'" */
std::vector<double> numbers(const Element& element, const char* name, std::size_t count, const std::string& where) {
  const std::string text = attribute(element, name);
  std::istringstream words(text);
  std::vector<double> values;
  for (std::string word; words >> word;) {
    std::istringstream stream(word);
    stream.imbue(std::locale::classic());
    double value = 0;
    if (!(stream >> value) || !stream.eof() || !std::isfinite(value))
      refuse(where, fmt::format("<{} {}=\"{}\">: '{}' is not a finite number; write a plain number (1e6 stands for no limit)",
                                element.Name(), name, text, word));
    values.push_back(value);
  }
  if (values.size() != count)
    refuse(where, fmt::format("<{} {}=\"{}\">: {} number{} expected, {} given", element.Name(), name, text, count, count == 1 ? "" : "s",
                              values.size()));
  return values;
}

/** The same if the attribute is there; absent ones have URDF's defaults. */
void optionalNumbers(const Element& element, const char* name, std::size_t count, const std::string& where) {
  if (element.Attribute(name)) numbers(element, name, count, where);
}

void checkOrigin(const Element& parent, const std::string& where) {
  const Element* origin = parent.FirstChildElement("origin");
  if (!origin) return;
  optionalNumbers(*origin, "xyz", 3, where);
  optionalNumbers(*origin, "rpy", 3, where);
}

void checkInertial(const Element& inertial, const std::string& where) {
  checkOrigin(inertial, where + " inertial");
  const Element* mass = inertial.FirstChildElement("mass");
  const Element* inertia = inertial.FirstChildElement("inertia");
  if (!mass) refuse(where, "<inertial> without <mass value=\"...\"/> in kg; add it or leave <inertial> out");
  if (!inertia) refuse(where, "<inertial> without <inertia .../> in kg m^2; add it or leave <inertial> out");
  const double value = numbers(*mass, "value", 1, where)[0];
  if (value < 0) refuse(where, fmt::format("mass {:g} kg is negative; give it its true mass", value));
  for (const char* name : {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"}) numbers(*inertia, name, 1, where);
}

void checkPositive(const Element& shape, const char* name, std::size_t count, const std::string& where) {
  for (double value : numbers(shape, name, count, where))
    if (!(value > 0)) refuse(where, fmt::format("<{} {}=\"{}\">: must be greater than zero", shape.Name(), name, attribute(shape, name)));
}

void checkCollision(const Element& collision, const std::string& where) {
  checkOrigin(collision, where);
  const Element* geometry = collision.FirstChildElement("geometry");
  const Element* shape = geometry ? geometry->FirstChildElement() : nullptr;
  if (!shape) refuse(where, "no shape; put a <box>, <cylinder>, <sphere> or <mesh> into its <geometry>");
  const std::string kind = shape->Name();
  if (kind == "box") {
    checkPositive(*shape, "size", 3, where);
  } else if (kind == "cylinder") {
    checkPositive(*shape, "radius", 1, where);
    checkPositive(*shape, "length", 1, where);
  } else if (kind == "sphere") {
    checkPositive(*shape, "radius", 1, where);
  } else if (kind == "mesh") {
    if (attribute(*shape, "filename").empty()) refuse(where, "<mesh> without a filename; write filename=\"package://NAME/path\"");
    optionalNumbers(*shape, "scale", 3, where);
  } else if (kind == "capsule") {
    refuse(where, "<capsule> is not URDF; write a <cylinder> and a <sphere> of the same radius at each of its ends");
  } else {
    refuse(where, fmt::format("unknown shape <{}>; use <box>, <cylinder>, <sphere> or <mesh>", kind));
  }
}

void checkLink(const Element& link, const std::string& where) {
  if (const Element* inertial = link.FirstChildElement("inertial")) checkInertial(*inertial, where);
  int index = 0;
  forChildren(link, "collision",
              [&](const Element& collision) { checkCollision(collision, fmt::format("{} collision {}", where, ++index)); });
}

void checkLimit(const Element& joint, const std::string& type, const std::string& where) {
  const Element* limit = joint.FirstChildElement("limit");
  const bool needed = type == "revolute" || type == "prismatic";
  if (!limit && needed)
    refuse(where, fmt::format("a {} joint needs <limit lower upper effort velocity/>{}", type,
                              type == "revolute" ? "; add it or make the joint continuous" : "; add it"));
  if (!limit) return;
  double range[2] = {0, 0};
  int i = 0;
  for (const char* name : {"lower", "upper"}) {
    if (limit->Attribute(name)) range[i] = numbers(*limit, name, 1, where)[0];
    ++i;
  }
  if (needed && range[0] > range[1])
    refuse(where, fmt::format("lower limit {} is above upper limit {}; exchange them", range[0], range[1]));
  for (const char* name : {"effort", "velocity"}) {
    if (!limit->Attribute(name)) refuse(where, fmt::format("<limit> without {}; add it (1e6 stands for no limit)", name));
    if (numbers(*limit, name, 1, where)[0] < 0)
      refuse(where, fmt::format("{} limit {} is negative; give its size", name, attribute(*limit, name)));
  }
}

void checkJointNumbers(const Element& joint, const std::string& type, const std::string& where) {
  checkOrigin(joint, where);
  if (const Element* axis = joint.FirstChildElement("axis")) {
    const std::vector<double> xyz = numbers(*axis, "xyz", 3, where);
    const bool used = type != "fixed" && type != "floating";
    if (used && !(std::hypot(std::hypot(xyz[0], xyz[1]), xyz[2]) > 1e-9))
      refuse(where, "its axis has no length; give it a direction, such as 0 0 1");
  }
  checkLimit(joint, type, where);
  if (const Element* dynamics = joint.FirstChildElement("dynamics")) {
    for (const char* name : {"damping", "friction"})
      if (dynamics->Attribute(name) && numbers(*dynamics, name, 1, where)[0] < 0)
        refuse(where, fmt::format("{} {} is negative; give zero or more", name, attribute(*dynamics, name)));
  }
}

void checkSafetyController(const Element& joint, const std::string& where) {
  const Element* safety = joint.FirstChildElement("safety_controller");
  if (!safety) return;
  if (!safety->Attribute("k_velocity")) refuse(where, "<safety_controller> without k_velocity; add it (0 bounds no effort)");
  for (const char* name : {"soft_lower_limit", "soft_upper_limit"}) optionalNumbers(*safety, name, 1, where);
  for (const char* name : {"k_position", "k_velocity"})
    if (safety->Attribute(name) && numbers(*safety, name, 1, where)[0] < 0)
      refuse(where, fmt::format("<safety_controller {}=\"{}\"> is negative; give zero or more", name, attribute(*safety, name)));
}

JointOutline checkJoint(const Element& joint, const std::string& where) {
  static const std::set<std::string> TYPES = {"fixed", "revolute", "continuous", "prismatic", "planar", "floating"};
  JointOutline outline;
  outline.name = attribute(joint, "name");
  outline.type = attribute(joint, "type");
  if (TYPES.count(outline.type) == 0)
    refuse(where, fmt::format("unknown type '{}'; use fixed, revolute, continuous, prismatic, planar or floating", outline.type));
  const Element* parent = joint.FirstChildElement("parent");
  const Element* child = joint.FirstChildElement("child");
  if (parent) outline.parent = attribute(*parent, "link");
  if (child) outline.child = attribute(*child, "link");
  if (outline.parent.empty() || outline.child.empty()) refuse(where, "it needs <parent link=\"...\"/> and <child link=\"...\"/>");
  checkJointNumbers(joint, outline.type, where);
  checkSafetyController(joint, where);
  if (const Element* mimic = joint.FirstChildElement("mimic")) {
    outline.mimic = attribute(*mimic, "joint");
    if (outline.mimic.empty()) refuse(where, "<mimic> without a joint; name the joint it follows");
    optionalNumbers(*mimic, "multiplier", 1, where);
    optionalNumbers(*mimic, "offset", 1, where);
  }
  return outline;
}

/** Counts elements that are not simulated. */
void countExtensions(const Element& element, const std::set<std::string>& known, std::map<std::string, int>* left_out) {
  forChildren(element, nullptr, [&](const Element& child) {
    if (known.count(child.Name()) == 0) ++(*left_out)[child.Name()];
  });
}

/** Refuses what xacro would have replaced. What is drawn alone, and what plugins read, may hold such text. */
void checkExpanded(const Element& element, const std::string& source) {
  static const std::set<std::string> OTHERS = {"gazebo", "visual", "material"};
  const auto refuseXacro = [&](const std::string& words) {
    refuse(source, fmt::format("<{}>: this is xacro, not URDF; expand it first (xacro FILE > robot.urdf)", words));
  };
  const std::string name = element.Name();
  if (name.compare(0, 6, "xacro:") == 0) refuseXacro(name);
  if (OTHERS.count(name) > 0) return;
  for (const tinyxml2::XMLAttribute* given = element.FirstAttribute(); given; given = given->Next()) {
    const std::string value = given->Value();
    if (value.find("${") != std::string::npos || value.find("$(") != std::string::npos)
      refuseXacro(fmt::format("{} {}=\"{}\"", name, given->Name(), value));
  }
  forChildren(element, nullptr, [&](const Element& child) { checkExpanded(child, source); });
}

const Element& robotElement(const tinyxml2::XMLDocument& document, const std::string& xml, const std::string& source) {
  if (document.Error()) {
    const bool hint = xml.find_first_not_of(" \t\r\n") == std::string::npos;
    refuse(source, hint ? "the URDF is empty; give it a <robot>"
                        : fmt::format("not XML, line {}: {}; write a URDF whose outermost element is <robot>", document.ErrorLineNum(),
                                      tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID())));
  }
  const Element* robot = document.RootElement();
  if (!robot || std::string(robot->Name()) != "robot")
    refuse(source, fmt::format("the outermost element is <{}>; a URDF begins with <robot name=\"...\">", robot ? robot->Name() : ""));
  if (attribute(*robot, "name").empty()) refuse(source, "<robot> has no name; write <robot name=\"...\">");
  checkExpanded(*robot, source);
  return *robot;
}

}  // namespace

UrdfOutline checkUrdf(const std::string& xml, const std::string& source) {
  tinyxml2::XMLDocument document;
  document.Parse(xml.c_str(), xml.size());
  const Element& robot = robotElement(document, xml, source);
  UrdfOutline outline;
  std::map<std::string, int> left_out;
  countExtensions(robot, {"link", "joint", "material", "transmission", "gazebo"}, &left_out);
  forChildren(robot, "link", [&](const Element& link) {
    outline.links.push_back(attribute(link, "name"));
    checkLink(link, fmt::format("{}: link '{}'", source, outline.links.back()));
    countExtensions(link, {"inertial", "visual", "collision"}, &left_out);
  });
  std::vector<JointOutline> joints;
  forChildren(robot, "joint", [&](const Element& joint) {
    outline.joints.push_back(attribute(joint, "name"));
    joints.push_back(checkJoint(joint, fmt::format("{}: joint '{}'", source, outline.joints.back())));
    countExtensions(joint, {"origin", "parent", "child", "axis", "limit", "dynamics", "mimic", "safety_controller"}, &left_out);
  });
  checkTree(outline.links, joints, source);
  outline.transmissions = readTransmissions(robot, outline.joints, source, &outline.notes);
  outline.gazebo = readGazeboBlocks(robot, &outline.notes);
  for (const auto& [name, count] : left_out)
    outline.notes.push_back(fmt::format("<{}> left out ({} of them): it is not simulated", name, count));
  outline.simulated = simulatedText(xml, &document);
  return outline;
}

}  // namespace blem_sim::model
