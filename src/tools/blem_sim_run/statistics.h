// Summaries of numbers that come one by one.
#pragma once

#include <cstdint>
#include <vector>

namespace blem_sim {

/** Mean, standard deviation (of the population), minimum and maximum of each component of a vector. [Welford 1962] */
class VectorStatistics {
 public:
  /** Precondition: as many values as the first time. */
  void add(const std::vector<double>& values);
  std::uint64_t count() const { return count_; }
  const std::vector<double>& mean() const { return mean_; }
  std::vector<double> standardDeviation() const;
  const std::vector<double>& minimum() const { return minimum_; }
  const std::vector<double>& maximum() const { return maximum_; }

 private:
  std::uint64_t count_ = 0;
  std::vector<double> mean_, squares_, minimum_, maximum_;
};

/** Mean, maximum and exact quantiles; keeps every value, in single precision. */
class Distribution {
 public:
  void add(double value);
  double mean() const;
  double maximum() const;
  /** @param fraction 0 to 1: the smallest value that at least this fraction of all values does not exceed; 0 without values */
  double quantile(double fraction) const;

 private:
  double sum_ = 0;
  std::vector<float> values_;
};

}  // namespace blem_sim
