#include "renderer/shared_grids.h"

#include "base/error.h"

namespace lightgrid {

size_t max_texture_bytes(GLenum format) {
  GLint texels = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &texels);
  return size_t(texels) * (format == GL_RG32UI ? 8 : format == GL_R32UI || format == GL_R32F ? 4 : 2);
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
  if (for_gl && shared.bytes() < bytes && bytes > max_texture_bytes(format)) {
    throw machine_error(
        "light grid: {} bytes are more than the {} that a buffer texture may have in this OpenGL; use "
        "larger tiles, fewer slices or fewer lights",
        bytes, max_texture_bytes(format));
  }
  return shared.at_least(renderer_, bytes, format, for_gl);
}

cl::Buffer& SharedGridStorage::cells(size_t bytes) { return grown(cells_, bytes, GL_RG32UI); }

cl::Buffer& SharedGridStorage::indices(size_t bytes) {
  return grown(indices_, bytes, index_bits_ == 16 ? GL_R16UI : GL_R32UI);
}

cl::Buffer& SharedGridStorage::masks(size_t bytes) { return grown(masks_, bytes, GL_R32UI); }

cl::Buffer& SharedGridStorage::z_bins(size_t bytes) { return grown(z_bins_, bytes, GL_R32UI); }

cl::Buffer& SharedGridStorage::factors(size_t bytes) { return grown(factors_, bytes, GL_R32F); }

size_t SharedGridStorage::allocated_bytes() const {
  size_t bytes = 0;
  for (const SharedTexture* shared : {&cells_, &indices_, &masks_, &z_bins_, &factors_})
    bytes += shared->bytes();
  return bytes;
}

class SharedWorldGridStorage : public WorldGridStorage {
 public:
  SharedWorldGridStorage(Renderer& renderer, int index_bits, bool for_gl)
      : WorldGridStorage(*renderer.cl), renderer_(renderer), index_bits_(index_bits), for_gl_(for_gl) {}

  cl::Buffer& at_least(WorldArray array, size_t bytes) override {
    if (const size_t most = max_bytes(array); bytes > most) {
      throw machine_error(
          "world grid: {} bytes are more than the {} that a buffer texture may have in this OpenGL; use "
          "larger cells (world-cell), smaller ranges or fewer lights",
          bytes, most);
    }
    return shared(array).at_least(renderer_, std::max<size_t>(bytes, 64), format_of(array), for_gl_);
  }
  cl::Buffer& buffer(WorldArray array) override { return shared(array).buffer->cl_buffer(); }
  size_t bytes(WorldArray array) const override { return arrays_[size_t(array)].bytes(); }
  size_t max_bytes(WorldArray array) const override {
    return for_gl_ ? max_texture_bytes(format_of(array)) : WorldGridStorage::max_bytes(array);
  }
  void swap_lists() override {
    std::swap(shared(WorldArray::cells), shared(WorldArray::old_cells));
    std::swap(shared(WorldArray::indices), shared(WorldArray::old_indices));
  }

  SharedTexture& shared(WorldArray array) { return arrays_[size_t(array)]; }

 private:
  GLenum format_of(WorldArray array) const {
    if (array == WorldArray::buckets) return GL_R32UI;
    const bool index = array == WorldArray::indices || array == WorldArray::old_indices;
    return !index ? GL_RG32UI : index_bits_ == 16 ? GL_R16UI : GL_R32UI;
  }

  Renderer& renderer_;
  const int index_bits_;
  const bool for_gl_;
  std::array<SharedTexture, 6> arrays_;
};

WorldEye world_eye(const View& view) {
  WorldEye eye{.position = view.eye};
  const glm::dmat4& clip = view.clip_from_view;
  const int column = view.orthographic ? 3 : 2;  // the column that moves the image's middle
  const double width = (1 + std::abs(clip[column][0])) / std::abs(clip[0][0]);
  const double height = (1 + std::abs(clip[column][1])) / std::abs(clip[1][1]);
  if (view.orthographic) {
    eye.seen_m = width + height + std::abs(view.near_m) + std::abs(view.far_m);
  } else {
    eye.spread = std::max(1.0, (width + height) / 4);
  }
  return eye;
}

WorldViewParams world_view_params(const WorldLayout& layout, const View& view) {
  return world_view_params(layout, view.eye, glm::transpose(glm::dmat3(view.view_from_world)));
}

SharedWorldGrid::SharedWorldGrid(Renderer& renderer, WorldGridShape shape, std::optional<double> cell,
                                 int index_bits, bool for_gl)
    : SharedWorldGrid(renderer, new SharedWorldGridStorage(renderer, index_bits, for_gl && renderer.gl),
                      shape, cell, index_bits) {}

SharedWorldGrid::SharedWorldGrid(Renderer& renderer, SharedWorldGridStorage* storage, WorldGridShape shape,
                                 std::optional<double> cell, int index_bits)
    : WorldGrid(*renderer.cl, *renderer.kernels, std::unique_ptr<WorldGridStorage>(storage), shape, cell,
                index_bits),
      shared_(storage) {}

void SharedWorldGrid::hand_to_gl() {
  if (in_gl_ == builds() + updates()) return;
  for (size_t i = 0; i < sizes().size(); ++i) {
    if (sizes()[i] > 0) shared_->shared(WorldArray(i)).buffer->hand_to_gl(sizes()[i]);
  }
  block_ = make_buffer(sizeof layout().params, &layout().params);
  in_gl_ = builds() + updates();
}

GLuint SharedWorldGrid::texture(WorldArray array) const { return shared_->shared(array).texture.name(); }

}  // namespace lightgrid
