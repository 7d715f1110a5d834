#include "loop/checked_transport.h"

#include <utility>

namespace blem_sim::node {

std::size_t largestBlockOf(std::size_t message_bytes) {
  constexpr std::size_t ROOM = 1 << 16, LARGEST_ENTRY = 64;
  return ROOM + LARGEST_ENTRY * message_bytes;
}

CheckedMessages::CheckedMessages(ros::SubscriptionCallbackHelperPtr reader, Refuse refuse)
    : reader_(std::move(reader)), refuse_(std::move(refuse)) {}

ros::VoidConstPtr CheckedMessages::deserialize(const ros::SubscriptionCallbackHelperDeserializeParams& params) {
  try {
    const AllocationLimit limit(largestBlockOf(params.length));
    return reader_->deserialize(params);
  } catch (const std::exception& error) {
    refuse_(std::string("its bytes do not fit its type: ") + error.what());
    return {};
  }
}

}  // namespace blem_sim::node
