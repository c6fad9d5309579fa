// SPDX-License-Identifier: Apache-2.0
// A test with an empty folder of its own that goes with it.
#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace turbid {

class ScratchFolder : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("turbid-" + std::string(test.test_suite_name()) + "-" + test.name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  const std::filesystem::path& folder() const { return folder_; }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

 private:
  std::filesystem::path folder_;
};

}  // namespace turbid
