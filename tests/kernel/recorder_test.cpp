// SPDX-License-Identifier: Apache-2.0
// The event timeline and the count of device memory.
#include <gtest/gtest.h>

#include "tests/support/test_media.h"

namespace turbid {
namespace {

using F = cl::Buffer<float>;

struct Triad {
  cl::Session& session;
  cl::Program program = session.build("ceilings.cl", {});
  cl::Kernel<F, F, F, float> kernel{program, "triad"};
  F a = session.zeros<float>(16 * 1024), b = session.zeros<float>(16 * 1024), c = session.zeros<float>(16 * 1024);
  void run() { kernel.enqueue(session.march_queue(), {1024}, {64}, a, b, c, 2.0f); }
};

TEST(Recorder, SeesEveryCommandWithItsNameInTheOrderOfTheQueue) {
  cl::Session& session = test::session();
  cl::Recorder& recorder = session.recorder();
  recorder.start();
  Triad triad{session};
  recorder.stage("work");
  triad.run();
  session.copy(session.march_queue(), triad.a, triad.b);
  session.read(session.march_queue(), triad.a);
  recorder.stop();
  std::vector<std::string> names;
  for (const cl::Command& command : recorder.commands()) names.push_back(command.name);
  EXPECT_EQ(names, (std::vector<std::string>{"fill", "fill", "fill", "triad", "copy", "read"}));
  ASSERT_EQ(recorder.programs().size(), 1u);
  EXPECT_EQ(recorder.programs()[0].file, "ceilings.cl");
  const cl::Command& command = recorder.commands()[3];
  EXPECT_EQ(command.program, "ceilings.cl");
  EXPECT_EQ(command.queue, "march");
  EXPECT_EQ(command.stage, "work");
  EXPECT_EQ(command.global[0], 1024u);
  EXPECT_EQ(command.bytes(), 3u * 64 * 1024);
  ASSERT_EQ(command.buffers.size(), 3u);
  EXPECT_EQ(command.buffers[1].argument, "b");
}

TEST(Recorder, TimesLieInOrderWithinTheHostsOwn) {
  cl::Session& session = test::session();
  Triad triad{session};
  session.recorder().start();
  for (int i = 0; i < 20; ++i) triad.run();
  session.march_queue().finish();
  session.recorder().stop();
  const cl::Recorder& recorder = session.recorder();
  ASSERT_EQ(recorder.commands().size(), 20u);
  double before = recorder.started();
  for (const cl::Command& command : recorder.commands()) {
    // A tenth of a millisecond: how far the two clocks may have been taken apart.
    EXPECT_GE(command.queued, recorder.started() - 1e-4);
    EXPECT_LE(command.queued, command.submitted);
    EXPECT_LE(command.submitted, command.started);
    EXPECT_LE(command.started, command.ended);
    EXPECT_LE(command.ended, recorder.ended() + 1e-4);
    EXPECT_GE(command.started, before - 1e-4) << "an in-order queue runs one command after the other";
    before = command.ended;
  }
}

TEST(Recorder, SeesNothingWhileItIsOff) {
  cl::Session& session = test::session();
  Triad triad{session};
  session.recorder().start();
  session.recorder().stop();
  triad.run();
  session.march_queue().finish();
  EXPECT_TRUE(session.recorder().commands().empty());
  EXPECT_TRUE(session.recorder().programs().empty());
}

TEST(MemoryCount, GoesUpWithABufferAndDownWhenItGoes) {
  cl::Session& session = test::session();
  const std::size_t before = session.memory().now;
  session.stage("here");
  const auto it = session.memory().by_stage.find("here");
  const std::size_t stage_before = it == session.memory().by_stage.end() ? 0 : it->second;
  {
    const F one = session.allocate<float>(1000);
    F two = session.allocate<float>(500);
    EXPECT_EQ(session.memory().now, before + 6000);
    two = F();
    EXPECT_EQ(session.memory().now, before + 4000);
    F three = session.allocate<float>(10);
    three = session.allocate<float>(20);
    EXPECT_EQ(session.memory().now, before + 4080);
  }
  session.stage("");
  EXPECT_EQ(session.memory().now, before);
  EXPECT_GE(session.memory().peak, before + 6000);
  EXPECT_EQ(session.memory().by_stage.at("here"), stage_before + 6120);
}

}  // namespace
}  // namespace turbid
