#include "checks/urdf_gazebo.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cstddef>

#include "blem_sim/geometry/one_line.h"

namespace blem_sim::model {
namespace {

using Element = tinyxml2::XMLElement;

constexpr std::size_t LONGEST_NAME = 100, LONGEST_TEXT = 1000;  // characters kept
constexpr int DEEPEST = 12;                                     // elements below a block
constexpr int MOST_VALUES = 30000, MOST_BLOCKS = 10000;         // of a robot

std::string trimmed(const char* text, std::size_t longest) {
  const std::string all = geometry::oneLine(text ? text : "");
  const std::size_t first = all.find_first_not_of(' ');
  if (first == std::string::npos) return "";
  return all.substr(first, std::min(all.find_last_not_of(' ') + 1 - first, longest));
}

bool isBlock(const Element& element) {
  const std::string name = element.Name();
  return name == "sensor" || name == "plugin";
}

/** Copies blocks until there are too many of them. */
class BlockReader {
 public:
  GazeboBlock block(const Element& element, const std::string& reference) {
    GazeboBlock block;
    block.element = trimmed(element.Name(), LONGEST_NAME);
    block.type = trimmed(element.Attribute(block.element == "plugin" ? "filename" : "type"), LONGEST_NAME);
    block.name = trimmed(element.Attribute("name"), LONGEST_NAME);
    block.reference = reference;
    ++blocks_;
    addChildren(element, "", 0, &block);
    return block;
  }

  bool full() const { return values_ >= MOST_VALUES || blocks_ >= MOST_BLOCKS; }
  int leftOut() const { return left_out_; }

 private:
  void addChildren(const Element& element, const std::string& path, int depth, GazeboBlock* block) {
    for (const Element* child = element.FirstChildElement(); child; child = child->NextSiblingElement()) {
      if (full() || depth == DEEPEST)
        ++left_out_;
      else if (isBlock(*child))
        block->blocks.push_back(this->block(*child, block->reference));
      else
        addElement(*child, path + trimmed(child->Name(), LONGEST_NAME), depth + 1, block);
    }
  }

  /** Adds an element's attributes, its text if it has one, and what is inside. */
  void addElement(const Element& element, const std::string& path, int depth, GazeboBlock* block) {
    const char* value = nullptr;
    for (const tinyxml2::XMLAttribute* a = element.FirstAttribute(); a && !full(); a = a->Next()) {
      const std::string name = trimmed(a->Name(), LONGEST_NAME);
      if (name == "value")
        value = a->Value();
      else
        add(path + "/" + name, a->Value(), block);
    }
    if (value || !element.FirstChildElement()) add(path, value ? value : element.GetText(), block);
    addChildren(element, path + "/", depth, block);
  }

  void add(const std::string& path, const char* text, GazeboBlock* block) {
    block->values.push_back({path, trimmed(text, LONGEST_TEXT)});
    ++values_;
  }

  int values_ = 0, blocks_ = 0, left_out_ = 0;
};

}  // namespace

std::vector<GazeboBlock> readGazeboBlocks(const Element& robot, std::vector<std::string>* notes) {
  BlockReader reader;
  std::vector<GazeboBlock> blocks;
  int left_out = 0;
  for (const Element* child = robot.FirstChildElement("gazebo"); child; child = child->NextSiblingElement("gazebo")) {
    if (reader.full())
      ++left_out;
    else
      blocks.push_back(reader.block(*child, trimmed(child->Attribute("reference"), LONGEST_NAME)));
  }
  left_out += reader.leftOut();
  if (left_out > 0)
    notes->push_back(fmt::format("<gazebo>: {} elements left out: too deep, or too many; at most {} deep, {} values and {} blocks are read",
                                 left_out, DEEPEST, MOST_VALUES, MOST_BLOCKS));
  return blocks;
}

}  // namespace blem_sim::model
