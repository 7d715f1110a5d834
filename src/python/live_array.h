// Arrays of numpy that show a simulation as it goes on.
#pragma once

#include <pybind11/numpy.h>

#include <memory>
#include <vector>

namespace blem_sim::python {

/**
 * Memory of numbers in rows, and the one array of numpy that shows it. The array keeps the memory alive, may outlive its maker, and cannot
 * be written by Python.
 */
class LiveArray {
 public:
  /** @param width numbers of a row; 0: the array has one dimension */
  LiveArray(std::size_t rows, std::size_t width) : memory_(std::make_shared<std::vector<double>>(rows * (width ? width : 1))) {
    memory_->reserve(1);  // of an array without rows, too, which else would be numpy's own
    using Memory = std::shared_ptr<std::vector<double>>;
    const pybind11::capsule keeper(new Memory(memory_), [](void* memory) { delete static_cast<Memory*>(memory); });
    std::vector<Py_ssize_t> shape{static_cast<Py_ssize_t>(rows)};
    if (width) shape.push_back(static_cast<Py_ssize_t>(width));
    array_ = pybind11::array_t<double>(shape, memory_->data(), keeper);
    array_.attr("setflags")(pybind11::arg("write") = false);
  }

  double* data() { return memory_->data(); }
  const pybind11::array& array() const { return array_; }

 private:
  std::shared_ptr<std::vector<double>> memory_;
  pybind11::array array_;
};

}  // namespace blem_sim::python
