#include "core/program.hpp"

#include "core/error.hpp"

#include <gtest/gtest.h>

#include <string>

namespace scree {
namespace {

std::string message_of(const std::vector<std::string>& command) {
  try {
    run_program(command);
  } catch (const RunError& error) {
    return error.what();
  }
  return "none";
}

TEST(RunProgram, ReturnsWhatItWrites) { EXPECT_EQ(run_program({"printf", "a%sc", "b"}), "abc"); }

// The text is more than a pipe holds, in both directions at once.
TEST(RunProgram, GivesAndTakesMuch) {
  std::string text;
  for (int k = 0; k < 400000; ++k) text += std::to_string(k) + '\n';
  EXPECT_EQ(run_program({"cat"}, text), text);
  EXPECT_EQ(run_program({"cat"}), "");
}

TEST(RunProgram, SaysHowItFailed) {
  EXPECT_EQ(message_of({"scree-no-such-program"}),
            "the program scree-no-such-program is not installed: install it and call scree again");
  EXPECT_EQ(message_of({"sh", "-c", "echo fine; echo why >&2; exit 3"}), "sh failed: why\n");
  EXPECT_EQ(message_of({"sh", "-c", "kill -9 $$"}), "sh was ended by signal 9");
  EXPECT_EQ(message_of({"/"}), "/ does not start: Permission denied");
}

TEST(RunProgram, KeepsTheLastWordsOfMany) {
  const std::string message =
      message_of({"sh", "-c", "yes many words | head -n 9999 >&2; echo last >&2; exit 1"});
  EXPECT_TRUE(message.ends_with("many words\nlast\n"));
  EXPECT_LT(message.size(), 2100u);
}

}  // namespace
}  // namespace scree
