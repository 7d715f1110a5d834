// Values of the parameter server as YAML.
#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

namespace YAML {
class Node;
}

namespace blem_sim::node {

/** Parameters are YAML that has been through XML-RPC; this is the way back. @throws InputError: dates and binary data, which no key takes
 */
YAML::Node toYaml(XmlRpc::XmlRpcValue value);

}  // namespace blem_sim::node
