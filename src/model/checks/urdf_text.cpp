#include "checks/urdf_text.h"

#include <set>
#include <sstream>

namespace blem_sim::model {
namespace {

using Element = tinyxml2::XMLElement;

const std::set<std::string> NUMBERS = {"value",
                                       "ixx",
                                       "ixy",
                                       "ixz",
                                       "iyy",
                                       "iyz",
                                       "izz",
                                       "xyz",
                                       "rpy",
                                       "size",
                                       "radius",
                                       "length",
                                       "scale",
                                       "lower",
                                       "upper",
                                       "effort",
                                       "velocity",
                                       "damping",
                                       "friction",
                                       "multiplier",
                                       "offset",
                                       "rising",
                                       "falling",
                                       "k_position",
                                       "k_velocity",
                                       "soft_lower_limit",
                                       "soft_upper_limit"};

void removeChildren(Element* parent, const char* name) {
  while (Element* child = parent->FirstChildElement(name)) parent->DeleteChild(child);
}

std::string singlySpaced(const std::string& text) {
  std::istringstream words(text);
  std::string spaced;
  for (std::string word; words >> word;) spaced += (spaced.empty() ? "" : " ") + word;
  return spaced;
}

void spaceNumbers(Element* element) {
  for (const tinyxml2::XMLAttribute* attribute = element->FirstAttribute(); attribute; attribute = attribute->Next())
    if (NUMBERS.count(attribute->Name()) > 0) element->SetAttribute(attribute->Name(), singlySpaced(attribute->Value()).c_str());
  for (Element* child = element->FirstChildElement(); child; child = child->NextSiblingElement()) spaceNumbers(child);
}

std::string printed(const tinyxml2::XMLDocument& urdf) {
  tinyxml2::XMLPrinter printer(nullptr, true);
  urdf.Print(&printer);
  return printer.CStr();
}

}  // namespace

std::string simulatedText(const std::string& xml, tinyxml2::XMLDocument* urdf) {
  const std::string before = printed(*urdf);
  Element* robot = urdf->RootElement();
  removeChildren(robot, "material");
  for (Element* link = robot->FirstChildElement("link"); link; link = link->NextSiblingElement("link")) removeChildren(link, "visual");
  for (const char* name : {"link", "joint"})
    for (Element* part = robot->FirstChildElement(name); part; part = part->NextSiblingElement(name)) spaceNumbers(part);
  const std::string after = printed(*urdf);
  return after == before ? xml : after;
}

}  // namespace blem_sim::model
