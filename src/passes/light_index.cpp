// Draws light volumes into images of light indices, from which shading reads its lights
// (docs/techniques/lidr.md).
#include "passes/light_index.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "passes/light_index/blending.h"
#include "passes/light_index/index_drawing.h"
#include "passes/light_index/index_shadows.h"
#include "passes/light_index/light_groups.h"

namespace lightgrid {

struct Order {
  std::vector<LightVolume> volumes;
  std::vector<VolumeBatch> batches;
};

class LightIndexOrder : public PassCache {
 public:
  explicit LightIndexOrder(Work& work)
      : layout(light_index_layout(work.plan.settings, work.plan.local.size(), share_bits_of(work))),
        group_of_light(work.plan.local.size(), no_group) {
    require_exact_blending(work, layout);
    find_influence(work);
  }

  // Lights that come into view need groups as well.
  bool follow(Work& work) override {
    if (group_of_light.size() != work.plan.local.size()) return false;
    grouped = false;
    find_influence(work);
    return true;
  }

  LightIndexLayout layout;
  std::vector<double> influence;         // of each light
  std::vector<uint32_t> group_of_light;  // while it does not depend on the camera
  bool grouped = false;
  Order order;

 private:
  void find_influence(const Seen& seen) {
    influence.clear();
    for (const ViewLight& light :
         lights_in_view(seen.scene, seen.view, seen.plan.settings.ranges, seen.plan.local)) {
      influence.push_back(influence_of(light));
    }
  }
};

namespace {

// Most influence first if lidr-order says so, else scene order.
void put_in_order(const Seen& seen, const LightIndexOrder& state, std::vector<LightVolume>& volumes) {
  if (seen.plan.settings.lidr_order == LidrOrder::scene) return;
  std::stable_sort(volumes.begin(), volumes.end(), [&](const LightVolume& a, const LightVolume& b) {
    return state.influence[a.light] > state.influence[b.light];
  });
}

LightExtent extent_in_space(const LightVolume& v) {
  return {v.center - v.radius, v.center + v.radius, v.center, v.radius};
}
LightExtent extent_on_screen(const LightVolume& v) {
  return {glm::dvec3(v.low_px, 0), glm::dvec3(v.high_px, 0)};
}

// Sort: lights without a group are left out. With stencil, lights that do not touch in space share no pixel,
// whatever the camera; with front faces, the rectangles on screen must not touch.
void put_in_groups(const Seen& seen, LightIndexOrder& state, std::vector<LightVolume>& volumes) {
  const bool on_screen = seen.plan.settings.lidr_volumes == LidrVolumes::front_faces;
  if (on_screen || !state.grouped) {
    std::vector<LightExtent> extents;
    for (const LightVolume& v : volumes)
      extents.push_back(on_screen ? extent_on_screen(v) : extent_in_space(v));
    const std::vector<uint32_t> groups = group_lights(extents, state.layout.groups);
    for (size_t i = 0; i < groups.size(); ++i) state.group_of_light[volumes[i].light] = groups[i];
    state.grouped = true;
  }
  const auto group = [&](const LightVolume& v) { return state.group_of_light[v.light]; };
  std::erase_if(volumes, [&](const LightVolume& v) { return group(v) == no_group; });
  std::stable_sort(volumes.begin(), volumes.end(),
                   [&](const LightVolume& a, const LightVolume& b) { return group(a) < group(b); });
}

// Rounds in which no two volumes share a pixel, because the stencil marks one volume at a time. A single
// round if nothing is marked and each draw's channels are fixed.
std::vector<uint32_t> rounds_of(const Seen& seen, const LightIndexLayout& layout,
                                const std::vector<LightVolume>& volumes) {
  const bool sorted = layout.packing == LidrPacking::sort,
             marked = seen.plan.settings.lidr_volumes == LidrVolumes::stencil;
  if (!marked && (sorted || layout.groups == 1)) return std::vector<uint32_t>(volumes.size(), 0);
  std::vector<LightExtent> extents;
  for (const LightVolume& v : volumes) extents.push_back(extent_on_screen(v));
  return draw_rounds(extents);
}

Order order_of(const Seen& seen, LightIndexOrder& state, std::vector<LightVolume> volumes) {
  const bool sorted = state.layout.packing == LidrPacking::sort;
  put_in_order(seen, state, volumes);
  if (sorted) put_in_groups(seen, state, volumes);
  const std::vector<uint32_t> rounds = rounds_of(seen, state.layout, volumes);
  // Within a round of a group any order gives the same image; this one needs few calls. If there is only one
  // round, the order decides which lights are kept when slots run out.
  const auto batch_of = [&](uint32_t i) {
    return std::tuple(sorted ? state.group_of_light[volumes[i].light] : 0, rounds[i], volumes[i].crosses_near,
                      volumes[i].mesh);
  };
  std::vector<uint32_t> order(volumes.size());
  std::iota(order.begin(), order.end(), 0u);
  const bool any_order =
      sorted || seen.plan.settings.lidr_volumes == LidrVolumes::stencil || state.layout.groups > 1;
  if (any_order)
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return batch_of(a) < batch_of(b); });
  Order out;
  for (size_t i = 0; i < order.size(); ++i) {
    const auto [group, round, crosses, mesh] = batch_of(order[i]);
    const auto [last_group, last_round, last_crosses, last_mesh] = batch_of(order[i ? i - 1 : 0]);
    if (i == 0 || group != last_group || round != last_round || crosses != last_crosses)
      out.batches.push_back({i, 0, group});
    ++out.batches.back().count;
    out.volumes.push_back(volumes[order[i]]);
  }
  return out;
}

std::vector<GLuint> index_images(Work& work, const LightIndexLayout& layout) {
  std::vector<GLuint> images;
  for (uint32_t i = 0; i < layout.targets(); ++i) {
    images.push_back(
        work.targets.texture("light_index_" + std::to_string(i), layout.format(), TargetUse::light_index));
  }
  return images;
}

void clear(const LightIndexLayout& layout, GLuint framebuffer, GLint stencil) {
  const float none[4] = {};
  for (uint32_t i = 0; i < layout.targets(); ++i)
    glClearNamedFramebufferfv(framebuffer, GL_COLOR, GLint(i), none);
  glStencilMask(255);
  glClearNamedFramebufferiv(framebuffer, GL_STENCIL, 0, &stencil);
}

// Whether lights are not written where they are hidden.
bool drops_hidden(const Seen& seen) {
  return seen.plan.own_shadows && seen.plan.settings.lidr_shadows != LidrShadows::final_pass;
}

// Where the stencil marks what is inside, hidden pixels get no mark. Discarding them later would leave one.
IndexDrawing::Programs programs_of(Work& work, const LightIndexLayout& layout, const GlLightLoop* shadows) {
  const auto program = [&](const std::vector<std::string>& more) {
    std::vector<std::string> defines = layout.defines();
    defines.insert(defines.end(), more.begin(), more.end());
    return work.program("shaders/light_index.vert", "shaders/light_index.frag", std::move(defines)).name();
  };
  if (!shadows) return {program({}), program({})};
  // A share is found once more where it is written.
  const bool marked = work.plan.settings.lidr_volumes == LidrVolumes::stencil && !layout.share_bits;
  return {program(shadows->defines), program(marked ? std::vector<std::string>() : shadows->defines)};
}

void draw_volumes(Work& work, const LightIndexOrder& state, const LightVolumes& volumes, const Order& order,
                  GLuint framebuffer, const IndexShadows* shadows) {
  const LightIndexLayout& layout = state.layout;
  std::optional<GlLightLoop> input;
  if (shadows) input = shadows->input(work);
  const IndexDrawing drawing(work, layout, volumes, programs_of(work, layout, input ? &*input : nullptr));
  if (input) input->bind(work);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, work.grid().width, work.grid().height);
  clear(layout, framebuffer, drawing.cleared_stencil());
  glEnable(GL_DEPTH_TEST), glDepthMask(GL_FALSE), glEnable(GL_STENCIL_TEST);
  begin_light_indices(layout);
  for (const VolumeBatch& batch : order.batches) {
    if (shadows) {
      shadows->draw_casters(work, std::span(order.volumes).subspan(batch.first, batch.count));
      glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    }
    volumes.begin();
    drawing.draw(batch);
  }
  volumes.end();
  end_light_indices();
  glStencilMask(255);
  glDisable(GL_STENCIL_TEST), glCullFace(GL_BACK);
}

bool may_repeat(const Seen& seen) { return seen.plan.settings.lidr_volumes == LidrVolumes::front_faces; }

// shadows: of lights that are listed where they are hidden too.
GlLightLoop index_loop(Work& seen, const LightIndexLayout& layout, const std::vector<GLuint>& images,
                       const IndexShadows* shadows) {
  GlLightLoop loop = light_loop(seen);
  if (shadows) {
    const GlLightLoop input = shadows->input(seen);
    loop.defines.insert(loop.defines.end(), input.defines.begin(), input.defines.end());
    loop.textures = input.textures, loop.blocks = input.blocks;
  }
  for (std::string& define : layout.defines()) loop.defines.push_back(std::move(define));
  loop.defines.emplace_back("LIGHTS_LIDR");
  if (seen.plan.settings.lidr_unpack == LidrUnpack::floats) loop.defines.emplace_back("LIDR_FLOAT");
  if (may_repeat(seen)) loop.defines.emplace_back("LIDR_REPEATS");
  for (size_t i = 0; i < images.size(); ++i)
    loop.textures.push_back({Sampler::light_index_images, images[i], i});
  return loop;
}

ListedLights read_light_index(Work& work, Cached<LightIndexOrder>& cache) {
  const LightIndexLayout& layout = cache.of(work).layout;
  glBindFramebuffer(GL_READ_FRAMEBUFFER,
                    work.targets.framebuffer(index_images(work, layout), work.targets.depth()));
  const std::vector<uint16_t> channels = read_channels(layout, work.grid());
  const size_t stride = layout.targets() * 4;
  ListedLights lists;
  lists.cell_of_pixel.resize(channels.size() / stride);
  std::iota(lists.cell_of_pixel.begin(), lists.cell_of_pixel.end(), 0u);
  std::vector<uint32_t> lights;
  for (size_t pixel = 0; pixel < lists.cell_of_pixel.size(); ++pixel) {
    unpack_light_index(layout, {&channels[pixel * stride], stride}, may_repeat(work), lights);
    lists.first.push_back(lists.indices.size()), lists.count.push_back(uint32_t(lights.size()));
    lists.indices.insert(lists.indices.end(), lights.begin(), lights.end());
  }
  return lists;
}

}  // namespace

LightSource light_index(Work& work, Cached<LightIndexOrder>& cache, Cached<LightVolumes>& volume_cache,
                        Cached<IndexShadows>& shadow_cache, bool numbered) {
  LightIndexOrder& state = cache.of(work);
  LightVolumes& volumes = volume_cache.of(work);
  const std::vector<GLuint> images = index_images(work, state.layout);
  const GLuint framebuffer = work.targets.framebuffer(images, work.targets.depth());
  {
    auto pass = work.timer.pass("light_volumes", "gl");
    Order order = order_of(work, state, volumes.update(work));
    volumes.upload_volumes(order.volumes);
    state.order = std::move(order);
  }
  IndexShadows* shadows = work.plan.own_shadows ? &shadow_cache.of(work) : nullptr;
  if (shadows) shadows->find(work, numbered);
  auto pass = work.timer.pass("light_index", "gl");
  draw_volumes(work, state, volumes, state.order, framebuffer, drops_hidden(work) ? shadows : nullptr);
  const size_t values = work.grid().values();
  pass.moves(values * 5 + volumes.memory_bytes(), values * (state.layout.pixel_bytes() + 1));
  if (drops_hidden(work)) shadows = nullptr;
  return LightSource(
      [&work, &state, images, shadows] { return index_loop(work, state.layout, images, shadows); }, {},
      work.targets.bytes(TargetUse::light_index),
      [&work, &cache](auto&) { return read_light_index(work, cache); });
}

void tell_index_shadows(Work& work, Cached<IndexShadows>& shadow_cache, Cached<LightVolumes>& volume_cache,
                        Frame& frame) {
  if (!work.plan.own_shadows) return;
  const IndexShadows& shadows = shadow_cache.of(work);
  frame.shadows = [&] { return shadows.read(work, volume_cache.of(work)); };
  frame.shadow_figures = [&] { return shadows.figures(work); };
}

}  // namespace lightgrid
