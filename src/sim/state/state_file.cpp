#include "blem_sim/sim/state_file.h"

#include <fmt/format.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "blem_sim/geometry/input_error.h"
#include "state/whole_file.h"

namespace blem_sim::sim {

namespace {

// Format: little-endian 64-bit words throughout, so that a state goes from one machine to another.
const char FILE_MAGIC[] = "blem_sim state 2\n";

void putWord(std::ostream& stream, std::uint64_t word) {
  char bytes[8];
  for (int i = 0; i < 8; ++i) bytes[i] = static_cast<char>((word >> (8 * i)) & 0xff);
  stream.write(bytes, 8);
}

void putWords(std::ostream& stream, const std::vector<std::uint64_t>& words) {
  putWord(stream, words.size());
  for (const std::uint64_t word : words) putWord(stream, word);
}

void putNumbers(std::ostream& stream, const std::vector<double>& numbers) {
  putWord(stream, numbers.size());
  for (const double number : numbers) {
    std::uint64_t word;
    std::memcpy(&word, &number, sizeof word);
    putWord(stream, word);
  }
}

void putText(std::ostream& stream, const std::string& text) {
  putWord(stream, text.size());
  stream << text;
}

/** Most states have none, and no bytes for them. */
void putMemories(std::ostream& stream, const ControllerMemories& memories) {
  for (const auto& [robot, controllers] : memories) {
    for (const auto& [controller, memory] : controllers) {
      putText(stream, robot);
      putText(stream, controller);
      putNumbers(stream, memory);
    }
  }
}

/** Walks through the bytes of a file. */
class FileReader {
 public:
  FileReader(const std::string& bytes, const std::string& file) : bytes_(bytes), file_(file) {}

  std::string text(std::size_t size) {
    if (size > bytes_.size() - at_) fail();
    at_ += size;
    return bytes_.substr(at_ - size, size);
  }

  std::uint64_t word() {
    const std::string bytes = text(8);
    std::uint64_t word = 0;
    for (int i = 7; i >= 0; --i) word = (word << 8) | static_cast<unsigned char>(bytes[static_cast<std::size_t>(i)]);
    return word;
  }

  std::vector<std::uint64_t> words() {
    const std::uint64_t count = word();
    if (count > (bytes_.size() - at_) / 8) fail();
    std::vector<std::uint64_t> words(count);
    for (std::uint64_t& item : words) item = word();
    return words;
  }

  std::vector<double> numbers() {
    const std::vector<std::uint64_t> given = words();
    std::vector<double> numbers(given.size());
    if (!given.empty()) std::memcpy(numbers.data(), given.data(), 8 * given.size());
    return numbers;
  }

  bool atEnd() const { return at_ == bytes_.size(); }

 private:
  [[noreturn]] void fail() const {
    throw InputError(fmt::format("{}: is no whole state; save it again with --save-state or save_state", file_));
  }

  const std::string& bytes_;
  const std::string& file_;
  std::size_t at_ = 0;
};

}  // namespace

std::string stateBytes(const SimulationState& state) {
  std::ostringstream stream;
  stream.write(FILE_MAGIC, sizeof FILE_MAGIC - 1);
  for (const std::uint64_t word : {state.header.format, state.header.layout, state.header.length, state.header.checksum})
    putWord(stream, word);
  putText(stream, state.layout);
  putWord(stream, state.step);
  putNumbers(stream, state.world.numbers);
  putWords(stream, state.world.words);
  putNumbers(stream, state.numbers);
  putWords(stream, state.words);
  putMemories(stream, state.memories);
  return stream.str();
}

SimulationState stateOf(const std::string& bytes, const std::string& source) {
  FileReader reader(bytes, source);
  if (bytes.compare(0, sizeof FILE_MAGIC - 1, FILE_MAGIC) != 0)
    throw InputError(fmt::format("{}: is not a state that --save-state or save_state of this version wrote; save it again", source));
  reader.text(sizeof FILE_MAGIC - 1);
  SimulationState state;
  for (std::uint64_t* word : {&state.header.format, &state.header.layout, &state.header.length, &state.header.checksum})
    *word = reader.word();
  state.layout = reader.text(reader.word());
  state.step = reader.word();
  state.world.numbers = reader.numbers();
  state.world.words = reader.words();
  state.numbers = reader.numbers();
  state.words = reader.words();
  while (!reader.atEnd()) {
    const std::string robot = reader.text(reader.word()), controller = reader.text(reader.word());
    state.memories[robot][controller] = reader.numbers();
  }
  return state;
}

void saveState(const SimulationState& state, const std::string& file) { writeWhole(file, stateBytes(state)); }

SimulationState loadState(const std::string& file) {
  std::error_code error;
  std::ifstream stream(file, std::ios::binary);
  if (!stream || !std::filesystem::is_regular_file(file, error)) throw InputError(fmt::format("{}: cannot be read; check the path", file));
  std::ostringstream buffer;
  buffer << stream.rdbuf();
  return stateOf(buffer.str(), file);
}

}  // namespace blem_sim::sim
