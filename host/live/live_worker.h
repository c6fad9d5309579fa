// SPDX-License-Identifier: Apache-2.0
// The live view's one computing thread. The newest wish wins: a change stops the refining of the picture before it. A
// solve under way is finished and seen first, so that a slider that is being dragged shows something all along.
#pragma once
#include <condition_variable>
#include <deque>
#include <exception>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "host/cl/session.h"
#include "host/live/live_scene.h"
#include "host/report/live_report.h"

namespace turbid {

/// Edge of the coarse picture's pixels in pixels of the whole one: the smallest of 1, 2, 4 at which it takes 100 ms
/// or less at the speed seen last, else 8.
int coarse_edge(int width, int height, double samples_per_second);

class LiveWorker {
 public:
  /// Starts the thread. Saved files go to `folder`.
  LiveWorker(const cl::DeviceChoice&, Scene, std::string folder);
  ~LiveWorker();

  // From any thread:
  /// Settings as for change_scene(), which may throw.
  void change(const std::vector<std::string>& settings);
  /// The state as JSON, once it has a number above `after` or `patience` seconds have passed.
  std::string state(std::uint64_t after, double patience) const;
  /// Null before the first one.
  std::shared_ptr<const LivePicture> picture() const;
  std::string scene_text() const;
  /// Writes the effective scene as it is wanted now; returns the files. Throws InputError if that can't be.
  std::vector<std::string> save_scene();
  /// Waits for the refined picture of the scene as it is wanted now, solved from nothing, and writes EXR and PNG:
  /// radiances equal to those of `turbid render` on the saved scene in every bit.
  std::vector<std::string> save_picture();
  /// Asks the thread to end, and all who wait in state() or save_picture() to give up.
  void stop();
  /// What ended the thread, if it was an error.
  std::exception_ptr failure() const;

 private:
  struct SaveJob {
    std::shared_ptr<const Scene> scene;
    std::promise<std::vector<std::string>> files;
  };

  void run();
  Redo bring_up(LiveScene&, const std::shared_ptr<const Scene>&, bool afresh);
  void show(LiveScene&, const std::shared_ptr<const Scene>&);
  void serve(LiveScene&, SaveJob&);
  void take_back(const std::shared_ptr<const Scene>& bad, const std::string& why);
  void refine(LiveScene&, const Scene&);
  ViewImage look_timed(LiveScene&, const Camera&, const char* stage);
  void publish(const Scene&, bool refined);
  void note_progress(const std::string& stage, double fraction);
  void bump();

  const cl::DeviceChoice choice_;
  const std::string folder_;

  mutable std::mutex guard_;  // of what follows
  mutable std::condition_variable changed_;
  bool stop_ = false;
  std::uint64_t number_ = 1, pictures_ = 0;
  std::shared_ptr<const Scene> wanted_, good_;  ///< good_: the last that gave a picture
  double wanted_since_ = 0;
  std::deque<SaveJob> jobs_;
  std::string stage_, message_;
  double fraction_ = 0, first_seconds_ = 0, last_note_ = 0;
  std::vector<StageTime> times_;
  std::shared_ptr<const SolverReport> solver_;
  std::shared_ptr<const LivePicture> picture_;
  std::exception_ptr failure_;

  // Of the thread alone:
  Progress progress_{Verbosity::quiet};
  std::shared_ptr<const Scene> shown_;  ///< what runs now or ran last
  double shown_since_ = 0;
  bool may_be_superseded_ = false;
  bool refined_ = false;  ///< image_ is the whole picture of shown_
  ViewImage image_;
  int image_samples_ = 0;
  double samples_per_second_ = 0;

  std::jthread thread_;  ///< last: it uses all the others
};

}  // namespace turbid
