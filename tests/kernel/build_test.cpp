// SPDX-License-Identifier: Apache-2.0
// Every kernel file builds for every combination of its integers, and stops where one is missing.
#include <gtest/gtest.h>

#include "host/base/errors.h"
#include "tests/support/test_media.h"

namespace turbid {
namespace {

TEST(KernelFiles, RayProgramsBuildForEveryKindOfScene) {
  for (const char* file : {"march.cl", "view.cl"}) {
    for (int choice = 0; choice < 48; ++choice) {  // from 32 on with tiles in half precision, where they are read
      const long channels = choice & 1 ? 3 : 1, bodies = choice & 2 ? 2 : 0, half = choice >= 32;
      EXPECT_NO_THROW(test::session().build(file, {{"TURBID_CHANNELS", channels},
                                                   {"TURBID_BODIES", bodies},
                                                   {"TURBID_GRADED", half | (choice >> 2 & 1)},
                                                   {"TURBID_HETEROGENEOUS", half | (choice >> 3 & 1)},
                                                   {"TURBID_HALF_TILES", half},
                                                   {"TURBID_INDEX_EXPONENT", 13},
                                                   {"TURBID_COEFFICIENT_EXPONENT", -3},
                                                   {"TURBID_SCATTERING", choice >> 4 & 1},
                                                   {"TURBID_INTERLEAVE", choice & 1 ? 32 : 1},
                                                   {"TURBID_RAYS_PER_CLAIM", 64},
                                                   {"TURBID_SAMPLES_PER_CLAIM", 64},
                                                   {"TURBID_OWN_SUMS", choice & 1},
                                                   {"TURBID_FIRST_MOMENT", choice & 1},
                                                   {"TURBID_LIGHTS", 1 << choice % 4},
                                                   {"TURBID_VOXELS_X", 16},
                                                   {"TURBID_VOXELS_Y", 24},
                                                   {"TURBID_VOXELS_Z", 8}}))
          << file << " " << choice;
    }
  }
}

TEST(KernelFiles, LatticesOfEitherEdgeAndTheGlobalOneBuildForEveryCollisionAndStorage) {
  for (long choice = 0; choice < 8; ++choice) {
    const cl::Define collision{"TURBID_COLLISION", choice % 4}, half{"TURBID_HALF", choice / 4};
    for (long edge : {4, 8})
      EXPECT_NO_THROW(test::session().build("lattice.cl", {{"TURBID_EDGE", edge}, collision, half})) << choice;
    EXPECT_NO_THROW(test::session().build("global_lattice.cl", {collision, half})) << choice;
  }
}

TEST(KernelFiles, TheSteadySolveBuilds) {
  EXPECT_NO_THROW(test::session().build("steady.cl", {}));
}

TEST(KernelFiles, AMissingIntegerIsAnErrorThatNamesIt) {
  try {
    test::session().build("lattice.cl", {{"TURBID_EDGE", 8}, {"TURBID_HALF", 0}});
    FAIL() << "built";
  } catch (const DeviceError& error) {
    EXPECT_NE(std::string(error.what()).find("TURBID_COLLISION"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("lattice.cl"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace turbid
