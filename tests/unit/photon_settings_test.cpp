// SPDX-License-Identifier: Apache-2.0
// Keys of [solver.photon].
#include <gtest/gtest.h>

#include "tests/unit/scene_files.h"

namespace turbid {
namespace {

using test::error_of;
using test::kBall;
using test::read_text;

TEST(PhotonSettings, are_read_checked_and_written_back) {
  const Scene scene = read_text(std::string(kBall) + "[solver]\nname = \"photon\"\nseed = 9\n[solver.photon]\nphotons = 5_000_000_000\n" +
                                "error = 0.01\nbatches = 64\nmax_steps = 1000\n");
  EXPECT_EQ(scene.solver.solver, "photon");
  EXPECT_EQ(scene.solver.photon.photons, 5'000'000'000);
  EXPECT_FLOAT_EQ(scene.solver.photon.error, 0.01f);
  EXPECT_EQ(scene.solver.photon.batches, 64);
  EXPECT_EQ(scene.solver.photon.max_steps, 1000);
  const Scene again = read_text(scene.effective_toml);
  EXPECT_EQ(again.solver.photon.photons, 5'000'000'000);
  EXPECT_EQ(again.hash, scene.hash);
}

TEST(PhotonSettings, out_of_range_or_unknown_are_refused) {
  auto error = [](const std::string& line) { return error_of(std::string(kBall) + "[solver.photon]\n" + line + "\n"); };
  EXPECT_HOLDS(error("photons = 0"), "photons = 0: must be");
  EXPECT_HOLDS(error("batches = 1"), "batches = 1: must be");
  EXPECT_HOLDS(error("error = 1.5"), "error = 1.5: must be");
  EXPECT_HOLDS(error("checkpoint = \"x\""), "checkpoint");
}

}  // namespace
}  // namespace turbid
