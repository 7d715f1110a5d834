// Save, restore, reset, hash.
#include <utility>

#include "blem_sim/sim/state_file.h"
#include "numbers/content_hash.h"
#include "numbers/number_reader.h"
#include "simulator_impl.h"
#include "state/state_header.h"
#include "state/state_layout.h"

namespace blem_sim::sim {
namespace {

// The names of a state's layout, in the order of its content. Colliders are in it by their slots, as contacts are known by them.
std::string namesOfAll(const SimulatedWorld& world) {
  std::string names;
  for (const ModelInfo& model : world.models)
    if (model.alive) names += model.name + ";";
  for (int body = 0; body < world.world.bodyCount(); ++body)
    if (world.world.hasBody(body)) names += world.world.bodySpec(body).name + ";";
  for (int joint = 0; joint < world.world.jointCount(); ++joint)
    if (world.world.hasJoint(joint)) names += world.world.jointSpec(joint).name + ";";
  for (std::size_t i = 0; i < world.colliders.size(); ++i)
    if (world.colliders[i].enabled) names += std::to_string(i) + world.colliders[i].name + ";";
  for (const SensorInfo& sensor : world.sensors) names += sensor.config.name + ";";
  return names;
}

/** Parts of a state except the world's, read and found sound, and not in force yet. */
struct StateParts {
  EnergyBalance energy_balance;
  std::vector<JointMotor> motors;
  std::vector<std::vector<double>> sensors;  // numbers of each
  std::vector<DelayLine> delays;             // of each
  reduction::ReductionMemory choices;
  LayerWatch layer_watch;
  CrossingHistory crossings;
  FadingPoints fading;
  LayerStops stops;
  AppliedLoads loads;
  Epoch epoch;
};

/** The next numbers of the state, as many as the sensor has. */
std::vector<double> numbersOf(const Sensor& sensor, NumberReader* reader) {
  std::vector<double> numbers;
  sensor.append(&numbers);
  reader->numbers(numbers.data(), numbers.size());
  return numbers;
}

/** Words of a state: whether the simulation has stopped, then of each sensor its random numbers, then those of contacts. */
std::size_t contactWords(std::size_t sensors) { return 1 + sensors; }

/** Reads the numbers at the end, which only states with loads or another time step have. */
void readLoads(const SimulationState& state, const SimulatedWorld& world, NumberReader* reader, StateParts* parts) {
  if (reader->left() == 0) return;
  parts->epoch.time = reader->number();
  const double step = reader->number();
  if (!(parts->epoch.time >= 0) || !(step >= 0 && step <= static_cast<double>(state.step)))
    NumberReader::refuseContent("the time step was set at a step that is still to come");
  parts->epoch.step = static_cast<std::uint64_t>(step);
  parts->loads.read(world.world.bodyCount(), world.world.jointCount(), reader);
}

/** @param first word @param live there are live environments, of whose points the state tells */
void readContacts(const SimulationState& state, const std::vector<contact::Collider>& colliders, std::size_t first, bool live,
                  NumberReader* reader, StateParts* parts) {
  const std::uint64_t *words = state.words.data() + first, *end = state.words.data() + state.words.size();
  if (!parts->choices.read(colliders, &words, end) || !parts->layer_watch.read(colliders, &words, end) ||
      !parts->crossings.read(colliders, &words, end, reader) || (live && !parts->fading.read(colliders, &words, end)) ||
      !parts->stops.read(colliders, words, end))
    NumberReader::refuseContent("memories of contacts are of no pairs of these colliders");
}

/** @param parts as they are now, overwritten @throws InputError */
void readParts(const SimulationState& state, const SimulatedWorld& world, const std::vector<SensorChannel>& sensors, bool live,
               StateParts* parts) {
  constexpr std::uint64_t MOST_STEPS = std::uint64_t{1} << 53;  // up to here the times of all steps are different
  if (state.step > MOST_STEPS) NumberReader::refuseContent("there are more steps than time can count");
  const std::size_t contacts = contactWords(sensors.size());
  if (state.words.size() < contacts) NumberReader::refuse();
  if (state.words[0] > 1) NumberReader::refuseContent("a flag is neither 0 nor 1");
  NumberReader reader(state.numbers);
  parts->energy_balance.read(world.world.bodyCount(), &reader);
  for (std::size_t joint = 0; joint < parts->motors.size(); ++joint)
    if (world.world.hasJoint(static_cast<int>(joint))) parts->motors[joint].read(&reader);
  for (const SensorChannel& sensor : sensors) {
    parts->sensors.push_back(numbersOf(sensor.sensor(), &reader));
    parts->delays.push_back(sensor.delay());
    parts->delays.back().read(&reader);
  }
  readContacts(state, world.colliders, contacts, live, &reader, parts);
  readLoads(state, world, &reader, parts);
  reader.finish();
}

}  // namespace

const std::string& Simulator::Impl::layout() const {
  if (layout_.empty()) layout_ = layoutOf(config_, world_);
  return layout_;
}

SimulationState Simulator::Impl::content() const {
  SimulationState state;
  state.step = step_count_;
  state.world = world_.world.save();
  state.words.push_back(stopped_ ? 1 : 0);
  energy_balance_.append(&state.numbers);
  for (std::size_t joint = 0; joint < world_.motors.size(); ++joint)
    if (world_.world.hasJoint(static_cast<int>(joint))) world_.motors[joint].append(&state.numbers);
  for (const SensorChannel& sensor : sensors_) {
    sensor.sensor().append(&state.numbers);
    sensor.delay().append(&state.numbers);
    state.words.push_back(sensor.sensor().random().state());
  }
  constraint_maker_.memory().append(&state.words);
  layer_watch_.append(&state.words);
  at_hand_.crossings.append(&state.numbers, &state.words);
  if (!live_.empty()) fading_.append(&state.words);
  constraint_maker_.stops().append(&state.words);
  if (loads_.empty() && epoch_.step == 0) return state;
  state.numbers.insert(state.numbers.end(), {epoch_.time, static_cast<double>(epoch_.step)});
  loads_.append(&state.numbers);
  return state;
}

SimulationState Simulator::Impl::save() const {
  SimulationState state = content();
  state.layout = layout();
  state.header = headerOf(state);
  return state;
}

void Simulator::Impl::restore(const SimulationState& state) {
  checkHeader(state);
  checkLayout(state.layout, layout());
  StateParts parts{energy_balance_, world_.motors, {}, {}, {}, {}, {}, {}, {}, {}, {}};
  readParts(state, world_, sensors_, !live_.empty(), &parts);
  world_.world.restoreChecked(state.world);
  // Nothing below throws.
  step_count_ = state.step;
  stopped_ = state.words[0] != 0;
  energy_balance_ = std::move(parts.energy_balance);
  world_.motors = std::move(parts.motors);
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    NumberReader reader(parts.sensors[i]);
    sensors_[i].sensor().restore(&reader);
    sensors_[i].sensor().random().setState(state.words[1 + i]);
    sensors_[i].delay() = std::move(parts.delays[i]);
  }
  constraint_maker_.memory() = std::move(parts.choices);
  fading_ = std::move(parts.fading);
  constraint_maker_.stops() = std::move(parts.stops);
  at_hand_.crossings = std::move(parts.crossings);
  layer_watch_ = std::move(parts.layer_watch);
  loads_ = std::move(parts.loads);
  epoch_ = parts.epoch;
  at_hand_.known = false;
  reportWithoutStep();
}

// A sensor's noise is a stream of its own, told by names: other sensors and robots change nothing in it.
void Simulator::Impl::seedSensor(std::size_t sensor) {
  const SensorInfo& info = world_.sensors[sensor];
  ContentHash seed;
  seed.add(config_.random_seed).add(world_.robots[info.robot].name).add(info.config.name);
  sensors_[sensor].sensor().random().setState(seed.value());
}

SimulationState Simulator::save() const { return impl_->save(); }
void Simulator::restore(const SimulationState& state) {
  impl_->restore(state);
  if (impl_->watcher_) impl_->watcher_->told({"restore", {}, {}, stateBytes(state)});
}
void Simulator::resetWorld() {
  impl_->resetWorld();
  impl_->tell("resetWorld");
}

void Simulator::resetSimulation() {
  impl_->step_count_ = 0;
  impl_->epoch_ = Epoch();
  for (std::size_t i = 0; i < impl_->sensors_.size(); ++i) impl_->seedSensor(i);
  impl_->resetWorld();
  impl_->tell("resetSimulation");
}

std::uint64_t Simulator::stateHash() const {
  const SimulationState state = impl_->content();
  ContentHash hash;
  hash.add(state.step).add(state.world.numbers).add(state.world.words).add(state.numbers).add(state.words);
  return hash.add(namesOfAll(impl_->world_)).value();
}

}  // namespace blem_sim::sim
