// The sections of a configuration, one reader each; config_parser.cpp puts them together.
#pragma once

#include "blem_sim/sim/config.h"
#include "config/yaml_reader.h"

namespace blem_sim::sim {

ContactConfig readContact(YamlReader reader);
dynamics::SolverSettings readSolver(YamlReader reader);
/** Reads those given of boundary_width, friction, restitution, impact_friction_factor, impact_friction_speed, stiffness, damping, shrink.
 */
ContactOverrides readContactOverrides(YamlReader& reader);
model::CloudOptions readCloud(YamlReader reader);
/** Keys of an environment with a topic. @param cloud its points' settings */
LiveConfig readLive(YamlReader& environment, const model::CloudOptions& cloud);
/** A name that models may bear: given, not empty, without "::". */
std::string readName(YamlReader& reader);
/** One number or three, none of them 0. */
void readScale(YamlReader& reader, Vector3* scale);

EnvironmentConfig readEnvironment(YamlReader& reader);
ObjectConfig readObject(YamlReader& reader);
RobotConfig readRobot(YamlReader& reader);
std::vector<SensorConfig> readSensors(YamlReader& robot);
/** Nothing if the robot names none. */
std::optional<std::vector<ControllerConfig>> readControllers(YamlReader& robot);
/** Keys of a drive, its name and type apart. */
void readDrive(YamlReader& reader, ControllerConfig* config);
const std::vector<std::string>& driveKeys(ControllerKind kind);

/** parseConfig that also tells which keys it knows, as "robots[].gains.*.p"; of a list or map only if the node holds one. */
SimulationConfig parseConfig(const YAML::Node& root, const std::string& source, const std::string& base_directory,
                             std::set<std::string>* known_keys);

}  // namespace blem_sim::sim
