#include "bridge/pixel_copies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>
#include <tuple>

#include "gl/context.h"
#include "gl/objects.h"

namespace lightgrid {
namespace {

struct Pixels {
  const char* name;
  GLenum internal, format, type;
  size_t bytes;
};

constexpr Pixels read_pixels[] = {
    {"depth", GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, 4},
    {"depth beside stencil", GL_DEPTH32F_STENCIL8, GL_DEPTH_COMPONENT, GL_FLOAT, 4},
    {"4 floats", GL_RGBA32F, GL_RGBA, GL_FLOAT, 16},
    {"4 x 8 bits", GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4},
    {"2 x 16 bits", GL_RG16, GL_RG, GL_UNSIGNED_SHORT, 4},
    {"4 x 16 bits", GL_RGBA16, GL_RGBA, GL_UNSIGNED_SHORT, 8},
    {"a number of 8 bits", GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE, 1},
    {"a number of 16 bits", GL_R16UI, GL_RED_INTEGER, GL_UNSIGNED_SHORT, 2},
    {"4 halves, which no shader copies", GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT, 8},
};

using Bytes = std::vector<unsigned char>;
constexpr size_t spare = 32;

// Floats from 0 to 1 with random low bits, halves likewise; all values of integers.
Bytes random_pixels(const Pixels& pixels, size_t count) {
  std::mt19937 random(7);
  Bytes bytes(count * pixels.bytes);
  if (pixels.type == GL_FLOAT) {
    for (size_t i = 0; i < bytes.size(); i += 4) {
      const float value = float(random()) * 0x1p-32f;
      std::memcpy(&bytes[i], &value, 4);
    }
  } else {
    for (unsigned char& byte : bytes) byte = static_cast<unsigned char>(random());
  }
  if (pixels.type == GL_HALF_FLOAT)
    for (size_t i = 1; i < bytes.size(); i += 2) bytes[i] &= 0x3b;  // exponents up to 14
  return bytes;
}

Bytes contents(GLuint buffer, size_t bytes) {
  Bytes read(bytes);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glGetNamedBufferSubData(buffer, 0, GLsizeiptr(bytes), read.data());
  return read;
}

struct PixelCopiesOfContext : testing::Test {
  std::unique_ptr<GlContext> gl = GlContext::create();
};

// The uploaded pixels are the reference for both ways.
TEST_F(PixelCopiesOfContext, WriteTheBytesOfTheImageByShaderAndByDriver) {
  PixelCopies by_shader(true), by_driver(false);
  for (const Pixels& pixels : read_pixels) {
    for (const auto& [width, height] : {std::pair(1, 1), {17, 9}, {67, 33}}) {
      const size_t count = size_t(width) * size_t(height);
      Bytes expected = random_pixels(pixels, count);
      const bool depth = pixels.format == GL_DEPTH_COMPONENT;
      const GlTexture texture = make_texture_2d(pixels.internal, width, height);
      glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
      glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
      glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
      glTextureSubImage2D(texture.name(), 0, 0, 0, width, height, pixels.format, pixels.type,
                          expected.data());
      glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
      const GlFramebuffer framebuffer =
          depth ? make_framebuffer({}, texture.name()) : make_framebuffer({texture.name()}, 0);
      const PixelCopies::Source source{
          framebuffer.name(), GLenum(depth ? GL_DEPTH_ATTACHMENT : GL_COLOR_ATTACHMENT0), texture.name()};
      const size_t used = expected.size(), words = (used + 3) / 4 * 4;
      expected.resize(words + spare, 0xab);  // bytes that no copy may touch
      for (PixelCopies* copies : {&by_shader, &by_driver}) {
        const Bytes before(expected.size(), 0xab);
        const GlBuffer buffer = make_buffer(before.size(), before.data());
        copies->to_buffer(source, pixels.format, pixels.type, {width, height}, buffer.name());
        Bytes copied = contents(buffer.name(), before.size());
        std::copy_n(expected.begin() + long(used), words - used, copied.begin() + long(used));
        EXPECT_EQ(copied, expected) << pixels.name << ", " << width << "x" << height
                                    << (copies == &by_shader ? " by shader" : " by driver");
      }
    }
  }
  EXPECT_EQ(by_shader.programs(), 7) << "kinds of pixels that a shader copies";
  EXPECT_EQ(by_driver.programs(), 0);
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

constexpr Pixels written_pixels[] = {
    {"4 floats", GL_RGBA32F, GL_RGBA, GL_FLOAT, 16},
    {"2 floats", GL_RG32F, GL_RG, GL_FLOAT, 8},
    {"4 halves", GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT, 8},
    {"2 halves", GL_RG16F, GL_RG, GL_HALF_FLOAT, 4},
    {"4 x 8 bits", GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4},
    {"2 x 8 bits", GL_RG8, GL_RG, GL_UNSIGNED_BYTE, 2},
};

GlTexture make_volume(GLenum format, int width, int height, int depth) {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_3D, 1, &name);
  GlTexture texture(name);
  glTextureStorage3D(name, 1, format, width, height, depth);
  return texture;
}

// Fills images and volumes, in whole words, as copies require.
TEST_F(PixelCopiesOfContext, FillATextureByShaderAndByDriver) {
  PixelCopies by_shader(true), by_driver(false);
  for (const Pixels& pixels : written_pixels) {
    for (const auto& [width, height, depth] :
         {std::tuple(1, 1, 0), {67, 33, 0}, {17, 1, 1}, {35, 9, 5}, {64, 64, 16}}) {
      const size_t bytes = size_t(width) * size_t(height) * size_t(std::max(depth, 1)) * pixels.bytes;
      const Bytes expected = random_pixels(pixels, bytes / pixels.bytes);
      Bytes words = expected;
      words.resize((bytes + 3) / 4 * 4, 0xab);
      const GlBuffer buffer = make_buffer(words.size(), words.data());
      for (PixelCopies* copies : {&by_shader, &by_driver}) {
        const GlTexture texture = depth > 0 ? make_volume(pixels.internal, width, height, depth)
                                            : make_texture_2d(pixels.internal, width, height);
        copies->to_texture(buffer.name(), pixels.format, pixels.type, {width, height}, texture.name(), depth);
        Bytes read(bytes);
        glPixelStorei(GL_PACK_ALIGNMENT, 1);
        glGetTextureImage(texture.name(), 0, pixels.format, pixels.type, GLsizei(bytes), read.data());
        glPixelStorei(GL_PACK_ALIGNMENT, 4);
        EXPECT_EQ(read, expected) << pixels.name << ", " << width << "x" << height << "x" << depth
                                  << (copies == &by_shader ? " by shader" : " by driver");
      }
    }
  }
  EXPECT_EQ(by_shader.programs(), 12) << "kinds of pixels, of images and of volumes";
  EXPECT_EQ(by_driver.programs(), 0);
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

// Values that arithmetic would change: NaNs, and numbers below the smallest normal one.
TEST_F(PixelCopiesOfContext, KeepEachBitByShader) {
  PixelCopies by_shader(true);
  const uint32_t floats[] = {0x7f800001u, 0xffc12345u, 0x00000001u, 0x80000000u};
  const uint32_t halves[] = {0x7c01fe34u, 0x00018000u};
  const auto written = [&](const Pixels& pixels, const auto& values) {
    const GlBuffer buffer = make_buffer(sizeof values, values);
    const GlTexture texture = make_texture_2d(pixels.internal, 1, 1);
    by_shader.to_texture(buffer.name(), pixels.format, pixels.type, {1, 1}, texture.name());
    std::vector<uint32_t> read(std::size(values));
    glGetTextureImage(texture.name(), 0, pixels.format, pixels.type, GLsizei(sizeof values), read.data());
    EXPECT_EQ(read, std::vector<uint32_t>(std::begin(values), std::end(values))) << pixels.name;
  };
  written(written_pixels[0], floats);
  written(written_pixels[2], halves);
}

}  // namespace
}  // namespace lightgrid
