#include "numbers_of.h"

#include <fmt/format.h>
#include <pybind11/numpy.h>

#include "blem_sim/geometry/input_error.h"

namespace py = pybind11;

namespace blem_sim::python {

namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

Array arrayOf(const py::object& value, const std::string& name, Py_ssize_t dimensions) {
  const Array array = Array::ensure(value);
  if (!array) throw InputError(fmt::format("{}: must be numbers, in an array or a list", name));
  if (array.ndim() != dimensions)
    throw InputError(fmt::format("{}: must have {} dimension{}, not {}", name, dimensions, dimensions == 1 ? "" : "s", array.ndim()));
  return array;
}

}  // namespace

std::vector<double> numbersOf(const py::object& value, const std::string& name) {
  if (value.is_none()) return {};
  const Array array = arrayOf(value, name, 1);
  return std::vector<double>(array.data(), array.data() + array.size());
}

std::vector<std::vector<double>> rowsOf(const py::object& value, const std::string& name) {
  std::vector<std::vector<double>> rows;
  if (value.is_none()) return rows;
  const Array array = arrayOf(value, name, 2);
  for (Py_ssize_t row = 0; row < array.shape(0); ++row)
    rows.emplace_back(array.data() + row * array.shape(1), array.data() + (row + 1) * array.shape(1));
  return rows;
}

Vector3 vectorOf(const py::object& value, const std::string& name) {
  const std::vector<double> numbers = numbersOf(value, name);
  if (numbers.size() != 3) throw InputError(fmt::format("{}: must be three numbers, not {}", name, numbers.size()));
  return Vector3(numbers[0], numbers[1], numbers[2]);
}

std::vector<std::string> namesOf(const py::object& value, const std::string& name) {
  std::vector<std::string> names;
  if (py::isinstance<py::str>(value) || !py::isinstance<py::sequence>(value))
    throw InputError(fmt::format("{}: must be a list of names", name));
  for (const py::handle& item : py::reinterpret_borrow<py::sequence>(value)) {
    if (!py::isinstance<py::str>(item)) throw InputError(fmt::format("{}: must be a list of names", name));
    names.push_back(py::cast<std::string>(item));
  }
  return names;
}

}  // namespace blem_sim::python
