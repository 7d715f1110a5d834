// The writer and the reader of saved states.
#include "blem_sim/geometry/state_stream.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace blem_sim::geometry {
namespace {

template <typename Read>
std::string refusal(const StateContent& content, const Read& read, const char* not_ours = StateReader::CUT_SHORT) {
  StateReader reader(content, not_ours);
  try {
    read(&reader);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(StateStream, EachListIsReadInTheOrderOfWriting) {
  StateContent content;
  StateWriter writer(&content);
  writer.flag(true);
  writer.number(0.5);
  writer.integer(7);
  writer.vector({1, 2, 3});
  writer.word(2);
  writer.words({8, 9});
  writer.numbers({4, 5});
  EXPECT_EQ(content.numbers, (std::vector<double>{0.5, 1, 2, 3, 4, 5}));
  EXPECT_EQ(content.words, (std::vector<std::uint64_t>{1, 7, 2, 8, 9}));
  StateReader reader(content);
  EXPECT_EQ(reader.number(), 0.5);
  EXPECT_EQ(reader.vector(), Vector3(1, 2, 3));
  EXPECT_TRUE(reader.flag());
  EXPECT_EQ(reader.word(), 7u);
  EXPECT_EQ(reader.words(reader.count(1, 0)), (std::vector<std::uint64_t>{8, 9}));
  double rest[2];
  reader.numbers(rest, 2);
  EXPECT_EQ(rest[1], 5);
  reader.finish();
}

TEST(StateStream, ListsThatEndTooEarlyOrTooLateAreRefused) {
  const StateContent content{{1, 2}, {1, 2}};
  const auto is_cut = [&](const auto& read) { return refusal(content, read, "not ours") == "not ours"; };
  double three[3];
  EXPECT_TRUE(is_cut([&](StateReader* reader) { reader->numbers(three, 3); }));
  EXPECT_TRUE(is_cut([](StateReader* reader) { reader->vector(); }));
  EXPECT_TRUE(is_cut([](StateReader* reader) { reader->words(3); }));
  EXPECT_TRUE(is_cut([](StateReader* reader) { reader->words(~std::size_t{0}); }));
  EXPECT_TRUE(is_cut([](StateReader* reader) {
    for (int i = 0; i < 3; ++i) reader->word();
  }));
  for (const StateContent& longer : {StateContent{{1}, {}}, StateContent{{}, {1}}})
    EXPECT_TRUE(has(refusal(longer, [](StateReader* reader) { reader->finish(); }), "cut short"));
}

TEST(StateStream, CountsThatTheRestCannotHoldAreRefused) {
  const StateContent content{{1, 2, 3}, {2, 0, 0, 0}};
  EXPECT_EQ(refusal(content, [](StateReader* reader) { reader->count(1, 1); }), "");
  EXPECT_TRUE(has(refusal(content, [](StateReader* reader) { reader->count(2, 0); }), "cut short"));
  EXPECT_TRUE(has(refusal(content, [](StateReader* reader) { reader->count(0, 2); }), "cut short"));
  const StateContent endless{{}, {~std::uint64_t{0}, 0}};
  EXPECT_TRUE(has(refusal(endless, [](StateReader* reader) { reader->count(3, 16); }), "cut short"));
}

TEST(StateStream, FlagsAndChoicesAreOfThoseThereAre) {
  for (const std::uint64_t word : {std::uint64_t{2}, std::uint64_t{256}, ~std::uint64_t{0}})
    EXPECT_TRUE(has(refusal({{}, {word}}, [](StateReader* reader) { reader->flag(); }), "a flag is neither 0 nor 1")) << word;
  EXPECT_EQ(refusal({{2}, {}}, [](StateReader* reader) { EXPECT_EQ(reader->choice(3), 2); }), "");
  for (const double number : {-1.0, 0.5, 3.0, 1e300, std::nan("")})
    EXPECT_TRUE(has(refusal({{number}, {}}, [](StateReader* reader) { reader->choice(3); }), "a choice is none of those there are"))
        << number;
}

TEST(StateStream, NumbersFromOutsideMustBeFinite) {
  const auto require = [](StateReader* reader) { reader->requireFinite(); };
  EXPECT_EQ(refusal({{1, 2}, {}}, require), "");
  EXPECT_TRUE(has(refusal({{1, std::nan("")}, {}}, require), "a number is not finite"));
  EXPECT_TRUE(has(refusal({{HUGE_VAL, 1}, {}}, require), "a number is not finite"));
}

}  // namespace
}  // namespace blem_sim::geometry
