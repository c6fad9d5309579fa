// SPDX-License-Identifier: Apache-2.0
// For tests that read scenes: files in a folder of their own, removed afterwards.
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "host/base/errors.h"
#include "host/scene/scene.h"

namespace turbid::test {

/// A folder that lives as long as this object.
class Folder {
 public:
  Folder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "turbid-test-XXXXXX").string();
    path_ = mkdtemp(pattern.data());
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string file(const std::string& name) const { return (path_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << text;
    return file(name);
  }

 private:
  std::filesystem::path path_;
};

inline Scene read_text(const std::string& text, const SceneOverrides& overrides = {}) {
  const Folder folder;
  return read_scene(folder.write("s.toml", text), overrides);
}

/// The message without the folder in front of the file's name.
inline std::string error_of(const std::string& text, const SceneOverrides& overrides = {}) {
  const Folder folder;
  const std::string path = folder.write("s.toml", text);
  try {
    read_scene(path, overrides);
  } catch (const InputError& error) {
    std::string message = error.what();
    const std::string parent = std::filesystem::path(path).parent_path().string() + "/";
    for (std::size_t at; (at = message.find(parent)) != std::string::npos;) message.erase(at, parent.size());
    return message;
  }
  return "no error";
}

/// A small scene: a ball, a light, a camera.
inline constexpr char kBall[] = R"(unit = "mm"
[domain]
resolution = 32
[material.jade]
eta = 1.4
sigma_s = [1.0, 1.4, 0.9]
sigma_a = 0.02
[[object]]
shape = "sphere"
radius = 10
material = "jade"
[[light]]
type = "point"
position = [30, 0, 0]
power = 1
[camera]
position = [0, 0, 60]
)";

/// The same with one piece of its text replaced.
inline std::string ball_with(const std::string& old, const std::string& replacement) {
  std::string text = kBall;
  text.replace(text.find(old), old.size(), replacement);
  return text;
}

inline SceneOverrides with(std::vector<std::string> settings) {
  SceneOverrides overrides;
  overrides.settings = std::move(settings);
  return overrides;
}

#define EXPECT_BEGINS(text, start) EXPECT_EQ((text).substr(0, std::string(start).size()), start) << (text)
#define EXPECT_HOLDS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

}  // namespace turbid::test
