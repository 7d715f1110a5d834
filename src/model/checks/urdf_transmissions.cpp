#include "checks/urdf_transmissions.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <locale>
#include <sstream>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/geometry/one_line.h"

namespace blem_sim::model {
namespace {

using Element = tinyxml2::XMLElement;

std::string nameOf(const Element* element) {
  const char* name = element ? element->Attribute("name") : nullptr;
  return name ? name : "";
}

/** The finite number in <name> below an element; `otherwise` if there is none. */
double numberIn(const Element* parent, const char* name, double otherwise, const std::string& where) {
  const Element* element = parent ? parent->FirstChildElement(name) : nullptr;
  if (!element) return otherwise;
  std::istringstream stream(element->GetText() ? element->GetText() : "");
  stream.imbue(std::locale::classic());
  double value = 0;
  if (!(stream >> value) || !(stream >> std::ws).eof() || !std::isfinite(value))
    throw InputError(geometry::oneLine(fmt::format("{}: <{}> is no finite number; write a plain number", where, name)));
  return value;
}

/** @param joint null if the transmission names none @param actuator whose gear counts; null: the joint's own */
Transmission readJoint(const Element& element, const Element* joint, const Element* actuator, const std::string& source) {
  Transmission transmission;
  transmission.name = nameOf(&element);
  transmission.joint = nameOf(joint);
  const std::string where = fmt::format("{}: transmission '{}'", source, transmission.name);
  const double reduction = numberIn(&element, "mechanicalReduction", 1, where);
  transmission.reduction = numberIn(actuator ? actuator : joint, "mechanicalReduction", reduction, where);
  transmission.offset = numberIn(joint, "offset", 0, where);
  if (transmission.reduction == 0) throw InputError(geometry::oneLine(where + ": <mechanicalReduction> is 0; give the ratio of its gear"));
  return transmission;
}

/** One for each joint. Of several joints that share their actuators, as in a differential, each has its own gear and a motor of its own. */
std::vector<Transmission> readTransmission(const Element& element, const std::string& source) {
  const Element* joint = element.FirstChildElement("joint");
  const Element* next = joint ? joint->NextSiblingElement("joint") : nullptr;
  std::vector<Transmission> joints = {readJoint(element, joint, next ? nullptr : element.FirstChildElement("actuator"), source)};
  for (; next; next = next->NextSiblingElement("joint")) joints.push_back(readJoint(element, next, nullptr, source));
  return joints;
}

}  // namespace

std::vector<Transmission> readTransmissions(const Element& robot, const std::vector<std::string>& joints, const std::string& source,
                                            std::vector<std::string>* notes) {
  std::vector<Transmission> transmissions;
  for (const Element* child = robot.FirstChildElement("transmission"); child; child = child->NextSiblingElement("transmission")) {
    for (const Transmission& transmission : readTransmission(*child, source)) {
      if (std::find(joints.begin(), joints.end(), transmission.joint) != joints.end())
        transmissions.push_back(transmission);
      else
        notes->push_back(geometry::oneLine(
            fmt::format("transmission '{}' left out: the robot has no joint '{}'", transmission.name, transmission.joint)));
    }
  }
  return transmissions;
}

}  // namespace blem_sim::model
