#include "bridge/shared_buffer.h"

#include <gmock/gmock.h>
#include <stdlib.h>

#include <cstring>
#include <functional>
#include <numeric>

#include "cl/launch.h"
#include "cl/program_cache.h"
#include "gl/objects.h"

namespace lightgrid {
namespace {

using Parameters = std::tuple<GlBackend, BridgeKind>;

// Every test runs with every backend and every kind that the machine allows.
struct SharedBufferOf : testing::TestWithParam<Parameters> {
  ClDevice cl;
  std::unique_ptr<GlContext> gl;
  ProgramCache programs{cl, ""};
  BridgeKind kind = std::get<1>(GetParam());

  void SetUp() override {
    try {
      gl = GlContext::create(std::get<0>(GetParam()));
    } catch (const Error& error) {
      GTEST_SKIP() << error.what();
    }
    if (kind == BridgeKind::imported) {
      if (const std::string why = why_not_imported(cl, *gl); !why.empty())
        GTEST_SKIP() << "no imported memory: " << why;
    }
    if (kind == BridgeKind::mapped && choose_bridge(cl, *gl) != kind)
      GTEST_SKIP() << cl.info().name << " and " << gl->renderer << " do not share their memory";
  }

  // out[i] = i * i + start, in OpenCL.
  void write_squares(SharedBuffer& buffer, cl_uint count, cl_uint start) {
    cl::Kernel kernel = programs.kernel_of_source("squares",
                                                  "kernel void squares(global uint* out, uint start) {"
                                                  "  uint i = get_global_id(0); out[i] = i * i + start; }",
                                                  "");
    launch(cl, "squares", kernel, cl::NDRange(count), cl::NullRange, buffer.cl_buffer(), start);
  }

  std::vector<cl_uint> read_in_cl(SharedBuffer& buffer, size_t count) {
    cl::Kernel kernel = programs.kernel_of_source("copy",
                                                  "kernel void copy(global const uint* in, global uint* out) "
                                                  "{ uint i = get_global_id(0); out[i] = in[i]; }",
                                                  "");
    std::vector<cl_uint> result(count);
    cl::Buffer out(cl.context(), CL_MEM_READ_WRITE, count * 4);
    launch(cl, "copy", kernel, cl::NDRange(count), cl::NullRange, buffer.cl_buffer(), out);
    cl.queue().enqueueReadBuffer(out, CL_TRUE, 0, count * 4, result.data());
    return result;
  }
};

constexpr const char* copy_shader = R"(#version 450
layout(local_size_x = 1) in;
layout(std430, binding = 0) readonly buffer In { uint values[]; };
layout(std430, binding = 1) writeonly buffer Out { uint copied[]; };
void main() { copied[gl_GlobalInvocationID.x] = values[gl_GlobalInvocationID.x]; }
)";

constexpr const char* texel_shader = R"(#version 450
layout(local_size_x = 1) in;
layout(binding = 0) uniform usamplerBuffer values;
layout(std430, binding = 1) writeonly buffer Out { uint copied[]; };
void main() { copied[gl_GlobalInvocationID.x] = texelFetch(values, int(gl_GlobalInvocationID.x)).r; }
)";

GLuint compute_program(const char* source) {
  const GLuint shader = glCreateShader(GL_COMPUTE_SHADER), program = glCreateProgram();
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  glAttachShader(program, shader);
  glLinkProgram(program);
  glDeleteShader(shader);
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  EXPECT_TRUE(linked);
  return program;
}

// The values that a shader reads from `buffer`, bound as a texture buffer or as a storage buffer.
std::vector<cl_uint> read_in_gl(SharedBuffer& buffer, size_t count, const char* shader) {
  const GLuint program = compute_program(shader);
  GLuint out = 0, texture = 0;
  glCreateBuffers(1, &out);
  glNamedBufferStorage(out, GLsizeiptr(count * 4), nullptr, 0);
  glCreateTextures(GL_TEXTURE_BUFFER, 1, &texture);
  glTextureBuffer(texture, GL_R32UI, buffer.gl_buffer());
  glBindTextureUnit(0, texture);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer.gl_buffer());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, out);
  glUseProgram(program);
  glDispatchCompute(GLuint(count), 1, 1);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  std::vector<cl_uint> result(count);
  glGetNamedBufferSubData(out, 0, GLsizeiptr(count * 4), result.data());
  glUseProgram(0);
  glDeleteProgram(program);
  glDeleteTextures(1, &texture);
  glDeleteBuffers(1, &out);
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
  return result;
}

std::vector<cl_uint> squares(cl_uint count, cl_uint start) {
  std::vector<cl_uint> values(count);
  for (cl_uint i = 0; i < count; ++i) values[i] = i * i + start;
  return values;
}

TEST_P(SharedBufferOf, ShowsAKernelsWritesToStorageBuffers) {
  for (cl_uint count : {1u, 153u, 4097u}) {
    SharedBuffer buffer(cl, kind, count * 4);
    write_squares(buffer, count, 5);
    buffer.hand_to_gl(count * 4);
    EXPECT_EQ(read_in_gl(buffer, count, copy_shader), squares(count, 5)) << count;
  }
}

TEST_P(SharedBufferOf, ShowsAKernelsWritesToTextureBuffersFrameAfterFrame) {
  constexpr cl_uint count = 153;
  SharedBuffer buffer(cl, kind, count * 4);
  for (cl_uint frame = 0; frame < 3; ++frame) {
    write_squares(buffer, count, 1000 * frame);
    buffer.hand_to_gl(count * 4);
    EXPECT_EQ(read_in_gl(buffer, count, texel_shader), squares(count, 1000 * frame)) << frame;
  }
}

TEST_P(SharedBufferOf, ShowsPixelsThatGlReadBackToKernels) {
  for (const auto& [width, height] : {std::pair(1, 1), {17, 9}, {129, 65}}) {
    GLuint texture = 0, framebuffer = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &texture);
    glTextureStorage2D(texture, 1, GL_DEPTH_COMPONENT32F, width, height);
    std::vector<float> depth(size_t(width) * height);
    for (size_t i = 0; i < depth.size(); ++i) depth[i] = float(i + 1) / float(depth.size() + 1);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(texture, 0, 0, 0, width, height, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
    glCreateFramebuffers(1, &framebuffer);
    glNamedFramebufferTexture(framebuffer, GL_DEPTH_ATTACHMENT, texture, 0);
    glNamedFramebufferDrawBuffer(framebuffer, GL_NONE);
    glNamedFramebufferReadBuffer(framebuffer, GL_NONE);

    SharedBuffer buffer(cl, kind, depth.size() * 4);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer.gl_buffer());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_DEPTH_COMPONENT, GL_FLOAT, nullptr);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    buffer.hand_to_cl(depth.size() * 4);

    std::vector<cl_uint> bits(depth.size());
    std::memcpy(bits.data(), depth.data(), depth.size() * 4);
    EXPECT_EQ(read_in_cl(buffer, bits.size()), bits) << width << "x" << height;
    glDeleteFramebuffers(1, &framebuffer);
    glDeleteTextures(1, &texture);
  }
}

TEST_P(SharedBufferOf, ShowsAShadersWritesToKernels) {
  constexpr cl_uint count = 153;
  SharedBuffer buffer(cl, kind, count * 4);
  const GLuint program = compute_program(R"(#version 450
layout(local_size_x = 1) in;
layout(std430, binding = 0) writeonly buffer Out { uint values[]; };
void main() { values[gl_GlobalInvocationID.x] = 7u * gl_GlobalInvocationID.x; }
)");
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer.gl_buffer());
  glUseProgram(program);
  glDispatchCompute(count, 1, 1);
  buffer.hand_to_cl(count * 4);
  std::vector<cl_uint> expected(count);
  for (cl_uint i = 0; i < count; ++i) expected[i] = 7 * i;
  EXPECT_EQ(read_in_cl(buffer, count), expected);
  glDeleteProgram(program);
}

TEST_P(SharedBufferOf, MovesWithItsContentsAndFreesOnce) {
  constexpr cl_uint count = 17;
  SharedBuffer made(cl, kind, count * 4);
  write_squares(made, count, 0);
  SharedBuffer moved(std::move(made));
  SharedBuffer assigned(cl, kind, 4);
  assigned = std::move(moved);
  assigned.hand_to_gl(count * 4);
  EXPECT_EQ(assigned.size(), count * 4);
  EXPECT_EQ(read_in_gl(assigned, count, copy_shader), squares(count, 0));
}

TEST_P(SharedBufferOf, MayBeEmpty) {
  SharedBuffer buffer(cl, kind, 0);
  buffer.hand_to_gl(0);
  buffer.hand_to_cl(0);
  EXPECT_EQ(buffer.size(), 0u);
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

// An OpenGL that copies late, like a GPU: copies are delayed until a wait.
struct LateCopies {
  LateCopies() {
    copy = glCopyNamedBufferSubData;
    wait = glClientWaitSync;
    finish = glFinish;
    pending.clear();
    finishes = 0;
    glCopyNamedBufferSubData = [](GLuint from, GLuint to, GLintptr a, GLintptr b, GLsizeiptr bytes) {
      pending.push_back([=] { copy(from, to, a, b, bytes); });
    };
    glClientWaitSync = [](GLsync sync, GLbitfield flags, GLuint64 time) {
      run();
      return wait(sync, flags, time);
    };
    glFinish = [] {
      ++finishes;
      run();
      finish();
    };
  }
  ~LateCopies() {
    run();
    glCopyNamedBufferSubData = copy;
    glClientWaitSync = wait;
    glFinish = finish;
  }
  static void run() {
    for (const auto& late : pending) late();
    pending.clear();
  }
  static inline std::vector<std::function<void()>> pending;
  static inline int finishes;  // calls of glFinish
  static inline PFNGLCOPYNAMEDBUFFERSUBDATAPROC copy;
  static inline PFNGLCLIENTWAITSYNCPROC wait;
  static inline PFNGLFINISHPROC finish;
};

// A second hand-over must not overwrite data that the first copy has not yet read.
TEST_P(SharedBufferOf, WaitsForTheLastCopyBeforeItHandsOverAgain) {
  constexpr cl_uint count = 16;
  SharedBuffer buffer(cl, kind, count * 4);
  std::vector<cl_uint> first_frame(count);
  {
    const LateCopies late;
    write_squares(buffer, count, 1);
    buffer.hand_to_gl(count * 4);
    // OpenGL's contents after the first copy.
    LateCopies::pending.push_back(
        [&] { glGetNamedBufferSubData(buffer.gl_buffer(), 0, count * 4, first_frame.data()); });
    write_squares(buffer, count, 1000);
    buffer.hand_to_gl(count * 4);
  }
  if (kind == BridgeKind::staged) {
    EXPECT_EQ(first_frame, squares(count, 1));
  }
  EXPECT_EQ(read_in_gl(buffer, count, copy_shader), squares(count, 1000));
}

TEST_P(SharedBufferOf, HandsSeveralToKernelsWithOneWait) {
  constexpr cl_uint counts[] = {1, 153, 4097};
  std::vector<SharedBuffer> buffers;
  for (cl_uint count : counts) buffers.emplace_back(cl, kind, count * 4);
  std::vector<SharedBuffer*> pointers;
  std::vector<SharedBuffer::Written> written;
  for (SharedBuffer& buffer : buffers) {
    pointers.push_back(&buffer);
    written.push_back({&buffer, buffer.size()});
  }
  for (cl_uint frame = 0; frame < 2; ++frame) {
    const LateCopies late;
    SharedBuffer::take_for_gl(pointers);
    std::vector<GlBuffer> sources;
    for (size_t i = 0; i < buffers.size(); ++i) {
      sources.push_back(make_buffer(buffers[i].size(), squares(counts[i], 1000 * frame).data()));
      glCopyNamedBufferSubData(sources[i].name(), buffers[i].gl_buffer(), 0, 0,
                               GLsizeiptr(buffers[i].size()));
    }
    LateCopies::finishes = 0;
    SharedBuffer::hand_to_cl(written);
    EXPECT_EQ(LateCopies::finishes, 1);
    for (size_t i = 0; i < buffers.size(); ++i)
      EXPECT_EQ(read_in_cl(buffers[i], counts[i]), squares(counts[i], 1000 * frame))
          << counts[i] << ", frame " << frame;
  }
}

TEST_P(SharedBufferOf, HandsSeveralToShaders) {
  constexpr cl_uint counts[] = {1, 153, 4097};
  std::vector<SharedBuffer> buffers;
  for (cl_uint count : counts) buffers.emplace_back(cl, kind, count * 4);
  std::vector<SharedBuffer::Written> written;
  for (SharedBuffer& buffer : buffers) written.push_back({&buffer, buffer.size()});
  for (cl_uint frame = 0; frame < 3; ++frame) {
    for (size_t i = 0; i < buffers.size(); ++i) write_squares(buffers[i], counts[i], 1000 * frame);
    SharedBuffer::hand_to_gl(written);
    for (size_t i = 0; i < buffers.size(); ++i)
      EXPECT_EQ(read_in_gl(buffers[i], counts[i], copy_shader), squares(counts[i], 1000 * frame))
          << counts[i] << ", frame " << frame;
  }
}

// Earlier failures are not attributed to the buffer. Debug builds abort at the call itself.
TEST_P(SharedBufferOf, DoesNotTakeAnEarlierErrorForItsOwn) {
#ifndef NDEBUG
  GTEST_SKIP() << "this build aborts at the first OpenGL error";
#endif
  glEnable(GL_TEXTURE_2D + 0xdead);
  try {
    SharedBuffer buffer(cl, kind, 64);
    FAIL() << "made";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("GL_INVALID_ENUM of a call before"));
    EXPECT_THAT(error.what(), testing::Not(testing::HasSubstr("no room")));
  }
  SharedBuffer buffer(cl, kind, 64);
}

std::string pair_name(const testing::TestParamInfo<Parameters>& info) {
  return std::string(std::get<0>(info.param) == GlBackend::osmesa ? "osmesa_" : "egl_") +
         to_string(std::get<1>(info.param));
}
INSTANTIATE_TEST_SUITE_P(Pairs, SharedBufferOf,
                         testing::Combine(testing::Values(GlBackend::osmesa, GlBackend::egl),
                                          testing::Values(BridgeKind::mapped, BridgeKind::staged)),
                         pair_name);
INSTANTIATE_TEST_SUITE_P(Gpu, SharedBufferOf,
                         testing::Values(Parameters(GlBackend::egl, BridgeKind::imported)), pair_name);

}  // namespace
}  // namespace lightgrid
