// From a configuration to a world: files are loaded, names are checked, bodies are placed at their start poses.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "blem_sim/model/loaders.h"
#include "blem_sim/sim/config.h"
#include "build/file_stamp.h"
#include "build/load_watch.h"
#include "build/simulated_world.h"
#include "build/surface_library.h"

namespace blem_sim::sim {

/** Description of a robot or an object: a file, or a text. */
struct UrdfSource {
  std::string where;  ///< in messages
  std::string file, xml;
  std::string parameter;  ///< that the text came from, or empty
};

/** Adds models one by one. Each function throws InputError before it changes the world. */
class WorldBuilder {
 public:
  /** @param time_step [s] @param base_directory of relative files */
  WorldBuilder(const ContactConfig& contact, double time_step, std::string base_directory, const model::UriResolver& resolver, LoadLog log)
      : contact_(contact),
        base_directory_(std::move(base_directory)),
        resolver_(resolver),
        log_(std::move(log)),
        surfaces_(contact.mending, time_step) {}

  /** Lets later loads use what the other one has loaded and the world still holds, but files that were written since. Precondition: the
   *  resolvers are alike. */
  void learnFrom(const WorldBuilder& other);
  void addEnvironment(const EnvironmentConfig& config, SimulatedWorld* world);
  void addRobot(const RobotConfig& config, SimulatedWorld* world);
  void addObject(const ObjectConfig& config, SimulatedWorld* world);
  /** Description of a robot that is not added yet. @throws InputError */
  std::shared_ptr<const model::RobotModel> describe(const RobotConfig& config);
  /** @param time_step [s] of models to come */
  void setTimeStep(double time_step) { surfaces_.setTimeStep(time_step); }
  /** Lets later loads read files below these folders alone. */
  void restrictFiles(const model::FileRoots& roots) { resolver_.restrictTo(roots); }

 private:
  /** A description, and its files as they were read. */
  struct Described {
    std::weak_ptr<const model::RobotModel> model;
    std::vector<std::pair<std::string, FileStamp>> files;
  };

  void addMeshObject(const ObjectConfig& config, LoadWatch* watch, SimulatedWorld* world);
  void addUrdfObject(const ObjectConfig& config, LoadWatch* watch, SimulatedWorld* world);
  SharedSurface load(const std::string& uri, const Vector3& scale, const model::CloudOptions& cloud, const std::string& where,
                     LoadWatch* watch);
  /** @param watch may be null */
  std::shared_ptr<const model::RobotModel> description(const UrdfSource& urdf, LoadWatch* watch);

  const ContactConfig contact_;
  const std::string base_directory_;
  model::UriResolver resolver_;
  const LoadLog log_;
  SurfaceLibrary surfaces_;
  std::map<std::string, Described> descriptions_;  ///< by file, or by folder and text
};

}  // namespace blem_sim::sim
