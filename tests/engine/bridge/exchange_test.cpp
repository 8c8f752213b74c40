// Many hand-overs of buffers of changing sizes in both directions, with no wait but the bridge's own. Each
// API checks every word that the other wrote, in place; the counts are read at the end.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <random>

#include "bridge/pixel_copies.h"
#include "bridge/shared_buffer.h"
#include "cl/launch.h"
#include "cl/program_cache.h"
#include "cl/transfer.h"
#include "gl/objects.h"

namespace lightgrid {
namespace {

// Word i of a round, in OpenCL C and GLSL: as a float between 1 and 2, which every copy keeps.
constexpr const char* word_of = R"(
uint word_of(uint i, uint seed) {
  uint h = (i + seed * 0x9e3779b9u) * 2654435761u;
  h = (h ^ (h >> 15u)) * 2246822519u;
  return 0x3f800000u | ((h ^ (h >> 13u)) >> 9u);
}
)";

constexpr const char* write_kernel =
    "kernel void write_words(global uint* out, uint count, uint seed) {"
    "  uint i = get_global_id(0);"
    "  if (i < count) out[i] = word_of(i, seed); }";
// counts[2 * round]: wrong words; [2 * round + 1]: checked ones, which shows a kernel that did not run.
constexpr const char* check_kernel =
    "kernel void check_words(global const uint* in, uint count, uint seed, uint round, global uint* counts) {"
    "  uint i = get_global_id(0);"
    "  if (i >= count) return;"
    "  if (in[i] != word_of(i, seed)) atomic_inc(counts + 2 * round);"
    "  atomic_inc(counts + 2 * round + 1); }";

constexpr const char* write_shader = R"(
layout(local_size_x = 256) in;
layout(location = 0) uniform uint count;
layout(location = 1) uniform uint seed;
layout(std430, binding = 0) writeonly buffer Words { uint words[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < count) words[i] = word_of(i, seed);
}
)";
constexpr const char* check_shader = R"(
layout(local_size_x = 256) in;
layout(location = 0) uniform uint count;
layout(location = 1) uniform uint seed;
layout(location = 2) uniform uint round;
layout(location = 3) uniform uint texels;
layout(binding = 0) uniform usamplerBuffer words_as_texels;
layout(std430, binding = 0) readonly buffer Words { uint words[]; };
layout(std430, binding = 1) buffer Counts { uint counts[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  uint word = word_of(i, seed);
  if (words[i] != word) atomicAdd(counts[2u * round], 1u);
  if (i < texels && texelFetch(words_as_texels, int(i)).r != word) atomicAdd(counts[2u * round], 1u);
  atomicAdd(counts[2u * round + 1u], 1u);
}
)";

GlObject<GlKind::program> compute_program_of(const std::string& text) {
  const std::string source = std::string("#version 450 core\n") + word_of + text;
  const char* sources[] = {source.c_str()};
  const GLuint shader = glCreateShader(GL_COMPUTE_SHADER);
  GlObject<GlKind::program> program(glCreateProgram());
  glShaderSource(shader, 1, sources, nullptr);
  glCompileShader(shader);
  glAttachShader(program.name(), shader);
  glLinkProgram(program.name());
  glDeleteShader(shader);
  GLint linked = 0;
  glGetProgramiv(program.name(), GL_LINK_STATUS, &linked);
  EXPECT_TRUE(linked);
  return program;
}

void dispatch_words(const GlObject<GlKind::program>& program, cl_uint count, cl_uint seed) {
  glUseProgram(program.name());
  glUniform1ui(0, count);
  glUniform1ui(1, seed);
  glDispatchCompute((count + 255) / 256, 1, 1);
}

cl::NDRange whole_groups(cl_uint count) { return cl::NDRange((size_t(count) + 63) / 64 * 64); }

struct BridgeExchange : testing::TestWithParam<BridgeKind> {
  ClDevice cl;
  std::unique_ptr<GlContext> gl = GlContext::create();
  ProgramCache programs{cl, ""};

  void SetUp() override {
    if (GetParam() == BridgeKind::mapped && !may_share_memory(cl.info(), gl->software))
      GTEST_SKIP() << cl.info().name << " and " << gl->renderer << " do not share their memory";
    if (GetParam() != BridgeKind::imported) return;
    if (const std::string why = why_not_imported(cl, *gl); !why.empty())
      GTEST_SKIP() << "no imported memory: " << why;
  }

  void write_in_cl(SharedBuffer& buffer, cl_uint count, cl_uint seed) {
    cl::Kernel kernel = programs.kernel_of_source("write_words", std::string(word_of) + write_kernel, "");
    launch(cl, "write_words", kernel, whole_groups(count), cl::NDRange(64), buffer.cl_buffer(), count, seed);
  }

  void check_in_cl(SharedBuffer& buffer, cl_uint count, cl_uint seed, cl_uint round,
                   const cl::Buffer& counts) {
    cl::Kernel kernel = programs.kernel_of_source("check_words", std::string(word_of) + check_kernel, "");
    launch(cl, "check_words", kernel, whole_groups(count), cl::NDRange(64), buffer.cl_buffer(), count, seed,
           round, counts);
  }
};

// File descriptors of this process; 0 where the system does not list them.
size_t open_files() {
  size_t count = 0;
  if (!std::filesystem::exists("/proc/self/fd")) return 0;
  for ([[maybe_unused]] const auto& file : std::filesystem::directory_iterator("/proc/self/fd")) ++count;
  return count;
}

struct Slot {
  std::optional<SharedBuffer> buffer;
  GlTexture texels;
  cl_uint words = 0;
};

// Writes the words of `seed` into the first pixels of four floats by way of an image. Returns their number.
cl_uint write_through_image(SharedBuffer& buffer, cl_uint words, cl_uint seed, int width, int height,
                            PixelCopies& copies, const GlObject<GlKind::program>& write) {
  const GlTexture image = make_texture_2d(GL_RGBA32F, width, height);
  copies.to_texture(buffer.gl_buffer(), GL_RGBA, GL_FLOAT, {width, height}, image.name());
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer.gl_buffer());
  dispatch_words(write, words, ~seed);  // a word that no texel replaces is then wrong
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
  copies.to_buffer({0, GL_COLOR_ATTACHMENT0, image.name()}, GL_RGBA, GL_FLOAT, {width, height},
                   buffer.gl_buffer());
  return cl_uint(width) * cl_uint(height) * 4;
}

TEST_P(BridgeExchange, BringsEveryWordAndTexelInBothDirections) {
  const bool gpu = GetParam() == BridgeKind::imported;
  const cl_uint rounds = gpu ? 500 : 50;
  const double largest_log2 = gpu ? 23 : 15;  // number of words: 32 MiB
  GLint max_texels = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &max_texels);
  const auto write = compute_program_of(write_shader), check = compute_program_of(check_shader);
  PixelCopies copies(true);
  const std::vector<cl_uint> zeros(2 * rounds);
  const size_t count_bytes = zeros.size() * 4;
  cl::Buffer cl_counts(cl.context(), CL_MEM_READ_WRITE, count_bytes);
  fill_buffer(cl, "counts", cl_counts, 0, count_bytes);
  const GlBuffer gl_counts = make_buffer(count_bytes, zeros.data());
  std::vector<cl_uint> words_to_cl(rounds), words_to_gl(rounds);
  Slot slots[6];  // alive together
  std::mt19937 random(11);
  size_t files = 0;
  for (cl_uint round = 0; round < rounds; ++round) {
    if (round == rounds / 2) files = open_files();
    Slot& slot = slots[random() % std::size(slots)];
    if (!slot.buffer || random() % 2) {
      slot.words = cl_uint(std::exp2(std::uniform_real_distribution<>(0, largest_log2)(random)));
      slot.texels = GlTexture();
      slot.buffer.reset();
      slot.buffer.emplace(cl, GetParam(), size_t(slot.words) * 4);
      slot.texels = make_buffer_texture(GL_R32UI, slot.buffer->gl_buffer());
    }
    SharedBuffer& buffer = *slot.buffer;
    const cl_uint seed = 2 * round;

    // OpenGL writes, by storage or by an image; OpenCL checks.
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer.gl_buffer());
    dispatch_words(write, slot.words, seed);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    words_to_cl[round] = slot.words;
    if (slot.words >= 4 && random() % 2) {
      const int pixels = int(slot.words / 4), width = 1 + int(random() % cl_uint(std::min(pixels, 4096)));
      words_to_cl[round] =
          write_through_image(buffer, slot.words, seed, width, std::min(pixels / width, 8192), copies, write);
    }
    buffer.hand_to_cl(buffer.size());
    check_in_cl(buffer, words_to_cl[round], seed, round, cl_counts);

    // OpenCL writes; OpenGL checks, as storage and as texels.
    words_to_gl[round] = slot.words;
    write_in_cl(buffer, slot.words, seed + 1);
    buffer.hand_to_gl(buffer.size());
    glBindTextureUnit(0, slot.texels.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer.gl_buffer());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, gl_counts.name());
    glUseProgram(check.name());
    glUniform1ui(2, round);
    glUniform1ui(3, GLuint(max_texels));
    dispatch_words(check, slot.words, seed + 1);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);  // the next round may write this buffer: GPUs overlap dispatches
                                           // without a barrier
  }
  std::vector<cl_uint> in_cl(zeros.size()), in_gl(zeros.size());
  read_buffer(cl, "counts", cl_counts, in_cl.data(), count_bytes);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glGetNamedBufferSubData(gl_counts.name(), 0, GLsizeiptr(count_bytes), in_gl.data());
  size_t wrong = 0, exchanged = 0;
  for (cl_uint round = 0; round < rounds; ++round) {
    ASSERT_EQ(in_cl[2 * round + 1], words_to_cl[round]) << "checked in OpenCL, round " << round;
    ASSERT_EQ(in_gl[2 * round + 1], words_to_gl[round]) << "checked in OpenGL, round " << round;
    if (in_cl[2 * round] + in_gl[2 * round] > 0 && ++wrong <= 5) {
      ADD_FAILURE() << "round " << round << ": of " << words_to_cl[round] << " words " << in_cl[2 * round]
                    << " wrong in OpenCL, of " << words_to_gl[round] << " " << in_gl[2 * round]
                    << " in OpenGL";
    }
    exchanged += words_to_cl[round] + words_to_gl[round];
  }
  EXPECT_EQ(wrong, 0u) << "rounds of " << rounds;
  if (gpu) {
    EXPECT_LE(open_files(), files + 20) << "descriptors stay open";
    std::printf("%u rounds, %zu words, %zu open files\n", rounds, exchanged, open_files());
  }
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

const auto name_of_kind = [](const auto& info) { return std::string(to_string(info.param)); };
INSTANTIATE_TEST_SUITE_P(Here, BridgeExchange, testing::Values(BridgeKind::mapped, BridgeKind::staged),
                         name_of_kind);
INSTANTIATE_TEST_SUITE_P(Gpu, BridgeExchange, testing::Values(BridgeKind::imported), name_of_kind);

}  // namespace
}  // namespace lightgrid
