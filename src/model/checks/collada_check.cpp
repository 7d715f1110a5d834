#include <tinyxml2.h>

#include <cstdint>
#include <map>
#include <sstream>

#include <fmt/format.h>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/geometry/one_line.h"
#include "checks/file_check.h"

namespace blem_sim::model {
namespace {

using Element = tinyxml2::XMLElement;

/** Looks through a document once for its ids and counts, once for the references to them. */
class ColladaCheck {
 public:
  explicit ColladaCheck(const std::string& file) : file_(file) {}

  void run(const Element& root) {
    collect(root);
    const Element* scene = root.FirstChildElement("scene");
    if (!scene || !scene->FirstChildElement("instance_visual_scene")) refuse("it has no <scene> with an <instance_visual_scene>");
    checkReferences(root);
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
    if (const char* id = element.Attribute("id")) kinds_[id] = name;
    if (name == "float_array") checkArray(element);
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
