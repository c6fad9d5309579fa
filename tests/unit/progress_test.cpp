// SPDX-License-Identifier: Apache-2.0
// What Progress prints on a terminal and elsewhere, what it remembers, how Ctrl-C stops it; files written whole or not.
#include "host/base/progress.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <thread>

#include "host/base/atomic_file.h"
#include "host/base/errors.h"

namespace turbid {
namespace {

void wait(int milliseconds) {
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

std::string printed(const std::function<void()>& action) {
  testing::internal::CaptureStderr();
  action();
  return testing::internal::GetCapturedStderr();
}

TEST(Progress, PrintsOnePlainLinePerStageWhenNotOnATerminal) {
  Progress progress;
  const std::string text = printed([&] {
    progress.stage("voxelise");
    for (int i = 0; i <= 10; ++i) progress.update(i / 10.0);
    progress.stage("march");
    progress.detail("only with -v");
    progress.finish();
    progress.finish();  // nothing left to finish
  });
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2) << text;
  EXPECT_EQ(text.rfind("voxelise ", 0), 0u) << text;
  EXPECT_NE(text.find("\nmarch "), std::string::npos) << text;
  EXPECT_NE(text.find(" s\n"), std::string::npos) << text;
  EXPECT_EQ(text.find('\r'), std::string::npos) << text;
}

TEST(Progress, RemembersWallTimesInOrder) {
  Progress progress(Verbosity::quiet);
  progress.stage("a");
  wait(30);
  progress.stage("b");
  progress.finish();
  ASSERT_EQ(progress.times().size(), 2u);
  EXPECT_EQ(progress.times()[0].name, "a");
  EXPECT_GE(progress.times()[0].seconds, 0.03);
  EXPECT_LT(progress.times()[0].seconds, 5);  // a loaded machine sleeps longer, but not that long
  EXPECT_EQ(progress.times()[1].name, "b");
}

TEST(Progress, QuietPrintsWarningsOnlyAndVerboseDetailsToo) {
  Progress quiet(Verbosity::quiet), verbose(Verbosity::verbose);
  EXPECT_EQ(printed([&] {
              quiet.stage("a");
              quiet.update(0.5);
              quiet.detail("no");
              quiet.warn("the mesh was inside out and has been turned");
              quiet.finish();
            }),
            "warning: the mesh was inside out and has been turned\n");
  EXPECT_EQ(quiet.warnings(), (std::vector<std::string>{"the mesh was inside out and has been turned"}));
  EXPECT_EQ(printed([&] { verbose.detail("70224 triangles"); }), "  70224 triangles\n");
}

TEST(Progress, DrawsABarWithPercentageAndTimeLeftOnATerminal) {
  const int host = posix_openpt(O_RDWR | O_NOCTTY);
  ASSERT_GE(host, 0);
  ASSERT_EQ(grantpt(host), 0);
  ASSERT_EQ(unlockpt(host), 0);
  const int terminal = open(ptsname(host), O_RDWR | O_NOCTTY);
  ASSERT_GE(terminal, 0);
  const int saved = dup(STDERR_FILENO);
  setenv("TERM", "xterm", 1);
  fflush(stderr);
  dup2(terminal, STDERR_FILENO);
  {
    Progress progress;
    progress.stage("march");
    wait(600);
    progress.update(0.25);
    progress.finish();
  }
  fflush(stderr);
  dup2(saved, STDERR_FILENO);
  close(saved);
  fcntl(host, F_SETFL, O_NONBLOCK);
  std::string text;
  char buffer[4096];
  for (ssize_t size; (size = ::read(host, buffer, sizeof buffer)) > 0;) text.append(buffer, size);
  close(terminal);
  close(host);
  EXPECT_NE(text.find("\rmarch [......"), std::string::npos) << text;
  EXPECT_NE(text.find("march [######..................]  25 %"), std::string::npos) << text;
  EXPECT_NE(text.find(" s left"), std::string::npos) << text;         // 0.6 s for a quarter: about 1.8 s for the rest
  EXPECT_NE(text.find("\r\033[Kmarch "), std::string::npos) << text;  // the bar gives way to the stage's line
}

/// In a child process (the flag cannot be taken back): Ctrl-C during "march", then print what was thrown.
[[noreturn]] void stop_during_march(bool at_next_stage, int signal) {
  install_interrupt_handler();
  Progress progress(Verbosity::quiet);
  progress.stage("voxelise");
  progress.stage("upload");
  progress.stage("march");
  raise(signal);
  try {
    if (at_next_stage) progress.stage("lattice");
    progress.update(0.5);
  } catch (const Interrupted& stop) {
    std::fprintf(stderr, "<%s>\n", stop.what());
    _exit(0);
  }
  _exit(1);
}

TEST(InterruptDeathTest, CtrlCStopsTheStageAndSaysWhatWasFinished) {
  EXPECT_EXIT(stop_during_march(false, SIGINT), testing::ExitedWithCode(0),
              "<stopped during march; finished: voxelise, upload>");
  EXPECT_EXIT(stop_during_march(true, SIGTERM), testing::ExitedWithCode(0),
              "<stopped before lattice; finished: voxelise, upload, march>");
}

TEST(InterruptDeathTest, ASecondCtrlCEndsTheProcessAtOnce) {
  const auto twice = [] {
    install_interrupt_handler();
    raise(SIGINT);
    if (!interrupt_requested()) _exit(1);
    raise(SIGINT);
    _exit(2);
  };
  EXPECT_EXIT(twice(), testing::ExitedWithCode(130), "stopping");
}

TEST(AtomicFileDeathTest, AFullDiskIsAnErrorWithAReasonAndLeavesNothing) {
  // A limit on file size stands in for a full disk: both make write() fail half-way.
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "turbid-atomic-file";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  const std::string path = (folder / "a.bin").string();
  write_file_atomically(path, "old", 3);
  const auto overflow = [&] {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{4096, 4096};
    setrlimit(RLIMIT_FSIZE, &limit);
    const std::string much(1 << 20, 'x');
    try {
      write_file_atomically(path, much.data(), much.size());
    } catch (const InputError& error) {
      std::fprintf(stderr, "<%s>\n", error.what());
      _exit(0);
    }
    _exit(1);
  };
  EXPECT_EXIT(overflow(), testing::ExitedWithCode(0), "a.bin: cannot be written: File too large>");
  EXPECT_EQ(std::filesystem::file_size(path), 3u);  // the old file is untouched
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()), 1);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace turbid
