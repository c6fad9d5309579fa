// SPDX-License-Identifier: Apache-2.0
// The commands doing their work: files, reports, overrides, the same bits again.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/run.h"
#include "tests/support/small_scene.h"

namespace turbid::test {
namespace {

using Json = nlohmann::json;
using Words = std::vector<std::string>;

Json json_of(const Outcome& outcome) {
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const Json json = Json::parse(outcome.out, nullptr, /*allow_exceptions=*/false);
  EXPECT_FALSE(json.is_discarded()) << outcome.out;
  return json;
}

class Commands : public testing::Test {
 protected:
  void SetUp() override { place.write("ball.toml", kMilkyBall); }
  const Workplace place;
};

TEST_F(Commands, render_writes_picture_preview_and_report_and_says_where) {
  const Outcome outcome = place.turbid({"render", "ball.toml"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(place.content(), (Words{"ball.toml", "out/", "out/ball/", "out/ball/ball.exr", "out/ball/ball.png",
                                    "out/ball/report.json"}));
  for (const char* said :
       {"out/ball/ball.exr", "out/ball/ball.png", "out/ball/report.json", "emitted", "towards -x", "imbalance"})
    EXPECT_NE(outcome.out.find(said), std::string::npos) << said << " in " << outcome.out;

  const Outcome info = place.turbid({"info", "out/ball/ball.exr"});
  EXPECT_EQ(info.status, 0) << info.err;
  for (const char* said : {"48 x 32 pixels", "direct.R", "scattered.B", "depth.Z", "N.X", "turbid:scene_hash",
                           "turbid:device", "turbid:voxel_size", "turbid:solver = \"steady\"", "turbid:seconds:view"})
    EXPECT_NE(info.out.find(said), std::string::npos) << said << " in " << info.out;
  // Lines of channels: name, type, min, max, mean, NaN, Inf.
  std::istringstream lines(info.out);
  std::size_t channels = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string name, type, low, high, mean, nan, infinite;
    words >> name >> type >> low >> high >> mean >> nan >> infinite;
    if (type != "half" && type != "float") continue;
    ++channels;
    EXPECT_EQ(nan + " " + infinite, "0 0") << line;
    if (name == "R") {
      EXPECT_GT(std::stod(high), 0) << "a lit ball is not black";
    }
  }
  EXPECT_EQ(channels, 14u) << info.out;
}

TEST_F(Commands, render_to_a_file_puts_the_others_beside_it) {
  EXPECT_EQ(place.turbid({"render", "ball.toml", "-q", "-o", "a/b.exr"}).status, 0);
  EXPECT_EQ(place.content(), (Words{"a/", "a/b.exr", "a/b.png", "a/b.report.json", "ball.toml"}));
}

TEST_F(Commands, the_report_holds_what_a_script_wants) {
  const Outcome outcome = place.turbid({"render", "ball.toml", "--json", "-o", "p"});
  const Json json = json_of(outcome);
  std::ifstream file(place.path("p/report.json"));
  EXPECT_EQ(Json::parse(file), json) << "report.json is what --json prints";
  EXPECT_EQ(json["version"], TURBID_VERSION);
  EXPECT_EQ(json["scene"]["name"], "ball");
  EXPECT_EQ(json["scene"]["hash"].get<std::string>().size(), 16u);
  EXPECT_EQ(json["solver"]["name"], "steady");
  EXPECT_GT(json["solver"]["rays"], 0);
  EXPECT_GT(json["solver"]["iterations"], 0);
  EXPECT_GT(json["medium"]["active_voxels"], 0);
  EXPECT_GT(json["medium"]["optical_thickness"]["max"], json["medium"]["optical_thickness"]["min"]);
  EXPECT_GT(json["peak_memory_bytes"], 1'000'000);
  EXPECT_TRUE(json["warnings"].is_array());
  EXPECT_EQ(json["outputs"]["exr"], "p/ball.exr");
  double total = 0;
  for (const auto& [stage, seconds] : json["seconds"].items())
    if (stage != "total") total += seconds.get<double>();
  EXPECT_NEAR(json["seconds"]["total"], total, 1e-9);
}

TEST_F(Commands, every_watt_is_accounted_for_per_colour) {
  for (const char* solver : {"steady", "lattice"}) {
    const Json energy = json_of(place.turbid({"solve", "ball.toml", "-q", "--json", "--solver", solver}))["energy"];
    EXPECT_TRUE(energy["balanced"]);
    EXPECT_LT(energy["imbalance"], 1e-5) << "the project's own bound";
    for (std::size_t c = 0; c < 3; ++c) {
      double faces = 0;
      for (const auto& [face, power] : energy["escaped_faces"].items()) faces += power[c].get<double>();
      EXPECT_NEAR(faces, energy["escaped"][c].get<double>(), 1e-9) << "the faces' sum, in double precision";
      double rest = 0;
      for (const char* where :
           {"missed", "reflected_at_entry", "absorbed", "absorbed_by_opaque", "escaped", "in_flight"})
        rest += energy[where][c].get<double>();
      EXPECT_NEAR(energy["emitted"][c].get<double>(), 1.0, 1e-6) << "the light has 1 W";
      EXPECT_NEAR(rest, 1.0, 1e-5);
    }
  }
}

TEST_F(Commands, a_medium_in_half_precision_tells_how_far_it_errs) {
  const auto solved = [&](const char* storage, const char* sigma_s) {
    const std::string out = std::string(storage) + ".vdb";
    return json_of(place.turbid({"solve", "ball.toml", "-q", "--json", "-o", out, "-D", std::string("solver.storage=") + storage,
                                 "-D", sigma_s}));
  };
  const char* varying = "material.milk.sigma_s={expression=\"8 + 0.3*x + 0.2*y\"}";
  const Json full = solved("float", varying), half = solved("half", varying);
  EXPECT_EQ(full["solver"]["storage_error"], 0);
  const double told = half["solver"]["storage_error"];
  EXPECT_GT(told, 5e-5);
  EXPECT_LT(told, 4.9e-4) << "one rounding of half precision";
  EXPECT_LT(half["energy"]["imbalance"], 1e-5) << "the project's own bound";
  EXPECT_NE(half["checksums"]["fluence"], full["checksums"]["fluence"]);
  const Outcome alike =
      place.turbid({"compare", "half.vdb", "float.vdb", "--measure", "rel-l2", "--tolerance", std::to_string(told)});
  EXPECT_EQ(alike.status, 0) << alike.out << alike.err;
  EXPECT_EQ(solved("half", "material.milk.sigma_s=8")["solver"]["storage_error"], 0) << "nothing varies";
}

TEST_F(Commands, half_precision_storage_tells_what_it_took_and_how_far_it_errs) {
  for (const char* edge : {"8", "0"}) {
    const auto solved = [&](const char* storage) {
      return json_of(place.turbid({"solve", "ball.toml", "-q", "--json", "--solver", "lattice", "-D",
                                   std::string("solver.storage=") + storage, "-D",
                                   std::string("solver.lattice.block_edge=") + edge}));
    };
    const Json full = solved("float"), half = solved("half");
    EXPECT_TRUE(half["energy"]["balanced"]);
    EXPECT_LT(half["energy"]["imbalance"], 1e-5) << "the project's own bound";
    EXPECT_LT(half["solver"]["diffusion_bytes"], 0.9 * full["solver"]["diffusion_bytes"].get<double>());
    EXPECT_GT(half["solver"]["storage_error"].get<double>(), 4.9e-4) << "one rounding of half precision";
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(full["energy"]["rounding"][c], 0);
      EXPECT_NE(half["energy"]["rounding"][c], 0);
      EXPECT_NEAR(half["energy"]["rounding"][c].get<double>(), 0, 1e-4);
      EXPECT_NEAR(half["energy"]["escaped"][c].get<double>(), full["energy"]["escaped"][c].get<double>(), 5e-4);
    }
  }
}

TEST_F(Commands, solve_writes_fluence_and_medium_as_openvdb) {
  EXPECT_EQ(place.turbid({"solve", "ball.toml", "-o", "f.vdb", "-q"}).status, 0);
  const Outcome info = place.turbid({"info", "f.vdb"});
  EXPECT_EQ(info.status, 0) << info.err;
  for (const char* grid : {"fluence: vec3s, fog volume", "deposit: ", "eta: ", "sigma_s: ", "sigma_a: ",
                           "signed_distance: float, level set", "unit = mm"})
    EXPECT_NE(info.out.find(grid), std::string::npos) << grid << " in " << info.out;
  EXPECT_EQ(json_of(place.turbid({"info", "f.vdb", "--json"}))["kind"], "vdb");
  EXPECT_EQ(place.content(), (Words{"ball.toml", "f.vdb"}));
}

TEST_F(Commands, voxelise_writes_the_medium) {
  const Json json = json_of(place.turbid({"voxelise", "ball.toml", "-o", "m/medium.vdb", "--json", "-q"}));
  EXPECT_EQ(json["outputs"]["vdb"], "m/medium.vdb");
  const Outcome info = place.turbid({"info", "m/medium.vdb"});
  EXPECT_NE(info.out.find("occupancy: float"), std::string::npos) << info.out;
}

TEST_F(Commands, check_prints_a_scene_that_reads_back_as_the_same) {
  const Outcome outcome = place.turbid({"check", "ball.toml", "-D", "camera.fov=20", "-q"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("fov = 20.0"), std::string::npos) << outcome.out;
  for (const char* said : {"bodies: 1", "scattering: isotropic", "active blocks:", "optical thickness per voxel: min",
                           "memory: about", "no warnings"})
    EXPECT_NE(outcome.out.find(said), std::string::npos) << said << " in " << outcome.out;
  place.write("again.toml", outcome.out);
  EXPECT_EQ(json_of(place.turbid({"check", "again.toml", "--json", "-q"}))["scene"]["hash"],
            json_of(place.turbid({"check", "ball.toml", "-D", "camera.fov=20", "--json", "-q"}))["scene"]["hash"]);
}

TEST_F(Commands, check_warns_of_what_is_doubtful) {
  const auto warnings = [&](const Words& settings) {
    Words arguments{"check", "ball.toml", "--json", "-q"};
    for (const std::string& setting : settings) arguments.insert(arguments.end(), {"-D", setting});
    return json_of(place.turbid(arguments))["warnings"].dump();
  };
  EXPECT_EQ(warnings({}), "[]");
  EXPECT_NE(warnings({"material.milk.sigma_s=50"}).find("optically too thick"), std::string::npos);
  EXPECT_NE(warnings({"light.0.position=[1,0,0]"}).find("light 1 stands inside \\\"sphere\\\""), std::string::npos);
  EXPECT_NE(warnings({"camera.position=[1,0,0]"}).find("the camera stands inside \\\"sphere\\\""), std::string::npos);
  EXPECT_NE(warnings({"object.0.interface='smooth'", "material.milk.eta=2.5", "domain.smoothing=0.3"})
                .find("refractive index"),
            std::string::npos);
  EXPECT_NE(warnings({"object.0={shape='box', size=[20, 20, 0.5], material='milk'}"}).find("voxels thick"),
            std::string::npos);
}

TEST_F(Commands, overrides_reach_the_scene) {
  const Json json =
      json_of(place.turbid({"render", "ball.toml", "-q", "--json", "-D", "camera.width=20", "-D",
                            "light.0.power=[2,1,0.5]", "--resolution", "16", "--solver", "lattice", "--seed", "7"}));
  EXPECT_EQ(json["picture"]["width"], 20);
  EXPECT_EQ(json["medium"]["grid"][0], 16);
  EXPECT_EQ(json["solver"]["name"], "lattice");
  EXPECT_EQ(json["solver"]["seed"], 7);
  EXPECT_NEAR(json["energy"]["emitted"][0], 2.0, 1e-6);
}

TEST_F(Commands, quiet_runs_say_nothing_on_standard_error) {
  EXPECT_EQ(place.turbid({"render", "ball.toml", "-q"}).err, "");
  const Outcome talking = place.turbid({"render", "ball.toml"});
  for (const char* stage : {"read", "voxelise", "march", "view", "write"})
    EXPECT_NE(("\n" + talking.err).find("\n" + std::string(stage) + " "), std::string::npos)
        << stage << " in " << talking.err;
}

TEST_F(Commands, devices_lists_what_there_is_and_what_would_be_used) {
  const Outcome outcome = place.turbid({"devices"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("<- would be used: "), std::string::npos) << outcome.out;
  const Json json = json_of(place.turbid({"devices", "--json"}));
  EXPECT_TRUE(json["devices"][0].contains("compute_units"));
}

TEST_F(Commands, scenes_without_scattering_or_without_refraction_render_too) {
  const Words none{"-D", "material.milk.sigma_s=0", "-D", "material.milk.sigma_a=0"};
  Words glass{"render", "ball.toml", "-q", "--json", "-o", "glass"};
  glass.insert(glass.end(), none.begin(), none.end());
  EXPECT_EQ(json_of(place.turbid(glass))["medium"]["optical_thickness"], nullptr);
  json_of(place.turbid({"render", "ball.toml", "-q", "--json", "-o", "fog", "-D", "material.milk.eta=1"}));
}

TEST_F(Commands, the_same_scene_gives_the_same_bits_whatever_the_number_of_threads) {
  const auto run = [&](const char* threads, const char* solver) {
    const RunSettings settings{.environment = {{"POCL_MAX_PTHREAD_COUNT", threads}}};
    const Json device = json_of(place.turbid({"devices", "--json"}, settings))["devices"][0];
    if (device["platform"] == "Portable Computing Language") {
      EXPECT_EQ(device["compute_units"], std::stoi(threads));
    }
    return json_of(place.turbid({"render", "ball.toml", "-q", "--json", "--solver", solver}, settings))["checksums"]
        .dump();
  };
  for (const char* solver : {"steady", "lattice"}) {
    const std::string one = run("1", solver);
    EXPECT_EQ(run("2", solver), one) << solver;
    EXPECT_EQ(run("2", solver), one) << solver << ", once more";
  }
}

}  // namespace
}  // namespace turbid::test
