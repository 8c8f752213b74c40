// Failures of OpenGL, and the state that they leave.
#include <gmock/gmock.h>

#include "base/error.h"
#include "gl/bindings.h"
#include "gl/context.h"
#include "gl/gl.h"
#include "gl/objects.h"

namespace lightgrid {
namespace {

using testing::HasSubstr;

struct GlFailures : testing::Test {
  std::unique_ptr<GlContext> context = GlContext::create();
};

template <typename Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::machine);
    return error.what();
  }
  return "";
}

// An OpenGL without memory: storage fails, and glGetError reports it once.
struct NoMemory {
  NoMemory() {
    buffer = glNamedBufferStorage;
    texture = glTextureStorage2D;
    error = glGetError;
    pending = GL_NO_ERROR;
    glNamedBufferStorage = [](GLuint, GLsizeiptr, const void*, GLbitfield) { pending = GL_OUT_OF_MEMORY; };
    glTextureStorage2D = [](GLuint, GLsizei, GLenum, GLsizei, GLsizei) { pending = GL_OUT_OF_MEMORY; };
    glGetError = [] { return std::exchange(pending, GLenum(GL_NO_ERROR)); };
  }
  ~NoMemory() {
    glNamedBufferStorage = buffer;
    glTextureStorage2D = texture;
    glGetError = error;
  }
  static inline GLenum pending;
  PFNGLNAMEDBUFFERSTORAGEPROC buffer;
  PFNGLTEXTURESTORAGE2DPROC texture;
  PFNGLGETERRORPROC error;
};

TEST_F(GlFailures, BuffersAndTexturesWithoutRoomAreErrorsWithTheirSizes) {
  const GlCounts before = gl_counts();
  {
    const NoMemory none;
    EXPECT_EQ(refusal([] { make_buffer(123456, nullptr); }),
              "OpenGL has no room for a buffer of 123456 bytes (GL_OUT_OF_MEMORY)");
    EXPECT_EQ(refusal([] { make_texture_2d(GL_R32F, 640, 480); }),
              "OpenGL has no room for a texture of 640 x 480 pixels (GL_OUT_OF_MEMORY)");
  }
  EXPECT_EQ(gl_counts().of(GlKind::buffer), before.of(GlKind::buffer));
  EXPECT_EQ(gl_counts().of(GlKind::texture), before.of(GlKind::texture));
}

TEST_F(GlFailures, AnErrorOfAnEarlierCallIsNamedAndForgotten) {
#ifndef NDEBUG
  GTEST_SKIP() << "this build aborts at the first OpenGL error";
#endif
  glEnable(0xdead);
  EXPECT_EQ(refusal([] { check_gl("the test"); }), "OpenGL: GL_INVALID_ENUM of a call before: the test");
  EXPECT_EQ(refusal([] { check_gl("the test"); }), "");
  glEnable(0xdead);
  EXPECT_THAT(refusal([] { make_buffer(64, nullptr); }), HasSubstr("GL_INVALID_ENUM of a call before"));
  EXPECT_TRUE(make_buffer(64, nullptr));
}

TEST_F(GlFailures, AProgramThatDoesNotCompileLeavesNoShaderBehind) {
  static int made = 0, deleted = 0;
  static PFNGLCREATESHADERPROC create = glCreateShader;
  static PFNGLDELETESHADERPROC remove = glDeleteShader;
  glCreateShader = [](GLenum stage) {
    ++made;
    return create(stage);
  };
  glDeleteShader = [](GLuint shader) {
    ++deleted;
    remove(shader);
  };
  EXPECT_THAT(refusal([] { GlProgram("shaders/screen.vert", "shaders/screen.vert", {"main ["}); }),
              HasSubstr("does not compile"));
  glCreateShader = create;
  glDeleteShader = remove;
  EXPECT_EQ(made, 2);
  EXPECT_EQ(deleted, 2);
}

TEST_F(GlFailures, ResetStateIsThatOfANewContext) {
  const auto state = [] {
    std::vector<GLint> values;
    for (const GLenum name : {GL_BLEND, GL_CULL_FACE, GL_DEPTH_TEST, GL_SCISSOR_TEST, GL_STENCIL_TEST,
                              GL_BLEND_SRC_RGB, GL_BLEND_DST_ALPHA, GL_BLEND_EQUATION_RGB, GL_CULL_FACE_MODE,
                              GL_FRONT_FACE, GL_DEPTH_FUNC, GL_DEPTH_WRITEMASK, GL_STENCIL_FUNC,
                              GL_STENCIL_WRITEMASK, GL_STENCIL_FAIL, GL_STENCIL_BACK_WRITEMASK,
                              GL_PIXEL_PACK_BUFFER_BINDING, GL_VERTEX_ARRAY_BINDING, GL_SAMPLER_BINDING}) {
      glGetIntegerv(name, &values.emplace_back());
      const bool is_mask = name == GL_STENCIL_WRITEMASK || name == GL_STENCIL_BACK_WRITEMASK;
      if (is_mask) values.back() &= 0xff;  // drivers differ in the bits that no stencil plane has
    }
    GLint mask[4];
    glGetIntegerv(GL_COLOR_WRITEMASK, mask);
    values.insert(values.end(), mask, mask + 4);
    return values;
  };
  const std::vector<GLint> fresh = state();
  const GlSampler sampler = make_sampler();
  const GlBuffer buffer = make_buffer(64, nullptr);
  const GlVertexArray array = make_vertex_array();
  for (const GLenum test : {GL_BLEND, GL_CULL_FACE, GL_DEPTH_TEST, GL_SCISSOR_TEST, GL_STENCIL_TEST})
    glEnable(test);
  glBlendEquation(GL_MAX);
  glBlendFunc(GL_ONE, GL_ONE);
  glCullFace(GL_FRONT);
  glFrontFace(GL_CW);
  glDepthFunc(GL_EQUAL);
  glDepthMask(GL_FALSE);
  glStencilMask(1);
  glStencilFunc(GL_EQUAL, 1, 1);
  glStencilOp(GL_ZERO, GL_ZERO, GL_ZERO);
  glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_TRUE);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer.name());
  glBindVertexArray(array.name());
  glBindSampler(0, sampler.name());
  ASSERT_NE(state(), fresh);
  reset_gl_state();
  EXPECT_EQ(state(), fresh);
}

}  // namespace
}  // namespace lightgrid
