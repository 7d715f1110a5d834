#include <tinyxml2.h>

#include <cstdint>
#include <cstdlib>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/geometry/one_line.h"
#include "checks/file_check.h"

namespace blem_sim::model {
namespace {

using Element = tinyxml2::XMLElement;

constexpr double MOST_NODES = 1e6;          // of a scene, each counted as often as it is instanced
constexpr std::size_t DEEPEST_NODES = 500;  // that instance one another: assimp goes down by one call each

/** Lists of faces and lines, which name vertices by number. */
bool isPrimitive(const std::string& name) {
  static const std::set<std::string> NAMES = {"triangles", "polylist", "polygons", "tristrips", "trifans", "lines", "linestrips"};
  return NAMES.count(name) > 0;
}

/** Looks through a document once for its ids and counts, once for the references to them. */
class ColladaCheck {
 public:
  explicit ColladaCheck(const std::string& file) : file_(file) {}

  void run(const Element& root) {
    collect(root);
    const Element* scene = root.FirstChildElement("scene");
    if (!scene || !scene->FirstChildElement("instance_visual_scene")) refuse("it has no <scene> with an <instance_visual_scene>");
    checkReferences(root);
    if (nodesBelow(root) > MOST_NODES) refuse(fmt::format("its nodes instance each other more than {:.0f} times", MOST_NODES));
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(fmt::format("{}: not a readable dae mesh: {}; export it again", file_, geometry::oneLine(what)));
  }

  std::size_t count(const Element& element, const char* attribute, bool needed) const {
    std::int64_t value = 0;
    const tinyxml2::XMLError error = element.QueryInt64Attribute(attribute, &value);
    const bool absent = error == tinyxml2::XML_NO_ATTRIBUTE && !needed;
    if (!absent && (error != tinyxml2::XML_SUCCESS || value < 0))
      refuse(fmt::format("<{}> needs a count in '{}'", element.Name(), attribute));
    return static_cast<std::size_t>(value);
  }

  void collect(const Element& element) {
    const std::string name = element.Name();
    if (const char* id = element.Attribute("id")) {
      kinds_[id] = name;
      if (name == "node") nodes_[id] = &element;
    }
    if (name == "float_array") checkArray(element);
    if (isPrimitive(name)) checkPrimitive(element);
    if (name == "unit") checkUnit(element);
    for (const Element* child = element.FirstChildElement(); child; child = child->NextSiblingElement()) collect(*child);
  }

  void checkArray(const Element& array) {
    std::istringstream words(array.GetText() ? array.GetText() : "");
    std::size_t there = 0;
    for (std::string word; words >> word;) ++there;
    const std::size_t announced = count(array, "count", true);
    if (there != announced) refuse(fmt::format("a <float_array> announces {} numbers, {} there", announced, there));
    if (const char* id = array.Attribute("id")) array_counts_[id] = announced;
  }

  /** Numbers in a list of vertices or of their counts. assimp reads on for ever at what is none, and takes those below 0 for 0. */
  std::vector<double> wholeNumbers(const Element& list) const {
    std::vector<double> numbers;
    std::istringstream words(list.GetText() ? list.GetText() : "");
    for (std::string word; words >> word;) {
      numbers.push_back(std::strtod(word.c_str(), nullptr));
      if (word.find_first_not_of("0123456789") != std::string::npos || numbers.back() > std::numeric_limits<std::int32_t>::max())
        refuse(fmt::format("<{}> has '{}' where the number of a vertex belongs", list.Name(), word));
    }
    return numbers;
  }

  /** assimp makes room for as much as is announced. */
  void checkPrimitive(const Element& primitive) const {
    double there = 0, corners = 0;
    for (const Element* p = primitive.FirstChildElement("p"); p; p = p->NextSiblingElement("p")) there += wholeNumbers(*p).size();
    const double announced = count(primitive, "count", true);
    if (announced > there + 1)  // an empty list may have a count of 0 or 1
      refuse(fmt::format("<{}> announces {:.0f} of them, but <p> names {:.0f} vertices", primitive.Name(), announced, there));
    if (const Element* vcount = primitive.FirstChildElement("vcount"))
      for (const double of_one : wholeNumbers(*vcount)) corners += of_one;
    if (corners > there) refuse(fmt::format("<vcount> announces {:.0f} corners, but <p> names {:.0f} vertices", corners, there));
    for (const Element* input = primitive.FirstChildElement("input"); input; input = input->NextSiblingElement("input"))
      if (there > 0 && count(*input, "offset", false) > there)
        refuse(fmt::format("<input> has an offset beyond the {:.0f} vertices of <p>", there));
  }

  void checkUnit(const Element& unit) const {
    double metres = 1;
    const tinyxml2::XMLError error = unit.QueryDoubleAttribute("meter", &metres);
    if (error != tinyxml2::XML_NO_ATTRIBUTE && (error != tinyxml2::XML_SUCCESS || !(metres > 0)))
      refuse("<unit> needs a number above 0 in 'meter'");
  }

  /** Nodes that an element makes, those that are instanced below it too. */
  double nodesBelow(const Element& element) {
    double nodes = 0;
    for (const Element* child = element.FirstChildElement(); child && nodes <= MOST_NODES; child = child->NextSiblingElement())
      nodes += std::string(child->Name()) == "instance_node" ? nodesOfInstance(*child) : 1 + nodesBelow(*child);
    return nodes;
  }

  double nodesOfInstance(const Element& instance) {
    const std::string id = instance.Attribute("url") + 1;
    if (const auto known = instanced_.find(id); known != instanced_.end()) return known->second;
    if (!open_.insert(id).second) refuse(fmt::format("node '{}' instances itself", id));
    if (open_.size() > DEEPEST_NODES) refuse(fmt::format("more than {} nodes instance one another in a row", DEEPEST_NODES));
    const double nodes = 1 + nodesBelow(*nodes_.at(id));
    open_.erase(id);
    return instanced_[id] = nodes;
  }

  /** A "#id" that must name an element of this kind; other documents are not followed. */
  void checkReference(const Element& element, const char* attribute, const std::string& kind) const {
    const std::string url = element.Attribute(attribute) ? element.Attribute(attribute) : "";
    const auto target = kinds_.find(url.empty() ? "" : url.substr(1));
    if (url.empty() || url[0] != '#' || target == kinds_.end() || (!kind.empty() && target->second != kind))
      refuse(fmt::format("<{} {}=\"{}\"> names nothing of that kind in this file", element.Name(), attribute, url));
  }

  void checkReferences(const Element& element) const {
    const std::string name = element.Name();
    if (name == "instance_visual_scene") checkReference(element, "url", "visual_scene");
    if (name == "instance_geometry") checkReference(element, "url", "geometry");
    if (name == "instance_node") checkReference(element, "url", "node");
    if (name == "input") checkReference(element, "source", "");
    if (name == "accessor") checkAccessor(element);
    for (const Element* child = element.FirstChildElement(); child; child = child->NextSiblingElement()) checkReferences(*child);
  }

  void checkAccessor(const Element& accessor) const {
    checkReference(accessor, "source", "");
    const auto array = array_counts_.find(accessor.Attribute("source") + 1);
    if (array == array_counts_.end()) return;  // names of bones and the like
    const std::size_t stride = accessor.Attribute("stride") ? count(accessor, "stride", true) : 1;
    const double needed = static_cast<double>(count(accessor, "count", true)) * static_cast<double>(stride) +
                          static_cast<double>(count(accessor, "offset", false));
    if (stride == 0 || needed > static_cast<double>(array->second))
      refuse(fmt::format("an <accessor> reads {:.0f} numbers of a <float_array> of {}", needed, array->second));
  }

  const std::string& file_;
  std::map<std::string, std::string> kinds_;         // element name by id
  std::map<std::string, std::size_t> array_counts_;  // numbers by id of the array
  std::map<std::string, const Element*> nodes_;      // by id
  std::map<std::string, double> instanced_;          // nodes that an instance of this one makes
  std::set<std::string> open_;                       // nodes whose instances are being counted
};

}  // namespace

void checkCollada(const std::string& file, const std::string& bytes) {
  tinyxml2::XMLDocument document;
  document.Parse(bytes.c_str(), bytes.size());
  if (document.Error())
    throw InputError(fmt::format("{}: not a readable dae mesh: not XML, line {}: {}; export it again", file, document.ErrorLineNum(),
                                 tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID())));
  const Element* root = document.RootElement();
  if (!root || std::string(root->Name()) != "COLLADA")
    throw InputError(fmt::format("{}: not a readable dae mesh: its outermost element is not <COLLADA>; export it again", file));
  ColladaCheck(file).run(*root);
}

}  // namespace blem_sim::model
