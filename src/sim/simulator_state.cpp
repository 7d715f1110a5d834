// Save, restore, reset, hash.
#include <algorithm>
#include <utility>

#include "blem_sim/geometry/state_stream.h"
#include "blem_sim/sim/state_file.h"
#include "numbers/content_hash.h"
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

/** @param steps of the state */
Epoch epochFrom(std::uint64_t steps, geometry::StateReader* reader) {
  const double time = reader->number(), step = reader->number();
  if (!(time >= 0) || !(step >= 0 && step <= static_cast<double>(steps)))
    reader->refuseContent("the time step was set at a step that is still to come");
  return {time, static_cast<std::uint64_t>(step)};
}

/** Ticks of a substep: those of a step, or half of that, and so on. */
int mostTicksFrom(geometry::StateReader* reader) {
  const double ticks = reader->number();
  for (int most = Substeps::MAX_SUBSTEPS; most > 0; most /= 2)
    if (ticks == most) return most;
  reader->refuseContent("a step is divided into no even parts");
}

}  // namespace

/** Parts of a state except the world's, read and found sound, and not in force yet. */
struct Simulator::Impl::StateParts {
  bool stopped;
  EnergyBalance energy_balance;
  std::vector<JointMotor> motors;
  SensorSet sensors;
  reduction::ReductionMemory choices;
  LayerWatch layer_watch;
  CrossingHistory crossings;
  FadingPoints fading;
  LayerStops stops;
  Epoch epoch;
  AppliedLoads loads;
  BaseDrives base_drives;
  int most_ticks = Substeps::MAX_SUBSTEPS;
};

const std::string& Simulator::Impl::layout() const {
  if (layout_.empty()) layout_ = layoutOf(config_, world_);
  return layout_;
}

SimulationState Simulator::Impl::content() const {
  SimulationState state;
  state.step = step_count_;
  state.world = world_.world.save();
  geometry::StateWriter writer(&state);
  writer.flag(stopped_);
  energy_balance_.save(world_.world.bodyCount(), &writer);
  for (std::size_t joint = 0; joint < world_.motors.size(); ++joint)
    if (world_.world.hasJoint(static_cast<int>(joint))) world_.motors[joint].save(&writer);
  sensors_.save(&writer);
  constraint_maker_.memory().save(&writer);
  layer_watch_.save(&writer);
  at_hand_.crossings.save(&writer);
  if (!live_.empty()) fading_.save(&writer);
  constraint_maker_.stops().save(&writer);
  saveRarities(&writer);
  return state;
}

// Most simulations have none of these, and their states none of these numbers. Whatever is rare brings what stands before it.
void Simulator::Impl::saveRarities(geometry::StateWriter* writer) const {
  const bool driven = !base_drives_.empty(), divided = most_ticks_ != Substeps::MAX_SUBSTEPS || driven,
             tared = sensors_.isTared() || divided;
  if (loads_.empty() && epoch_.step == 0 && !tared) return;
  writer->numbers({epoch_.time, static_cast<double>(epoch_.step)});
  loads_.save(writer);
  if (tared) sensors_.saveTares(writer);
  if (divided) writer->number(most_ticks_);
  if (driven) base_drives_.save(writer);
}

Simulator::Impl::StateParts Simulator::Impl::partsOf(const SimulationState& state) const {
  constexpr std::uint64_t MOST_STEPS = std::uint64_t{1} << 53;  // up to here the times of all steps are different
  geometry::StateReader reader(state);
  if (state.step > MOST_STEPS) reader.refuseContent("there are more steps than time can count");
  reader.requireFinite();
  StateParts parts{reader.flag(), energy_balance_, world_.motors, {}, {}, {}, {}, {}, {}, {}, {}, {}};
  parts.energy_balance.restore(world_.world.bodyCount(), &reader);
  for (std::size_t joint = 0; joint < parts.motors.size(); ++joint)
    if (world_.world.hasJoint(static_cast<int>(joint))) parts.motors[joint].restore(&reader);
  parts.sensors.restore(world_, config_.time_step, &reader);
  parts.choices.restore(world_.colliders, &reader);
  parts.layer_watch.restore(world_.colliders, &reader);
  parts.crossings.restore(world_.colliders, &reader);
  if (!live_.empty()) parts.fading.restore(world_.colliders, &reader);
  parts.stops.restore(world_.colliders, &reader);
  if (reader.numbersLeft() > 0) {
    parts.epoch = epochFrom(state.step, &reader);
    parts.loads.restore(world_.world.bodyCount(), world_.world.jointCount(), &reader);
  }
  if (reader.numbersLeft() > 0) parts.sensors.restoreTares(&reader);
  if (reader.numbersLeft() > 0) parts.most_ticks = mostTicksFrom(&reader);
  if (reader.numbersLeft() > 0) parts.base_drives.restore(world_.world.bodyCount(), &reader);
  reader.finish();
  return parts;
}

SimulationState Simulator::Impl::save() const {
  SimulationState state = content();
  state.memories = memories_;
  state.layout = layout();
  state.header = headerOf(state);
  return state;
}

void Simulator::Impl::restore(const SimulationState& state) {
  checkHeader(state);
  checkLayout(state.layout, layout());
  StateParts parts = partsOf(state);
  world_.world.restoreChecked(state.world);
  // Nothing below throws.
  step_count_ = state.step;
  stopped_ = parts.stopped;
  energy_balance_ = std::move(parts.energy_balance);
  world_.motors = std::move(parts.motors);
  sensors_ = std::move(parts.sensors);
  constraint_maker_.memory() = std::move(parts.choices);
  fading_ = std::move(parts.fading);
  constraint_maker_.stops() = std::move(parts.stops);
  at_hand_.crossings = std::move(parts.crossings);
  layer_watch_ = std::move(parts.layer_watch);
  loads_ = std::move(parts.loads);
  base_drives_ = std::move(parts.base_drives);
  epoch_ = parts.epoch;
  most_ticks_ = parts.most_ticks;
  memories_ = state.memories;
  at_hand_.known = false;
  reportWithoutStep();
}

void Simulator::remember(const std::string& robot, const std::string& controller, const std::vector<double>& memory) {
  if (memory.empty())
    impl_->memories_[robot].erase(controller);
  else
    impl_->memories_[robot][controller] = memory;
}

std::vector<double> Simulator::memory(const std::string& robot, const std::string& controller) const {
  const auto known = impl_->memories_.find(robot);
  if (known == impl_->memories_.end()) return {};
  const auto memory = known->second.find(controller);
  return memory == known->second.end() ? std::vector<double>() : memory->second;
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
  impl_->sensors_.seed(impl_->world_, impl_->config_.random_seed);
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
