// Configuration of a simulation as Python gives it: a file, a YAML text or a dictionary.
#pragma once

#include <pybind11/pybind11.h>

#include <map>
#include <string>

#include "blem_sim/sim/config.h"

namespace blem_sim::python {

/** Places and settings beside a configuration. */
struct ConfigPlaces {
  pybind11::object folder;    ///< of relative files; None: that of the file, or the working directory
  pybind11::object settings;  ///< {"key.path": value}, replaced before it is read; None: none
};

/**
 * @param config path, or text if it holds a line break or begins with {, or dictionary
 * @throws InputError for what it is refused for, in one line
 */
sim::SimulationConfig configOf(const pybind11::object& config, const ConfigPlaces& places);

/** @param value a text or an os.PathLike @param name of the argument, in messages @throws InputError: it is neither */
std::string pathOf(const pybind11::handle& value, const std::string& name);

/** @param packages {name: folder}, or None @throws InputError */
std::map<std::string, std::string> packagesOf(const pybind11::object& packages);

}  // namespace blem_sim::python
