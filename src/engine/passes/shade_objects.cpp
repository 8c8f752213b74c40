// Forward shading object by object, in as many draws as its lights take. The first draw of an object replaces
// the image, so that the later of two surfaces of one depth is visible, as in shade_forward. Further
// draws add light.
//
// Triangles of one object may also share a depth (coplanar parts of a mesh). The first draw leaves the last
// of them; each further draw must add light to that one only. It draws the triangles in reverse order, and
// the image's alpha accepts only the first fragment of a pixel. Draws expect an alpha of 1 and 0 in turn. The
// blend factor multiplies the added light by 1 if the alpha is as expected and by 0 otherwise; the draw
// leaves the other value. The first draw writes the value that makes the last draw leave 1.
#include "passes/shade_objects.h"

#include <algorithm>
#include <numeric>

#include "passes/read_outs.h"
#include "passes/shade_forward.h"
#include "renderer/drawing/draw.h"

namespace lightgrid {
namespace {

// The forward programs of an object's draws.
struct ObjectPrograms {
  ScenePrograms& base;             // without point and spot lights
  ScenePrograms& base_and_lights;  // with the first of the object's
  ScenePrograms& lights;           // with further ones alone

  static ScenePrograms& of(PassContext& work, const GlLightLoop& loop, const char* define) {
    std::vector<std::string> defines = loop.defines;
    defines.emplace_back(define);
    return work.programs({"shaders/scene.vert", "shaders/forward.frag", std::move(defines)});
  }
  ObjectPrograms(PassContext& work, const GlLightLoop& loop)
      : base(of(work, base_lighting(work), "FIRST_OF_DRAWS")),
        base_and_lights(of(work, loop, "FIRST_OF_DRAWS")),
        lights(of(work, loop, "ADDED")) {}
};

// Draws one object. Alpha is 0 or 1.
class ObjectDraws {
 public:
  ObjectDraws(PassContext& work, ObjectPrograms& programs, const ObjectLights::Object& object,
              InstanceDrawer& drawer, PendingDraws& pending)
      : work_(work),
        programs_(programs),
        object_(object),
        drawer_(drawer),
        pending_(pending),
        indices_(std::accumulate(object.ranges.counts.begin(), object.ranges.counts.end(), size_t(0))) {}

  // Replaces the image. Uses lights [0, count) of the object; 0: none.
  void draw_first(uint32_t count, int alpha) {
    const SceneProgram& program = bind(count > 0 ? programs_.base_and_lights : programs_.base, 0, count);
    glUniform1f(program.alpha, GLfloat(alpha));
    glDisable(GL_BLEND);
    drawer_.draw(object_.ranges);
    pending_.add(indices_);
    alpha_ = alpha;
  }

  // Adds the lights [first, first + count) of the object.
  void add(uint32_t first, uint32_t count) {
    bind(programs_.lights, first, count);
    if (reversed_.counts.empty()) reversed_ = in_reverse(object_.ranges, work_.gpu.in_gl());
    glEnable(GL_BLEND);
    glBlendFuncSeparate(alpha_ ? GL_DST_ALPHA : GL_ONE_MINUS_DST_ALPHA, GL_ONE, alpha_ ? GL_ZERO : GL_ONE,
                        GL_ZERO);
    drawer_.draw(reversed_);
    pending_.add(indices_);
    alpha_ = !alpha_;
  }

 private:
  const SceneProgram& bind(ScenePrograms& programs, uint32_t first, uint32_t count) {
    const SceneProgram& program = programs.of(work_.plan.surfaces.features_of_instance[object_.instance]);
    drawer_.bind(object_.instance, program);
    if (program.lights_of_draw >= 0)
      glUniform2i(program.lights_of_draw, GLint(object_.first_light + first), GLint(count));
    return program;
  }

  PassContext& work_;
  ObjectPrograms& programs_;
  const ObjectLights::Object& object_;
  InstanceDrawer& drawer_;
  PendingDraws& pending_;
  const size_t indices_;  // indices of a draw
  IndexRanges reversed_;  // reversed ranges of the object, computed at first use
  int alpha_ = 1;
};

void draw_object(PassContext& work, ObjectPrograms& programs, const ObjectLights::Object& object,
                 uint32_t lights_a_draw, bool own_apart, InstanceDrawer& drawer, PendingDraws& pending) {
  ObjectDraws draws(work, programs, object, drawer, pending);
  const bool unlit =
      work.scene.materials[work.scene.meshes[work.scene.instances[object.instance].mesh].material].unlit;
  const uint32_t count = unlit ? 0 : object.light_count;
  uint32_t done = own_apart ? 0 : std::min(count, lights_a_draw);
  const uint32_t further = (count - done + lights_a_draw - 1) / lights_a_draw;
  draws.draw_first(done, further % 2 == 0);
  for (; done < count; done += lights_a_draw) draws.add(done, std::min(count - done, lights_a_draw));
}

}  // namespace

ShadedImage shade_objects(PassContext& work, const ObjectLights& objects, uint32_t lights_a_draw,
                          bool own_apart) {
  auto pass = work.timer.pass("shade_objects", "gl");
  const ShadedImage image = begin_shading(work);
  glBlendEquation(GL_FUNC_ADD);
  const LightSource source = from_objects(work, objects);
  source.in_gl().bind(work);
  ObjectPrograms programs(work, source.in_gl());
  InstanceDrawer drawer(work, DrawStreams::all);
  PendingDraws pending;
  for (const ObjectLights::Object& object : objects.objects()) {
    draw_object(work, programs, object, lights_a_draw, own_apart, drawer, pending);
  }
  glDisable(GL_BLEND);
  pass.moves(work.gpu.in_gl().geometry_bytes() + work.grid().values() * 4 + source.bytes,
             work.grid().values() * 16);
  return image;
}

ListedLights listed_of_objects(PassContext& work, Cached<ObjectLights>& cache) {
  const ObjectLights& objects = cache.of(work);
  ListedLights lists{.indices = objects.lights()};
  for (const ObjectLights::Object& object : objects.objects()) {
    lists.first.push_back(object.first_light);
    lists.count.push_back(object.light_count);
  }
  lists.cell_of_pixel = indices_drawn(work, [&] {
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_EQUAL);
    InstanceDrawer drawer(work, DrawStreams::all);
    const SceneProgram& program = work.programs({"shaders/scene.vert", "shaders/object.frag", {}}).of(0);
    for (size_t i = 0; i < objects.objects().size(); ++i) {
      const ObjectLights::Object& object = objects.objects()[i];
      drawer.bind(object.instance, program);
      glUniform1ui(program.object, GLuint(i));
      drawer.draw(object.ranges);
    }
  });
  return lists;
}

}  // namespace lightgrid
