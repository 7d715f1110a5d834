#include "gazebo/gazebo_noise.h"

#include <fmt/format.h>

#include <cmath>

namespace blem_sim::sim {
namespace {

/** Takes the number of larger size. @return whether they differ */
bool takeLarger(double GazeboNoise::*number, const GazeboNoise& axis, GazeboNoise* largest) {
  const bool differ = axis.*number != largest->*number;
  if (std::abs(axis.*number) > std::abs(largest->*number)) largest->*number = axis.*number;
  return differ;
}

}  // namespace

GazeboNoise readNoise(GazeboReader* reader, const std::string& path, const std::string& type_path) {
  GazeboNoise noise;
  reader->read(path + "/mean", &noise.mean, NumberRange::bias());
  reader->read(path + "/stddev", &noise.stddev, NumberRange::deviation());
  reader->read(path + "/bias_mean", &noise.bias_mean, NumberRange::bias());
  reader->read(path + "/bias_stddev", &noise.bias_stddev, NumberRange::deviation());
  const std::string type = reader->text(type_path).value_or("gaussian");
  if (type == "gaussian") return noise;
  if (type != "none") reader->fault(type_path, fmt::format("'{}' is not known; the noise is left out: write gaussian", type));
  return {};
}

GazeboNoise readAxes(GazeboReader* reader, const std::vector<std::string>& axes, const std::string& what) {
  GazeboNoise largest;
  bool first = true, differ = false;
  for (const std::string& axis : axes) {
    const GazeboNoise noise = readNoise(reader, axis + "/noise", axis + "/noise/type");
    if (first) largest = noise;
    first = false;
    for (const auto number : {&GazeboNoise::mean, &GazeboNoise::stddev, &GazeboNoise::bias_mean, &GazeboNoise::bias_stddev})
      differ = takeLarger(number, noise, &largest) || differ;
  }
  if (differ) reader->fault(what, "its axes have different noise; the largest is taken for all: give all the same");
  return largest;
}

}  // namespace blem_sim::sim
