#include "passes/shade_light_volumes.h"

#include <numeric>

#include "base/image.h"
#include "passes/common/light_source.h"
#include "passes/depth_prepass.h"
#include "passes/light_volumes/volume_draws.h"
#include "renderer/drawing/draw.h"

namespace lightgrid {
namespace {

// Number of lights that one image of marks can distinguish: shaders/deferred_light.frag.
constexpr uint32_t lights_a_mark = 48;

// Draws the marks of all lights in batches, and calls visit(pixel, light) for each shader invocation.
template <typename Visit>
void visit_pairs(PassContext& work, Cached<LightVolumes>& cache, const Visit& visit) {
  const GlTexture centres = depth_of_centres(work);
  const GLuint depth = centres ? centres.name() : work.targets.depth();
  const int width = work.view.width, height = work.view.height;
  const GlTexture target = make_texture_2d(GL_RGBA32F, width, height);
  const GlFramebuffer framebuffer = make_framebuffer({target.name()}, depth);
  const std::vector<LightVolume>& volumes = cache.of(work).volumes();
  VolumeDraws draws(work, cache.of(work), "shaders/deferred_light.frag", {"MARK"});
  Image marks(width, height);
  for (size_t first = 0, end = 0; first < volumes.size(); first = end) {
    const uint32_t first_light = volumes[first].light;
    while (end < volumes.size() && volumes[end].light - first_light < lights_a_mark) ++end;
    const float nothing[4] = {0, 0, 0, 0};
    glClearNamedFramebufferfv(framebuffer.name(), GL_COLOR, 0, nothing);
    begin_adding_lights(work, framebuffer.name());
    bind_texture(Sampler::depth_image, depth);
    glUseProgram(draws.program().name());
    glUniform1ui(draws.program().uniform("first_light"), first_light);
    draws.draw(first, end);
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, marks.pixels.data());
    for (size_t pixel = 0; pixel < marks.pixels.size(); ++pixel) {
      for (uint32_t channel = 0; channel < 4; ++channel) {
        uint32_t digits = uint32_t(marks.pixels[pixel][int(channel)]);
        for (uint32_t light = first_light + 12 * channel; digits > 0; ++light, digits /= 4) {
          for (uint32_t times = digits % 4; times > 0; --times) visit(pixel, light);
        }
      }
    }
  }
  glDisable(GL_BLEND);
}

ListedLights read_pairs(PassContext& work, Cached<LightVolumes>& cache) {
  ListedLights lists;
  const size_t pixels = work.grid().pixels();
  lists.count.resize(pixels);
  lists.cell_of_pixel.resize(pixels);
  if (!work.plan.lights.any_local) return list_every_light(0);
  visit_pairs(work, cache, [&](size_t pixel, uint32_t) { ++lists.count[pixel]; });
  std::iota(lists.cell_of_pixel.begin(), lists.cell_of_pixel.end(), 0u);
  place_lists(lists);
  std::vector<uint64_t> next = lists.first;
  visit_pairs(work, cache, [&](size_t pixel, uint32_t light) { lists.indices[next[pixel]++] = light; });
  return lists;
}

// The defines of a shader that reads lights and the geometry buffer. Effects that the stencil's masks stand for
// are not tested again.
std::vector<std::string> defines_of_lights(PassContext& work) {
  std::vector<std::string> all = light_loop(work).defines;
  for (const Effect* effect : work.plan.effects) {
    if (work.plan.masks.stencil_bits > 0 && has_masks(*effect)) std::erase(all, define_of(*effect));
  }
  return all;
}

// Draws all lights with a fragment shader that adds what each does. bind: its inputs.
void add_lights(PassContext& work, LightVolumes& volumes, GLuint framebuffer, const char* fragment,
                const std::vector<std::string>& defines, const auto& bind) {
  volumes.update(work);
  std::vector<std::string> all = defines_of_lights(work);
  all.insert(all.end(), defines.begin(), defines.end());
  begin_adding_lights(work, framebuffer);
  bind();
  VolumeDraws(work, volumes, fragment, std::move(all)).draw(0, volumes.volumes().size());
  glDisable(GL_BLEND);
}

}  // namespace

void shade_light_volumes(PassContext& work, Cached<LightVolumes>& cache, const GBuffer& gbuffer) {
  if (!work.plan.lights.any_local) return;
  auto pass = work.timer.pass("shade_light_volumes", "gl");
  add_lights(work, cache.of(work), gbuffer.image.framebuffer, "shaders/deferred_light.frag",
             gbuffer_defines(gbuffer), [&] { bind_gbuffer(gbuffer); });
  const size_t values = work.grid().values();
  pass.moves(values * (4 + 16 + gbuffer.bytes()), values * 16);
}

void shade_full_screen(PassContext& work, const GBuffer& gbuffer) {
  if (!work.plan.lights.any_local) return;
  auto pass = work.timer.pass("shade_full_screen", "gl");
  std::vector<std::string> defines = defines_of_lights(work);
  for (const std::string& define : gbuffer_defines(gbuffer)) defines.push_back(define);
  defines.emplace_back("LIGHT_RANGE");
  begin_adding_lights(work, gbuffer.image.framebuffer);
  glDisable(GL_DEPTH_TEST);
  bind_gbuffer(gbuffer);
  const GlProgram& program = work.program("shaders/screen.vert", "shaders/deferred_light.frag", defines);
  glUseProgram(program.name());
  const size_t lights = work.plan.lights.local.size();
  for (size_t first = 0; first < lights; first += longest_plain_loop) {
    glUniform2ui(program.uniform("light_range"), GLuint(first),
                 GLuint(std::min(first + longest_plain_loop, lights)));
    draw_screen(program);
  }
  glDisable(GL_BLEND);
  const size_t values = work.grid().values();
  pass.moves(values * (4 + 16 + gbuffer.bytes()), values * 16);
}

HostLists listed_of_light_volumes(PassContext& work, Cached<LightVolumes>& cache) {
  return [&work, &cache](auto&) { return read_pairs(work, cache); };
}

LightBuffer draw_light_buffer(PassContext& work, Cached<LightVolumes>& cache, const NormalImage& normals) {
  auto pass = work.timer.pass("draw_light_buffer", "gl");
  const LightBuffer buffer = light_buffer_of(work);
  std::vector<GLuint> images = {buffer.first};
  if (buffer.second) images.push_back(buffer.second);
  const GLuint framebuffer = work.targets.framebuffer(images, work.targets.depth());
  const float nothing[4] = {0, 0, 0, 0};
  for (size_t i = 0; i < images.size(); ++i)
    glClearNamedFramebufferfv(framebuffer, GL_COLOR, GLint(i), nothing);
  std::vector<std::string> defines = light_buffer_defines(work);
  if (normals.layout->define) defines.insert(defines.begin(), normals.layout->define);
  add_lights(work, cache.of(work), framebuffer, "shaders/light_buffer.frag", defines, [&] {
    bind_texture(Sampler::normals, normals.texture);
    if (normals.surface_numbers) bind_texture(Sampler::surface_numbers, normals.surface_numbers);
    bind_texture(Sampler::depth_image, work.targets.depth());
  });
  pass.moves(work.grid().values() * (4 + normals.layout->image.bytes + buffer.bytes()),
             work.grid().values() * buffer.bytes());
  return buffer;
}

}  // namespace lightgrid
