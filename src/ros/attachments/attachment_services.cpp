#include "attachments/attachment_services.h"

#include <blem_sim/Attach.h>
#include <blem_sim/Detach.h>

#include <limits>

#include "blem_sim/sim/named_parts.h"

namespace blem_sim::node {

namespace {

/** A limit that a request leaves at 0 is none. */
double limitOf(double limit) { return limit == 0 ? std::numeric_limits<double>::infinity() : limit; }

}  // namespace

AttachmentServices::AttachmentServices(const ros::NodeHandle& private_node, sim::Simulator* simulator) : services_(private_node) {
  services_.add<Attach>("attach", [simulator](const auto& request, auto*) {
    simulator->attach(request.object_name, sim::findLink(*simulator, request.link_name, "link_name"), limitOf(request.max_force),
                      limitOf(request.max_torque));
  });
  services_.add<Detach>("detach", [simulator](const auto& request, auto*) { simulator->detach(request.object_name); });
}

}  // namespace blem_sim::node
