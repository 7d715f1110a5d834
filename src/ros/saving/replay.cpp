#include "saving/replay.h"

#include <blem_sim/RecordedSteps.h>
#include <fmt/format.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <deque>
#include <memory>
#include <utility>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/sim/state_file.h"
#include "saving/record_bag.h"

namespace blem_sim::node {

namespace {

/** A simulation that is led through a record, message by message. */
class Replayer {
 public:
  explicit Replayer(std::string file) : file_(std::move(file)) {}

  /** False: the record has ended, or a step differed. */
  bool take(const rosbag::MessageInstance& message) {
    if (message.getTopic() == START_TOPIC)
      start(*contentOf<RecordStart>(message));
    else if (message.getTopic() == INPUT_TOPIC)
      inputs_.push_back(*contentOf<RecordedInput>(message));
    else if (message.getTopic() == STEPS_TOPIC)
      makeSteps(*contentOf<RecordedSteps>(message));
    return !ended_ && result_.difference.empty();
  }

  ReplayResult finish() const {
    if (!simulator_) throw InputError(file_ + ": has no " + START_TOPIC + ", so it is no record of blem_sim's; check the path");
    if (!ended_ && result_.difference.empty())
      throw InputError(
          fmt::format("{}: is cut short: it has no end after step {}, and is the same up to there; record it again", file_, result_.steps));
    return result_;
  }

 private:
  template <typename Message>
  typename Message::ConstPtr contentOf(const rosbag::MessageInstance& instance) const {
    const typename Message::ConstPtr message = instance.instantiate<Message>();
    if (!message)
      throw InputError(file_ + ": " + instance.getTopic() + " is of another version's type; replay it with the version that recorded it");
    return message;
  }

  void start(const RecordStart& start) {
    if (simulator_) throw InputError(file_ + ": begins twice; record it again");
    simulator_ = std::make_unique<sim::Simulator>(configOf(start, file_), model::UriResolver());
    simulator_->restore(sim::stateOf(std::string(start.state.begin(), start.state.end()), file_));
  }

  void makeSteps(const RecordedSteps& steps) {
    if (!simulator_ || steps.first != result_.steps)
      throw InputError(fmt::format("{}: steps are missing after step {}; record it again", file_, result_.steps));
    for (std::size_t i = 0; i < steps.hashes.size() && result_.difference.empty(); ++i) makeStep(steps.hashes[i]);
    ended_ = steps.last;
  }

  void makeStep(std::uint64_t recorded) {
    while (!inputs_.empty() && inputs_.front().step == result_.steps) {
      if (!apply(inputs_.front())) return;
      inputs_.pop_front();
    }
    if (!inputs_.empty() && inputs_.front().step < result_.steps)
      throw InputError(
          fmt::format("{}: an input of step {} comes after step {}; record it again", file_, inputs_.front().step + 1, result_.steps));
    simulator_->step();
    ++result_.steps;
    result_.hash = simulator_->stateHash();
    if (result_.hash != recorded)
      result_.difference = fmt::format("step {} differs: its state hash is {:016x}, {:016x} in the record; {}", result_.steps, result_.hash,
                                       recorded, last());
  }

  bool apply(const RecordedInput& input) {
    try {
      sim::applyInput(fromMessage(input), simulator_.get());
    } catch (const InputError& refusal) {
      result_.difference = fmt::format("step {} differs: its input is refused: {}", result_.steps + 1, refusal.what());
      return false;
    }
    ++result_.inputs;
    last_call_ = fmt::format("the last input before it was {}, of step {}", input.call, input.step + 1);
    return true;
  }

  std::string last() const { return last_call_.empty() ? "no input came before it" : last_call_; }

  std::string file_, last_call_;
  std::unique_ptr<sim::Simulator> simulator_;
  std::deque<RecordedInput> inputs_;  // of steps to come
  bool ended_ = false;
  ReplayResult result_;
};

void replayBag(const std::string& file, Replayer* replayer) {
  rosbag::Bag bag(file, rosbag::bagmode::Read);
  rosbag::View view(bag);
  for (const rosbag::MessageInstance& message : view)
    if (!replayer->take(message)) return;
}

}  // namespace

ReplayResult replay(const std::string& file) {
  Replayer replayer(file);
  try {
    replayBag(file, &replayer);
  } catch (const InputError&) {
    throw;
  } catch (const rosbag::BagUnindexedException&) {
    throw InputError(file + ": is cut short, its writer was killed or its disk was full; rosbag reindex makes a copy of what is there");
  } catch (const std::exception& error) {
    throw InputError(file + ": cannot be read as a bag: " + error.what() + "; check the path, or record it again");
  }
  return replayer.finish();
}

}  // namespace blem_sim::node
