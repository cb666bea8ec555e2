// SPDX-License-Identifier: BSD-3-Clause
// Files that once ended a program, or that nobody should have to read to know: each is refused in
// words, or taken, and none ends a program by a signal.
#include <sys/stat.h>

#include <vector>

#include "end_to_end/program.hpp"

namespace repel::test {
namespace hostile_files_test {

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

std::string head_of_map(const std::string& kind) {
  return "# Octomap OcTree " + kind + "file\nid OcTree\nsize 2\nres 0.1\ndata\n";
}

/// A PLY file of three vertices and one face.
std::string ply(const std::string& face, const std::string& vertex = "0") {
  return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
         "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n" +
         vertex + " 0 0\n1 0 0\n0 1 0\n" + face + "\n";
}

std::string stl_that_says(unsigned triangles) {
  std::string text(80, ' ');
  for (unsigned i = 0; i < 4; ++i) text += static_cast<char>(triangles >> (8 * i));
  return text + std::string(50, '\0');
}

/// Files by their names; what they are is in them.
std::vector<std::pair<std::string, std::string>> hostile() {
  return {
      {"empty.stl", ""},
      {"counts.stl", stl_that_says(4294967295U)},
      {"nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
      {"far.obj", "v 0 0 0\nv 1e20 0 0\nv 0 1e20 0\nv 0 0 -1e20\nf 1 2 3\nf 1 2 4\n"},
      {"index.obj", "v 0 0 0\nf 1 2 99999999\n"},
      {"index.ply", ply("3 0 1 1000000")},
      {"below.ply", ply("3 0 1 -1")},
      {"nan.ply", ply("3 0 1 2", "nan")},
      {"corners.ply", ply("255 0 1 2")},
      {"deep.bt", head_of_map("binary ") + repeated(std::string("\3\0", 2), 100'000)},
      {"deep.ot", head_of_map("") + repeated(std::string("\0\0\0\0\1", 5), 100'000)},
      {"cut.bt", head_of_map("binary ") + "\xff"},
      {"cut.ot", head_of_map("") + std::string("\0\0\0\0\xff", 5)},
      {"wide.bt", head_of_map("binary ") + repeated("\xff\xff", 50'000)},
      {"none.ot", head_of_map("")},
      {"deep.dae", repeated("<node>", 200'000)},
      {"deep.yaml", repeated("[", 200'000)},
      {"aliases.yaml", "a: &a [1]\nb: &b [*a, *a]\nc: [*b, *b]\nrobot: *b\n"},
      {"comment.sdf", "<!-- -->"},
      {"deep.sdf", "<sdf version='1.9'>" + repeated("<model name='m'>", 100'000)},
      {"deep.urdf", "<robot name='r'>" + repeated("<link name='l'>", 100'000)},
      {"no.mcap", "\x89MCAP0\r\n" + std::string(1000, '\xff')},
  };
}

/// What is no file but can be named.
void make_others(const Folder& folder) {
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", folder / "zero");
  fs::create_directory(folder / "folder");
}
constexpr const char* others[] = {"pipe", "zero", "folder", "nothing"};

void expect_an_end(const Ending& ending, const std::string& what) {
  EXPECT_TRUE(ending.status >= 0 && ending.status < 124) << what << ": " << ending;
  EXPECT_TRUE(ending.status == 0 || !ending.err.empty()) << what << " is refused without a word";
}

/// Ends it after a minute, with the status 124.
Ending run(const std::string& program, const std::string& arguments) {
  return run_program("/usr/bin/timeout", "60 " + quoted(program) + " " + arguments);
}

std::string robot_with(const std::string& element) {
  return "<robot name='r'><link name='base'/><link name='arm'><inertial><mass value='1'/>"
         "<inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>" +
         element +
         "<collision><geometry><sphere radius='0.1'/></geometry></collision></link><joint name='j' "
         "type='continuous'><parent link='base'/><child link='arm'/><axis xyz='0 0 1'/></joint>"
         "</robot>";
}

TEST(HostileFiles, DoNotEndTheProgramThatCovers) {
  const Folder folder;
  make_others(folder);
  for (const auto& [name, text] : hostile()) {
    expect_an_end(run(REPEL_COVER, quoted(folder.with(name, text)) + " --quiet"), name);
  }
  for (const std::string name : others) {
    const Ending ending = run(REPEL_COVER, quoted(folder / name));
    EXPECT_EQ(ending.status, 1) << ending;
    EXPECT_TRUE(ending.says(name)) << ending;
    EXPECT_FALSE(ending.says("18446744073709551615")) << ending;
    for (const char* const ending_of_map : {".bt", ".ot"}) {
      fs::create_symlink(name, folder / (name + ending_of_map));
      EXPECT_EQ(run(REPEL_COVER, quoted(folder / (name + ending_of_map))).status, 1) << name;
    }
  }
}

TEST(HostileFiles, DoNotEndTheProgramThatReadsRobots) {
  const Folder folder;
  make_others(folder);
  for (const auto& [name, text] : hostile()) {
    expect_an_end(run(REPEL_ROBOT_INFO, quoted(folder.with(name, text))), name);
  }
  std::vector<std::string> meshes(std::begin(others), std::end(others));
  for (const auto& [name, text] : hostile()) meshes.push_back(name);
  for (const std::string& mesh : meshes) {
    const std::string geometry = "<geometry><mesh filename='" + mesh + "'/></geometry>";
    const std::string robot =
        folder.with("r.urdf", robot_with("<collision>" + geometry + "</collision>"));
    expect_an_end(run(REPEL_ROBOT_INFO, quoted(robot)), mesh + " as a collision");
  }
}

/// A scene with the robot of the file beside it.
std::string scene_with(const std::string& lines, const std::string& urdf) {
  return "rate: 400 Hz\nrobot:\n  urdf: " + urdf + "\n  start: 0 deg\n" +
         "tool:\n  - {name: ball, shape: sphere, radius: 10 mm, position: 1 0 0 m}\n" +
         "laws:\n  wall: {range: 20 mm, surface_force: 10 N}\n" +
         "network:\n  - {module: torque_arm}\n  - {module: multiplex}\n  - {module: spaceball}\n" +
         "  - {module: kbb2}\n  - {module: obstacle}\n  - {module: puma_kin}\n" +
         "  - {module: arm_obstacle}\n  - {module: puma_joints}\n" + lines;
}

TEST(HostileFiles, DoNotEndTheProgramThatRunsScenes) {
  const Folder folder;
  make_others(folder);
  (void)folder.with("sound.urdf", robot_with(""));
  const std::string sound = folder.with("sound.yaml", scene_with("obstacles: []\n", "sound.urdf"));
  EXPECT_EQ(run(REPEL_TELEOP, quoted(sound) + " --fast --seconds 0 --quiet").status, 0)
      << "what is hostile is all that is refused";
  std::vector<std::string> names(std::begin(others), std::end(others));
  for (const auto& [name, text] : hostile()) {
    names.push_back(name);
    const std::string path = folder.with(name, text);
    expect_an_end(run(REPEL_TELEOP, quoted(path) + " --fast --seconds 0"), name + " as a scene");
    expect_an_end(run(REPEL_TELEOP, "replay " + quoted(path)), name + " as a recording");
  }
  const auto expect_an_end_of = [&](const std::string& lines, const std::string& urdf,
                                    const std::string& what) {
    const std::string scene = folder.with("scene.yaml", scene_with(lines, urdf));
    expect_an_end(run(REPEL_TELEOP, quoted(scene) + " --fast --seconds 0 --quiet"), what);
  };
  for (const std::string& name : names) {
    expect_an_end_of("obstacles: []\n", name, name + " as a robot");
    for (const char* const shape : {"sdf", "urdf", "mesh"}) {
      expect_an_end_of("obstacles:\n  - {name: o, shape: " + std::string(shape) +
                           ", file: " + name + ", position: 0 0 9 m, law: wall}\n",
                       "sound.urdf", name + " as an obstacle of shape " + shape);
    }
    expect_an_end_of("camera: {recording: " + name + ", law: wall}\nobstacles: []\n", "sound.urdf",
                     name + " as recorded images");
    const std::string visual =
        "<visual><geometry><mesh filename='" + name + "'/></geometry></visual>";
    (void)folder.with("seen.urdf", robot_with(visual));
    const std::string scene = folder.with("seen.yaml", scene_with("obstacles: []\n", "seen.urdf"));
    expect_an_end(
        run(REPEL_TELEOP, quoted(scene) + " --seconds 0.1 --quiet --view --listen 127.0.0.1:0"),
        name + " as a visual");
  }
}

TEST(HostileFiles, AreNoSecrets) {
  const Folder folder;
  make_others(folder);
  for (const std::string name : {"zero", "folder", "nothing"}) {
    const Ending ending =
        run(REPEL_TELEOP,
            "empty --seconds 0.1 --view --listen 0.0.0.0:0 --secret " + quoted(folder / name));
    EXPECT_TRUE(ending.status == 1 || ending.status == 2) << ending;
    EXPECT_TRUE(ending.says("--secret: ")) << ending;
  }
}

}  // namespace hostile_files_test
}  // namespace repel::test
