// A hash of a thing's content, word by word.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "blem_sim/geometry/types.h"

namespace blem_sim::sim {

/** 64 bits. Every word is mixed in by a bijection, so that two contents of the same length that differ in one word never have the same. */
class ContentHash {
 public:
  ContentHash& add(std::uint64_t word) {
    hash_ = (hash_ ^ word) * 0x9e3779b97f4a7c15u;
    hash_ ^= hash_ >> 32;
    return *this;
  }
  ContentHash& add(double number) {
    std::uint64_t bits;
    std::memcpy(&bits, &number, sizeof bits);
    return add(bits);
  }
  ContentHash& add(int number) { return add(static_cast<std::uint64_t>(number)); }
  ContentHash& add(bool flag) { return add(static_cast<std::uint64_t>(flag)); }
  ContentHash& add(const std::string& text) {
    for (const unsigned char c : text) add(static_cast<std::uint64_t>(c));
    return add(static_cast<std::uint64_t>(text.size()));
  }
  template <typename Derived>
  ContentHash& add(const Eigen::MatrixBase<Derived>& matrix) {
    for (int column = 0; column < matrix.cols(); ++column)
      for (int row = 0; row < matrix.rows(); ++row) add(matrix(row, column));
    return *this;
  }
  ContentHash& add(const Pose& pose) { return add(pose.matrix()); }
  template <typename Item>
  ContentHash& add(const std::vector<Item>& items) {
    add(static_cast<std::uint64_t>(items.size()));
    for (const Item& item : items) add(item);
    return *this;
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

}  // namespace blem_sim::sim
