// SPDX-License-Identifier: Apache-2.0
// See live_worker.h.
#include "host/live/live_worker.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include "host/base/errors.h"
#include "host/live/save_files.h"

namespace turbid {
namespace {

constexpr double kCoarseSeconds = 0.1;  // of a coarse picture, at the most
constexpr double kNoteSeconds = 0.1;    // between two states that differ only by a stage's fraction
constexpr int kQuick = 1;               // compression of pictures that are seen for a moment

struct Superseded : Interrupted {
  Superseded() : Interrupted("superseded") {}
};

std::exception_ptr ended() {
  return std::make_exception_ptr(InputError("the live view is ending"));
}

}  // namespace

int coarse_edge(int width, int height, double samples_per_second) {
  const double pixels = static_cast<double>(width) * height;
  for (int edge = 1; edge < 8; edge *= 2)
    if (pixels / (edge * edge) <= kCoarseSeconds * samples_per_second) return edge;
  return 8;
}

LiveWorker::LiveWorker(const cl::DeviceChoice& choice, Scene scene, std::string folder)
    : choice_(choice), folder_(std::move(folder)), wanted_(std::make_shared<const Scene>(std::move(scene))) {
  wanted_since_ = wall_time();
  thread_ = std::jthread([this] { run(); });
}

LiveWorker::~LiveWorker() {
  stop();
}

void LiveWorker::bump() {
  ++number_;
  changed_.notify_all();
}

void LiveWorker::change(const std::vector<std::string>& settings) {
  std::shared_ptr<const Scene> before;
  while (true) {
    {
      const std::lock_guard lock(guard_);
      before = wanted_;
    }
    auto next = std::make_shared<const Scene>(change_scene(*before, settings));
    const std::lock_guard lock(guard_);
    if (wanted_ != before) continue;  // somebody else was faster: apply it to theirs
    wanted_ = std::move(next);
    wanted_since_ = wall_time();
    message_.clear();
    if (stage_.empty()) stage_ = "waiting";
    bump();
    return;
  }
}

std::string LiveWorker::state(std::uint64_t after, double patience) const {
  std::unique_lock lock(guard_);
  changed_.wait_for(lock, std::chrono::duration<double>(patience), [&] { return stop_ || number_ > after; });
  const auto scene = wanted_;
  const auto picture = picture_;
  const auto solver = solver_;
  const LiveReport report{.number = number_,
                          .scene = *scene,
                          .device = choice_.device,
                          .stage = stage_,
                          .fraction = fraction_,
                          .times = times_,
                          .picture = picture.get(),
                          .first_seconds = first_seconds_,
                          .solver = solver.get(),
                          .allowed_imbalance = kAllowedImbalance,
                          .message = message_};
  lock.unlock();
  return live_json(report);
}

std::shared_ptr<const LivePicture> LiveWorker::picture() const {
  const std::lock_guard lock(guard_);
  return picture_;
}

std::string LiveWorker::scene_text() const {
  const std::lock_guard lock(guard_);
  return wanted_->effective_toml;
}

std::vector<std::string> LiveWorker::save_scene() {
  std::shared_ptr<const Scene> scene;
  {
    const std::lock_guard lock(guard_);
    scene = wanted_;
  }
  return {save_scene_file(*scene, folder_)};
}

std::vector<std::string> LiveWorker::save_picture() {
  std::future<std::vector<std::string>> files;
  {
    const std::lock_guard lock(guard_);
    if (stop_) std::rethrow_exception(ended());
    jobs_.push_back({wanted_, {}});
    files = jobs_.back().files.get_future();
    changed_.notify_all();
  }
  return files.get();
}

void LiveWorker::stop() {
  const std::lock_guard lock(guard_);
  stop_ = true;
  for (SaveJob& job : jobs_) job.files.set_exception(ended());
  jobs_.clear();
  bump();
}

std::exception_ptr LiveWorker::failure() const {
  const std::lock_guard lock(guard_);
  return failure_;
}

void LiveWorker::run() {
  try {
    cl::Session session(choice_);
    progress_.on_update([this](const std::string& stage, double fraction) { note_progress(stage, fraction); });
    LiveScene live(session, progress_);
    while (true) {
      std::optional<SaveJob> job;
      std::shared_ptr<const Scene> scene;
      {
        std::unique_lock lock(guard_);
        if (wanted_ == shown_ && refined_ && jobs_.empty() && !stage_.empty()) {
          stage_.clear();
          bump();
        }
        changed_.wait(lock, [&] { return stop_ || !jobs_.empty() || wanted_ != shown_ || !refined_; });
        if (stop_) return;
        if (!jobs_.empty()) {
          job = std::move(jobs_.front());
          jobs_.pop_front();
        } else {
          scene = wanted_;
          shown_since_ = wanted_since_;
        }
      }
      try {
        if (job)
          serve(live, *job);
        else
          show(live, scene);
      } catch (const Superseded&) {
      } catch (const InputError& error) {
        take_back(scene, error.what());
      }
      session.march_queue().finish();  // whatever a stage that was stopped has left there
      session.lattice_queue().finish();
    }
  } catch (const Interrupted&) {
  } catch (...) {
    const std::lock_guard lock(guard_);
    failure_ = std::current_exception();
  }
  stop();
}

void LiveWorker::take_back(const std::shared_ptr<const Scene>& bad, const std::string& why) {
  const std::lock_guard lock(guard_);
  if (!good_) throw;  // the scene as it was given
  message_ = why;
  shown_.reset();
  if (wanted_ == bad) {
    wanted_ = good_;
    wanted_since_ = wall_time();
  }
  bump();
}

void LiveWorker::note_progress(const std::string& stage, double fraction) {
  const std::lock_guard lock(guard_);
  if (stop_) throw Interrupted("the live view is ending");
  if (may_be_superseded_ && wanted_ != shown_) throw Superseded();
  const double now = wall_time();
  const bool news = stage != stage_;
  stage_ = stage;
  fraction_ = fraction;
  if (!news && now - last_note_ < kNoteSeconds) return;
  last_note_ = now;
  bump();
}

Redo LiveWorker::bring_up(LiveScene& live, const std::shared_ptr<const Scene>& scene, bool afresh) {
  progress_.take_times();
  may_be_superseded_ = false;
  refined_ = false;
  shown_ = scene;
  const Redo redo = live.update(*scene, afresh);
  const std::lock_guard lock(guard_);
  if (redo >= Redo::light || !solver_) solver_ = std::make_shared<const SolverReport>(live.solution().report);
  good_ = scene;
  first_seconds_ = 0;
  return redo;
}

void LiveWorker::show(LiveScene& live, const std::shared_ptr<const Scene>& scene) {
  const bool was_refined = refined_;
  const Redo redo = bring_up(live, scene, false);
  if (redo <= Redo::tone && was_refined)
    publish(*scene, true);
  else
    refine(live, *scene);
  refined_ = true;
}

void LiveWorker::refine(LiveScene& live, const Scene& scene) {
  const Camera& whole = scene.camera;
  Camera one = whole;
  one.samples = 1;
  Camera coarse = one;
  const int edge = samples_per_second_ > 0 ? coarse_edge(whole.width, whole.height, samples_per_second_) : 4;
  coarse.width = std::max(1, whole.width / edge);
  coarse.height = std::max(1, whole.height / edge);
  const auto pass = [&](const Camera& camera, const char* stage, bool last) {
    image_ = look_timed(live, camera, stage);
    image_samples_ = camera.samples;
    publish(scene, last);
    may_be_superseded_ = true;
  };
  if (edge > 1) pass(coarse, "coarse view", false);
  if (whole.samples > 1) pass(one, "view, 1 sample", false);
  pass(whole, "view", true);
}

ViewImage LiveWorker::look_timed(LiveScene& live, const Camera& camera, const char* stage) {
  const double started = wall_time();
  ViewImage image = live.look(camera, stage);
  // Of whole pictures only: in a coarse one what does not grow with its size would count as slowness.
  if (camera.width == shown_->camera.width && camera.height == shown_->camera.height)
    samples_per_second_ = static_cast<double>(camera.width) * camera.height * camera.samples / (wall_time() - started);
  return image;
}

void LiveWorker::publish(const Scene& scene, bool refined) {
  auto picture = std::make_shared<LivePicture>();
  picture->width = image_.width;
  picture->height = image_.height;
  picture->samples = image_samples_;
  picture->refined = refined;
  picture->exposure = scene.film.exposure ? *scene.film.exposure : automatic_exposure(image_);
  picture->png = png_preview_bytes(image_, picture->exposure, kQuick);
  const std::lock_guard lock(guard_);
  picture->seconds = wall_time() - shown_since_;
  picture->number = ++pictures_;
  if (first_seconds_ == 0) first_seconds_ = picture->seconds;
  times_ = progress_.times();
  picture_ = std::move(picture);
  bump();
}

void LiveWorker::serve(LiveScene& live, SaveJob& job) {
  try {
    if (shown_ != job.scene || !refined_ || live.warm()) {
      bring_up(live, job.scene, true);
      image_ = look_timed(live, job.scene->camera, "view");
      image_samples_ = job.scene->camera.samples;
      publish(*job.scene, true);
      refined_ = true;
    }
    job.files.set_value(
        save_picture_files(live.on_grid(), choice_.device, live.solution().report, progress_.times(), image_, folder_));
  } catch (const InputError&) {
    job.files.set_exception(std::current_exception());  // for who asked; the thread goes on
  } catch (...) {
    job.files.set_exception(std::current_exception());
    throw;
  }
}

}  // namespace turbid
