// SPDX-License-Identifier: Apache-2.0
// The live view's decisions: what a change makes necessary again, how coarse a first picture is, who may ask.
#include <gtest/gtest.h>

#include "host/live/live_server.h"
#include "tests/unit/scene_files.h"

namespace turbid::test {
namespace {

TEST(Redo, goes_back_to_the_first_stage_that_a_change_reaches_and_no_further) {
  const Scene scene = read_text(std::string(kBall) + "[ground]\nheight = -12\n");
  const auto after = [&](const std::vector<std::string>& settings) {
    return redo_for(scene, change_scene(scene, settings));
  };
  EXPECT_EQ(after({}), Redo::nothing);
  EXPECT_EQ(after({"camera.fov=35"}), Redo::nothing);  // as it was
  EXPECT_EQ(after({"film.exposure=2"}), Redo::tone);
  EXPECT_EQ(after({"camera.position=[1, 2, 30]"}), Redo::look);
  EXPECT_EQ(after({"background=1"}), Redo::gather);
  EXPECT_EQ(after({"view.max_branches=2"}), Redo::gather);
  EXPECT_EQ(after({"light.0.power=2"}), Redo::light);
  EXPECT_EQ(after({"ground.height=-13"}), Redo::prepare);
  EXPECT_EQ(after({"material.jade.g=0.1"}), Redo::medium);
  EXPECT_EQ(after({"light.0.power=2", "film.exposure=2", "camera.fov=30"}), Redo::light);
  EXPECT_EQ(redo_for(scene, read_text(kBall, with({"domain.resolution=40"}))), Redo::all);
  EXPECT_EQ(redo_for(scene, read_text(std::string(kBall) + "[ground]\nheight = -12\n[[light]]\ntype = \"point\"\n"
                                                           "position = [0, 30, 0]\npower = 1\n")),
            Redo::light);
}

TEST(CoarsePicture, is_as_fine_as_a_tenth_of_a_second_allows) {
  EXPECT_EQ(coarse_edge(512, 512, 1e7), 1);
  EXPECT_EQ(coarse_edge(512, 512, 2.6e6), 2);
  EXPECT_EQ(coarse_edge(512, 512, 2e5), 4);
  EXPECT_EQ(coarse_edge(512, 512, 1), 8);
}

TEST(TrustedRequest, comes_to_an_address_or_localhost_and_from_the_same_place) {
  for (const char* host : {"localhost", "localhost:7777", "LOCALHOST:1", "127.0.0.1:7777", "192.168.1.5", "[::1]:7777"})
    EXPECT_TRUE(trusted_host(host)) << host;
  for (const char* host : {"", "evil.example", "evil.example:7777", "localhost.evil.example", "127.0.0.1.evil.example",
                           "[::1", "127.0.0.1@evil.example:80"})
    EXPECT_FALSE(trusted_host(host)) << host;
  EXPECT_TRUE(trusted_origin("", "127.0.0.1:7777"));  // no browser's page
  EXPECT_TRUE(trusted_origin("http://127.0.0.1:7777", "127.0.0.1:7777"));
  EXPECT_FALSE(trusted_origin("http://127.0.0.1:8888", "127.0.0.1:7777"));
  EXPECT_FALSE(trusted_origin("http://evil.example", "127.0.0.1:7777"));
  EXPECT_FALSE(trusted_origin("null", "127.0.0.1:7777"));
}

}  // namespace
}  // namespace turbid::test
