// Messages with sizes and places in them, given bytes that nobody vouches for.
#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <algorithm>
#include <cstring>

#include "clouds/cloud_message.h"
#include "fuzz/model_targets.h"

namespace blem_sim {

/** Numbers read one after the other; zeros when there are no bytes left. */
class FuzzBytes {
 public:
  FuzzBytes(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}
  template <typename Number>
  Number take() {
    Number number = 0;
    const std::size_t size = std::min(sizeof number, left_);
    if (size > 0) std::memcpy(&number, data_, size);
    data_ += size;
    left_ -= size;
    return number;
  }
  const std::uint8_t* begin() const { return data_; }
  const std::uint8_t* end() const { return data_ + left_; }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

/** A cloud's sizes, fields and points: four numbers of 32 bits, two bytes (byte order, number of fields), ten bytes a field, the points. */
inline void fuzzPoints(const std::uint8_t* data, std::size_t size) {
  static const char* const NAMES[] = {"x", "y", "z", "rgb", ""};
  FuzzBytes bytes(data, size);
  sensor_msgs::PointCloud2 cloud;
  for (std::uint32_t* number : {&cloud.width, &cloud.height, &cloud.point_step, &cloud.row_step}) *number = bytes.take<std::uint32_t>();
  cloud.is_bigendian = bytes.take<std::uint8_t>() & 1;
  cloud.fields.resize(bytes.take<std::uint8_t>() % 8);
  for (sensor_msgs::PointField& field : cloud.fields) {
    field.name = NAMES[bytes.take<std::uint8_t>() % 5];
    field.offset = bytes.take<std::uint32_t>();
    field.datatype = bytes.take<std::uint8_t>();
    field.count = bytes.take<std::uint32_t>();
  }
  cloud.data.assign(bytes.begin(), bytes.end());
  expectReadOrRefused([&] { node::pointsOf(cloud); });
}

}  // namespace blem_sim
