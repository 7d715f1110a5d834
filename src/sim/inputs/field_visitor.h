// Walk through the fields of what calls take, one list of fields for writing and for reading.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "blem_sim/geometry/types.h"

namespace blem_sim::sim {

/**
 * Composes fields of numbers and texts. @tparam Visitor has number(double*), integer(int*), text(std::string*), and count(std::size_t),
 * which takes a length to be written and returns the one to go on with, and check(const Pose&)
 */
template <typename Visitor>
class FieldVisitor {
 public:
  template <typename... Fields>
  void operator()(Fields&... fields) {
    (one(&fields), ...);
  }
  /** An enumerator, one of the first `count`. */
  template <typename Enum>
  void choice(Enum* value, int count) {
    auto number = static_cast<int>(*value);
    self().integer(&number, 0, count - 1);
    *value = static_cast<Enum>(number);
  }

 private:
  Visitor& self() { return static_cast<Visitor&>(*this); }

  void one(double* value) { self().number(value); }
  void one(int* value) { self().integer(value); }
  void one(std::string* value) { self().text(value); }
  void one(bool* value) {
    int number = *value ? 1 : 0;
    self().integer(&number, 0, 1);
    *value = number == 1;
  }
  void one(std::size_t* value) {
    auto number = static_cast<int>(*value);
    self().integer(&number, 0, 1 << 30);
    *value = static_cast<std::size_t>(number);
  }
  template <typename Number, int rows, int columns>
  void one(Eigen::Matrix<Number, rows, columns>* matrix) {
    for (int i = 0; i < rows * columns; ++i) one(matrix->data() + i);
  }
  void one(Pose* pose) {
    for (int i = 0; i < 12; ++i) one(pose->matrix().data() + i + i / 3);  // without the last row
    self().check(*pose);
  }
  template <typename T>
  void one(std::vector<T>* values) {
    values->resize(self().count(values->size()));
    for (T& value : *values) one(&value);
  }
  template <typename A, typename B>
  void one(std::pair<A, B>* both) {
    one(&both->first);
    one(&both->second);
  }
  template <typename T>
  void one(std::map<std::string, T>* values) {
    std::vector<std::pair<std::string, T>> rows(values->begin(), values->end());
    one(&rows);
    *values = std::map<std::string, T>(rows.begin(), rows.end());
  }
  template <typename T>
  void one(std::optional<T>* value) {
    bool given = value->has_value();
    one(&given);
    if (!given) return value->reset();
    if (!value->has_value()) value->emplace();
    one(&**value);
  }
  template <typename Struct>
  void one(Struct* value) {
    visitFields(self(), *value);
  }
};

}  // namespace blem_sim::sim
