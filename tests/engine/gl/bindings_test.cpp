// Texture units and binding points come from gl/bindings.h; a shader that does not fit it does not link.
#include "gl/bindings.h"

#include <gmock/gmock.h>

#include <regex>
#include <set>

#include "base/embedded.h"
#include "base/error.h"
#include "gl/context.h"
#include "gl/objects.h"

namespace lightgrid {
namespace {

using testing::HasSubstr;

struct Bindings : testing::Test {
  // Why a fragment shader does not link; empty: it does.
  static std::string refusal(const char* fragment, const std::vector<std::string>& defines) {
    try {
      GlProgram("shaders/screen.vert", fragment, defines);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::machine);
      return error.what();
    }
    return "";
  }
  std::unique_ptr<GlContext> context = GlContext::create();
};

TEST_F(Bindings, ProgramsOfOneSourceOfLightsShareItsUnits) {
  EXPECT_EQ(refusal("shaders/view.frag", {}), "");
  EXPECT_EQ(Sampler::grid_cells, Sampler::world_cells);
}

TEST_F(Bindings, ASamplerOrBlockThatTheListLacksIsNamed) {
  EXPECT_THAT(refusal("shaders/view.frag", {"left_image shadow_map"}),
              HasSubstr("shaders/view.frag declares the sampler \"shadow_map\""));
  EXPECT_EQ(refusal("shaders/cells.frag", {"GIVEN_DEPTH"}), "");
  EXPECT_THAT(refusal("shaders/cells.frag", {"GIVEN_DEPTH", "ViewParamsBlock RenamedBlock"}),
              HasSubstr("uniform block \"RenamedBlock\""));
}

TEST_F(Bindings, SamplersThatShareAUnitInOneProgramAreNamed) {
  EXPECT_THAT(refusal("shaders/view.frag", {"left_image grid_cells", "right_image object_lights"}),
              testing::AllOf(HasSubstr("\"grid_cells\""), HasSubstr("\"object_lights\"")));
}

TEST_F(Bindings, MoreTexturesThanAShaderMayReadAreCounted) {
  static PFNGLGETINTEGERVPROC get = glGetIntegerv;
  glGetIntegerv = [](GLenum name, GLint* value) {
    name == GL_MAX_TEXTURE_IMAGE_UNITS ? void(*value = 1) : get(name, value);
  };
  EXPECT_THAT(refusal("shaders/view.frag", {}), HasSubstr("reads 2 textures; a shader may read 1"));
  glGetIntegerv = get;
}

// Every shader, whichever defines it is built with. LIGHT_TABLE declares its samplers itself.
TEST_F(Bindings, ShadersAndTheListNameTheSameSamplersAndNoNumbers) {
  std::set<std::string> declared, listed;
#define LIGHTGRID_NAME(name) listed.insert(#name);
#define LIGHTGRID_SHARED_NAME(name, first) listed.insert(#name);
  LIGHTGRID_SURFACE_SAMPLERS(LIGHTGRID_NAME)
  LIGHTGRID_LIGHT_SAMPLERS(LIGHTGRID_NAME, LIGHTGRID_SHARED_NAME)
  const std::regex sampler("uniform (?:frame_)?[ui]?sampler\\w+ (\\w+)");
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
