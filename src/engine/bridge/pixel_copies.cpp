#include "bridge/pixel_copies.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "base/error.h"
#include "gl/bindings.h"

namespace lightgrid {
namespace {

// A variant of shaders/pixels_to_buffer.comp.
struct CopiedPixel {
  GLenum format, type;
  const char* define;
  size_t bytes;
};
constexpr CopiedPixel copied_pixels[] = {
    {GL_DEPTH_COMPONENT, GL_FLOAT, "FLOAT_1", 4},       {GL_RGBA, GL_FLOAT, "FLOAT_4", 16},
    {GL_RGBA, GL_UNSIGNED_BYTE, "UNORM8_4", 4},         {GL_RG, GL_UNSIGNED_SHORT, "UNORM16_2", 4},
    {GL_RGBA, GL_UNSIGNED_SHORT, "UNORM16_4", 8},       {GL_RED_INTEGER, GL_UNSIGNED_BYTE, "UINT8_1", 1},
    {GL_RED_INTEGER, GL_UNSIGNED_SHORT, "UINT16_1", 2},
};

// A variant of shaders/buffer_to_image.comp. The image is bound as integers of the same channels and bits, so
// that a copy keeps each bit, that of a NaN too.
struct WrittenPixel {
  GLenum format, type;
  const char *bits, *channels, *image;
  GLenum image_format;
  size_t bytes;
};
constexpr WrittenPixel written_pixels[] = {
    {GL_RGBA, GL_FLOAT, "BITS 32", "CHANNELS 4", "FORMAT rgba32ui", GL_RGBA32UI, 16},
    {GL_RG, GL_FLOAT, "BITS 32", "CHANNELS 2", "FORMAT rg32ui", GL_RG32UI, 8},
    {GL_RGBA, GL_HALF_FLOAT, "BITS 16", "CHANNELS 4", "FORMAT rgba16ui", GL_RGBA16UI, 8},
    {GL_RG, GL_HALF_FLOAT, "BITS 16", "CHANNELS 2", "FORMAT rg16ui", GL_RG16UI, 4},
    {GL_RGBA, GL_UNSIGNED_BYTE, "BITS 8", "CHANNELS 4", "FORMAT rgba8ui", GL_RGBA8UI, 4},
    {GL_RG, GL_UNSIGNED_BYTE, "BITS 8", "CHANNELS 2", "FORMAT rg8ui", GL_RG8UI, 2},
};

// Null also for more pixels than a shader may read or write in a buffer.
template <typename Pixel>
const Pixel* pixel_of(std::span<const Pixel> pixels, GLenum format, GLenum type, size_t count) {
  for (const Pixel& pixel : pixels) {
    if (pixel.format != format || pixel.type != type) continue;
    GLint64 largest = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &largest);
    return count * pixel.bytes <= size_t(largest) ? &pixel : nullptr;
  }
  return nullptr;
}

void dispatch_pixels(const GlProgram& program, const PixelGrid& grid, int depth = 1) {
  constexpr int group_width = 32, group_height = 8;  // size of the shaders' groups
  glUseProgram(program.name());
  glDispatchCompute(GLuint(grid.width + group_width - 1) / group_width,
                    GLuint(grid.height + group_height - 1) / group_height, GLuint(depth));
  glUseProgram(0);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, only_storage_block, 0);
}

}  // namespace

const GlProgram& PixelCopies::program(const std::string& file, const std::vector<std::string>& defines) {
  std::vector<std::string> key = defines;
  key.push_back(file);
  const auto found = programs_.find(key);
  if (found != programs_.end()) return found->second;
  return programs_.try_emplace(std::move(key), file, defines).first->second;
}

void PixelCopies::to_buffer(const Source& source, GLenum format, GLenum type, const PixelGrid& grid,
                            GLuint buffer) {
  const size_t count = grid.values();
  const bool several = grid.samples > 1;  // which only shaders read
  const auto* pixel =
      by_shader_ || several ? pixel_of<CopiedPixel>(copied_pixels, format, type, count) : nullptr;
  if (several && !pixel) throw machine_error("OpenGL's shaders write no {} samples to a buffer", count);
  if (pixel) {
    std::vector<std::string> defines = {pixel->define};
    if (several) defines.push_back(fmt::format("SAMPLES {}", grid.samples));
    bind_sampler_object(Sampler::image, 0);
    bind_texture(Sampler::image, source.texture);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, only_storage_block, buffer);
    dispatch_pixels(program("shaders/pixels_to_buffer.comp", defines), grid);
    bind_texture(Sampler::image, 0);
    return;
  }
  glBindFramebuffer(GL_READ_FRAMEBUFFER, source.framebuffer);
  if (source.attachment != GL_DEPTH_ATTACHMENT) glReadBuffer(source.attachment);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);  // rows of an odd number of pixels of one byte or two
  glReadPixels(0, 0, grid.width, grid.height, format, type, nullptr);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
}

void PixelCopies::to_texture(GLuint buffer, GLenum format, GLenum type, const PixelGrid& grid, GLuint texture,
                             int depth) {
  const size_t count = grid.values() * size_t(std::max(depth, 1));
  const auto* pixel = by_shader_ ? pixel_of<WrittenPixel>(written_pixels, format, type, count) : nullptr;
  if (pixel) {
    std::vector<std::string> defines = {pixel->bits, pixel->channels, pixel->image};
    if (depth > 0) defines.emplace_back("VOLUME");
    const GlProgram& copy = program("shaders/buffer_to_image.comp", defines);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, only_storage_block, buffer);
    glBindImageTexture(only_image, texture, 0, depth > 0, 0, GL_WRITE_ONLY, pixel->image_format);
    dispatch_pixels(copy, grid, std::max(depth, 1));
    glBindImageTexture(only_image, 0, 0, GL_FALSE, 0, GL_WRITE_ONLY, pixel->image_format);
    glMemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                    GL_TEXTURE_UPDATE_BARRIER_BIT);
    return;
  }
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);  // rows of an odd number of pixels of two bytes
  if (depth > 0)
    glTextureSubImage3D(texture, 0, 0, 0, 0, grid.width, grid.height, depth, format, type, nullptr);
  else
    glTextureSubImage2D(texture, 0, 0, 0, grid.width, grid.height, format, type, nullptr);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
}

}  // namespace lightgrid
