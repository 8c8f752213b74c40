#include "renderer/targets.h"

namespace lightgrid {
namespace {

// The bits that OpenGL allocated, which may be more than the format has.
size_t bits_of_pixel(GLuint texture) {
  size_t sum = 0;
  for (GLenum part : {GL_TEXTURE_RED_SIZE, GL_TEXTURE_GREEN_SIZE, GL_TEXTURE_BLUE_SIZE, GL_TEXTURE_ALPHA_SIZE,
                      GL_TEXTURE_DEPTH_SIZE, GL_TEXTURE_STENCIL_SIZE}) {
    GLint bits = 0;
    glGetTextureLevelParameteriv(texture, 0, part, &bits);
    sum += size_t(bits);
  }
  return sum;
}

}  // namespace

const TargetPool::Image& TargetPool::image(const std::string& name, GLenum format, const PixelGrid& grid) {
  const Key key{name, format, grid};
  const auto found = images_.find(key);
  if (found != images_.end()) return found->second;
  GlTexture texture = grid.samples == 1
                          ? make_texture_2d(format, grid.width, grid.height)
                          : make_texture_of_samples(format, grid.width, grid.height, grid.samples);
  const size_t bytes = grid.values() * bits_of_pixel(texture.name()) / 8;
  return images_.try_emplace(key, Image{std::move(texture), bytes}).first->second;
}

GLuint TargetPool::framebuffer(const std::vector<GLuint>& colors, GLuint depth) {
  std::vector<GLuint> key = colors;
  key.push_back(depth);
  const auto found = framebuffers_.find(key);
  if (found != framebuffers_.end()) return found->second.name();
  return framebuffers_.try_emplace(key, make_framebuffer(colors, depth)).first->second.name();
}

SharedBuffer& TargetPool::buffer(ClDevice& cl, BridgeKind bridge, const std::string& name, size_t bytes) {
  return buffers_.try_emplace({name, bytes}, cl, bridge, bytes).first->second;
}

void TargetPool::clear() {
  framebuffers_.clear();
  images_.clear();
  buffers_.clear();
}

GLuint Targets::texture(const std::string& name, GLenum format, TargetUse use) {
  return texture(name, format, use, grid_);
}

GLuint Targets::resolved(const std::string& name, GLenum format, TargetUse use) {
  return texture(name, format, use, {grid_.width, grid_.height});
}

GLuint Targets::in_a_row(const std::string& name, GLenum format, TargetUse use) {
  return texture(name, format, use, {grid_.width * grid_.samples, grid_.height});
}

GLuint Targets::texture(const std::string& name, GLenum format, TargetUse use, const PixelGrid& grid) {
  const auto found = targets_.find(name);
  if (found != targets_.end()) return found->second.texture;
  const TargetPool::Image& image = pool_->image(name, format, grid);
  return targets_.try_emplace(name, Target{image.texture.name(), use, image.bytes}).first->second.texture;
}

GLuint Targets::depth() { return texture("depth", depth_format()); }

SharedBuffer& Targets::buffer(ClDevice& cl, BridgeKind bridge, const std::string& name, size_t bytes,
                              TargetUse use) {
  SharedBuffer& buffer = pool_->buffer(cl, bridge, name, bytes);
  buffers_[name] = {use, bytes};
  return buffer;
}

void Targets::clear() {
  targets_.clear();
  buffers_.clear();
  pool_->clear();
}

size_t Targets::bytes() const {
  size_t sum = 0;
  for (const auto& [name, target] : targets_) sum += target.bytes;
  for (const auto& [name, buffer] : buffers_) sum += buffer.bytes;
  return sum;
}

size_t Targets::bytes(TargetUse use) const {
  size_t sum = 0;
  for (const auto& [name, target] : targets_) sum += target.use == use ? target.bytes : 0;
  for (const auto& [name, buffer] : buffers_) sum += buffer.use == use ? buffer.bytes : 0;
  return sum;
}

}  // namespace lightgrid
