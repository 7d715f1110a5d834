// Servers of services that answer a refusal in words.
#pragma once

#include <ros/console.h>
#include <ros/node_handle.h>

#include <boost/function.hpp>

#include <exception>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include "loop/checked_transport.h"

namespace blem_sim::node {

/** Some services of one namespace. A call always gets an answer; one that is refused changes nothing, and one line says why. */
class ServiceGroup {
 public:
  explicit ServiceGroup(const ros::NodeHandle& node) : node_(node) {}

  /** Advertises a service. @param act fills the response, or throws what is wrong with the request */
  template <typename Service>
  void add(const std::string& name, std::function<void(const typename Service::Request&, typename Service::Response*)> act) {
    using Request = typename Service::Request;
    using Response = typename Service::Response;
    const boost::function<bool(Request&, Response&)> serve = [name, act](Request& request, Response& response) {
      try {
        setOutcome(&response, true, "done");
        const AllocationLimit none(AllocationLimit::NONE);  // files may be large
        act(request, &response);
      } catch (const std::exception& error) {
        const std::string why = inOneLine(error.what());
        ROS_ERROR("%s: %s", name.c_str(), why.c_str());
        response = Response();
        setOutcome(&response, false, why);
      }
      return true;
    };
    servers_.push_back(advertiseChecked<Service>(node_, name, serve));
  }

 private:
  /** Text without what a request may have brought in: line ends, control characters, a length without bound. */
  static std::string inOneLine(std::string text) {
    constexpr std::size_t LONGEST = 2000;
    if (text.size() > LONGEST) text = text.substr(0, LONGEST) + " ...";
    for (char& c : text)
      if (static_cast<unsigned char>(c) < ' ') c = ' ';
    return text;
  }
  template <typename Response>
  static auto setOutcome(Response* response, bool success, const std::string& text) -> decltype(response->success, void()) {
    response->success = success;
    response->status_message = text;
  }
  static void setOutcome(void*, bool, const std::string&) {}  // a response without these fields

  ros::NodeHandle node_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace blem_sim::node
