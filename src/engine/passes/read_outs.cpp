#include "passes/read_outs.h"

#include <cmath>

#include "passes/common/gbuffer.h"
#include "passes/depth_prepass.h"
#include "renderer/drawing/draw.h"
#include "renderer/upload/culler_input.h"
#include "scene/grid_lists.h"
#include "shared/light_grid.h"

namespace lightgrid {

namespace {

// Returns whether a pixel's samples and its centre see one plane. A depth is linear on the screen.
bool sees_plane(float centre, const float* samples, std::span<const glm::ivec2> places) {
  double xx = 0, xy = 0, yy = 0, xd = 0, yd = 0, most = centre;
  for (size_t s = 0; s < places.size(); ++s) {
    const double x = places[s].x, y = places[s].y, d = double(samples[s]) - centre;
    xx += x * x;
    xy += x * y;
    yy += y * y;
    xd += x * d;
    yd += y * d;
    most = std::max(most, double(samples[s]));
  }
  // The gradient of least squares; of two samples the one along their line.
  const double determinant = xx * yy - xy * xy;
  const double gx = determinant > 0 ? (xd * yy - yd * xy) / determinant : xd / (xx + yy),
               gy = determinant > 0 ? (yd * xx - xd * xy) / determinant : yd / (xx + yy);
  constexpr double rounding = 0x1p-20;
  for (size_t s = 0; s < places.size(); ++s) {
    if (samples[s] == 0 ||
        std::abs(centre + gx * places[s].x + gy * places[s].y - samples[s]) > rounding * most)
      return false;
  }
  return centre != 0;
}

std::vector<float> read_depth_of_samples(PassContext& work) {
  SharedBuffer& copy = work.shared_samples("depth", 4);
  work.renderer.pixel_copies.to_buffer({work.depth_framebuffer(), GL_DEPTH_ATTACHMENT, work.targets.depth()},
                                       GL_DEPTH_COMPONENT, GL_FLOAT, work.grid(), copy.gl_buffer());
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  std::vector<float> samples(work.grid().values()), depth(work.grid().pixels());
  glGetNamedBufferSubData(copy.gl_buffer(), 0, GLsizeiptr(samples.size() * 4), samples.data());
  const GlTexture centres = depth_of_centres(work);
  const GlFramebuffer of_centres = make_framebuffer({}, centres.name());
  glBindFramebuffer(GL_READ_FRAMEBUFFER, of_centres.name());
  glReadPixels(0, 0, work.grid().width, work.grid().height, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
  const std::vector<glm::ivec2> places = work.sample_places();
  for (size_t i = 0; i < depth.size(); ++i)
    if (!sees_plane(depth[i], &samples[i * places.size()], places)) depth[i] = 0;
  return depth;
}

}  // namespace

std::vector<float> read_depth(PassContext& work) {
  if (work.grid().samples > 1) return read_depth_of_samples(work);
  std::vector<float> depth(work.grid().values());
  glBindFramebuffer(GL_READ_FRAMEBUFFER, work.depth_framebuffer());
  glReadPixels(0, 0, work.grid().width, work.grid().height, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
  return depth;
}

std::vector<uint32_t> indices_drawn(PassContext& work, const std::function<void()>& draw) {
  const int width = work.grid().width, height = work.grid().height;
  const GlTexture target = make_texture_2d(GL_R32UI, width, height);
  const GlTexture of_centres = depth_of_centres(work);
  const GlFramebuffer framebuffer =
      make_framebuffer({target.name()}, of_centres ? of_centres.name() : work.targets.depth());
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
  glViewport(0, 0, width, height);
  glClearNamedFramebufferuiv(framebuffer.name(), GL_COLOR, 0, &no_cell);
  glDepthMask(GL_FALSE);
  glDisable(GL_BLEND);
  work.bind_lights();
  draw();
  std::vector<uint32_t> cells(work.grid().pixels());
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  glReadPixels(0, 0, width, height, GL_RED_INTEGER, GL_UNSIGNED_INT, cells.data());
  return cells;
}

namespace {

std::vector<std::string> slice_defines(const ViewState& seen) {
  return seen.plan.lists.slices > 1 ? std::vector<std::string>{"SLICES"} : std::vector<std::string>{};
}

}  // namespace

std::vector<uint32_t> shaded_cells(PassContext& work) {
  return indices_drawn(work, [&] {
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_EQUAL);
    const auto no_features = [](uint32_t) { return 0u; };
    draw_list(
        work, work.opaque, DrawStreams::all,
        work.programs({"shaders/scene.vert", "shaders/cells.frag", slice_defines(work), false, no_features}));
  });
}

std::vector<uint32_t> cells_at_depths(PassContext& work, const std::vector<float>& depths) {
  const GlTexture texture = make_texture_2d(GL_R32F, work.grid().width, work.grid().height);
  glTextureSubImage2D(texture.name(), 0, 0, 0, work.grid().width, work.grid().height, GL_RED, GL_FLOAT,
                      depths.data());
  std::vector<std::string> defines = slice_defines(work);
  defines.emplace_back("GIVEN_DEPTH");
  return indices_drawn(work, [&] {
    glDisable(GL_DEPTH_TEST);
    bind_texture(Sampler::given_depth, texture.name());
    draw_screen(work.program("shaders/screen.vert", "shaders/cells.frag", defines));
  });
}

PixelCells::PixelCells(CullView view, const std::vector<float>& depth, uint tile, uint across, uint down)
    : view_(std::move(view)),
      depth_(depth),
      tile_(tile),
      across_(across),
      down_(down),
      slices_(slice_keys(view_)),
      z_bins_(z_bin_keys(view_)) {}

float PixelCells::key(int x, int y) const {
  return depth_key(view_, depth_[size_t(y) * size_t(view_.width) + size_t(x)]);
}

int PixelCells::slice(int x, int y) const { return int(slice_of_key(key(x, y), slices_.data())); }

uint32_t PixelCells::z_bin(int x, int y) const { return z_bin_of_key(key(x, y), z_bins_.data()); }

uint32_t PixelCells::cell(int x, int y, int slice) const {
  return cell_in_slice(cell_of_pixel(uint(x), uint(y), tile_, across_), uint(slice), across_, down_);
}

PixelCells cells_of_pixels(const ViewState& seen, const std::vector<float>& depth) {
  return {cull_view(seen.view, seen.plan), depth, seen.params.tile_size, seen.params.tiles_x,
          seen.params.tiles_y};
}

ListedLights at_pixels(ListedLights lists, const PixelCells& cells, std::span<const uint32_t> z_bins) {
  std::vector<uint32_t> bins;
  for (int y = 0; y < cells.height(); ++y) {
    for (int x = 0; x < cells.width(); ++x) {
      lists.cell_of_pixel.push_back(cells.cell(x, y));
      if (!z_bins.empty()) bins.push_back(cells.z_bin(x, y));
    }
  }
  return z_bins.empty() ? lists : in_z_bins(lists, bins, z_bins);
}

namespace {

Image read_image(int attachment, int width, int height) {
  Image image(width, height);
  glReadBuffer(GL_COLOR_ATTACHMENT0 + attachment);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, image.pixels.data());
  return image;
}

// The images that some surfaces need.
struct MoreImages {
  bool coats, models, specular;
};

// Images over the frame's depth, cleared and bound: three, two of coats, one of models, one of reflectance.
struct SurfaceTargets {
  SurfaceTargets(PassContext& work, MoreImages more) : width(work.view.width), height(work.view.height) {
    std::vector<GLuint> names;
    for (int i = 0; i < 3 + 2 * more.coats + more.models + more.specular; ++i) {
      textures.push_back(make_texture_2d(GL_RGBA32F, width, height));
      names.push_back(textures.back().name());
    }
    centres = depth_of_centres(work);
    framebuffer = make_framebuffer(names, centres ? centres.name() : work.targets.depth());
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glViewport(0, 0, width, height);
    for (size_t i = 0; i < textures.size(); ++i) clear(int(i));
    glDepthMask(GL_FALSE);
    glDisable(GL_BLEND);
  }
  void clear(int i) {
    const float nothing[4] = {0, 0, 0, 0};
    glClearNamedFramebufferfv(framebuffer.name(), GL_COLOR, i, nothing);
  }
  Image read(size_t i) { return read_image(int(i), width, height); }
  // The target is freed: nothing is drawn into it afterwards.
  Image take(size_t i) {
    Image image = read(i);
    textures[i] = GlTexture();
    return image;
  }

  int width, height;
  std::vector<GlTexture> textures;
  GlTexture centres;
  GlFramebuffer framebuffer;
};

// read: the image of a number, in the order of SurfaceTargets.
template <typename Read>
SurfaceImages surface_images_of(MoreImages more, const Read& read) {
  SurfaceImages s{.normal_roughness = read(0), .base_color_metallic = read(1), .emissive_occlusion = read(2)};
  size_t next = 3;
  if (more.coats) {
    s.coat_normal_roughness = read(next);
    s.coat_factor = read(next + 1);
    next += 2;
  }
  if (more.models) s.model = read(next++);
  if (more.specular) s.specular = read(next);
  return s;
}

}  // namespace

SurfaceImages read_surfaces(PassContext& work) {
  const MoreImages more{.coats = (work.plan.surfaces.features & feature_clearcoat) != 0,
                        .models = (work.plan.surfaces.features & (feature_skin | feature_minnaert)) != 0,
                        .specular = (work.plan.surfaces.features & feature_specular) != 0};
  SurfaceTargets targets(work, more);
  glEnable(GL_DEPTH_TEST);
  std::vector<std::string> defines;
  if (more.coats) defines.emplace_back("COATS");
  if (more.models) defines.emplace_back("MODELS");
  if (more.specular) defines.emplace_back("SPECULAR_IMAGE");
  ScenePrograms& programs = work.programs({"shaders/scene.vert", "shaders/surfaces.frag", defines});
  glDepthFunc(GL_EQUAL);
  draw_list(work, work.opaque, DrawStreams::all, programs);
  const auto read = [&](size_t i) {
    return work.plan.surfaces.blended.empty() ? targets.take(i) : targets.read(i);
  };
  SurfaceImages surfaces = surface_images_of(more, read);
  surfaces.models = material_models(work.scene);
  // A pixel belongs to a blended surface if it differs from the cleared target.
  surfaces.blended.assign(surfaces.normal_roughness.pixels.size(), false);
  if (!work.plan.surfaces.blended.empty()) {
    targets.clear(0);
    glDepthFunc(GL_GEQUAL);
    draw_list(work, work.blended, DrawStreams::all, programs);
    const Image normals = targets.read(0);
    for (size_t i = 0; i < normals.pixels.size(); ++i)
      surfaces.blended[i] = glm::vec3(normals.pixels[i]) != glm::vec3(0);
  }
  return surfaces;
}

SurfaceImages read_gbuffer_surfaces(PassContext& work) {
  const MoreImages more{.coats = work.plan.surfaces.clearcoat,
                        .models = work.plan.surfaces.skin || work.plan.surfaces.minnaert,
                        .specular = work.plan.surfaces.specular};
  SurfaceTargets targets(work, more);
  const GBuffer gbuffer = gbuffer_of(work);
  work.bind_lights();
  bind_gbuffer(gbuffer);
  glDisable(GL_DEPTH_TEST);
  draw_screen(work.program("shaders/screen.vert", "shaders/gbuffer_surfaces.frag", gbuffer_defines(gbuffer)));
  SurfaceImages surfaces = surface_images_of(more, [&](size_t i) { return targets.read(i); });
  surfaces.models = material_models(work.scene);
  return surfaces;
}

namespace {

// Two numbers a pixel over the frame's depth: the instance, and the triangle's place in the scene's indices.
class TriangleTarget {
 public:
  explicit TriangleTarget(PassContext& work)
      : work_(work),
        texture_(make_texture_2d(GL_RG32UI, work.grid().width, work.grid().height)),
        centres_(depth_of_centres(work)),
        framebuffer_(make_framebuffer({texture_.name()}, centres_ ? centres_.name() : work.targets.depth())) {
  }

  std::vector<glm::uvec2> drawn(const DrawList& list, GLenum depth_test) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glViewport(0, 0, work_.grid().width, work_.grid().height);
    const GLuint nothing[4] = {none, none, none, none};
    glClearNamedFramebufferuiv(framebuffer_.name(), GL_COLOR, 0, nothing);
    glDepthMask(GL_FALSE);
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(depth_test);
    draw_triangles(work_, list, {}, [](int instance) { return uint32_t(instance); });
    std::vector<glm::uvec2> found(work_.grid().pixels());
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glReadPixels(0, 0, work_.view.width, work_.view.height, GL_RG_INTEGER, GL_UNSIGNED_INT, found.data());
    return found;
  }

  static constexpr GLuint none = 0xffffffffu;

 private:
  PassContext& work_;
  GlTexture texture_, centres_;
  GlFramebuffer framebuffer_;
};

}  // namespace

ShownTriangles read_triangles(PassContext& work) {
  TriangleTarget target(work);
  const std::vector<uint32_t> indices = work.gpu.in_gl().read_indices();
  ShownTriangles shown;
  for (const glm::uvec2& found : target.drawn(work.opaque, GL_EQUAL)) {
    const bool none = found.x == TriangleTarget::none;
    shown.opaque.push_back(none ? SceneTriangle{}
                                : scene_triangle(int(found.x), &indices[3 * size_t(found.y)]));
  }
  shown.blended.assign(work.grid().pixels(), false);
  if (work.blended.empty()) return shown;
  const std::vector<glm::uvec2> over = target.drawn(work.blended, GL_GEQUAL);
  for (size_t i = 0; i < over.size(); ++i) shown.blended[i] = over[i].x != TriangleTarget::none;
  return shown;
}

}  // namespace lightgrid
