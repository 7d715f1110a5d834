#include "sensors/delay_line.h"

#include <algorithm>
#include <cmath>

#include "sensors/reading_numbers.h"

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

void DelayLine::append(std::vector<double>* numbers) const {
  if (steps_ == 0) return;
  const auto oldest = numbers_.begin() + static_cast<std::ptrdiff_t>(next_);
  numbers->push_back(static_cast<double>(taken_));
  numbers->insert(numbers->end(), oldest, numbers_.end());
  numbers->insert(numbers->end(), numbers_.begin(), oldest);
}

void DelayLine::read(NumberReader* reader) {
  if (steps_ == 0) return;
  taken_ = static_cast<std::size_t>(reader->choice(static_cast<int>(steps_) + 1));
  reader->numbers(numbers_.data(), numbers_.size());
  next_ = 0;
}

}  // namespace blem_sim::sim
