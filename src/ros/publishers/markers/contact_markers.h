#pragma once

#include <ros/node_handle.h>

#include <boost/shared_ptr.hpp>

#include <vector>

#include "blem_sim/sim/step_report.h"
#include "sending/listened_publisher.h"

namespace blem_sim::node {

/** The contacts that acted in a step. */
struct StampedContacts {
  ros::Time stamp;
  std::vector<sim::ContactReport> contacts;
};

/** Publishes contacts as points and force arrows, in one thread. */
class ContactMarkers {
 public:
  static constexpr double LONGEST_ARROW = 0.25;  // [m]
  ContactMarkers(ros::NodeHandle* private_node, const std::string& topic, double metres_per_newton);
  /** Not while publish() runs. */
  void setScale(double metres_per_newton) { metres_per_newton_ = metres_per_newton; }
  bool listened() const { return publisher_.listened(); }
  void publish(const boost::shared_ptr<StampedContacts>& contacts);

 private:
  ListenedPublisher publisher_;
  double metres_per_newton_;
  std::size_t arrows_ = 0;  // shown now
};

}  // namespace blem_sim::node
