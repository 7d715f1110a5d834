// Hands published messages to the sockets before a service answers.
#pragma once

#include <boost/signals2/connection.hpp>
#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace blem_sim::node {

/**
 * roscpp's publish() only queues; its poll thread serves the queues, then the sockets. A service's answer goes past those queues, so a
 * client in lock-step would see the answer before the messages of the steps it asked for.
 */
class Outbox {
 public:
  Outbox();
  ~Outbox();
  Outbox(const Outbox&) = delete;
  Outbox& operator=(const Outbox&) = delete;

  /** Returns when all messages published so far have been offered to the sockets; at most 100 ms later. */
  void flush();

 private:
  void roundStarted();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::uint64_t rounds_ = 0;
  boost::signals2::connection listener_;
};

}  // namespace blem_sim::node
