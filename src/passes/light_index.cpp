// Draws light volumes into images of light indices, from which shading reads its lights
// (docs/techniques/lidr.md).
#include "passes/light_index.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "passes/light_index/blending.h"
#include "passes/light_index/light_groups.h"
#include "passes/light_volumes/light_volumes.h"

namespace lightgrid {
namespace {

// The stencil's lowest bit is clear where the surface is inside the current volume; the bits above count the
// remaining slots down. Decrementing an even value does both: it sets the lowest bit and takes one from the
// count.
constexpr GLuint not_inside = 1;
constexpr GLuint has_room = 128;  // top bit: the count is not exhausted

}  // namespace

// Volumes that one call draws.
struct Batch {
  size_t first, count;
  uint32_t group;  // sort: the group whose channels are written
};

struct Order {
  std::vector<LightVolume> volumes;
  std::vector<Batch> batches;
};

class LightIndexOrder : public PassCache {
 public:
  explicit LightIndexOrder(Work& work)
      : layout(light_index_layout(work.plan.settings, work.plan.local.size())),
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
      const glm::dvec3& i_rgb = light.radiant_intensity;
      // The integral of intensity / distance^2 over the sphere, up to a factor.
      influence.push_back((i_rgb.r + i_rgb.g + i_rgb.b) * light.radius_m);
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

class Drawing {
 public:
  Drawing(const Seen& seen, const LightIndexLayout& layout, const LightVolumes& volumes)
      : layout_(layout),
        volumes_(volumes),
        inside_(seen.plan.settings.lidr_volumes == LidrVolumes::stencil) {}

  void draw(const Batch& batch) const {
    const bool counted = layout_.packing != LidrPacking::sort;
    if (inside_) mark_inside(batch);
    // Later groups first: otherwise a light that fills one group's last slot would also be written to the
    // next group.
    for (uint32_t group = counted ? layout_.groups : 1; group-- > 0;) {
      write_group(layout_, counted ? group : batch.group);
      if (counted)
        test_free_slot(group);
      else
        test_mark_only();
      if (inside_)
        write_marked(batch);
      else
        write_behind_front_faces(batch);
    }
  }

  // The initial stencil value: the number of free slots.
  GLint cleared_stencil() const {
    if (layout_.packing == LidrPacking::sort) return 255;
    return GLint(inside_ ? 2 * (has_room / 2 - 1 + layout_.overlap) + not_inside
                         : has_room - 1 + layout_.overlap);
  }

 private:
  // Marks surfaces behind a front face; write_marked then tests for a back face behind them. If the near
  // plane cuts holes into front faces, each face behind a surface inverts the bit: an odd number means
  // inside, for any closed mesh.
  void mark_inside(const Batch& batch) const {
    write_group(layout_, no_channels);
    const bool count = crosses_near(batch);
    count ? glDisable(GL_CULL_FACE) : glEnable(GL_CULL_FACE);
    glCullFace(GL_BACK);
    glDepthFunc(GL_GEQUAL);
    glStencilMask(not_inside);
    glStencilFunc(GL_ALWAYS, 0, 0);
    count ? glStencilOp(GL_KEEP, GL_INVERT, GL_KEEP) : glStencilOp(GL_KEEP, GL_KEEP, GL_ZERO);
    volumes_.draw(batch.first, batch.count);
  }

  // Tests for a free slot in this group and, with stencil, for the mark. A marked surface behind a back face
  // is not inside and loses its mark.
  void test_free_slot(uint32_t group) const {
    const GLuint step = inside_ ? 2 : 1;  // stencil steps a slot takes
    const GLuint of_group = layout_.groups > 1 ? step * layout_.slots : 0;
    glStencilMask(255);
    glStencilFunc(GL_EQUAL, GLint(has_room | (group == 0 ? of_group : 0)),
                  has_room | of_group | (inside_ ? not_inside : 0));
    glStencilOp(GL_KEEP, inside_ ? GL_INCR : GL_KEEP, GL_DECR);
  }

  void test_mark_only() const {
    inside_ ? glStencilFunc(GL_EQUAL, 0, not_inside) : glStencilFunc(GL_ALWAYS, 0, 0);
    inside_ ? glStencilOp(GL_KEEP, GL_INVERT, GL_INVERT) : glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  }

  void write_marked(const Batch& batch) const {
    glEnable(GL_CULL_FACE);
    glCullFace(GL_FRONT);
    glDepthFunc(crosses_near(batch) ? GL_ALWAYS : GL_LEQUAL);
    volumes_.draw(batch.first, batch.count);
  }

  // Writes to surfaces behind a front face or, if the near plane cuts holes into these, wherever there is a
  // back face.
  void write_behind_front_faces(const Batch& batch) const {
    glEnable(GL_CULL_FACE);
    glCullFace(crosses_near(batch) ? GL_FRONT : GL_BACK);
    glDepthFunc(crosses_near(batch) ? GL_ALWAYS : GL_GEQUAL);
    volumes_.draw(batch.first, batch.count);
  }

  bool crosses_near(const Batch& batch) const { return volumes_.volumes()[batch.first].crosses_near; }

  const LightIndexLayout& layout_;
  const LightVolumes& volumes_;
  bool inside_;
};

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

void draw_volumes(Work& work, const LightIndexOrder& state, const LightVolumes& volumes, const Order& order,
                  GLuint framebuffer) {
  const LightIndexLayout& layout = state.layout;
  const Drawing drawing(work, layout, volumes);
  const GlProgram& program =
      work.program("shaders/light_index.vert", "shaders/light_index.frag", layout.defines());
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, work.grid().width, work.grid().height);
  clear(layout, framebuffer, drawing.cleared_stencil());
  glEnable(GL_DEPTH_TEST), glDepthMask(GL_FALSE), glEnable(GL_STENCIL_TEST);
  glUseProgram(program.name());
  begin_light_indices(layout);
  volumes.begin();
  for (const Batch& batch : order.batches) drawing.draw(batch);
  volumes.end();
  end_light_indices();
  glStencilMask(255);
  glDisable(GL_STENCIL_TEST), glCullFace(GL_BACK);
}

bool may_repeat(const Seen& seen) { return seen.plan.settings.lidr_volumes == LidrVolumes::front_faces; }

GlLightLoop index_loop(const Seen& seen, const LightIndexLayout& layout, const std::vector<GLuint>& images) {
  GlLightLoop loop = light_loop(seen);
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

LightSource light_index(Work& work, Cached<LightIndexOrder>& cache, Cached<LightVolumes>& volume_cache) {
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
  auto pass = work.timer.pass("light_index", "gl");
  draw_volumes(work, state, volumes, state.order, framebuffer);
  const size_t values = work.grid().values();
  pass.moves(values * 5 + volumes.memory_bytes(), values * (state.layout.pixel_bytes() + 1));
  return LightSource([&work, &state, images] { return index_loop(work, state.layout, images); }, {},
                     work.targets.bytes(TargetUse::light_index),
                     [&work, &cache](auto&) { return read_light_index(work, cache); });
}

}  // namespace lightgrid
