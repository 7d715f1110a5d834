// Save, restore, reset, hash.
#include <cstring>

#include "blem_sim/geometry/input_error.h"
#include "number_reader.h"
#include "simulator_impl.h"

namespace blem_sim {
namespace {

class Fnv1a {  // 64 bits [Fowler, Noll, Vo]
 public:
  void add(std::uint64_t word) {
    for (int byte = 0; byte < 8; ++byte) {
      hash_ ^= (word >> (8 * byte)) & 0xff;
      hash_ *= 0x100000001b3u;
    }
  }
  void add(const std::vector<double>& numbers) {
    add(static_cast<std::uint64_t>(numbers.size()));
    for (const double number : numbers) {
      std::uint64_t bits;
      std::memcpy(&bits, &number, sizeof(bits));
      add(bits);
    }
  }
  void add(const std::vector<std::uint64_t>& words) {
    add(static_cast<std::uint64_t>(words.size()));
    for (const std::uint64_t word : words) add(word);
  }
  void add(const std::string& text) {
    for (const unsigned char c : text) add(static_cast<std::uint64_t>(c));
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

}  // namespace

// Colliders are in it by their slots, as contacts are known by them.
std::string Simulator::Impl::layout() const {
  std::string layout;
  for (const ModelInfo& model : world_.models)
    if (model.alive) layout += model.name + ";";
  for (int body = 0; body < world_.world.bodyCount(); ++body) layout += world_.world.bodySpec(body).name + ";";
  for (int joint = 0; joint < world_.world.jointCount(); ++joint) layout += world_.world.jointSpec(joint).name + ";";
  for (std::size_t i = 0; i < world_.colliders.size(); ++i)
    if (world_.colliders[i].enabled) layout += std::to_string(i) + world_.colliders[i].name + ";";
  for (const SensorInfo& sensor : world_.sensors) layout += sensor.config.name + ";";
  return layout;
}

SimulationState Simulator::Impl::save() const {
  SimulationState state;
  state.step = step_count_;
  state.world = world_.world.save();
  state.words.push_back(stopped_ ? 1 : 0);
  energy_balance_.append(&state.numbers);
  for (const JointMotor& motor : world_.motors) motor.append(&state.numbers);
  for (const auto& sensor : sensors_) {
    sensor->append(&state.numbers);
    state.words.push_back(sensor->random().state());
  }
  contacts_.memory().append(&state.words);
  layer_watch_.append(&state.words);
  contacts_.appendRecoveries(&state.numbers, &state.words);
  contacts_.stops().append(&state.words);
  state.layout = layout();
  return state;
}

void Simulator::Impl::restore(const SimulationState& state) {
  if (state.layout != layout())
    throw InputError("restore: the state belongs to other models; restore it where the same models, joints and environments are loaded");
  const SimulationState before = save();
  try {
    read(state);
  } catch (const InputError&) {
    read(before);
    throw;
  }
  contacts_.forget();
  reportWithoutStep();
}

void Simulator::Impl::read(const SimulationState& state) {
  world_.world.restore(state.world);
  NumberReader reader(state.numbers);
  energy_balance_.read(&reader);
  for (JointMotor& motor : world_.motors) motor.read(&reader);
  for (const auto& sensor : sensors_) sensor->restore(&reader);
  if (state.words.size() < 1 + sensors_.size()) NumberReader::refuse();
  for (std::size_t i = 0; i < sensors_.size(); ++i) sensors_[i]->random().setState(state.words[i + 1]);
  const std::uint64_t *words = state.words.data() + sensors_.size() + 1, *words_end = state.words.data() + state.words.size();
  if (!contacts_.memory().read(&words, words_end) || !layer_watch_.read(&words, words_end) ||
      !contacts_.readRecoveries(&words, words_end, &reader) || !contacts_.stops().read(words, words_end))
    NumberReader::refuse();
  reader.finish();
  step_count_ = state.step;
  stopped_ = state.words[0] != 0;
}

void Simulator::Impl::resetWorld() {
  world_.world.restore(initial_state_);
  for (JointMotor& motor : world_.motors) motor.reset();
  for (const auto& sensor : sensors_) sensor->reset();
  stopped_ = false;
  contacts_.memory().clear();
  contacts_.stops().clear();
  contacts_.forgetRecoveries();
  layer_watch_.clear();
  energy_balance_.clear();
  contacts_.forget();
  reportWithoutStep();
}

void Simulator::Impl::seedSensors() {
  RandomNumbers seeds(config_.random_seed);
  for (const auto& sensor : sensors_) sensor->random().setState(seeds.next());
}

SimulationState Simulator::save() const { return impl_->save(); }
void Simulator::restore(const SimulationState& state) { impl_->restore(state); }
void Simulator::resetWorld() { impl_->resetWorld(); }

void Simulator::resetSimulation() {
  impl_->step_count_ = 0;
  impl_->seedSensors();
  impl_->resetWorld();
}

std::uint64_t Simulator::stateHash() const {
  const SimulationState state = impl_->save();
  Fnv1a hash;
  hash.add(state.step);
  hash.add(state.world.numbers);
  hash.add(state.world.words);
  hash.add(state.numbers);
  hash.add(state.words);
  hash.add(state.layout);
  return hash.value();
}

}  // namespace blem_sim
