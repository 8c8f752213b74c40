// Texture units and binding points come from gl/bindings.h; a shader that does not fit it does not link.
#include "gl/bindings.h"

#include <gmock/gmock.h>

#include <regex>
#include <set>

#include "base/embedded.h"
#include "base/error.h"
#include "gl/context.h"
#include "gl/program.h"

namespace lightgrid {
namespace {

using testing::HasSubstr;

std::string refused(const std::vector<ActiveSampler>& samplers, GLuint most = 16) {
  try {
    units_of("a.frag", samplers, most);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Bindings, SamplersOfOneProgramHaveUnitsOfTheirOwn) {
  const std::vector<ActiveSampler> samplers = {{"base_color_map"}, {"grid_cells"}, {"light_positions"}};
  const std::vector<GLuint> units = units_of("a.frag", samplers, 16);
  EXPECT_EQ(std::set<GLuint>(units.begin(), units.end()).size(), 3u);
  EXPECT_EQ(units[1], GLuint(Sampler::grid_cells));
  EXPECT_EQ(Sampler::grid_cells, Sampler::world_cells) << "one source of lights a program";
}

TEST(Bindings, ASamplerThatTheListLacksIsNamed) {
  EXPECT_THAT(refused({{"light_positions"}, {"shadow_map"}}),
              HasSubstr("a.frag declares the sampler \"shadow_map\""));
}

TEST(Bindings, SamplersThatShareAUnitInOneProgramAreNamed) {
  EXPECT_THAT(refused({{"grid_indices"}, {"light_index_images", 3}}),
              HasSubstr("\"grid_indices\" and \"light_index_images\""));
  EXPECT_EQ(refused({{"light_index_images", 3}, {"light_cones"}}), "");
}

TEST(Bindings, MoreTexturesThanAShaderMayReadAreCounted) {
  const std::vector<ActiveSampler> samplers = {{"light_index_images", 3}, {"light_cones"}};
  EXPECT_EQ(refused(samplers, 4), "");
  EXPECT_THAT(refused(samplers, 3), HasSubstr("reads 4 textures; a shader may read 3"));
}

TEST(Bindings, AProgramWithAnUnlistedSamplerOrBlockDoesNotLink) {
  const std::unique_ptr<GlContext> context = GlContext::create();
  const auto link = [](const char* fragment, std::vector<std::string> defines) {
    try {
      GlProgram("shaders/screen.vert", fragment, defines);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(link("shaders/view.frag", {}), "");
  EXPECT_THAT(link("shaders/view.frag", {"left_image renamed_image"}),
              HasSubstr("sampler \"renamed_image\""));
  EXPECT_EQ(link("shaders/cells.frag", {"GIVEN_DEPTH"}), "");
  EXPECT_THAT(link("shaders/cells.frag", {"GIVEN_DEPTH", "ViewParamsBlock RenamedBlock"}),
              HasSubstr("uniform block \"RenamedBlock\""));
}

// Every shader, whichever defines it is built with. LIGHT_TABLE declares its samplers itself.
TEST(Bindings, ShadersAndTheListNameTheSameSamplersAndNoNumbers) {
  std::set<std::string> declared, listed;
#define LIGHTGRID_NAME(name) listed.insert(#name);
#define LIGHTGRID_SHARED_NAME(name, first) listed.insert(#name);
  LIGHTGRID_SURFACE_SAMPLERS(LIGHTGRID_NAME)
  LIGHTGRID_LIGHT_SAMPLERS(LIGHTGRID_NAME, LIGHTGRID_SHARED_NAME)
  const std::regex sampler("uniform [ui]?sampler\\w+ (\\w+)");
  for (const auto& [path, text] : embedded_files()) {
    if (!path.starts_with("shaders/") && !path.starts_with("shared/")) continue;
    EXPECT_THAT(text, testing::Not(testing::ContainsRegex("binding *="))) << path;
    for (std::sregex_iterator i(text.begin(), text.end(), sampler), end; i != end; ++i)
      declared.insert((*i)[1]);
  }
  EXPECT_EQ(declared, listed);
}

}  // namespace
}  // namespace lightgrid
