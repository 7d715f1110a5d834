#include "stop_expression.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <locale>
#include <optional>
#include <sstream>
#include <utility>

#include "blem_sim/geometry/input_error.h"
#include "numbers/nearest_name.h"

namespace blem_sim {

namespace {

const int MOST_NESTING = 100;
const std::size_t COMPARISONS = 2;  ///< level in LEVELS, where `not` stands
using Tokens = std::vector<std::pair<const char*, StopOperation>>;
/** Operators between two operands, the loosest first; of those that begin alike the longest first. */
const std::array<Tokens, 5> LEVELS = {{
    {{"or", StopOperation::OR}},
    {{"and", StopOperation::AND}},
    {{"<=", StopOperation::LESS_OR_EQUAL},
     {">=", StopOperation::GREATER_OR_EQUAL},
     {"==", StopOperation::EQUAL},
     {"!=", StopOperation::NOT_EQUAL},
     {"<", StopOperation::LESS},
     {">", StopOperation::GREATER}},
    {{"+", StopOperation::PLUS}, {"-", StopOperation::MINUS}},
    {{"*", StopOperation::TIMES}, {"/", StopOperation::DIVIDE}},
}};
const Tokens FUNCTIONS = {{"abs", StopOperation::ABS}, {"sqrt", StopOperation::SQRT}};
const Tokens PAIR_FUNCTIONS = {{"min", StopOperation::MIN}, {"max", StopOperation::MAX}};
const char* const DIGITS = "0123456789";
const char* const NAME_LETTERS = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789:.";

bool isTrue(double value) { return value != 0 && !std::isnan(value); }

/** Value of an operator; one of a single operand takes no b. */
double applied(StopOperation operation, double a, double b) {
  switch (operation) {
    case StopOperation::NEGATIVE:
      return -a;
    case StopOperation::ABS:
      return std::abs(a);
    case StopOperation::SQRT:
      return std::sqrt(a);
    case StopOperation::NOT:
      return !isTrue(a);
    case StopOperation::AND:
      return isTrue(a) && isTrue(b);
    case StopOperation::OR:
      return isTrue(a) || isTrue(b);
    case StopOperation::LESS:
      return a < b;
    case StopOperation::LESS_OR_EQUAL:
      return a <= b;
    case StopOperation::GREATER:
      return a > b;
    case StopOperation::GREATER_OR_EQUAL:
      return a >= b;
    case StopOperation::EQUAL:
      return a == b;
    case StopOperation::NOT_EQUAL:
      return a != b;
    case StopOperation::PLUS:
      return a + b;
    case StopOperation::MINUS:
      return a - b;
    case StopOperation::TIMES:
      return a * b;
    case StopOperation::DIVIDE:
      return a / b;
    case StopOperation::MIN:
      return std::min(a, b);
    case StopOperation::MAX:
      return std::max(a, b);
    case StopOperation::NUMBER:
    case StopOperation::NAME:
      break;  // operands
  }
  return std::numeric_limits<double>::quiet_NaN();
}

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
  int add(StopOperation operation, int left, int right) {
    nodes_.push_back({operation, left, right, 0, {}});
    return static_cast<int>(nodes_.size()) - 1;
  }
  /** Takes one of the tokens if it comes next. */
  std::optional<StopOperation> acceptOneOf(const Tokens& tokens) {
    for (const auto& [token, operation] : tokens)
      if (accept(token)) return operation;
    return std::nullopt;
  }
  int level(std::size_t depth) {
    if (depth == LEVELS.size()) return unary();
    if (depth == COMPARISONS && accept("not")) return add(StopOperation::NOT, nested([&] { return level(COMPARISONS); }), -1);
    int left = level(depth + 1);
    for (auto operation = acceptOneOf(LEVELS[depth]); operation; operation = acceptOneOf(LEVELS[depth])) {
      if (++operators_ > MOST_NESTING) throw InputError(fmt::format("{}: more than {} operators", where_, MOST_NESTING));
      const int right = level(depth + 1);
      left = add(*operation, left, right);
    }
    return left;
  }
  template <typename Inner>
  int nested(Inner inner) {
    if (++nesting_ > MOST_NESTING) throw InputError(fmt::format("{}: nested more than {} deep", where_, MOST_NESTING));
    const int node = inner();
    --nesting_;
    return node;
  }
  int unary() {
    if (accept("-")) return add(StopOperation::NEGATIVE, nested([&] { return unary(); }), -1);
    if (const auto function = acceptOneOf(FUNCTIONS)) return add(*function, nested([&] { return parenthesis(); }), -1);
    if (const auto function = acceptOneOf(PAIR_FUNCTIONS)) return nested([&] { return pair(*function); });
    skipSpace();
    if (at_ < text_.size() && text_[at_] == '(') return nested([&] { return parenthesis(); });
    return atom();
  }
  int parenthesis() {
    if (!accept("(")) refuse("'('");
    const int node = level(0);
    if (!accept(")")) refuse("')'");
    return node;
  }
  int pair(StopOperation operation) {
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
    const int node = add(StopOperation::NAME, -1, -1);
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
    const int node = add(StopOperation::NUMBER, -1, -1);
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
  if (node.operation == StopOperation::NUMBER) return node.number;
  if (node.operation == StopOperation::NAME) return node.quantity(report);
  const double a = value(node.left, report);
  if (node.operation == StopOperation::AND && !isTrue(a)) return 0;
  if (node.operation == StopOperation::OR && isTrue(a)) return 1;
  return applied(node.operation, a, node.right < 0 ? 0 : value(node.right, report));
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
