#include "stop_expression.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <locale>
#include <sstream>
#include <utility>

#include "blem_sim/geometry/input_error.h"
#include "numbers/nearest_name.h"

namespace blem_sim {

namespace {

const int MOST_NESTING = 100;
const std::size_t COMPARISONS = 2;  ///< level in LEVELS, where `not` stands
const std::array<std::vector<std::string>, 5> LEVELS = {{{"or"}, {"and"}, {"<=", ">=", "==", "!=", "<", ">"}, {"+", "-"}, {"*", "/"}}};
const char* const DIGITS = "0123456789";
const char* const NAME_LETTERS = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789:.";

double applied(const std::string& operation, double a, double b) {
  if (operation == "+") return a + b;
  if (operation == "-") return a - b;
  if (operation == "*") return a * b;
  if (operation == "/") return a / b;
  if (operation == "min") return std::min(a, b);
  if (operation == "max") return std::max(a, b);
  if (operation == "<") return a < b;
  if (operation == "<=") return a <= b;
  if (operation == ">") return a > b;
  if (operation == ">=") return a >= b;
  if (operation == "==") return a == b;
  return a != b;
}

bool isTrue(double value) { return value != 0 && !std::isnan(value); }

void addBody(const sim::Simulator& simulator, int body, Quantities* quantities) {
  const std::string name = simulator.bodyName(body);
  const auto b = static_cast<std::size_t>(body);
  const Vector3 com = simulator.world().bodySpec(body).inertial.com;
  const std::array<const char*, 3> axes = {".x", ".y", ".z"};
  for (int axis = 0; axis < 3; ++axis)
    (*quantities)[name + axes[static_cast<std::size_t>(axis)]] = [b, axis](const sim::StepReport& report) {
      return report.bodies[b].X_WB.translation()[axis];
    };
  (*quantities)[name + ".speed"] = [b, com](const sim::StepReport& report) {
    const dynamics::BodyState& state = report.bodies[b];
    return (state.v_WCom - state.w_WB.cross(Vector3(state.X_WB.linear() * com))).norm();
  };
  (*quantities)[name + ".roll"] = [b](const sim::StepReport& report) {
    const auto& R = report.bodies[b].X_WB.linear();
    return std::atan2(R(2, 1), R(2, 2));
  };
  (*quantities)[name + ".pitch"] = [b](const sim::StepReport& report) {
    const auto& R = report.bodies[b].X_WB.linear();
    return std::atan2(-R(2, 0), std::hypot(R(2, 1), R(2, 2)));
  };
  (*quantities)[name + ".yaw"] = [b](const sim::StepReport& report) {
    const auto& R = report.bodies[b].X_WB.linear();
    return std::atan2(R(1, 0), R(0, 0));
  };
}

}  // namespace

Quantities quantitiesOf(const sim::Simulator& simulator, const LastReadings& readings) {
  Quantities quantities;
  quantities["time"] = [](const sim::StepReport& report) { return report.time; };
  quantities["energy"] = [](const sim::StepReport& report) { return report.energy; };
  for (const sim::StatusBit& status : sim::STEP_STATUS)
    quantities[status.name] = [bit = status.bit](const sim::StepReport& report) { return (report.status & bit) != 0 ? 1.0 : 0.0; };
  for (const sim::ModelInfo& model : simulator.models())
    for (const int body : model.bodies)
      if (model.alive && body != dynamics::WORLD_BODY) addBody(simulator, body, &quantities);
  for (const sim::RobotInfo& robot : simulator.robots()) {
    for (std::size_t i = 0; i < robot.joints.size(); ++i) {
      const std::string name = robot.name + "::" + robot.joint_names[i];
      const auto j = static_cast<std::size_t>(robot.joints[i]);
      quantities[name + ".position"] = [j](const sim::StepReport& report) { return report.joints[j].position; };
      quantities[name + ".velocity"] = [j](const sim::StepReport& report) { return report.joints[j].velocity; };
      quantities[name + ".effort"] = [j](const sim::StepReport& report) { return report.joints[j].effort; };
    }
  }
  for (std::size_t i = 0; i < readings.names().size(); ++i)
    quantities[readings.names()[i]] = [&readings, i](const sim::StepReport&) { return readings.values()[i]; };
  return quantities;
}

/** Recursive descent over LEVELS; each function returns the node it has added. */
class StopParser {
 public:
  StopParser(std::string where, std::string text, const Quantities& quantities, StopExpression* expression)
      : where_(std::move(where)), text_(std::move(text)), quantities_(quantities), nodes_(expression->nodes_) {}

  int parse() {
    const int root = level(0);
    skipSpace();
    if (at_ < text_.size()) refuse("an operator");
    return root;
  }

 private:
  [[noreturn]] void refuse(const std::string& expected) const {
    throw InputError(fmt::format("{}: {} is expected at letter {} of '{}'", where_, expected, at_ + 1, sim::shownName(text_)));
  }
  void skipSpace() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
  }
  bool accept(const std::string& token) {
    skipSpace();
    if (text_.compare(at_, token.size(), token) != 0) return false;
    const std::size_t end = at_ + token.size();
    const std::string letters = NAME_LETTERS;
    const bool word = letters.find(token[0]) != std::string::npos;
    if (word && end < text_.size() && letters.find(text_[end]) != std::string::npos) return false;
    at_ = end;
    return true;
  }
  int add(const std::string& operation, int left, int right) {
    nodes_.push_back({operation, left, right, 0, {}});
    return static_cast<int>(nodes_.size()) - 1;
  }
  std::string acceptOneOf(const std::vector<std::string>& tokens) {
    for (const std::string& token : tokens)
      if (accept(token)) return token;
    return {};
  }
  int level(std::size_t depth) {
    if (depth == LEVELS.size()) return unary();
    if (depth == COMPARISONS && accept("not")) return nested("not", [&] { return level(COMPARISONS); });
    int left = level(depth + 1);
    for (std::string token = acceptOneOf(LEVELS[depth]); !token.empty(); token = acceptOneOf(LEVELS[depth])) {
      if (++operators_ > MOST_NESTING) throw InputError(fmt::format("{}: more than {} operators", where_, MOST_NESTING));
      const int right = level(depth + 1);
      left = add(token, left, right);
    }
    return left;
  }
  template <typename Inner>
  int nested(const std::string& operation, Inner inner) {
    if (++nesting_ > MOST_NESTING) throw InputError(fmt::format("{}: nested more than {} deep", where_, MOST_NESTING));
    const int node = inner();
    --nesting_;
    return operation.empty() ? node : add(operation, node, -1);
  }
  int unary() {
    if (accept("-")) return nested("negative", [&] { return unary(); });
    for (const char* function : {"abs", "sqrt"})
      if (accept(function)) return nested(function, [&] { return parenthesis(); });
    for (const char* function : {"min", "max"})
      if (accept(function)) return nested("", [&] { return pair(function); });
    skipSpace();
    if (at_ < text_.size() && text_[at_] == '(') return nested("", [&] { return parenthesis(); });
    return atom();
  }
  int parenthesis() {
    if (!accept("(")) refuse("'('");
    const int node = level(0);
    if (!accept(")")) refuse("')'");
    return node;
  }
  int pair(const std::string& operation) {
    if (!accept("(")) refuse("'('");
    const int left = level(0);
    if (!accept(",")) refuse("','");
    const int right = level(0);
    if (!accept(")")) refuse("')'");
    return add(operation, left, right);
  }
  int atom() {
    if (at_ < text_.size() && std::string(DIGITS).append(".").find(text_[at_]) != std::string::npos) return number();
    const std::size_t end = std::min(text_.find_first_not_of(NAME_LETTERS, at_), text_.size());
    const bool quoted = at_ < text_.size() && text_[at_] == '"';
    const std::size_t quote = quoted ? text_.find('"', at_ + 1) : std::string::npos;
    if (quoted && quote == std::string::npos) refuse("a name that ends with '\"'");
    const std::string word = quoted ? text_.substr(at_ + 1, quote - at_ - 1) : text_.substr(at_, end - at_);
    if (!quoted && word.empty()) refuse("a number or a name");
    const auto found = quantities_.find(word);
    if (found == quantities_.end()) refuseName(word);
    at_ = quoted ? quote + 1 : end;
    const int node = add("name", -1, -1);
    nodes_.back().quantity = found->second;
    return node;
  }
  /** Digits, a point and an exponent, with or without a sign. */
  int number() {
    std::size_t end = std::min(text_.find_first_not_of(NAME_LETTERS, at_), text_.size());
    const bool exponent =
        end < text_.size() && (text_[end] == '+' || text_[end] == '-') && (text_[end - 1] == 'e' || text_[end - 1] == 'E');
    if (exponent) end = std::min(text_.find_first_not_of(DIGITS, end + 1), text_.size());
    const std::string word = text_.substr(at_, end - at_);
    std::istringstream stream(word);
    stream.imbue(std::locale::classic());
    double value = 0;
    if (!(stream >> value) || stream.peek() != std::istringstream::traits_type::eof()) refuse("a number");
    at_ += word.size();
    const int node = add("number", -1, -1);
    nodes_.back().number = value;
    return node;
  }
  [[noreturn]] void refuseName(const std::string& word) const {
    std::vector<std::string> names;
    for (const auto& [name, quantity] : quantities_) names.insert(names.end(), name);
    throw InputError(
        fmt::format("{}: '{}' is unknown; the nearest known name is '{}'", where_, sim::shownName(word), sim::nearestName(word, names)));
  }

  std::string where_, text_;
  const Quantities& quantities_;
  std::vector<StopExpression::Node>& nodes_;
  std::size_t at_ = 0;
  int nesting_ = 0, operators_ = 0;
};

StopExpression::StopExpression(const std::string& option, const std::string& text, const Quantities& quantities) {
  root_ = StopParser("--stop " + option, text, quantities, this).parse();
}

bool StopExpression::holds(const sim::StepReport& report) const { return isTrue(value(root_, report)); }

double StopExpression::value(int index, const sim::StepReport& report) const {
  const Node& node = nodes_[static_cast<std::size_t>(index)];
  if (node.operation == "number") return node.number;
  if (node.operation == "name") return node.quantity(report);
  const double a = value(node.left, report);
  if (node.operation == "negative") return -a;
  if (node.operation == "abs") return std::abs(a);
  if (node.operation == "sqrt") return std::sqrt(a);
  if (node.operation == "not") return isTrue(a) ? 0 : 1;
  if (node.operation == "and") return isTrue(a) && isTrue(value(node.right, report));
  if (node.operation == "or") return isTrue(a) || isTrue(value(node.right, report));
  return applied(node.operation, a, value(node.right, report));
}

StopConditions::StopConditions(const sim::Simulator& simulator, const std::vector<std::pair<std::string, std::string>>& stops)
    : readings_(simulator) {
  if (stops.empty()) return;
  const Quantities quantities = quantitiesOf(simulator, readings_);
  for (const auto& [name, text] : stops) {
    for (const auto& [earlier, expression] : stops_)
      if (earlier == name) throw InputError(fmt::format("--stop {}: the name is given twice; each stop needs its own", name));
    stops_.emplace_back(name, StopExpression(name, text, quantities));
  }
}

const std::string* StopConditions::met(const sim::StepReport& report) {
  if (stops_.empty()) return nullptr;
  readings_.add(report);
  for (const auto& [name, expression] : stops_)
    if (expression.holds(report)) return &name;
  return nullptr;
}

}  // namespace blem_sim
