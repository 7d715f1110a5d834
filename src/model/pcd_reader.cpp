#include <pcl/PCLPointCloud2.h>
#include <pcl/io/pcd_io.h>

#include <cstdint>
#include <cstring>

#include <fmt/format.h>

#include "blem_sim/geometry/input_error.h"
#include "checks/file_check.h"
#include "clouds/quiet_pcl.h"
#include "soup/surface_soup.h"

namespace blem_sim::model {
namespace {

const pcl::PCLPointField& coordinateField(const std::string& file, const pcl::PCLPointCloud2& cloud, const std::string& name) {
  for (const pcl::PCLPointField& field : cloud.fields) {
    if (field.name != name) continue;
    if (field.datatype == pcl::PCLPointField::FLOAT32 || field.datatype == pcl::PCLPointField::FLOAT64) return field;
    throw InputError(fmt::format("{}: field '{}' is not a float; write x, y and z as float or double in metres", file, name));
  }
  throw InputError(fmt::format("{}: there is no field '{}'; write x, y and z as float or double in metres", file, name));
}

double coordinate(const std::uint8_t* point, const pcl::PCLPointField& field) {
  if (field.datatype == pcl::PCLPointField::FLOAT64) {
    double value = 0;
    std::memcpy(&value, point + field.offset, sizeof(value));
    return value;
  }
  float value = 0;
  std::memcpy(&value, point + field.offset, sizeof(value));
  return value;
}

pcl::PCLPointCloud2 readCloud(const std::string& file, Eigen::Vector4f* origin, Eigen::Quaternionf* orientation) {
  pcl::PCLPointCloud2 cloud;
  const QuietPcl quiet;
  int version = 0;
  try {
    if (pcl::PCDReader().read(file, cloud, *origin, *orientation, version) < 0)
      throw InputError(file + ": truncated or damaged PCD; record the cloud again");
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: not a readable PCD: {}; record the cloud again", file, error.what()));
  }
  return cloud;
}

}  // namespace

SurfaceSoup readPcd(const std::string& file) {
  checkPcd(file, readBytes(file));
  Eigen::Vector4f origin = Eigen::Vector4f::Zero();
  Eigen::Quaternionf orientation = Eigen::Quaternionf::Identity();
  const pcl::PCLPointCloud2 cloud = readCloud(file, &origin, &orientation);
  const pcl::PCLPointField& x = coordinateField(file, cloud, "x");
  const pcl::PCLPointField& y = coordinateField(file, cloud, "y");
  const pcl::PCLPointField& z = coordinateField(file, cloud, "z");
  SurfaceSoup soup;
  soup.width = static_cast<int>(cloud.width);
  soup.height = static_cast<int>(cloud.height);
  const std::size_t count = std::size_t{cloud.width} * cloud.height;
  if (cloud.data.size() < count * cloud.point_step) throw InputError(file + ": truncated PCD; record the cloud again");
  soup.mesh.vertices.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* point = cloud.data.data() + i * cloud.point_step;
    soup.mesh.vertices.emplace_back(coordinate(point, x), coordinate(point, y), coordinate(point, z));
  }
  if (!origin.head<3>().isZero(0) || !orientation.coeffs().isApprox(Eigen::Quaternionf::Identity().coeffs()))
    soup.notes.push_back("the sensor's VIEWPOINT is not applied: coordinates are taken as they stand");
  if (!origin.head<3>().isZero(0)) soup.viewpoint = origin.head<3>().cast<double>();
  return soup;
}

}  // namespace blem_sim::model
