#include "gl/context.h"

#include <gmock/gmock.h>

#include <array>
#include <cstdlib>

#include "base/error.h"
#include "gl/gl.h"
#include "support/error_of.h"

namespace lightgrid {
namespace {

using testing::HasSubstr;

// Newer distributions have no OSMesa: its tests are then skipped with a message. EGL is required, so its
// tests fail.
bool osmesa_is_installed() {
  try {
    GlContext::create(GlBackend::osmesa);
    return true;
  } catch (const Error& error) {
    return std::string(error.what()).find("is not installed") == std::string::npos;
  }
}

struct GlContextOf : testing::TestWithParam<GlBackend> {
  void SetUp() override {
    if (GetParam() == GlBackend::osmesa && !osmesa_is_installed()) GTEST_SKIP() << "OSMesa is not installed";
  }
};

// Only the program's own: drivers add variables.
std::vector<std::string> environment() {
  std::vector<std::string> values;
  for (const char* name : {"EGL_LOG_LEVEL"}) {
    const char* value = std::getenv(name);
    values.push_back(value ? value : "(not set)");
  }
  return values;
}

// A library may not call setenv: another thread of the host program may be reading the environment.
TEST_P(GlContextOf, LeavesTheEnvironmentOfTheHostProgramAsItIs) {
  const std::vector<std::string> before = environment();
  const auto context = GlContext::create(GetParam());
  EXPECT_EQ(environment(), before);
}

TEST_P(GlContextOf, IsACoreProfileOfAtLeast45) {
  auto context = GlContext::create(GetParam());
  GLint major = 0, minor = 0, profile = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
  EXPECT_GE(major * 10 + minor, 45);
  EXPECT_EQ(profile, GL_CONTEXT_CORE_PROFILE_BIT);
  EXPECT_EQ(context->backend, GetParam() == GlBackend::osmesa ? "osmesa" : "egl");
}

// A clear to a value and its read-back, through a framebuffer object of an awkward size: `context` must be
// current.
std::array<float, 4> clear_and_read(float red) {
  GLuint texture = 0, framebuffer = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &texture);
  glTextureStorage2D(texture, 1, GL_RGBA32F, 17, 9);
  glCreateFramebuffers(1, &framebuffer);
  glNamedFramebufferTexture(framebuffer, GL_COLOR_ATTACHMENT0, texture, 0);
  EXPECT_EQ(glCheckNamedFramebufferStatus(framebuffer, GL_FRAMEBUFFER), GLenum(GL_FRAMEBUFFER_COMPLETE));
  const float color[4] = {red, 2, 3, 4};
  glClearNamedFramebufferfv(framebuffer, GL_COLOR, 0, color);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
  std::array<float, 4> pixel = {};
  glReadPixels(16, 8, 1, 1, GL_RGBA, GL_FLOAT, pixel.data());
  glDeleteFramebuffers(1, &framebuffer);
  glDeleteTextures(1, &texture);
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
  return pixel;
}

TEST_P(GlContextOf, DrawsToAFramebufferObjectWithoutAWindow) {
  auto context = GlContext::create(GetParam());
  EXPECT_EQ(clear_and_read(0.25f), (std::array<float, 4>{0.25f, 2, 3, 4}));
}

TEST_P(GlContextOf, CanBeMadeAgainAfterTheFirstIsGone) {
  GlContext::create(GetParam()).reset();
  auto context = GlContext::create(GetParam());
  EXPECT_EQ(clear_and_read(0.5f)[0], 0.5f);
}

INSTANTIATE_TEST_SUITE_P(Backends, GlContextOf, testing::Values(GlBackend::osmesa, GlBackend::egl),
                         [](const auto& info) { return info.param == GlBackend::osmesa ? "osmesa" : "egl"; });

#ifndef NDEBUG
using GlContextDeathTest = GlContextOf;
TEST_P(GlContextDeathTest, AnErrorInADebugBuildSaysWhichAndAborts) {
  EXPECT_DEATH(
      {
        auto context = GlContext::create(GetParam());
        glBindTextureUnit(0, 12345);
      },
      "OpenGL: GL_INVALID_OPERATION");
}
INSTANTIATE_TEST_SUITE_P(Backends, GlContextDeathTest, testing::Values(GlBackend::osmesa, GlBackend::egl));
#endif

TEST(GlContext, BothBackendsLiveSideBySideAndMakeCurrentSwitches) {
  if (!osmesa_is_installed()) GTEST_SKIP() << "OSMesa is not installed";
  auto osmesa = GlContext::create(GlBackend::osmesa);
  auto egl = GlContext::create(GlBackend::egl);
  EXPECT_EQ(clear_and_read(1)[0], 1);
  osmesa->make_current();
  EXPECT_EQ(clear_and_read(2)[0], 2);
  egl->make_current();
  EXPECT_EQ(clear_and_read(3)[0], 3);
  egl.reset();
  osmesa->make_current();
  EXPECT_EQ(clear_and_read(4)[0], 4);
}

TEST(GlContext, AutomaticPrefersHardware) {
  auto context = GlContext::create();
  EXPECT_TRUE(context->backend == "osmesa" || !context->software)
      << context->backend << ", " << context->renderer;
}

TEST(GlBackendName, IsOneOfThree) {
  EXPECT_EQ(parse_gl_backend("auto"), GlBackend::automatic);
  EXPECT_EQ(parse_gl_backend("osmesa"), GlBackend::osmesa);
  EXPECT_EQ(parse_gl_backend("egl"), GlBackend::egl);
}

TEST(GlBackendName, ThatIsUnknownIsAnInputErrorThatNamesItAndTheKnownOnes) {
  const std::string message = error_of([&] { parse_gl_backend("glx"); });
  EXPECT_THAT(message, HasSubstr("\"glx\""));
  EXPECT_THAT(message, HasSubstr("auto, osmesa, egl"));
}

TEST(GlFunctions, ThatAreMissingAreNamed) {
  try {
    load_gl_functions([](const char*) -> void* { return nullptr; });
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::machine);
    EXPECT_THAT(error.what(), HasSubstr("glAttachShader"));
  }
}

}  // namespace
}  // namespace lightgrid
