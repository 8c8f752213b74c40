#include "bridge/pixel_copies.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

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
    for (size_t i = 1; i < bytes.size(); i += 2) bytes[i] &= 0x3b;  // of exponents up to 14
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

// What was uploaded is the reference for both ways.
TEST_F(PixelCopiesOfContext, WriteTheBytesOfTheImageByShaderAndByDriver) {
  PixelCopies by_shader(true), by_driver(false);
  for (const Pixels& pixels : read_pixels) {
    for (const auto& [width, height] : {std::pair(1, 1), {17, 9}, {67, 33}}) {
      const size_t count = size_t(width) * size_t(height);
      Bytes expected = random_pixels(pixels, count);
      const bool depth = pixels.format == GL_DEPTH_COMPONENT;
      const GlTexture texture = make_texture_2d(pixels.internal, width, height);
      glTextureSubImage2D(texture.name(), 0, 0, 0, width, height, pixels.format, pixels.type,
                          expected.data());
      const GlFramebuffer framebuffer =
          depth ? make_framebuffer({}, texture.name()) : make_framebuffer({texture.name()}, 0);
      const PixelCopies::Source source{
          framebuffer.name(), GLenum(depth ? GL_DEPTH_ATTACHMENT : GL_COLOR_ATTACHMENT0), texture.name()};
      expected.resize(expected.size() + spare, 0xab);  // what no copy may touch
      for (PixelCopies* copies : {&by_shader, &by_driver}) {
        const Bytes before(expected.size(), 0xab);
        const GlBuffer buffer = make_buffer(before.size(), before.data());
        copies->to_buffer(source, pixels.format, pixels.type, width, height, buffer.name());
        EXPECT_EQ(contents(buffer.name(), before.size()), expected)
            << pixels.name << ", " << width << "x" << height
            << (copies == &by_shader ? " by shader" : " by driver");
      }
    }
  }
  EXPECT_EQ(by_shader.programs(), 5) << "kinds of pixels that a shader copies";
  EXPECT_EQ(by_driver.programs(), 0);
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

TEST_F(PixelCopiesOfContext, FillATextureByShaderAndByDriver) {
  const Pixels floats = read_pixels[2];
  PixelCopies by_shader(true), by_driver(false);
  for (const auto& [width, height] : {std::pair(1, 1), {67, 33}}) {
    const Bytes expected = random_pixels(floats, size_t(width) * size_t(height));
    const GlBuffer buffer = make_buffer(expected.size(), expected.data());
    for (PixelCopies* copies : {&by_shader, &by_driver}) {
      const GlTexture texture = make_texture_2d(floats.internal, width, height);
      copies->to_texture(buffer.name(), floats.format, floats.type, width, height, texture.name());
      Bytes read(expected.size());
      glGetTextureImage(texture.name(), 0, floats.format, floats.type, GLsizei(read.size()), read.data());
      EXPECT_EQ(read, expected) << width << "x" << height
                                << (copies == &by_shader ? " by shader" : " by driver");
    }
  }
  EXPECT_EQ(by_shader.programs(), 1);
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

}  // namespace
}  // namespace lightgrid
