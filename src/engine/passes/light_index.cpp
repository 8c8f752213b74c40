// Draws light volumes into images of light indices, from which shading reads its lights
// (docs/techniques/lidr.md).
#include "passes/light_index.h"

#include <numeric>

#include "passes/depth_prepass.h"
#include "passes/light_index/blending.h"
#include "passes/light_index/draw_order.h"
#include "passes/light_index/index_shadows.h"
#include "passes/light_index/lidr_settings.h"
#include "plan/settings/shadows.h"
#include "renderer/drawing/draw.h"

namespace lightgrid {

namespace {

const Setting<bool> unpack_in_float{
    330,
    "lidr-unpack",
    "light indices are unpacked with integers, or in float as the article does",
    {{"integer", false}, {"float", true}}};

// Returns whether each sample has its own indices and is shaded separately: the article's technique 1 with
// samples. In technique 2 a pixel has one list, of the lights in front of its farthest sample.
bool has_samples(const ViewState& seen) {
  return seen.grid().samples > 1 && seen.plan.settings[setting::lidr_volumes] == LidrVolumes::stencil;
}

struct IndexImages {
  std::vector<GLuint> textures;
  GLuint framebuffer = 0;
  GLuint own_depth = 0;  // 0: the frame's
};

IndexImages index_images(PassContext& work, const LightIndexLayout& layout) {
  IndexImages images;
  for (uint32_t i = 0; i < layout.targets(); ++i) {
    const std::string name = "light_index_" + std::to_string(i);
    images.textures.push_back(has_samples(work)
                                  ? work.targets.texture(name, layout.format(), TargetUse::light_index)
                                  : work.targets.resolved(name, layout.format(), TargetUse::light_index));
  }
  if (work.grid().samples > 1 && !has_samples(work))
    images.own_depth =
        work.targets.resolved("farthest_depth", work.targets.depth_format(), TargetUse::light_index);
  images.framebuffer =
      work.targets.framebuffer(images.textures, images.own_depth ? images.own_depth : work.targets.depth());
  return images;
}

void draw_farthest_depth(PassContext& work, GLuint depth) {
  glBindFramebuffer(GL_FRAMEBUFFER, work.targets.framebuffer({}, depth));
  glViewport(0, 0, work.grid().width, work.grid().height);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_ALWAYS);
  glDepthMask(GL_TRUE);
  bind_sampler_object(Sampler::depth_image, 0);
  bind_texture(Sampler::depth_image, work.targets.depth());
  draw_screen(work.program("shaders/screen.vert", "shaders/farthest_depth.frag", {}));
}

void clear(const LightIndexLayout& layout, GLuint framebuffer, GLint stencil) {
  const float none[4] = {};
  for (uint32_t i = 0; i < layout.targets(); ++i)
    glClearNamedFramebufferfv(framebuffer, GL_COLOR, GLint(i), none);
  glStencilMask(255);
  glClearNamedFramebufferiv(framebuffer, GL_STENCIL, 0, &stencil);
}

// Returns whether lights are not written where they are hidden.
bool drops_hidden(const ViewState& seen) {
  return seen.plan.shadows.own && seen.plan.settings[setting::lidr_shadows] != LidrShadows::final_pass;
}

// Where the stencil marks what is inside, hidden pixels get no mark. Discarding them later would leave one.
IndexDrawing::Programs programs_of(PassContext& work, const LightIndexLayout& layout,
                                   const GlLightLoop* shadows) {
  const auto program = [&](const std::vector<std::string>& more) {
    std::vector<std::string> defines = layout.defines();
    defines.insert(defines.end(), more.begin(), more.end());
    return work.program("shaders/light_index.vert", "shaders/light_index.frag", std::move(defines)).name();
  };
  if (!shadows) return {program({}), program({})};
  // A share is found once more where it is written.
  const bool marked = work.plan.settings[setting::lidr_volumes] == LidrVolumes::stencil && !layout.share_bits;
  return {program(shadows->defines), program(marked ? std::vector<std::string>() : shadows->defines)};
}

// Draws the lights of one pass over the surfaces.
void draw_volumes(PassContext& work, const LightIndexOrder& state, const LightVolumes& volumes,
                  GLuint framebuffer, const IndexShadows* shadows, uint32_t pass) {
  const LightIndexLayout& layout = state.layout();
  std::optional<GlLightLoop> input;
  if (shadows) input = shadows->input(work);
  const IndexDrawing drawing(work, layout, volumes, programs_of(work, layout, input ? &*input : nullptr));
  if (input) input->bind(work);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, work.grid().width, work.grid().height);
  clear(layout, framebuffer, drawing.cleared_stencil());
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glEnable(GL_STENCIL_TEST);
  begin_light_indices(layout);
  for (const VolumeBatch& batch : state.batches().batches) {
    if (batch.pass != pass) continue;
    if (shadows) {
      shadows->draw_casters(work, std::span(state.batches().volumes).subspan(batch.first, batch.count));
      glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    }
    volumes.begin();
    drawing.draw(batch);
  }
  volumes.end();
  end_light_indices();
  glStencilMask(255);
  glDisable(GL_STENCIL_TEST);
  glCullFace(GL_BACK);
}

bool may_repeat(const ViewState& seen) {
  return seen.plan.settings[setting::lidr_volumes] != LidrVolumes::stencil;
}

// shadows: of lights that are listed where they are hidden too.
GlLightLoop index_loop(PassContext& seen, const LightIndexLayout& layout, const std::vector<GLuint>& images,
                       const IndexShadows* shadows, bool points_alone) {
  GlLightLoop loop = light_loop(seen);
  if (shadows) {
    const GlLightLoop input = shadows->input(seen);
    loop.defines.insert(loop.defines.end(), input.defines.begin(), input.defines.end());
    loop.textures = input.textures;
    loop.blocks = input.blocks;
  }
  for (std::string& define : layout.defines()) loop.defines.push_back(std::move(define));
  loop.defines.emplace_back("LIGHTS_LIDR");
  if (points_alone) loop.defines.emplace_back("NO_CONES");
  if (seen.plan.settings[unpack_in_float]) loop.defines.emplace_back("LIDR_FLOAT");
  if (may_repeat(seen)) loop.defines.emplace_back("LIDR_REPEATS");
  if (has_samples(seen)) loop.defines.emplace_back("PER_SAMPLE");
  for (size_t i = 0; i < images.size(); ++i)
    loop.textures.push_back({Sampler::light_index_images, images[i], i});
  return loop;
}

// For read-outs of a frame with samples: images of one sample, drawn at pixels' centres.
struct CentreImages {
  CentreImages(PassContext& work, const LightIndexLayout& layout) : depth(depth_of_centres(work)) {
    std::vector<GLuint> names;
    for (uint32_t i = 0; i < layout.targets(); ++i) {
      images.push_back(make_texture_2d(layout.format(), work.grid().width, work.grid().height));
      names.push_back(images.back().name());
    }
    framebuffer = make_framebuffer(names, depth.name());
  }
  GlTexture depth;
  std::vector<GlTexture> images;
  GlFramebuffer framebuffer;
};

// redraw: draws the images of a pass into a framebuffer.
ListedLights read_light_index(PassContext& work, const LightIndexOrder& state,
                              const std::function<void(uint32_t pass, GLuint framebuffer)>& redraw) {
  const LightIndexLayout& layout = state.layout();
  const size_t stride = layout.targets() * 4, pixels = work.grid().pixels();
  const uint32_t passes = uint32_t(state.batches().passes.size());
  std::vector<std::vector<uint16_t>> of_pass;
  std::optional<CentreImages> centres;
  if (has_samples(work)) centres.emplace(work, layout);
  const GLuint framebuffer = centres ? centres->framebuffer.name() : index_images(work, layout).framebuffer;
  for (uint32_t pass = 0; pass < passes; ++pass) {
    if (passes > 1 || centres) redraw(pass, framebuffer);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    of_pass.push_back(read_channels(layout, work.grid()));
  }
  ListedLights lists;
  lists.cell_of_pixel.resize(pixels);
  std::iota(lists.cell_of_pixel.begin(), lists.cell_of_pixel.end(), 0u);
  std::vector<uint32_t> lights;
  for (size_t pixel = 0; pixel < pixels; ++pixel) {
    lists.first.push_back(lists.indices.size());
    for (const std::vector<uint16_t>& channels : of_pass) {
      unpack_light_index(layout, {&channels[pixel * stride], stride}, may_repeat(work), lights);
      lists.indices.insert(lists.indices.end(), lights.begin(), lights.end());
    }
    lists.count.push_back(uint32_t(lists.indices.size() - lists.first.back()));
  }
  return lists;
}

}  // namespace

uint32_t order_light_index(PassContext& work, Cached<LightIndexOrder>& cache,
                           Cached<LightVolumes>& volume_cache) {
  auto pass = work.timer.pass("light_volumes", "gl");
  LightIndexOrder& state = cache.of(work);
  LightVolumes& volumes = volume_cache.of(work);
  state.order(work, volumes.update(work));
  volumes.upload_volumes(state.batches().volumes);
  return uint32_t(state.batches().passes.size());
}

LightSource light_index(PassContext& work, Cached<LightIndexOrder>& cache, Cached<LightVolumes>& volume_cache,
                        Cached<IndexShadows>& shadow_cache, bool numbered, uint32_t number) {
  const LightIndexOrder& state = cache.of(work);
  const LightVolumes& volumes = volume_cache.of(work);
  const LightIndexLayout& layout = state.layout();
  const IndexImages images = index_images(work, layout);
  IndexShadows* shadows = work.plan.shadows.own ? &shadow_cache.of(work) : nullptr;
  if (shadows && number == 0) shadows->find(work, numbered);
  const IndexShadows* dropping = drops_hidden(work) ? shadows : nullptr;
  auto pass = work.timer.pass("light_index", "gl");
  const auto draw = [&work, &state, &volumes, dropping](uint32_t which, GLuint framebuffer) {
    draw_volumes(work, state, volumes, framebuffer, dropping, which);
  };
  const bool finds_depth =
      images.own_depth && number == 0 && work.plan.settings[setting::lidr_volumes] != LidrVolumes::no_prepass;
  if (finds_depth) draw_farthest_depth(work, images.own_depth);
  draw(number, images.framebuffer);
  const PixelGrid grid = work.grid();
  const size_t values = has_samples(work) ? grid.values() : grid.pixels();
  pass.moves(values * 5 + (finds_depth ? grid.values() * 4 : 0) + volumes.memory_bytes(),
             values * (layout.pixel_bytes() + 1) + (finds_depth ? grid.pixels() * 4 : 0));
  if (drops_hidden(work)) shadows = nullptr;
  const bool points_alone = state.batches().passes[number].points_alone;
  return LightSource(
      [=, &work, &layout] { return index_loop(work, layout, images.textures, shadows, points_alone); }, {},
      work.targets.bytes(TargetUse::light_index),
      [&work, &state, draw](auto&) { return read_light_index(work, state, draw); });
}

void tell_index_shadows(PassContext& work, Cached<IndexShadows>& shadow_cache,
                        Cached<LightVolumes>& volume_cache, Frame& frame) {
  if (!work.plan.shadows.own) return;
  const IndexShadows& shadows = shadow_cache.of(work);
  frame.shadows = [&] { return shadows.read(work, volume_cache.of(work)); };
  frame.shadow_figures = [&] { return shadows.figures(work); };
}

}  // namespace lightgrid
