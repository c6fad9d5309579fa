// SPDX-License-Identifier: Apache-2.0
// turbid view as a browser meets it: pictures, changes, refusals, saved files, and its end.
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "tests/support/http.h"
#include "tests/support/run.h"
#include "tests/support/small_scene.h"

namespace turbid::test {
namespace {

using Words = std::vector<std::string>;
using Json = nlohmann::json;

Json state(const std::string& url) {
  const HttpAnswer answer = ask(url, {.path = "/state"});
  if (answer.status == 200) return Json::parse(answer.body);
  throw std::runtime_error("no state: the server answered " + std::to_string(answer.status) + " " + answer.body);
}

/// The state once nothing is left to do.
Json settled(const std::string& url) {
  for (int i = 0; i < 600; ++i) {
    const Json now = state(url);
    if (now["stage"] == "" && now.contains("picture") && now["picture"]["refined"]) return now;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  ADD_FAILURE() << "never settled: " << state(url);
  return {};
}

HttpAnswer change(const std::string& url, const std::string& lines) {
  return ask(url, {.method = "POST", .path = "/change", .body = lines});
}

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class View : public testing::Test {
 protected:
  void SetUp() override { place.write("ball.toml", kMilkyBall); }
  /// Runs the view for as long as `visit` takes.
  Outcome with_view(std::function<void(const std::string& url)> visit, Words more = {}) {
    Words words{"view", "ball.toml", "--port", "0", "-o", "kept"};
    words.insert(words.end(), more.begin(), more.end());
    return place.turbid(words, {.visit = std::move(visit)});
  }
  const Workplace place;
};

TEST_F(View, shows_changes_and_saves_a_scene_that_renders_to_the_picture_it_saved) {
  const Outcome outcome = with_view([&](const std::string& url) {
    EXPECT_EQ(ask(url, {.path = "/"}).status, 200);
    Json now = settled(url);
    EXPECT_EQ(now["picture"]["width"], 48);
    EXPECT_TRUE(now["solver"]["energy"]["balanced"]);
    const std::string first = ask(url, {.path = "/picture.png"}).body;
    EXPECT_TRUE(first.starts_with("\x89PNG"));

    // A camera move runs no stage of light; a light no stage of the medium; a material no more than it must.
    const auto stages = [&](const std::string& lines) {
      EXPECT_EQ(change(url, lines).status, 200);
      now = settled(url);
      Words names;
      for (const Json& time : now["times"]) names.push_back(time["name"]);
      return names;
    };
    EXPECT_NE(stages("camera.position=[20, 15, 50]").front().find("view"), std::string::npos) << now["times"];
    EXPECT_NE(ask(url, {.path = "/picture.png"}).body, first);
    EXPECT_EQ(stages("light.0.position=[-60, 40, 30]").front(), "lights");
    EXPECT_EQ(stages("light.0.power=[1, 2, 3]\nmaterial.milk.sigma_a=0.05\n").front(), "voxelise");
    EXPECT_EQ(stages("film.exposure=12").size(), 0u);
    EXPECT_EQ(now["picture"]["exposure"], 12);

    EXPECT_EQ(Json::parse(ask(url, {.method = "POST", .path = "/save/scene"}).body)["files"],
              Json{"kept/ball-001.toml"});
    EXPECT_EQ(Json::parse(ask(url, {.method = "POST", .path = "/save/picture"}).body)["files"],
              (Json{"kept/ball-002.exr", "kept/ball-002.png"}));
  });
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_LT(outcome.seconds_after_interrupt, 6.0);
  const Outcome render = place.turbid({"render", "kept/ball-001.toml", "-q", "-o", "again.exr"});
  ASSERT_EQ(render.status, 0) << render.err;
  const Outcome compare = place.turbid({"compare", "kept/ball-002.exr", "again.exr", "--tolerance", "0"});
  EXPECT_EQ(compare.status, 0) << compare.out << compare.err;
  EXPECT_EQ(content(place.path("kept/ball-002.png")), content(place.path("again.png")));
}

TEST_F(View, refuses_bad_requests_with_one_line_and_goes_on) {
  const Outcome outcome = with_view([&](const std::string& url) {
    const Json before = settled(url);
    const auto refused = [&](const HttpRequest& request, int status, const std::string& words) {
      const HttpAnswer answer = ask(url, request);
      EXPECT_EQ(answer.status, status) << request.body;
      EXPECT_NE(answer.body.find(words), std::string::npos) << answer.body;
      EXPECT_EQ(answer.body.find('\n'), answer.body.size() - 1) << answer.body;
    };
    const auto bad = [&](const std::string& lines, const std::string& words) {
      refused({.method = "POST", .path = "/change", .body = lines}, 400, words);
    };
    bad("", "expected lines such as camera.fov=30");
    bad("nonsense", "expected key.sub=value");
    bad("camera.fov=0", "fov = 0: must be in (0, 170]");
    bad("camera.fov=[", "the value must be TOML");
    bad("camera.position=[0, 0, 0]\ncamera.target=[0, 0, 0]", "must differ from target");
    bad("light.7.power=1", "expected an index from 0 to 0");
    bad("domain.resolution=8", "can't be changed");
    bad("material.gold.eta=2", "no material");
    refused({.path = "/state?after=x"}, 400, "expected a whole number");
    refused({.path = "/", .host = "evil.example"}, 403, "expected localhost");
    refused(
        {.method = "POST", .path = "/change", .body = "camera.fov=20", .headers = "Origin: http://evil.example\r\n"},
        403, "may not change anything");
    EXPECT_EQ(ask(url, {.method = "POST", .path = "/change", .body = std::string(100'000, 'x')}).status, 413);
    EXPECT_EQ(ask(url, {.path = "/etc/passwd"}).status, 404);
    EXPECT_EQ(state(url)["camera"], before["camera"]);

    // A value that only the voxels show to be wrong is taken back.
    EXPECT_EQ(change(url, "material.milk.sigma_s={ expression = \"x\" }").status, 200);
    for (int i = 0; i < 600 && state(url)["message"] == ""; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    const Json now = settled(url);
    EXPECT_NE(now["message"].get<std::string>().find("material \"milk\": sigma_s = "), std::string::npos)
        << now["message"];
    EXPECT_EQ(now["materials"], before["materials"]);
    EXPECT_EQ(now["scene"]["hash"], before["scene"]["hash"]);

    // The port is taken.
    const std::string port = url.substr(url.rfind(':') + 1, url.size() - url.rfind(':') - 2);
    const Outcome second = place.turbid({"view", "ball.toml", "--port", port});
    EXPECT_EQ(second.status, 2);
    EXPECT_TRUE(second.error_lines().back().starts_with("turbid: --port " + port + ": can't be opened on 127.0.0.1"))
        << second.err;
  });
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(place.content(), Words{"ball.toml"});
}

TEST_F(View, ends_with_what_is_wrong_with_the_scene) {
  place.write("bad.toml", milky_ball_with("sigma_s = [1.0, 1.2, 1.5]", "sigma_s = { expression = \"x\" }"));
  const Outcome voxels = place.turbid({"view", "bad.toml", "--port", "0"});
  EXPECT_EQ(voxels.status, 2) << voxels.err;
  EXPECT_NE(voxels.err.find("material \"milk\": sigma_s = "), std::string::npos) << voxels.err;
  place.write("blind.toml", kMilkyBall.substr(0, kMilkyBall.find("[camera]")));
  const Outcome blind = place.turbid({"view", "blind.toml", "--port", "0"});
  EXPECT_EQ(blind.status, 2);
  EXPECT_EQ(blind.error_lines().back(),
            "turbid: blind.toml: has no [camera], so there is nothing to look at; turbid solve needs none");
}

}  // namespace
}  // namespace turbid::test
