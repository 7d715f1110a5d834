// Reading and writing a WorldState, number by number.
#pragma once

#include "blem_sim/dynamics/world_types.h"

namespace blem_sim::dynamics {

class StateWriter {
 public:
  explicit StateWriter(WorldState* state) : state_(state) {}
  void number(double x) { state_->numbers.push_back(x); }
  void numbers(const double* x, std::size_t count) { state_->numbers.insert(state_->numbers.end(), x, x + count); }
  void vector(const Vector3& v) { numbers(v.data(), 3); }
  void word(std::uint64_t w) { state_->words.push_back(w); }

 private:
  WorldState* state_;
};

/** Reads in the order of writing; throws InputError where the state ends too early or cannot be of this world. */
class StateReader {
 public:
  explicit StateReader(const WorldState& state) : state_(state) {}
  double number();
  void numbers(double* x, std::size_t count);
  Vector3 vector();
  std::uint64_t word();
  /** A word that counts items of so many words and numbers each; refused if the rest of the state cannot hold them. */
  std::size_t count(std::size_t words_each, std::size_t numbers_each);
  /** Refuses the state: it is not of this world. */
  [[noreturn]] static void refuse();
  /** Throws InputError unless everything was read. */
  void finish() const;

 private:
  const WorldState& state_;
  std::size_t next_number_ = 0, next_word_ = 0;
};

class Scene;
class ContactMemory;

void saveScene(const Scene& scene, StateWriter* writer);
void restoreScene(Scene* scene, StateReader* reader);
void saveMemory(const ContactMemory& memory, StateWriter* writer);
void restoreMemory(ContactMemory* memory, StateReader* reader);

}  // namespace blem_sim::dynamics
