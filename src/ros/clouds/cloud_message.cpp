#include "clouds/cloud_message.h"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <limits>

#include "blem_sim/geometry/input_error.h"

namespace blem_sim::node {
namespace {

using sensor_msgs::PointCloud2;
using sensor_msgs::PointField;

/** A coordinate in a point's bytes. */
struct Coordinate {
  std::uint32_t offset;
  bool is_double;

  double of(const std::uint8_t* point) const { return is_double ? read<double>(point) : read<float>(point); }

 private:
  template <typename Number>
  double read(const std::uint8_t* point) const {
    Number number;
    std::memcpy(&number, point + offset, sizeof number);
    return static_cast<double>(number);
  }
};

Coordinate coordinateOf(const PointCloud2& cloud, const std::string& name) {
  for (const PointField& field : cloud.fields) {
    if (field.name != name) continue;
    const bool is_double = field.datatype == PointField::FLOAT64;
    if (!is_double && field.datatype != PointField::FLOAT32)
      throw InputError(fmt::format("field {}: datatype {} is no float32 or float64", name, field.datatype));
    if (field.count > 1) throw InputError(fmt::format("field {}: count {} is not 1", name, field.count));
    const std::uint64_t end = std::uint64_t{field.offset} + (is_double ? sizeof(double) : sizeof(float));
    if (end > cloud.point_step)
      throw InputError(fmt::format("field {}: ends at byte {} of points of {} bytes (point_step)", name, end, cloud.point_step));
    return {field.offset, is_double};
  }
  throw InputError(fmt::format("there is no field {}; send x, y and z in metres", name));
}

/** Number of points. */
std::uint64_t checkSizes(const PointCloud2& cloud) {
  const std::uint64_t points = std::uint64_t{cloud.width} * cloud.height;
  if (points == 0) throw InputError(fmt::format("width {} and height {}: there is no point", cloud.width, cloud.height));
  if (points > MOST_CLOUD_POINTS)
    throw InputError(
        fmt::format("width {} and height {}: {} points are more than the {} that are taken; thin the cloud out before it is sent",
                    cloud.width, cloud.height, points, MOST_CLOUD_POINTS));
  if (cloud.is_bigendian) throw InputError("is_bigendian: send little-endian numbers");
  if (cloud.point_step == 0) throw InputError("point_step: is 0");
  const std::uint64_t row = std::uint64_t{cloud.width} * cloud.point_step;
  if (cloud.row_step < row) throw InputError(fmt::format("row_step: {} is less than width times point_step, {}", cloud.row_step, row));
  const std::uint64_t claimed = (std::uint64_t{cloud.height} - 1) * cloud.row_step + row;
  if (cloud.data.size() < claimed) throw InputError(fmt::format("data: has {} bytes of {}", cloud.data.size(), claimed));
  return points;
}

}  // namespace

std::vector<Vector3> pointsOf(const PointCloud2& cloud, bool all) {
  const std::uint64_t count = checkSizes(cloud);
  const std::array<Coordinate, 3> xyz = {coordinateOf(cloud, "x"), coordinateOf(cloud, "y"), coordinateOf(cloud, "z")};
  std::vector<Vector3> points;
  points.reserve(count);
  std::uint64_t measured = 0;
  for (std::uint64_t row = 0; row < cloud.height; ++row) {
    const std::uint8_t* point = cloud.data.data() + row * cloud.row_step;
    for (std::uint32_t column = 0; column < cloud.width; ++column, point += cloud.point_step) {
      const Vector3 p(xyz[0].of(point), xyz[1].of(point), xyz[2].of(point));
      measured += p.allFinite() ? 1 : 0;
      if (p.allFinite())
        points.push_back(p);
      else if (all)
        points.push_back(Vector3::Constant(std::numeric_limits<double>::quiet_NaN()));
    }
  }
  if (measured == 0) throw InputError(fmt::format("none of its {} points is finite", count));
  return points;
}

}  // namespace blem_sim::node
