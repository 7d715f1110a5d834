// Once warm, a step's messages are handed over without asking the heap for anything.
#include <gtest/gtest.h>

#include "messages/message_pool.h"
#include "sending/step_sender.h"

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

#include "support/counted_allocations.h"

namespace blem_sim::node {
namespace {

struct Topic {
  void publish(const boost::shared_ptr<int>& number) { sum += *number; }
  long sum = 0;
};

TEST(StepSender, AWarmStepAllocatesNothing) {
  Topic topic;
  MessagePool<int> messages;
  StepSender sender;
  const auto step = [&] {
    for (int i = 0; i < 20; ++i) {
      const auto message = messages.spare();
      *message = i;
      sender.add(&topic, message);
    }
    sender.send();
    sender.drain();  // as far behind in every step
  };
  for (int i = 0; i < 10; ++i) step();
  const long before = allocations;
  for (int i = 0; i < 100; ++i) step();
  EXPECT_EQ(allocations, before);
  EXPECT_EQ(topic.sum, 110 * 190);
}

}  // namespace
}  // namespace blem_sim::node

#endif
