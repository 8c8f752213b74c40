#include "renderer/grid_storage.h"

#include "base/error.h"

namespace lightgrid {

size_t most_texture_bytes(GLenum format) {
  GLint texels = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &texels);
  return size_t(texels) * (format == GL_RG32UI ? 8 : format == GL_R32UI ? 4 : 2);
}

cl::Buffer& SharedTexture::at_least(Renderer& renderer, size_t bytes, GLenum format, bool for_gl) {
  if (this->bytes() < bytes || !buffer) {
    texture = GlTexture();
    buffer.reset();  // freed first, so that both need not fit at once
    buffer.emplace(*renderer.cl, for_gl ? renderer.bridge : BridgeKind::none, bytes);
    if (for_gl) texture = make_buffer_texture(format, buffer->gl_buffer());
  }
  return buffer->cl_buffer();
}

cl::Buffer& SharedGridStorage::grown(SharedTexture& shared, size_t bytes, GLenum format) {
  const bool for_gl = bool(renderer_.gl);
  if (for_gl && shared.bytes() < bytes && bytes > most_texture_bytes(format)) {
    throw machine_error(
        "light grid: {} bytes are more than the {} that a buffer texture may have in this OpenGL; use "
        "larger tiles, fewer slices or fewer lights",
        bytes, most_texture_bytes(format));
  }
  return shared.at_least(renderer_, bytes, format, for_gl);
}

cl::Buffer& SharedGridStorage::cells(size_t bytes) { return grown(cells_, bytes, GL_RG32UI); }

cl::Buffer& SharedGridStorage::indices(size_t bytes) {
  return grown(indices_, bytes, index_bits_ == 16 ? GL_R16UI : GL_R32UI);
}

cl::Buffer& SharedGridStorage::masks(size_t bytes) { return grown(masks_, bytes, GL_R32UI); }

cl::Buffer& SharedGridStorage::z_bins(size_t bytes) { return grown(z_bins_, bytes, GL_R32UI); }

size_t SharedGridStorage::allocated_bytes() const {
  size_t bytes = 0;
  for (const SharedTexture* shared : {&cells_, &indices_, &masks_, &z_bins_}) bytes += shared->bytes();
  return bytes;
}

}  // namespace lightgrid
