// Messages and requests whose bytes are looked at before they cost memory.
#pragma once

#include <ros/node_handle.h>

#include <boost/make_shared.hpp>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

#include "loop/allocation_limit.h"

namespace blem_sim::node {

/** Largest block [bytes] that an honest message of so many bytes can need: entries of a list take 64 times their bytes at most. */
std::size_t largestBlockOf(std::size_t message_bytes);

/** Reads messages under a limit; one whose bytes do not fit its type is refused in words and goes no further. */
class CheckedMessages : public ros::SubscriptionCallbackHelper {
 public:
  using Refuse = std::function<void(const std::string& why)>;

  CheckedMessages(ros::SubscriptionCallbackHelperPtr reader, Refuse refuse);
  ros::VoidConstPtr deserialize(const ros::SubscriptionCallbackHelperDeserializeParams& params) override;
  void call(ros::SubscriptionCallbackHelperCallParams& params) override { reader_->call(params); }
  const std::type_info& getTypeInfo() override { return reader_->getTypeInfo(); }
  bool isConst() override { return reader_->isConst(); }
  bool hasHeader() override { return reader_->hasHeader(); }

 private:
  ros::SubscriptionCallbackHelperPtr reader_;
  Refuse refuse_;
};

/** Options of a subscription to a topic. @param refuse gets why a message's bytes are none of the type, in the thread of the callbacks */
template <typename Message>
ros::SubscribeOptions checkedSubscription(const std::string& topic, std::uint32_t queue,
                                          const boost::function<void(const boost::shared_ptr<const Message>&)>& take,
                                          const CheckedMessages::Refuse& refuse) {
  ros::SubscribeOptions options;
  options.template init<Message>(topic, queue, take);
  options.helper = boost::make_shared<CheckedMessages>(options.helper, refuse);
  return options;
}

/** Reads requests under a limit; what their bytes do not fit is answered as an error of the call. */
template <typename Service>
class CheckedRequests : public ros::ServiceCallbackHelper {
 public:
  explicit CheckedRequests(ros::ServiceCallbackHelperPtr server) : server_(server) {}

  bool call(ros::ServiceCallbackHelperCallParams& params) override {
    check(params.request);
    return server_->call(params);
  }

 private:
  static void check(const ros::SerializedMessage& bytes) {
    const AllocationLimit limit(largestBlockOf(bytes.num_bytes));
    typename Service::Request request;
    try {
      ros::serialization::deserializeMessage(bytes, request);
    } catch (const std::exception& error) {
      throw std::runtime_error(std::string("the request's bytes do not fit its type: ") + error.what());
    }
  }

  ros::ServiceCallbackHelperPtr server_;
};

/** Advertises a service whose requests are checked. */
template <typename Service>
ros::ServiceServer advertiseChecked(ros::NodeHandle node, const std::string& name,
                                    const boost::function<bool(typename Service::Request&, typename Service::Response&)>& serve) {
  ros::AdvertiseServiceOptions options;
  options.init<typename Service::Request, typename Service::Response>(name, serve);
  options.helper = boost::make_shared<CheckedRequests<Service>>(options.helper);
  return node.advertiseService(options);
}

}  // namespace blem_sim::node
