// The culling library as other programs use it: installed, found by CMake, linked into the example of
// docs/examples, run.
#include <dlfcn.h>
#include <gmock/gmock.h>

#include <fmt/format.h>
#include <glm/glm.hpp>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "support/installed_library.h"
#include "support/temp_folder.h"

// The example's own view, depths and lights.
#define main example_main
#include "../../docs/examples/cull_depth/main.cpp"
#undef main

namespace lightgrid {
namespace {

using testing::HasSubstr;
using testing::Not;

// Lights whose sphere contains the surface at the centre of one of the tile's pixels.
std::set<uint32_t> lights_of_tile(const std::vector<CullLight>& lights, const std::vector<float>& depth,
                                  int tx, int ty) {
  std::set<uint32_t> found;
  for (int y = ty * 16; y < ty * 16 + 16; ++y) {
    for (int x = tx * 16; x < tx * 16 + 16; ++x) {
      const double value = depth[size_t(y) * width + x];
      if (value == 0) continue;
      const double d = near_m / value;
      const glm::dvec3 place(d * slope_x * ((x + 0.5) * 2 / width - 1),
                             d * slope_y * ((y + 0.5) * 2 / height - 1), -d);
      for (size_t i = 0; i < lights.size(); ++i) {
        if (glm::distance(place, lights[i].position) < lights[i].radius_m) found.insert(uint32_t(i));
      }
    }
  }
  return found;
}

// The numbers of a line that a pattern finds.
std::vector<uint32_t> numbers_after(const std::string& text, const std::string& pattern) {
  std::smatch match;
  if (!std::regex_search(text, match, std::regex(pattern + "([ 0-9]*)\n"))) return {};
  std::istringstream words(match[1].str());
  return {std::istream_iterator<uint32_t>(words), {}};
}

TEST(Library, InstalledIsFoundByCMakeAndCullsInTheExampleWithoutOpenGl) {
  if (!has_tool(LIGHTGRID_CMAKE)) GTEST_SKIP() << "there is no cmake at " << LIGHTGRID_CMAKE;
  const TempFolder temp;
  const std::string example = built_example("cull_depth", temp.path);
  if (HasFailure()) return;
  const std::string out = must_run(example);

  EXPECT_THAT(out, HasSubstr("80 x 45 tiles, "));
  const std::vector<CullLight> lights = make_lights(500);
  const std::vector<float> depth = make_depth();
  const auto listed = numbers_after(out, "pixel 640 200:");
  const auto reaching = lights_of_tile(lights, depth, 640 / 16, 200 / 16);
  EXPECT_GE(reaching.size(), 3u);
  EXPECT_THAT(listed, testing::IsSupersetOf(reaching));
  EXPECT_LE(listed.size(), 2 * reaching.size());

  size_t pairs = 0, tiles = 0;
  for (int tile = 0; tile < 80 * 45; ++tile) {
    const size_t count = lights_of_tile(lights, depth, tile % 80, tile / 80).size();
    pairs += count;
    tiles += count > 0;
  }
  std::smatch numbers;
  ASSERT_TRUE(
      std::regex_search(out, numbers, std::regex("tiles, ([0-9]+) of[^]*500 lights, ([0-9]+) entries")))
      << out;
  EXPECT_GE(std::stoul(numbers[1]), tiles);
  EXPECT_GE(std::stoul(numbers[2]), pairs);
  EXPECT_LE(std::stoul(numbers[2]), 2 * pairs);

  if (!has_tool("ldd")) GTEST_SKIP() << "there is no ldd to ask what the example links";
  const std::string libraries = must_run("ldd " + example);
  EXPECT_THAT(libraries, HasSubstr("libOpenCL"));
  for (const char* name :
       {"libGL", "libEGL", "libOSMesa", "libglapi", "libX11", "libpng", "libspdlog", "libdraco"}) {
    EXPECT_THAT(libraries, Not(HasSubstr(name)));
  }
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path) << text;
}

TEST(Library, LinksIntoAPluginOfAnEngineThatHasABaseFolderOfItsOwn) {
  if (!has_tool(LIGHTGRID_CMAKE)) GTEST_SKIP() << "there is no cmake at " << LIGHTGRID_CMAKE;
  const TempFolder temp;
  const std::string prefix = temp.path / "prefix", engine = temp.path / "engine", build = temp.path / "build";
  write_text(temp.path / "engine/own/base/error.h", "#pragma once\nstruct EngineError { int code = 7; };\n");
  write_text(temp.path / "engine/plugin.cpp", R"(
#include "base/error.h"
#include <lightgrid/base/error.h>
#include <lightgrid/culling/light_culler.h>
#include "raster/raster_view.h"

extern "C" int cull_nothing() {
  try {
    lightgrid::ClDevice device;
    lightgrid::ProgramCache programs(device);
    lightgrid::LightCuller culler(device, programs, {});
    lightgrid::RasterScene scene(device);
    lightgrid::RasterView view(scene, programs, {});
    return 0;
  } catch (const lightgrid::Error& error) {
    return error.exit_code();
  }
}
extern "C" int engine_code() { return EngineError().code; }
)");
  write_text(temp.path / "engine/CMakeLists.txt", R"(
cmake_minimum_required(VERSION 3.22)
project(engine LANGUAGES CXX)
find_package(lightgrid 0.1 REQUIRED)
add_library(plugin SHARED plugin.cpp)
target_include_directories(plugin BEFORE PRIVATE own)
target_link_libraries(plugin PRIVATE lightgrid::culling lightgrid::raster)
target_link_options(plugin PRIVATE -Wl,--no-undefined)
)");
  for (const std::string& command :
       {fmt::format("{} --install {} --component library --prefix {}", LIGHTGRID_CMAKE, LIGHTGRID_BUILD_DIR,
                    prefix),
        fmt::format("{} -S {} -B {} -DCMAKE_PREFIX_PATH={}", LIGHTGRID_CONFIGURE, engine, build, prefix),
        fmt::format("{} --build {}", LIGHTGRID_CMAKE, build)}) {
    const CommandOutcome outcome = run_command(command + " 2>&1");
    ASSERT_EQ(outcome.status, 0) << command << "\n" << outcome.output;
  }
  void* const plugin = dlopen((build + "/libplugin.so").c_str(), RTLD_NOW | RTLD_LOCAL);
  ASSERT_NE(plugin, nullptr) << dlerror();
  const auto call = [&](const char* name) { return reinterpret_cast<int (*)()>(dlsym(plugin, name))(); };
  EXPECT_EQ(call("engine_code"), 7);
  EXPECT_EQ(call("cull_nothing"), 0);
}

TEST(Library, AsASubfolderItLeavesTheProjectAboveItsSettings) {
  if (!has_tool(LIGHTGRID_CMAKE)) GTEST_SKIP() << "there is no cmake at " << LIGHTGRID_CMAKE;
  const TempFolder temp;
  write_text(temp.path / "engine/CMakeLists.txt", fmt::format(R"(
cmake_minimum_required(VERSION 3.22)
project(engine LANGUAGES CXX)
add_subdirectory({} lightgrid)
add_library(engine STATIC engine.cpp)
target_link_libraries(engine PRIVATE lightgrid::culling)
get_target_property(unity engine UNITY_BUILD)
get_target_property(options engine COMPILE_OPTIONS)
get_target_property(ours lightgrid_culling UNITY_BUILD)
message(STATUS "build type '${{CMAKE_BUILD_TYPE}}', unity '${{unity}}', options '${{options}}', ours '${{ours}}'")
if(TARGET lightgrid)
  message(FATAL_ERROR "the program is built too")
endif()
)",
                                                              source_folder));
  write_text(temp.path / "engine/engine.cpp", "#include <lightgrid/culling/light_culler.h>\n");
  const std::string build = temp.path / "build";
  const CommandOutcome outcome = run_command(fmt::format("{} -DCMAKE_BUILD_TYPE= -S {}/engine -B {} 2>&1",
                                                         LIGHTGRID_CONFIGURE, temp.path.string(), build));
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_THAT(outcome.output,
              testing::ContainsRegex(
                  "build type '', unity '(unity-)?(OFF|NOTFOUND)?', options '(options-NOTFOUND)?', "
                  "ours 'ON'"));
}

// As on a machine with OpenCL, GLM and fmt and without the program's other dependencies.
TEST(Library, AloneIsConfiguredWithoutThePackagesOfTheProgram) {
  if (!has_tool(LIGHTGRID_CMAKE)) GTEST_SKIP() << "there is no cmake at " << LIGHTGRID_CMAKE;
  const TempFolder temp;
  std::string command = fmt::format("{} -S {} -B {} -DLIGHTGRID_PROGRAM=OFF", LIGHTGRID_CONFIGURE,
                                    source_folder, temp.path.string());
  for (const char* package : {"CLI11", "draco", "GTest", "meshoptimizer", "nlohmann_json", "OpenGL",
                              "PkgConfig", "PNG", "spdlog", "TinyGLTF", "tinyexr"}) {
    command += fmt::format(" -DCMAKE_DISABLE_FIND_PACKAGE_{}=ON", package);
  }
  const CommandOutcome outcome = run_command(command + " 2>&1");
  EXPECT_EQ(outcome.status, 0) << outcome.output;
}

}  // namespace
}  // namespace lightgrid
