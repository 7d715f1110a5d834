// Numbers and names that Python gives.
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "blem_sim/geometry/types.h"

namespace blem_sim::python {

/** @param name of the argument, in messages @return none for None @throws InputError: it is no list of numbers */
std::vector<double> numbersOf(const pybind11::object& value, const std::string& name);
/** Rows of equal length; none for None. @throws InputError: it is no table of numbers */
std::vector<std::vector<double>> rowsOf(const pybind11::object& value, const std::string& name);
/** @throws InputError: it is not three numbers */
Vector3 vectorOf(const pybind11::object& value, const std::string& name);
/** @throws InputError: it is no list of texts */
std::vector<std::string> namesOf(const pybind11::object& value, const std::string& name);

}  // namespace blem_sim::python
