#include "inputs/input_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "blem_sim/geometry/input_error.h"

namespace blem_sim::sim {

namespace {
constexpr double TURN_ERROR = 1e-6;  // of matrices that turn, and of symmetric ones
}

void InputReader::refuse(const std::string& why) const {
  throw InputError(fmt::format("input '{}': {}; record it again", input_.call, why));
}

void InputReader::number(double* value) {
  if (numbers_read_ == input_.numbers.size()) refuse("numbers are missing");
  *value = input_.numbers[numbers_read_++];
}

void InputReader::integer(int* value, int least, int most) {
  double number;
  this->number(&number);
  if (!(number >= least && number <= most) || number != std::floor(number))
    refuse(fmt::format("{} is no whole number from {} to {}", number, least, most));
  *value = static_cast<int>(number);
}

void InputReader::text(std::string* value) {
  if (texts_read_ == input_.texts.size()) refuse("texts are missing");
  *value = input_.texts[texts_read_++];
}

std::size_t InputReader::count(std::size_t) {
  double number;
  this->number(&number);
  const std::size_t left = input_.numbers.size() - numbers_read_ + input_.texts.size() - texts_read_;
  if (!(number >= 0 && number <= static_cast<double>(left)) || number != std::floor(number))
    refuse(fmt::format("a list of {} with {} arguments left", number, left));
  return static_cast<std::size_t>(number);
}

void InputReader::check(const Pose& pose) const {
  const Matrix3& turn = pose.linear();
  const bool is_turn = pose.matrix().allFinite() && turn.isUnitary(TURN_ERROR) && turn.determinant() > 0;
  if (!is_turn) refuse("a pose does not turn its axes, or is not finite");
}

void InputReader::finish() const {
  if (texts_read_ != input_.texts.size() || numbers_read_ != input_.numbers.size()) refuse("has more arguments than the call takes");
}

double InputReader::takeCommand() {
  const auto value = take<double>();
  if (!isCommand(value)) refuse(fmt::format("{} is no command", value));
  return value;
}

geometry::MassProperties InputReader::takeInertial() {
  auto inertial = take<geometry::MassProperties>();
  const Matrix3& inertia = inertial.inertia;
  const double skew = (inertia - inertia.transpose()).cwiseAbs().maxCoeff(), largest = inertia.cwiseAbs().maxCoeff();
  if (!inertia.allFinite() || !(skew <= TURN_ERROR * largest)) refuse("an inertia is not symmetric");
  return inertial;
}

int InputReader::takeIndex(const char* kind, std::size_t count) {
  const int index = take<int>();
  if (index < 0 || static_cast<std::size_t>(index) >= count) refuse(fmt::format("there is no {} {}", kind, index));
  return index;
}

int InputReader::takeModel() {
  const int model = takeIndex("model", simulator_.models().size());
  if (!simulator_.models()[model].alive) refuse(fmt::format("model {} is gone", model));
  return model;
}

int InputReader::takeBody() {
  const int body = takeIndex("body", static_cast<std::size_t>(simulator_.world().bodyCount()));
  if (!simulator_.world().hasBody(body)) refuse(fmt::format("body {} is gone", body));
  return body;
}

int InputReader::takeJoint() {
  const int joint = takeIndex("joint", static_cast<std::size_t>(simulator_.world().jointCount()));
  if (!simulator_.world().hasJoint(joint)) refuse(fmt::format("joint {} is gone", joint));
  return joint;
}

int InputReader::takeLinkOf(int body) {
  const int link = take<int>();
  int links = 0;
  for (const RobotInfo& robot : simulator_.robots())
    if (std::find(robot.bodies.begin(), robot.bodies.end(), body) != robot.bodies.end())
      links = static_cast<int>(robot.description->links.size());
  if (links == 0 ? link != -1 : link < 0 || link >= links) refuse(fmt::format("there is no link {} of body {}", link, body));
  return link;
}

}  // namespace blem_sim::sim
