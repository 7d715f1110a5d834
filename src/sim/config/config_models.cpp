#include "config/config_sections.h"

namespace blem_sim::sim {

namespace {

/** Texts of which exactly one must be given. */
void requireOneOf(YamlReader& reader, const std::vector<std::string>& keys) {
  int given = 0;
  std::string list;
  for (const std::string& key : keys) {
    given += reader.has(key) ? 1 : 0;
    list += (list.empty() ? "" : key == keys.back() ? " or " : ", ") + key;
  }
  if (given != 1) reader.refuse("", "needs exactly one of " + list + (given ? ", not several" : ""));
}

std::optional<Matrix3> readInertia(YamlReader& reader) {
  const auto given = reader.numbers("inertia", 6);
  if (!given) return std::nullopt;
  const double ixx = (*given)[0], ixy = (*given)[1], ixz = (*given)[2], iyy = (*given)[3], iyz = (*given)[4], izz = (*given)[5];
  Matrix3 inertia;
  inertia << ixx, ixy, ixz, ixy, iyy, iyz, ixz, iyz, izz;
  if (!(ixx > 0) || !(iyy > 0) || !(izz > 0) || !(inertia.determinant() > 0) || !(ixx * iyy - ixy * ixy > 0))
    reader.refuse("inertia", "must be positive definite: [ixx, ixy, ixz, iyy, iyz, izz] about the centre of mass");
  return inertia;
}

}  // namespace

std::string readName(YamlReader& reader) {
  std::string name;
  reader.read("name", &name);
  if (name.empty()) reader.refuse("name", "is missing; give every robot, object, environment and sensor a name");
  if (name.find("::") != std::string::npos) reader.refuse("name", "must not hold '::', which separates model and link");
  return name;
}

void readScale(YamlReader& reader, Vector3* scale) {
  const YAML::Node given = reader.node("scale");
  if (given.IsDefined() && given.IsScalar()) {
    double all = 1;
    reader.read("scale", &all, NumberRange::any());
    *scale = Vector3::Constant(all);
  } else {
    reader.read("scale", scale);
  }
  if ((scale->array() == 0).any()) reader.refuse("scale", "must not hold 0, which would flatten the mesh");
}

EnvironmentConfig readEnvironment(YamlReader& reader) {
  EnvironmentConfig environment;
  environment.name = readName(reader);
  requireOneOf(reader, {"uri", "plane", "topic"});
  reader.read("uri", &environment.uri);
  if (const auto plane = reader.numbers("plane", 4)) {
    environment.plane = Eigen::Vector4d((*plane)[0], (*plane)[1], (*plane)[2], (*plane)[3]);
    if (environment.plane->head<3>().norm() == 0) reader.refuse("plane", "needs a normal: [a, b, c, d] for a x + b y + c z = d");
  }
  reader.read("pose", &environment.X_WE);
  readScale(reader, &environment.scale);
  environment.cloud = readCloud(reader.section("cloud"));
  environment.live = readLive(reader, environment.cloud);
  environment.contact = readContactOverrides(reader);
  return environment;
}

ObjectConfig readObject(YamlReader& reader) {
  ObjectConfig object;
  object.name = readName(reader);
  requireOneOf(reader, {"uri", "urdf"});
  reader.read("uri", &object.uri);
  reader.read("urdf", &object.urdf);
  readScale(reader, &object.scale);
  reader.read("mesh_pose", &object.X_OM);
  reader.read("pose", &object.X_WO);
  reader.read("mass", &object.mass, NumberRange::positive());
  if (object.urdf.empty() && !object.mass) reader.refuse("mass", "is missing; give it in kg");
  reader.read("com", &object.com);
  object.inertia = readInertia(reader);
  reader.read("linear_velocity", &object.linear_velocity);
  reader.read("angular_velocity", &object.angular_velocity);
  object.cloud = readCloud(reader.section("cloud"));
  object.contact = readContactOverrides(reader);
  reader.read("max_contacts_per_object", &object.max_contacts, 1);
  return object;
}

}  // namespace blem_sim::sim
