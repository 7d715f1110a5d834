#include "saving/input_recorder.h"

#include <ros/console.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>

#include "blem_sim/geometry/input_error.h"
#include "saving/record_bag.h"

namespace blem_sim::node {

namespace {

constexpr std::size_t STEPS_PER_MESSAGE = 100;
constexpr std::uint32_t CHUNK = 16384;  // [bytes] that a killed node loses at most: rosbag reindex finds chunks that were ended

/** Writes to a bag. @throws BagException: rosbag's words, which name the call that failed, and the system's, which say why */
template <typename Act>
void withReason(const Act& act) {
  errno = 0;
  try {
    act();
  } catch (const rosbag::BagException& error) {
    const int number = errno;
    if (number == 0) throw;
    throw rosbag::BagException(std::string(error.what()) + " (" + std::generic_category().message(number) + ")");
  }
}

}  // namespace

InputRecorder::InputRecorder(sim::Simulator* simulator, const std::string& configuration)
    : simulator_(simulator), configuration_(configuration), first_layout_(simulator->save().layout) {}

InputRecorder::~InputRecorder() { end(); }

void InputRecorder::end() {
  try {
    if (!file_.empty()) stop();
  } catch (const InputError& error) {
    ROS_ERROR("%s", error.what());
  }
}

template <typename Message>
void InputRecorder::write(const char* topic, const Message& message) {
  // A reader goes by the stamps, so they differ.
  const ros::WallTime now = ros::WallTime::now();
  last_stamp_ = std::max(ros::Time(now.sec, now.nsec), last_stamp_ + ros::Duration(0, 1));
  withReason([&] { bag_->write(topic, last_stamp_, message); });
}

void InputRecorder::start(const std::string& file) {
  if (!file_.empty()) throw InputError("record: " + file_ + " is being recorded; stop it first");
  if (simulator_->save().layout != first_layout_)
    throw InputError("record: models or settings have changed since the node started; start the node with record: FILE");
  bag_ = std::make_unique<rosbag::Bag>();
  try {
    withReason([&] { bag_->open(file, rosbag::bagmode::Write); });
    write(START_TOPIC, startMessage(*simulator_, configuration_));
    bag_->setChunkThreshold(CHUNK);  // ends the chunk of the beginning, too
  } catch (const rosbag::BagException& error) {
    closeBag();
    throw InputError("record: " + file + ": cannot be written: " + error.what() + "; check the folder and its disk");
  }
  file_ = file;
  given_up_.clear();
  steps_ = RecordedSteps();
  inputs_ = 0;
  simulator_->watch(this);
}

std::string InputRecorder::stop() {
  if (file_.empty()) throw InputError(given_up_.empty() ? "record: nothing is being recorded; start it first" : given_up_);
  const std::string file = file_;
  steps_.last = true;
  writeSteps();
  if (file_.empty()) throw InputError("record: " + file + ": its end could not be written; the log says why");
  simulator_->watch(nullptr);
  file_.clear();
  if (!closeBag()) throw InputError("record: " + file + ": its end could not be written; make room on its disk and record again");
  return std::to_string(steps_.first) + " steps, " + std::to_string(inputs_) + " inputs in " + file;
}

void InputRecorder::told(const sim::SimulatorInput& input) {
  ++inputs_;
  try {
    write(INPUT_TOPIC, toMessage(input, steps_.first + steps_.hashes.size()));
  } catch (const rosbag::BagException& error) {
    giveUp(error.what());
  }
}

void InputRecorder::stepped() {
  steps_.hashes.push_back(simulator_->stateHash());
  if (steps_.hashes.size() == STEPS_PER_MESSAGE) writeSteps();
}

void InputRecorder::writeSteps() {
  try {
    write(STEPS_TOPIC, steps_);
  } catch (const rosbag::BagException& error) {
    return giveUp(error.what());
  }
  steps_.first += steps_.hashes.size();
  steps_.hashes.clear();
}

void InputRecorder::giveUp(const char* why) {
  given_up_ = "record: " + file_ + " ends at step " + std::to_string(steps_.first) + " or up to 16 kB before: " + why +
              "; rosbag reindex mends it, make room and record again";
  ROS_ERROR("%s", given_up_.c_str());
  simulator_->watch(nullptr);
  file_.clear();
  closeBag();
}

bool InputRecorder::closeBag() {
  try {
    bag_->close();
    bag_.reset();
    return true;
  } catch (const rosbag::BagException&) {
    static_cast<void>(bag_.release());
    return false;
  }
}

}  // namespace blem_sim::node
