#include "sensors/readings/delay_line.h"

#include <algorithm>
#include <cmath>

#include "sensors/readings/reading_numbers.h"

namespace blem_sim::sim {

DelayLine::DelayLine(double delay, double time_step, SensorReading reading) : steps_(std::lround(delay / time_step)) {
  std::size_t width = 0;
  forEachNumber(&reading, [&](double&, int) { ++width; });
  numbers_.resize(steps_ * width);
}

bool DelayLine::pass(SensorReading* reading) {
  if (steps_ == 0) return true;
  forEachNumber(reading, [this](double& number, int) {
    std::swap(number, numbers_[next_]);
    next_ = (next_ + 1) % numbers_.size();
  });
  if (taken_ == steps_) return true;
  ++taken_;
  return false;
}

void DelayLine::clear() {
  std::fill(numbers_.begin(), numbers_.end(), 0);
  next_ = taken_ = 0;
}

void DelayLine::save(geometry::StateWriter* writer) const {
  if (steps_ == 0) return;
  writer->number(static_cast<double>(taken_));
  writer->numbers(numbers_.data() + next_, numbers_.size() - next_);
  writer->numbers(numbers_.data(), next_);
}

void DelayLine::restore(geometry::StateReader* reader) {
  if (steps_ == 0) return;
  taken_ = static_cast<std::size_t>(reader->choice(static_cast<int>(steps_) + 1));
  reader->numbers(numbers_.data(), numbers_.size());
  next_ = 0;
}

}  // namespace blem_sim::sim
