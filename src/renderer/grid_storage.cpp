#include "renderer/grid_storage.h"

#include "base/error.h"

namespace lightgrid {
namespace {

void check_texture_size(size_t bytes, GLenum format) {
  GLint texels = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &texels);
  const size_t texel_bytes = format == GL_RG32UI ? 8 : format == GL_R32UI ? 4 : 2;
  if (bytes / texel_bytes <= size_t(texels)) return;
  throw machine_error(
      "light grid: {} bytes are more than the {} texels that a buffer texture may have in this OpenGL; use "
      "larger tiles, fewer slices or fewer lights",
      bytes, texels);
}

cl::Buffer& grown(Renderer& renderer, SharedTexture& shared, size_t bytes, GLenum format) {
  if (!shared.buffer || shared.buffer->size() < bytes) {
    if (renderer.gl) check_texture_size(bytes, format);
    shared.texture = GlTexture();
    shared.buffer.reset();  // freed first, so that both need not fit at once
    shared.buffer.emplace(*renderer.cl, renderer.bridge, bytes);
    if (renderer.gl) shared.texture = make_buffer_texture(format, shared.buffer->gl_buffer());
  }
  return shared.buffer->cl_buffer();
}

}  // namespace

cl::Buffer& SharedGridStorage::cells(size_t bytes) { return grown(renderer_, cells_, bytes, GL_RG32UI); }

cl::Buffer& SharedGridStorage::indices(size_t bytes) {
  return grown(renderer_, indices_, bytes, index_bits_ == 16 ? GL_R16UI : GL_R32UI);
}

cl::Buffer& SharedGridStorage::masks(size_t bytes) { return grown(renderer_, masks_, bytes, GL_R32UI); }

cl::Buffer& SharedGridStorage::z_bins(size_t bytes) { return grown(renderer_, z_bins_, bytes, GL_R32UI); }

size_t SharedGridStorage::allocated_bytes() const {
  size_t bytes = 0;
  for (const SharedTexture* shared : {&cells_, &indices_, &masks_, &z_bins_})
    bytes += shared->buffer ? shared->buffer->size() : 0;
  return bytes;
}

}  // namespace lightgrid
