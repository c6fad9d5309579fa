// SPDX-License-Identifier: Apache-2.0
// Only what a scene needs: which programs are built, which kernels run and which buffers they are given, told by the
// recorder, for bundled scenes at low resolution.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "host/cl/kernel_source.h"
#include "host/profile/profile.h"
#include "tests/support/test_media.h"

namespace turbid {
namespace {

struct Needs {
  std::set<std::string> programs, kernels;
  std::vector<BufferUse> buffers;
  SceneFeatures features;
  std::size_t memory = 0;
  std::string options;  // of all programs

  bool builds(const std::string& file) const { return programs.count(file) > 0; }
  bool launches(const std::string& kernel) const { return kernels.count(kernel) > 0; }
  bool defines(const std::string& define) const { return options.find("-D" + define + " ") != std::string::npos; }
  std::size_t bytes_of(const std::string& argument) const {
    std::size_t sum = 0;
    for (const BufferUse& use : buffers)
      if (use.argument == argument) sum += use.bytes;
    return sum;
  }
};

std::string scene_file(const std::string& name) {
  return (std::filesystem::path(cl::kernel_directory()).parent_path() / "scenes" / name).string();
}

Needs needs_of(const std::string& name, bool general = false) {
  Progress progress(Verbosity::quiet);
  SceneOverrides small;
  small.resolution = 16;
  small.settings = {"camera.width=32", "camera.height=24", "camera.samples=1", "solver.march.rays_per_face=1"};
  Needs needs;
  cl::Session session(cl::choose_device(""));
  const SceneOnGrid scene = put_on_grid(read_scene(scene_file(name), small), progress);
  needs.features = general ? general_features(scene.features) : scene.features;
  std::optional<PreparedScene> prepared;
  const Frame frame = record(session, progress, [&] {
    prepared.emplace(session, scene, progress, needs.features);
    prepared->look(prepared->light());
  });
  for (const cl::BuiltProgram& program : frame.programs) {
    needs.programs.insert(program.file);
    needs.options += program.options + " ";
  }
  for (const cl::Command& command : frame.commands)
    if (command.is_kernel()) needs.kernels.insert(command.name);
  needs.buffers = buffers_of(frame);
  needs.memory = session.memory().peak;
  return needs;
}

void expect_no_diffusion(const Needs& needs) {
  EXPECT_EQ(needs.kernels, (std::set<std::string>{"march", "view"}));
  EXPECT_EQ(needs.programs, (std::set<std::string>{"march.cl", "view.cl"}));
  EXPECT_EQ(needs.bytes_of("deposit"), 0u);
  EXPECT_EQ(needs.bytes_of("source_tiles"), 0u);
}

void expect_isotropic_diffusion(const Needs& needs) {
  EXPECT_TRUE(needs.launches("march") && needs.launches("view") && needs.builds("steady.cl"));
  EXPECT_FALSE(needs.builds("lattice.cl")) << "the solver is steady";
  EXPECT_FALSE(needs.builds("photon.cl")) << "the one program with phase functions";
  EXPECT_GT(needs.bytes_of("deposit"), 0u);
  EXPECT_GT(needs.bytes_of("source_tiles"), 0u);
  EXPECT_TRUE(needs.defines("TURBID_SCATTERING=1"));
}

TEST(GlassNeeds, NothingOfDiffusionAndNoIndexGradient) {
  const Needs needs = needs_of("glass.toml");
  expect_no_diffusion(needs);
  EXPECT_EQ(needs.bytes_of("index_tiles"), 0u) << "the index is constant in each body";
  EXPECT_EQ(needs.bytes_of("coefficient_tiles"), 0u);
  EXPECT_GT(needs.bytes_of("distance_tiles"), 0u) << "surfaces to refract at";
  EXPECT_TRUE(needs.defines("TURBID_SCATTERING=0"));
  EXPECT_TRUE(needs.defines("TURBID_GRADED=0"));
  EXPECT_TRUE(needs.defines("TURBID_LIGHTS=4")) << "spot lights only";
}

TEST(FogNeeds, OneChannelStraightRaysAndNoSurfaces) {
  const Needs needs = needs_of("fog.toml");
  expect_isotropic_diffusion(needs);
  EXPECT_EQ(needs.features.channels, 1);
  EXPECT_TRUE(needs.defines("TURBID_CHANNELS=1"));
  EXPECT_TRUE(needs.defines("TURBID_GRADED=0"));
  EXPECT_TRUE(needs.defines("TURBID_BODIES=0"));
  EXPECT_TRUE(needs.defines("TURBID_LIGHTS=1")) << "directional lights only";
  EXPECT_EQ(needs.bytes_of("index_tiles"), 0u);
  EXPECT_EQ(needs.bytes_of("distance_tiles"), 0u);
  EXPECT_GT(needs.bytes_of("coefficient_tiles"), 0u) << "the fog varies";
  EXPECT_EQ(needs.bytes_of("ground"), 0u) << "straight light is kept with the shadow map";
}

TEST(SphereNeeds, NoVaryingCoefficientsAndNoIndexGradient) {
  const Needs needs = needs_of("sphere.toml");
  expect_isotropic_diffusion(needs);
  EXPECT_EQ(needs.features.channels, 3);
  EXPECT_TRUE(needs.defines("TURBID_HETEROGENEOUS=0"));
  EXPECT_EQ(needs.bytes_of("coefficient_tiles"), 0u);
  EXPECT_EQ(needs.bytes_of("index_tiles"), 0u);
}

TEST(BunnyNeeds, VaryingCoefficientsButNoIndexGradient) {
  if (!std::filesystem::exists(scene_file("meshes/bunny.obj"))) GTEST_SKIP() << "scripts/setup brings the mesh";
  const Needs needs = needs_of("bunny.toml");
  expect_isotropic_diffusion(needs);
  EXPECT_EQ(needs.features.channels, 3);
  EXPECT_GT(needs.bytes_of("coefficient_tiles"), 0u);
  EXPECT_EQ(needs.bytes_of("index_tiles"), 0u);
}

TEST(TheGeneralPath, HoldsMoreThanAnySceneNeeds) {
  for (const char* name : {"glass.toml", "fog.toml"}) {
    const Needs own = needs_of(name), general = needs_of(name, true);
    EXPECT_GT(general.memory, own.memory) << name;
    EXPECT_GT(general.bytes_of("index_tiles"), 0u) << name;
    EXPECT_TRUE(general.defines("TURBID_CHANNELS=3") && general.defines("TURBID_LIGHTS=7")) << name;
  }
}

}  // namespace
}  // namespace turbid
