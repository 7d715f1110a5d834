#include "statistics.h"

#include <algorithm>
#include <cmath>

namespace blem_sim {

void VectorStatistics::add(const std::vector<double>& values) {
  if (count_ == 0) {
    mean_.assign(values.size(), 0);
    squares_.assign(values.size(), 0);
    minimum_ = maximum_ = values;
  }
  ++count_;
  for (std::size_t i = 0; i < mean_.size(); ++i) {
    const double from_old_mean = values[i] - mean_[i];
    mean_[i] += from_old_mean / static_cast<double>(count_);
    squares_[i] += from_old_mean * (values[i] - mean_[i]);
    minimum_[i] = std::min(minimum_[i], values[i]);
    maximum_[i] = std::max(maximum_[i], values[i]);
  }
}

std::vector<double> VectorStatistics::standardDeviation() const {
  std::vector<double> deviation;
  for (const double squares : squares_) deviation.push_back(std::sqrt(squares / static_cast<double>(count_)));
  return deviation;
}

void Distribution::add(double value) {
  sum_ += value;
  values_.push_back(static_cast<float>(value));
}

double Distribution::mean() const { return values_.empty() ? 0 : sum_ / static_cast<double>(values_.size()); }

double Distribution::maximum() const { return values_.empty() ? 0 : *std::max_element(values_.begin(), values_.end()); }

double Distribution::quantile(double fraction) const {
  if (values_.empty()) return 0;
  std::vector<float> values = values_;
  const double rank = std::ceil(fraction * static_cast<double>(values.size()));
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(std::max(rank, 1.0)) - 1;
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace blem_sim
