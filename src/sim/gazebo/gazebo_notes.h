// Words on the <gazebo> blocks of one robot: a line for each list, however much is in it.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace blem_sim::sim {

class GazeboNotes {
 public:
  /** @param source of the URDF, in messages */
  explicit GazeboNotes(std::string source) : source_(std::move(source)) {}

  /** Something that is not read. @param where the block @param what in words, such as <fudge> */
  void unknown(const std::string& where, const std::string& what) { unknown_.add(shortened(where + " " + what)); }
  /** A known element that has nothing to act on here. */
  void withoutEffect(const std::string& element) { without_effect_.add(element); }
  /** Something that cannot be used, and the cure. */
  void fault(const std::string& where, const std::string& why) {
    faults_.push_back(source_ + ": " + shortened(where) + ": " + shortened(why));
  }
  /** A link whose friction along the second direction is another one. */
  void anisotropic(const std::string& link) { anisotropic_.add(link); }
  /** A sensor that was made. @param words its name and kind */
  void sensor(const std::string& words) { sensors_.add(words); }

  /** A drive that was made. @param words its name and topic */
  void drive(const std::string& words) { drives_.add(words); }

  std::vector<std::string> lines() const;

 private:
  /** The beginning of what is absurdly long. */
  static std::string shortened(const std::string& words);

  /** Names once each, in the order they came. */
  class List {
   public:
    void add(const std::string& name) {
      if (known_.insert(name).second) names_.push_back(name);
    }
    /** Adds "BEGINNING: a, b and N more; END" unless it is empty. */
    void tell(const std::string& beginning, const std::string& end, std::vector<std::string>* lines) const;

   private:
    std::vector<std::string> names_;
    std::set<std::string> known_;
  };

  std::string source_;
  List unknown_, without_effect_, anisotropic_, sensors_, drives_;
  std::vector<std::string> faults_;
};

}  // namespace blem_sim::sim
