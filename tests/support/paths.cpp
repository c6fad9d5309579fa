// SPDX-License-Identifier: Apache-2.0
// The only file of the tests that is compiled with absolute paths.
#include "tests/support/paths.h"

namespace turbid::test {

std::string turbid_binary() { return TURBID_BINARY; }
std::string build_folder() { return TURBID_BUILD_FOLDER; }
std::string cmake_binary() { return TURBID_CMAKE; }
std::string test_kernel(const std::string& file) { return TURBID_TEST_KERNELS "/" + file; }

}  // namespace turbid::test
