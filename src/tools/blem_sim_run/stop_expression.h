// --stop: an expression over a step's report, compiled before the run.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "blem_sim/sim/simulator.h"
#include "last_readings.h"

namespace blem_sim {

/** Numbers of a step by name. */
using Quantities = std::map<std::string, std::function<double(const sim::StepReport&)>>;

/**
 * Names: time [s], energy [J], status bits (0 or 1), MODEL::LINK.x .y .z [m] .speed [m/s] .roll .pitch .yaw [rad], MODEL::JOINT.position
 * .velocity .effort, SENSOR.FIELD as in --csv. @param readings must live as long as the quantities
 */
Quantities quantitiesOf(const sim::Simulator& simulator, const LastReadings& readings);

/** Operands, and the operators on one or two of them. */
enum class StopOperation {
  NUMBER,
  NAME,
  NEGATIVE,
  ABS,
  SQRT,
  NOT,
  AND,
  OR,
  LESS,
  LESS_OR_EQUAL,
  GREATER,
  GREATER_OR_EQUAL,
  EQUAL,
  NOT_EQUAL,
  PLUS,
  MINUS,
  TIMES,
  DIVIDE,
  MIN,
  MAX
};

/** Numbers, names, + - * /, comparisons, and, or, not, abs, sqrt, min, max, parentheses. A comparison with NaN is false, but != is true. */
class StopExpression {
 public:
  /** @param option name of the stop, for errors @throws InputError: no expression, an unknown name (names the nearest) */
  StopExpression(const std::string& option, const std::string& text, const Quantities& quantities);
  /** Whether it is neither 0 nor NaN. */
  bool holds(const sim::StepReport& report) const;

 private:
  friend class StopParser;
  struct Node {
    StopOperation operation = StopOperation::NUMBER;
    int left = -1, right = -1;
    double number = 0;
    std::function<double(const sim::StepReport&)> quantity;
  };
  double value(int node, const sim::StepReport& report) const;

  std::vector<Node> nodes_;
  int root_ = -1;
};

/** The stops of a run, compiled. */
class StopConditions {
 public:
  /** @param stops name and expression of each @throws InputError: a name given twice, an expression that is none */
  StopConditions(const sim::Simulator& simulator, const std::vector<std::pair<std::string, std::string>>& stops);
  StopConditions(const StopConditions&) = delete;
  StopConditions& operator=(const StopConditions&) = delete;
  /** Name of the first stop that holds after a step, or null. */
  const std::string* met(const sim::StepReport& report);

 private:
  LastReadings readings_;
  std::vector<std::pair<std::string, StopExpression>> stops_;
};

}  // namespace blem_sim
