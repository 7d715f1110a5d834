// Reads the values of one <gazebo>, <sensor> or <plugin>, and notes what nobody asked for. Nothing here throws.
#pragma once

#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "blem_sim/model/gazebo_blocks.h"
#include "config/yaml_reader.h"
#include "gazebo/gazebo_notes.h"

namespace blem_sim::sim {

class GazeboReader {
 public:
  GazeboReader(const model::GazeboBlock& block, GazeboNotes* notes) : block_(block), notes_(*notes) {}

  /** The first text at a path, known from now on; nothing if there is none. */
  std::optional<std::string> text(const std::string& path);
  void read(const std::string& path, std::string* value);
  /** Numbers that are none, or out of range, are noted and leave the value as it is. */
  void read(const std::string& path, double* value, const NumberRange& range);
  void read(const std::string& path, std::optional<double>* value, const NumberRange& range);
  void read(const std::string& path, int* value, const NumberRange& range);
  void read(const std::string& path, std::optional<bool>* value);
  void read(const std::string& path, Vector3* value);
  /** "x y z roll pitch yaw" */
  void read(const std::string& path, Pose* value);

  /** Marks elements, with all that is in them, as known. */
  void skip(std::initializer_list<const char*> paths);
  /** The same for elements that have nothing to act on here. */
  void skipWithoutEffect(std::initializer_list<const char*> paths);
  /** The same for numbers that are not simulated, if they are 0; others are noted as not read. */
  void skipZeros(std::initializer_list<const char*> paths);
  /** Notes what nobody asked for. */
  void finish() const;

  /** Notes that an element cannot be used. */
  void fault(const std::string& path, const std::string& why) const;
  /** The block in words, for notes. */
  std::string where() const;
  GazeboNotes& notes() const { return notes_; }
  const model::GazeboBlock& block() const { return block_; }

 private:
  bool skipOne(const std::string& path);
  std::optional<std::vector<double>> numbers(const std::string& path, std::size_t count);

  const model::GazeboBlock& block_;
  GazeboNotes& notes_;
  std::set<std::string> known_;
};

}  // namespace blem_sim::sim
