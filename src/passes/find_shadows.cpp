// Lists of lights in tiles, by the culler, of those lights alone whose shadows the plan calls for; then a ray
// for each pixel and listed light that may shade it, or with shadows=map a look at the light's shadow map.
// docs/shadows.md has the contract.
#include "passes/find_shadows.h"

#include <fmt/format.h>
#include <numeric>

#include "base/error.h"
#include "cl/transfer.h"
#include "passes/shadows/certificates.h"
#include "passes/shadows/view_shadow_maps.h"
#include "renderer/drawing/draw.h"
#include "renderer/upload/culler_input.h"
#include "renderer/upload/lights.h"
#include "shared/shadow_bits.h"
#include "shared/shadow_certificates.h"
#include "shared/shadow_records.h"

namespace lightgrid {
namespace {

// Work-groups of one tile on a GPU, which share its lights: lists are of very different lengths.
constexpr size_t groups_a_tile = 4;

constexpr size_t least_bytes = 64;  // of a buffer

size_t entry_words(const FramePlan& plan) {
  return plan.shadow_bytes ? SHADOW_WORDS_OF_BYTES : SHADOW_WORDS_OF_BITS;
}

// Local and directional.
size_t lights_of(const FramePlan& plan) { return plan.local.size() + plan.directional_lights.size(); }

size_t tile_words(const FramePlan& plan) { return (lights_of(plan) + 31) / 32; }

size_t tiles_across(int pixels) { return (size_t(pixels) + SHADOW_TILE - 1) / SHADOW_TILE; }

CullerOptions options_of_shadows(const FramePlan& plan) {
  CullerOptions options = culler_options(plan);
  options.cull_test = default_cull_test, options.depth_bounds = DepthBoundsMode::minmax;
  options.tile = SHADOW_TILE, options.blend = false, options.index_bits = 0, options.lists = GridLists::lists;
  return options;
}

// In the order of FramePlan::shadowed, as shining: directional ones everywhere.
std::vector<CullLight> all_lights_of(const Seen& seen) {
  std::vector<CullLight> lights = cull_lights_of(seen.scene, seen.plan.local, seen.plan.settings.ranges);
  for (const int i : seen.plan.directional_lights)
    lights.push_back({.direction = glm::dvec3(seen.scene.lights[size_t(i)].direction)});
  return lights;
}

// Those without shadows are listed nowhere, directional ones in every tile that shows a surface.
std::vector<CullLight> shadowed_lights(const Seen& seen, std::vector<CullLight> lights) {
  for (size_t i = 0; i < lights.size(); ++i) {
    if (!seen.plan.shadowed[i]) lights[i].radius_m = -1;
  }
  return lights;
}

// Positions in view space are floats; they are turned to world axes and rounded again. Shading computes with
// other roundings of them. Points in range are no further from the eye and from the origin than the light and
// its range, and all of these errors together are below 2^-19 of that.
ShadowLight shadow_light(const CullLight& light, const View& view, const glm::dvec3& origin) {
  const glm::dvec3 at = light.position - origin;
  ShadowLight s{at.x, at.y, at.z, 1, float(light.direction.x), float(light.direction.y),
                float(light.direction.z), float(light.cos_outer), 0, 0, float(light.radius_m)};
  if (light.cos_outer < -1) s.cos_outer = -1;
  const double slack = 0x1p-19 * (glm::length(at) + glm::length(light.position - view.eye) + 2 * light.radius_m);
  const double reach = light.radius_m * (1 + 1e-5) + slack;
  s.reach_squared = float(std::min(reach * reach, double(std::numeric_limits<float>::infinity())));
  s.slack = float(std::min(slack, double(std::numeric_limits<float>::max())));
  return s;
}

ShadowLight shadow_light(const Light& directional) {
  const glm::dvec3 to_light = -glm::normalize(glm::dvec3(directional.direction));
  constexpr float everywhere = std::numeric_limits<float>::infinity();
  return {to_light.x, to_light.y, to_light.z, 0, 0, 0, 0, -1, everywhere, 0, {}};
}

ShadowView shadow_view(const Seen& seen, const glm::dvec3& origin) {
  const View& view = seen.view;
  const glm::dmat3 world_from_view = glm::transpose(glm::dmat3(view.view_from_world));
  const glm::dvec3 from = view.eye - origin, eye = view.orthographic ? world_from_view[2] : from;
  ShadowView v{eye.x, eye.y, eye.z, view.orthographic ? 0.0 : 1.0, {}, float(from.x), float(from.y),
               float(from.z), 0, 0, {}};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      v.world_from_view[3 * row + column] = float(world_from_view[column][row]);
  }
  v.words = uint(tile_words(seen.plan));
  const double piece = PIECE_PIXELS * 2 / (view.clip_from_view[1][1] * view.height);
  v.piece_scale = float(piece * piece);
  return v;
}

// Set where more than half of a light is hidden.
std::vector<uint32_t> bits_of_bytes(const std::vector<uint8_t>& shares) {
  std::vector<uint32_t> bits(shares.size() / 32);
  for (size_t i = 0; i < shares.size(); ++i) {
    if (shares[i] > 127) bits[i / 32] |= 1u << (i % 32);
  }
  return bits;
}

}  // namespace

class ShadowBits : public PassCache {
 public:
  explicit ShadowBits(Work& work) : kernels_(work, "shadows"), storage_(*work.renderer.cl) {}

  bool follow(Work&) override { return followed_ = false, true; }

  size_t memory_bytes() const override {
    size_t bytes = lights_.bytes() + view_.bytes() + offsets_.bytes() + rays_.bytes() + grid_.cell_bytes +
                   grid_.index_bytes;
    if (scene_) bytes += scene_->memory_bytes();
    if (certificates_) bytes += certificates_->memory_bytes();
    if (culler_) bytes += culler_->memory_bytes();
    if (maps_) bytes += maps_->memory_bytes();
    return bytes;
  }

  // No light is hidden anywhere.
  void clear(Work& work) {
    ClDevice& device = *work.renderer.cl;
    const size_t bytes = tile_bytes(work);
    if (cleared_ == bytes) return;
    fill_buffer(device, "clearing shadows", at_least(work, work.shadows.tiles, bytes, GL_RG32UI), 0, bytes);
    at_least(work, work.shadows.bits, least_bytes, GL_R32UI);
    grid_ = {}, cleared_ = bytes;
    hand_over(work, bytes, least_bytes);
  }

  void find(Work& work, const VisibilityBuffer* visible, const DepthBuffer& depth, const cl::Buffer& numbers) {
    ClDevice& device = *work.renderer.cl;
    cleared_ = 0;
    prepare(work, visible);
    const DepthBounds bounds = culler_->depth_bounds({depth.values});
    grid_ = culler_->cull(bounds.opaque, storage_);
    const size_t tiles = size_t(grid_.cells_x) * size_t(grid_.cells_y), bytes = tile_bytes(work);
    const size_t bit_bytes =
        std::max<size_t>(least_bytes, grid_.index_count * entry_words(work.plan) * sizeof(uint32_t));
    const cl::Buffer& listed = at_least(work, work.shadows.tiles, bytes, GL_RG32UI);
    const cl::Buffer& bits = at_least(work, work.shadows.bits, bit_bytes, GL_R32UI);
    // Drawn lights serve all lights of a tile.
    const size_t groups_here = kernels_.lanes || work.plan.settings.picks_shadows() ? 1 : groups_a_tile;
    parts_ = tiles * groups_here;
    const cl::Buffer& rays = rays_.at_least(device, parts_ * sizeof(uint32_t));
    if (maps_) maps_->draw(*scene_);
    const cl::NDRange lanes(size_t(grid_.cells_x), size_t(grid_.cells_y));
    const cl::NDRange groups(tiles * SHADOW_TILE * SHADOW_TILE, groups_here);
    kernels_.of("find_shadows")
        .launch(device, "find_shadows", kernels_.lanes ? lanes : groups,
                kernels_.lanes ? cl::NDRange(1, 1) : cl::NDRange(SHADOW_TILE * SHADOW_TILE, 1),
                (maps_ ? maps_->arguments() : ClArguments()) + scene_->arguments() +
                    ClArguments{{"triangles", numbers},
                                {"triangle_instance", visible ? visible->raster.triangle_instance : cl::Buffer()},
                                {"number_offsets", visible ? offsets_.buffer() : cl::Buffer()},
                                {"depths", depth.values},
                                {"cells", storage_.cells(grid_.cell_bytes)},
                                {"indices", storage_.indices(grid_.index_bytes)},
                                {"lights", lights_.buffer()},
                                {"shadow_view", view_.buffer()},
                                {"view", work.cl_lights().view.buffer()},
                                {"tiles", listed},
                                {"bits", bits},
                                {"rays", rays}} +
                    (certificates_ ? certificates_->arguments(device, parts_, grid_.index_count)
                                   : ClArguments{}));
    hand_over(work, bytes, bit_bytes);
  }

  const RayScene& scene(Work& work) {
    scene_ = work.gpu.in_rays(work.plan.settings.texels);
    return *scene_;
  }

  HostShadows read(Work& work) {
    ClDevice& device = *work.renderer.cl;
    HostShadows shadows;
    shadows.tiles_x = int(tiles_across(work.grid().width));
    if (grid_.index_count == 0) {
      shadows.cells.resize(size_t(shadows.tiles_x) * tiles_across(work.grid().height));
      return shadows;
    }
    HostGrid grid = read_grid(device, grid_, storage_);
    shadows.cells = std::move(grid.cells), shadows.indices = std::move(grid.indices);
    const auto read = [&](auto& values) {
      values.resize(shadows.indices.size() * entry_words(work.plan) * sizeof(uint32_t) / sizeof values[0]);
      read_buffer(device, "reading shadows", work.shadows.bits.buffer->cl_buffer(), values.data(),
                  values.size() * sizeof values[0]);
    };
    if (work.plan.shadow_bytes)
      read(shadows.shares), shadows.bits = bits_of_bytes(shadows.shares);
    else
      read(shadows.bits);
    return shadows;
  }

  ShadowFigures figures(Work& work) {
    ShadowFigures f;
    f.bytes = grid_.cell_bytes + grid_.index_bytes + work.shadows.bytes();
    if (grid_.index_count == 0) return f;
    f.lights = size_t(std::ranges::count(work.plan.shadowed, 1));
    std::vector<uint32_t> rays(parts_);
    read_buffer(*work.renderer.cl, "counting rays", rays_.get(), rays.data(), rays.size() * sizeof rays[0]);
    if (maps_) {
      f.maps = f.drawn = f.lights, f.halvings = maps_->atlas().halvings;
      f.bytes += maps_->atlas().bytes;
    }
    f.rays = std::accumulate(rays.begin(), rays.end(), size_t(0));
    if (certificates_) {
      f.kept = certificates_->decided(*work.renderer.cl);
      f.bytes += certificates_->memory_bytes();
    }
    return f;
  }

 private:
  size_t tile_bytes(const Seen& seen) const {
    return std::max<size_t>(least_bytes, tiles_across(seen.grid().width) * tiles_across(seen.grid().height) *
                                    tile_words(seen.plan) * sizeof(cl_uint2));
  }

  cl::Buffer& at_least(Work& work, SharedTexture& shared, size_t bytes, GLenum format) {
    if (work.plan.opengl && bytes > most_texture_bytes(format)) {
      throw machine_error(
          "shadows: {} bytes are more than the {} that a buffer texture may have in this OpenGL; let fewer "
          "lights cast, or use raster=opencl",
          bytes, most_texture_bytes(format));
    }
    return shared.at_least(work.renderer, bytes, format, work.plan.opengl);
  }

  void hand_over(Work& work, size_t tile_bytes, size_t bit_bytes) {
    if (!work.plan.opengl) return;
    const SharedBuffer::Written written[] = {{&*work.shadows.tiles.buffer, tile_bytes},
                                             {&*work.shadows.bits.buffer, bit_bytes}};
    SharedBuffer::hand_to_gl(written);
  }

  // Brings everything up to the view, its lights and surfaces.
  void prepare(Work& work, const VisibilityBuffer* visible) {
    const RayScene& rays = scene(work);
    std::string defines = rays.defines();
    for (const char* define : shadow_defines(work.plan)) defines += fmt::format(" -D{}", define);
    const Settings& settings = work.plan.settings;
    if (settings.soft_shadows()) defines += fmt::format(" -DSHADOW_RAYS={}", settings.shadow_rays);
    if (settings.picks_shadows()) defines += fmt::format(" -DSHADOW_PICK={}", settings.shadow_pick);
    if (!visible) defines += " -DNUMBERED";
    if (lights_of(work.plan) > 65536) defines += " -DINDEX_32";
    if (work.view.orthographic) defines += " -DORTHOGRAPHIC";
    if (kernels_.lanes && work.plan.settings.portable) defines += " -DPORTABLE";
    if (settings.shadows == ShadowMethod::map) {
      if (!maps_) maps_.emplace(work);
      if (!followed_) maps_->look(work, rays.origin());
      defines += maps_->defines();
    }
    const bool keeps = kernels_.lanes && settings.shadows == ShadowMethod::exact && !settings.soft_shadows() &&
                       !settings.picks_shadows();
    const size_t kept_bytes = keeps ? ShadowCertificates::bytes_of(settings) : 0;
    if (kept_bytes != 0) defines += " -DKEPT";
    kernels_.use(defines);
    if (followed_) return;
    ClDevice& device = *work.renderer.cl;
    if (!culler_) culler_.emplace(device, *work.renderer.kernels, options_of_shadows(work.plan));
    const std::vector<CullLight> all_lights = all_lights_of(work);
    const std::vector<CullLight> lights = shadowed_lights(work, all_lights);
    if (lights != lights_in_culler_) culler_->set_lights(lights), lights_in_culler_ = lights;
    culler_->set_view(cull_view(work.view));
    std::vector<int32_t> offsets;
    if (visible) {
      uint32_t first = 0;
      for (const int i : visible->instances) {
        offsets.push_back(int32_t(rays.first_triangle(size_t(i)) - first));
        first += uint32_t(work.scene.meshes[size_t(work.scene.instances[size_t(i)].mesh)].indices.size() / 3);
      }
      offsets_.put(device, "uploading numbers of triangles", offsets);
    }
    std::vector<ShadowLight> records;
    for (size_t i = 0; i < work.plan.local.size(); ++i) {
      ShadowLight& record = records.emplace_back(shadow_light(lights[i], work.view, rays.origin()));
      const Light& light = work.scene.lights[size_t(work.plan.local[i])];
      if (settings.soft_shadows()) record.source_m = float(settings.shadow_source_m);
      record.luminance = light.intensity * glm::dot(light.color, glm::vec3(0.2126f, 0.7152f, 0.0722f));
    }
    for (const int i : work.plan.directional_lights)
      records.push_back(shadow_light(work.scene.lights[size_t(i)]));
    ShadowView seen_from = shadow_view(work, rays.origin());
    if (kept_bytes != 0) {
      if (!certificates_) certificates_.emplace(device, kept_bytes);
      certificates_->follow(work, rays, all_lights, {seen_from, work.params, offsets, defines});
      for (size_t i = 0; i < records.size(); ++i) records[i].stamp = certificates_->stamp(i);
      seen_from.stamp = certificates_->sight_stamp();
    }
    lights_.put(device, "uploading lights of shadows", records);
    view_.put(device, "uploading the view of shadows", std::vector<ShadowView>{seen_from});
    followed_ = true;
  }

  PassKernels kernels_;
  std::shared_ptr<RayScene> scene_;
  std::optional<LightCuller> culler_;
  std::vector<CullLight> lights_in_culler_;
  std::optional<ViewShadowMaps> maps_;
  std::optional<ShadowCertificates> certificates_;
  ClGridStorage storage_;
  UploadedBuffer lights_, view_, offsets_;
  GrowingBuffer rays_;
  LightGrid grid_;
  size_t parts_ = 0;    // counts of rays
  size_t cleared_ = 0;  // bytes of tiles in which nothing was found since they were cleared
  bool followed_ = false;
};

namespace {

// By OpenGL, at the depth image: the rays' numbers of the triangles that pixels show.
const cl::Buffer& draw_triangle_numbers(Work& work, const RayScene& rays) {
  auto pass = work.timer.pass("triangle_numbers", "gl");
  const GLuint numbers = work.targets.texture("triangle numbers", GL_R32UI),
               framebuffer = work.targets.framebuffer({numbers}, work.targets.depth());
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, work.grid().width, work.grid().height);
  const GLuint nothing[4] = {0xffffffffu, 0, 0, 0};
  glClearNamedFramebufferuiv(framebuffer, GL_COLOR, 0, nothing);
  glDepthMask(GL_FALSE);
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_EQUAL);
  bind_texture(Sampler::triangle_numbers, work.gpu.in_gl().triangle_numbers());
  draw_triangles(work, work.opaque, {"RAY_NUMBERS"},
                 [&](int instance) { return rays.first_triangle(size_t(instance)); });
  SharedBuffer& copy = work.shared_pixels("triangle numbers", 4);
  const size_t bytes = work.grid().values() * 4;
  work.renderer.pixel_copies.to_buffer({framebuffer, GL_COLOR_ATTACHMENT0, numbers}, GL_RED_INTEGER,
                                       GL_UNSIGNED_INT, work.grid(), copy.gl_buffer());
  copy.hand_to_cl(bytes);
  pass.moves(work.gpu.in_gl().geometry_bytes() + bytes, 2 * bytes);
  return copy.cl_buffer();
}

}  // namespace

void find_shadows(Work& work, Cached<ShadowBits>& cache, const VisibilityBuffer* visible,
                  const DepthBuffer& depth) {
  if (!work.plan.light_reaches) return;
  ShadowBits& shadows = cache.of(work);
  if (!work.plan.shadows) return shadows.clear(work);
  const cl::Buffer& numbers =
      visible ? visible->image.triangle : draw_triangle_numbers(work, shadows.scene(work));
  auto pass = work.timer.pass("find_shadows", "cl");
  shadows.find(work, visible, depth, numbers);
  pass.moves(work.grid().values() * 8 + shadows.scene(work).memory_bytes(), work.shadows.bytes());
}

void tell_shadows(Work& work, Cached<ShadowBits>& cache, Frame& frame) {
  if (!work.plan.light_reaches) return;
  ShadowBits& shadows = cache.of(work);
  if (!frame.lights_in_volume) frame.shadows = [&] { return shadows.read(work); };
  frame.shadow_figures = [&] { return shadows.figures(work); };
}

}  // namespace lightgrid
