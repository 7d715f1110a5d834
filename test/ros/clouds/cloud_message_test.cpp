// Messages with clouds: every layout that is legal, and fields that lie.
#include "clouds/cloud_message.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "support/input_errors.h"

namespace blem_sim::node {
namespace {

using sensor_msgs::PointCloud2;
using sensor_msgs::PointField;

PointField field(const std::string& name, std::uint32_t offset, std::uint8_t datatype) {
  PointField field;
  field.name = name;
  field.offset = offset;
  field.datatype = datatype;
  field.count = 1;
  return field;
}

/** Rows of points (column, row, 0.5) whose coordinates are Numbers, behind `gap` bytes, with `padding` bytes after each row. */
template <typename Number>
PointCloud2 cloudOf(std::uint32_t width, std::uint32_t height, std::uint32_t gap, std::uint32_t padding) {
  const std::uint8_t type = sizeof(Number) == 8 ? PointField::FLOAT64 : PointField::FLOAT32;
  PointCloud2 cloud;
  cloud.header.frame_id = "camera";
  cloud.width = width;
  cloud.height = height;
  // z first, then x and y behind the gap.
  cloud.fields = {field("rgb", 0, PointField::FLOAT32), field("z", 4, type), field("x", 4 + sizeof(Number) + gap, type),
                  field("y", 4 + 2 * sizeof(Number) + gap, type)};
  cloud.point_step = 4 + 3 * sizeof(Number) + gap;
  cloud.row_step = width * cloud.point_step + padding;
  cloud.data.assign(height * cloud.row_step, 0xFF);
  for (std::uint32_t row = 0; row < height; ++row) {
    for (std::uint32_t column = 0; column < width; ++column) {
      std::uint8_t* point = cloud.data.data() + row * cloud.row_step + column * cloud.point_step;
      const Number x = static_cast<Number>(column), y = static_cast<Number>(row), z = Number(0.5);
      std::memcpy(point + 4, &z, sizeof z);
      std::memcpy(point + 4 + sizeof(Number) + gap, &x, sizeof x);
      std::memcpy(point + 4 + 2 * sizeof(Number) + gap, &y, sizeof y);
    }
  }
  return cloud;
}

TEST(CloudMessage, AnyLegalLayoutIsRead) {
  for (const PointCloud2& cloud : {cloudOf<float>(5, 1, 0, 0), cloudOf<double>(5, 1, 0, 0), cloudOf<float>(5, 4, 3, 7),
                                   cloudOf<double>(5, 4, 13, 1), cloudOf<float>(1, 20, 0, 0)}) {
    const std::vector<Vector3> points = pointsOf(cloud);
    ASSERT_EQ(points.size(), std::size_t{cloud.width} * cloud.height);
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(points[i], Vector3(i % cloud.width, i / cloud.width, 0.5));
  }
}

TEST(CloudMessage, AGridKeepsThePlacesOfWhatWasNotMeasured) {
  PointCloud2 cloud = cloudOf<float>(5, 4, 0, 0);
  const float none = std::nanf("");
  std::memcpy(cloud.data.data() + 7 * cloud.point_step + 4, &none, sizeof none);
  EXPECT_EQ(pointsOf(cloud).size(), 19u);
  const std::vector<Vector3> points = pointsOf(cloud, true);
  ASSERT_EQ(points.size(), 20u);
  EXPECT_FALSE(points[7].allFinite());
  EXPECT_EQ(points[8], Vector3(3, 1, 0.5));
}

TEST(CloudMessage, TheLastRowNeedsNoPadding) {
  PointCloud2 cloud = cloudOf<float>(5, 4, 3, 7);
  cloud.data.resize(cloud.data.size() - 7);
  EXPECT_EQ(pointsOf(cloud).size(), 20u);
  cloud.data.pop_back();
  EXPECT_TRUE(isOneLineWith(refusal([&] { pointsOf(cloud); }), {"data", "bytes"}));
}

TEST(CloudMessage, PointsThatWereNotMeasuredAreLeftOut) {
  PointCloud2 cloud = cloudOf<float>(5, 2, 0, 0);
  const float bad[] = {NAN, INFINITY};
  for (int i = 0; i < 2; ++i) std::memcpy(cloud.data.data() + i * cloud.point_step + 4, &bad[i], 4);
  EXPECT_EQ(pointsOf(cloud).size(), 8u);
  for (int i = 0; i < 10; ++i) std::memcpy(cloud.data.data() + i * cloud.point_step + 4, &bad[0], 4);
  EXPECT_TRUE(isOneLineWith(refusal([&] { pointsOf(cloud); }), {"10", "finite"}));
}

struct Lie {
  const char* name;
  void (*tell)(PointCloud2*);
  std::vector<std::string> words;
};

TEST(CloudMessage, LiesAreRefusedInOneLine) {
  const Lie lies[] = {
      {"no point", [](PointCloud2* c) { c->width = 0; }, {"width 0", "no point"}},
      {"no row", [](PointCloud2* c) { c->height = 0; }, {"height 0"}},
      {"step of 0", [](PointCloud2* c) { c->point_step = 0; }, {"point_step"}},
      {"overflow to 0", [](PointCloud2* c) { c->width = c->height = 1U << 16; }, {"more than", "4294967296"}},
      {"overflow of all", [](PointCloud2* c) { c->width = c->height = 0xFFFFFFFF; }, {"more than"}},
      {"1e8 points", [](PointCloud2* c) { c->width = 100000000, c->height = 1; }, {"100000000", "more than"}},
      {"rows of 0", [](PointCloud2* c) { c->row_step = 0; }, {"row_step"}},
      {"short rows", [](PointCloud2* c) { c->row_step = 5 * c->point_step - 1; }, {"row_step"}},
      {"long rows", [](PointCloud2* c) { c->row_step = 0xFFFFFFFF; }, {"data"}},
      {"short data", [](PointCloud2* c) { c->data.resize(10); }, {"data", "10"}},
      {"no data", [](PointCloud2* c) { c->data.clear(); }, {"data"}},
      {"more points than data", [](PointCloud2* c) { c->height = 1000; }, {"data"}},
      {"big-endian", [](PointCloud2* c) { c->is_bigendian = true; }, {"is_bigendian"}},
      {"no x", [](PointCloud2* c) { c->fields[2].name = "X"; }, {"no field x"}},
      {"no fields", [](PointCloud2* c) { c->fields.clear(); }, {"no field x"}},
      {"integers", [](PointCloud2* c) { c->fields[1].datatype = PointField::INT32; }, {"field z", "float"}},
      {"unknown type", [](PointCloud2* c) { c->fields[1].datatype = 99; }, {"field z", "99"}},
      {"arrays", [](PointCloud2* c) { c->fields[1].count = 3; }, {"field z", "count"}},
      {"outside the point", [](PointCloud2* c) { c->fields[3].offset = c->point_step - 3; }, {"field y", "point_step"}},
      {"offset that wraps", [](PointCloud2* c) { c->fields[3].offset = 0xFFFFFFFE; }, {"field y", "point_step"}},
  };
  for (const Lie& lie : lies) {
    PointCloud2 cloud = cloudOf<float>(5, 4, 0, 0);
    lie.tell(&cloud);
    const std::string text = refusal([&] { pointsOf(cloud); });
    EXPECT_TRUE(isOneLineWith(text, lie.words)) << lie.name << ": " << text;
  }
}

}  // namespace
}  // namespace blem_sim::node
