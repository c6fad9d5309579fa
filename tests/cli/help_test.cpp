// SPDX-License-Identifier: Apache-2.0
// What the program says of itself, and of command lines that it can't follow.
#include <gtest/gtest.h>

#include "tests/support/run.h"
#include "tests/support/small_scene.h"

namespace turbid::test {
namespace {

TEST(Help, every_command_explains_itself_with_an_example) {
  const Workplace place;
  const Outcome all = place.turbid({"--help"});
  EXPECT_EQ(all.status, 0);
  EXPECT_EQ(all.err, "");
  for (const std::string command : {"render", "solve", "voxelise", "check", "devices", "info", "compare", "profile", "bench", "verify"}) {
    EXPECT_NE(all.out.find("\n  " + command + " "), std::string::npos) << all.out;
    const Outcome help = place.turbid({command, "--help"});
    EXPECT_EQ(help.status, 0);
    EXPECT_EQ(help.err, "");
    EXPECT_TRUE(help.out.find("Example:\n  turbid " + command) != std::string::npos ||
                help.out.find("Examples:\n  turbid " + command) != std::string::npos)
        << help.out;
  }
}

TEST(Help, the_version_is_a_number) {
  const Outcome version = Workplace().turbid({"--version"});
  EXPECT_EQ(version.status, 0);
  EXPECT_EQ(version.out, std::string("turbid ") + TURBID_VERSION + "\n");
}

struct WrongCommandLine {
  const char* name;
  std::vector<std::string> arguments;
  const char* said;
};
void PrintTo(const WrongCommandLine& c, std::ostream* out) {
  *out << c.name;
}

class CommandLine : public testing::TestWithParam<WrongCommandLine> {};

TEST_P(CommandLine, what_cannot_be_followed_is_one_clear_line_and_status_2) {
  const Workplace place;
  place.write("s.toml", kMilkyBall);
  const Outcome outcome = place.turbid(GetParam().arguments);
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.out, "");
  ASSERT_EQ(outcome.error_lines().size(), 1u) << outcome.err;
  EXPECT_TRUE(outcome.err.starts_with("turbid: ")) << outcome.err;
  EXPECT_NE(outcome.err.find(GetParam().said), std::string::npos) << outcome.err;
  EXPECT_EQ(place.content(), std::vector<std::string>{"s.toml"});
}

INSTANTIATE_TEST_SUITE_P(
    All, CommandLine,
    testing::Values(
        WrongCommandLine{"nothing", {}, "no command given"},
        WrongCommandLine{"unknown_command", {"rendr", "s.toml"}, "rendr: no such command; there are render, solve"},
        WrongCommandLine{"no_scene", {"render"}, "SCENE is required; see turbid render --help"},
        WrongCommandLine{"two_scenes", {"render", "s.toml", "t.toml"}, "t.toml"},
        WrongCommandLine{"unknown_flag", {"solve", "s.toml", "--fast"}, "--fast"},
        WrongCommandLine{"word_for_a_number", {"check", "s.toml", "--resolution", "high"}, "--resolution = high"},
        WrongCommandLine{"negative_seed", {"render", "s.toml", "--seed", "-1"}, "--seed"},
        WrongCommandLine{"loud_and_quiet", {"render", "s.toml", "-v", "-q"}, "excludes"},
        WrongCommandLine{"no_file", {"info"}, "FILE is required"},
        WrongCommandLine{
            "setting_without_value", {"check", "s.toml", "-D", "camera.fov"}, "-D camera.fov: expected key.sub=value"}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace turbid::test
