// SPDX-License-Identifier: Apache-2.0
// The photon solver from the command line: its flags, its standard errors, and going on from a checkpoint.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/support/run.h"
#include "tests/support/small_scene.h"

namespace turbid::test {
namespace {

using Json = nlohmann::json;
using Words = std::vector<std::string>;

class PhotonCommand : public testing::Test {
 protected:
  void SetUp() override { place.write("ball.toml", kMilkyBall); }
  Json run(const Words& more) {
    Words words{"render", "ball.toml", "--json", "-q"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = place.turbid(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return Json::parse(outcome.out);
  }
  const Workplace place;
};

TEST_F(PhotonCommand, agrees_with_the_steady_solver_on_what_escapes) {
  const Json photon = run({"--solver", "photon", "--photons", "60000"});
  const Json steady = run({});
  EXPECT_EQ(photon["photon"]["photons"], 60000);
  for (int c = 0; c < 3; ++c) {
    const double mc = photon["photon"]["escaped"]["value"][c], se = photon["photon"]["escaped"]["standard_error"][c];
    EXPECT_GT(se, 0);
    // Four standard errors, and 3 %, which diffusion may be off at this albedo and 32 voxels (numerics section 2).
    EXPECT_NEAR(steady["energy"]["escaped"][c].get<double>(), mc, 4 * se + 0.03 * mc) << c;
  }
  EXPECT_LT(photon["energy"]["imbalance"].get<double>(), 1e-9);
}

TEST_F(PhotonCommand, gives_the_same_bits_again_with_a_checkpoint) {
  const Words flags{"--solver", "photon", "--photons", "20000", "--checkpoint", "run.checkpoint"};
  const Json first = run(flags), again = run(flags);
  EXPECT_EQ(first["checksums"], again["checksums"]);
}

TEST_F(PhotonCommand, says_which_flag_has_a_bad_value) {
  const Outcome outcome = place.turbid({"render", "ball.toml", "--photons", "many"});
  EXPECT_EQ(outcome.status, 2);
  ASSERT_EQ(outcome.error_lines().size(), 1u) << outcome.err;
  EXPECT_NE(outcome.err.find("photons"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace turbid::test
