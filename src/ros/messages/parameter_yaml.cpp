#include "messages/parameter_yaml.h"

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <string>

#include "blem_sim/geometry/input_error.h"

namespace blem_sim::node {

namespace {

YAML::Node realNumber(double value) {
  if (std::isnan(value)) return YAML::Node(".nan");
  if (std::isinf(value)) return YAML::Node(value > 0 ? ".inf" : "-.inf");
  return YAML::Node(value);
}

}  // namespace

YAML::Node toYaml(XmlRpc::XmlRpcValue value) {
  using XmlRpc::XmlRpcValue;
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean:
      return YAML::Node(static_cast<bool>(value));
    case XmlRpcValue::TypeInt:
      return YAML::Node(static_cast<int>(value));
    case XmlRpcValue::TypeDouble:
      return realNumber(static_cast<double>(value));
    case XmlRpcValue::TypeString:
      return YAML::Node(static_cast<std::string>(value));
    case XmlRpcValue::TypeArray: {
      YAML::Node list(YAML::NodeType::Sequence);
      for (int i = 0; i < value.size(); ++i) list.push_back(toYaml(value[i]));
      return list;
    }
    case XmlRpcValue::TypeStruct: {
      YAML::Node map(YAML::NodeType::Map);
      for (auto& [name, member] : value) map[name] = toYaml(member);
      return map;
    }
    case XmlRpcValue::TypeInvalid:
      return YAML::Node(YAML::NodeType::Null);
    default:
      throw InputError("parameters: a date or binary data is no setting; quote it if it is meant as text");
  }
}

}  // namespace blem_sim::node
