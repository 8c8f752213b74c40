#include "bridge/pixel_copies.h"

#include <vector>

namespace lightgrid {
namespace {

// Of shaders/pixels_to_buffer.comp; null: no shader copies these pixels.
struct CopiedPixel {
  GLenum format, type;
  const char* define;
  size_t bytes;
};
constexpr CopiedPixel copied_pixels[] = {
    {GL_DEPTH_COMPONENT, GL_FLOAT, "FLOAT_1", 4}, {GL_RGBA, GL_FLOAT, "FLOAT_4", 16},
    {GL_RGBA, GL_UNSIGNED_BYTE, "UNORM8_4", 4},   {GL_RG, GL_UNSIGNED_SHORT, "UNORM16_2", 4},
    {GL_RGBA, GL_UNSIGNED_SHORT, "UNORM16_4", 8},
};

// Null also for an image larger than what a shader may write.
const CopiedPixel* copied_pixel(GLenum format, GLenum type, int width, int height) {
  for (const CopiedPixel& pixel : copied_pixels) {
    if (pixel.format != format || pixel.type != type) continue;
    GLint64 largest = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &largest);
    return size_t(width) * size_t(height) * pixel.bytes <= size_t(largest) ? &pixel : nullptr;
  }
  return nullptr;
}

void dispatch_pixels(const GlProgram& program, int width, int height) {
  constexpr int group_width = 32, group_height = 8;  // of the shaders
  glUseProgram(program.name());
  glDispatchCompute(GLuint(width + group_width - 1) / group_width,
                    GLuint(height + group_height - 1) / group_height, 1);
  glUseProgram(0);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, 0);
}

}  // namespace

const GlProgram& PixelCopies::program(const std::string& file, const char* define) {
  const std::string key = file + " " + define;
  const auto found = programs_.find(key);
  if (found != programs_.end()) return found->second;
  return programs_.try_emplace(key, file, std::vector<std::string>{define}).first->second;
}

void PixelCopies::to_buffer(const Source& source, GLenum format, GLenum type, int width, int height,
                            GLuint buffer) {
  if (const CopiedPixel* pixel = by_shader_ ? copied_pixel(format, type, width, height) : nullptr) {
    glBindSampler(0, 0);
    glBindTextureUnit(0, source.texture);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer);
    dispatch_pixels(program("shaders/pixels_to_buffer.comp", pixel->define), width, height);
    glBindTextureUnit(0, 0);
    return;
  }
  glBindFramebuffer(GL_READ_FRAMEBUFFER, source.framebuffer);
  if (source.attachment != GL_DEPTH_ATTACHMENT) glReadBuffer(source.attachment);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
  glReadPixels(0, 0, width, height, format, type, nullptr);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
}

void PixelCopies::to_texture(GLuint buffer, GLenum format, GLenum type, int width, int height,
                             GLuint texture) {
  if (by_shader_ && format == GL_RGBA && type == GL_FLOAT && copied_pixel(format, type, width, height)) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer);
    glBindImageTexture(0, texture, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA32F);
    dispatch_pixels(program("shaders/buffer_to_image.comp", "FLOAT_4"), width, height);
    glBindImageTexture(0, 0, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA32F);
    glMemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                    GL_TEXTURE_UPDATE_BARRIER_BIT);
    return;
  }
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer);
  glTextureSubImage2D(texture, 0, 0, 0, width, height, format, type, nullptr);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
}

}  // namespace lightgrid
