// Forward shading object by object, in as many draws as its lights take. The first draw of an object replaces what is
// there, so that of two surfaces of one depth the later one is seen, as in shade_forward. Further draws add light.
//
// Triangles of one object may share a depth as well (coplanar parts of a mesh). The first draw leaves the last of them;
// each further draw must add the light of that one alone. It draws the triangles in reverse order, and the image's alpha
// lets the first fragment of a pixel pass and no other: draws expect an alpha of 1 and 0 in turn, multiply what they add
// by whether it is there (the blend factor), and leave the other value. The first draw writes the value that makes the
// last draw leave 1.
#include <algorithm>

#include "passes/frame/begin_shading.h"
#include "passes/cells.h"
#include "passes/frame/draw.h"
#include "passes/frame/light_defines.h"
#include "passes/object_lights.h"

namespace lightgrid {
namespace {

// The forward program without point and spot lights, with some of the object's, or of those alone.
enum class Part { own, own_and_lights, lights };

const GlProgram& program_of(Frame& f, const ObjectLights& objects, uint32_t features, Part part) {
  auto defines = part == Part::own ? own_light_defines(f, features) : light_defines(f, features, objects);
  defines.emplace_back(part == Part::lights ? "ADDED" : "FIRST_OF_DRAWS");
  return f.program("shaders/scene.vert", "shaders/forward.frag", defines);
}

// Draws one object. Alpha is 0 or 1.
class ObjectDraws {
 public:
  ObjectDraws(Frame& f, const ObjectLights& objects, const ObjectLights::Object& object, InstanceDrawer& drawer)
      : f_(f),
        objects_(objects),
        object_(object),
        drawer_(drawer),
        ranges_(index_ranges(f.gpu.mesh(f.scene.instances[object.instance].mesh), object.clusters)) {}

  // Replaces what is there. Lights [0, count) of the object; 0: none.
  void draw_first(uint32_t count, int alpha) {
    const GlProgram& program = bind(count > 0 ? Part::own_and_lights : Part::own, 0, count);
    glUniform1f(program.uniform("alpha"), GLfloat(alpha));
    glDisable(GL_BLEND);
    drawer_.draw(ranges_);
    alpha_ = alpha;
  }

  // Adds the lights [first, first + count) of the object.
  void add(uint32_t first, uint32_t count) {
    bind(Part::lights, first, count);
    if (reversed_.counts.empty()) reversed_ = in_reverse(ranges_, f_.gpu);
    glEnable(GL_BLEND);
    glBlendFuncSeparate(alpha_ ? GL_DST_ALPHA : GL_ONE_MINUS_DST_ALPHA, GL_ONE, alpha_ ? GL_ZERO : GL_ONE, GL_ZERO);
    drawer_.draw(reversed_);
    alpha_ = !alpha_;
  }

 private:
  const GlProgram& bind(Part part, uint32_t first, uint32_t count) {
    const GlProgram& program = program_of(f_, objects_, f_.plan.features_of_instance[object_.instance], part);
    drawer_.bind(object_.instance, program);
    if (part != Part::own) {
      glUniform2i(program.uniform("lights_of_draw"), GLint(object_.first_light + first), GLint(count));
    }
    return program;
  }

  Frame& f_;
  const ObjectLights& objects_;
  const ObjectLights::Object& object_;
  InstanceDrawer& drawer_;
  const IndexRanges ranges_;
  IndexRanges reversed_;  // of ranges_, made at first use
  int alpha_ = 1;
};

void draw_object(Frame& f, const ObjectLights& objects, const ObjectLights::Object& object, uint32_t lights_a_draw,
                 bool own_apart, InstanceDrawer& drawer) {
  ObjectDraws draws(f, objects, object, drawer);
  const bool unlit =
      f.scene.materials[f.scene.meshes[f.scene.instances[object.instance].mesh].material].unlit;
  const uint32_t count = unlit ? 0 : object.light_count;
  uint32_t done = own_apart ? 0 : std::min(count, lights_a_draw);
  const uint32_t further = (count - done + lights_a_draw - 1) / lights_a_draw;
  draws.draw_first(done, further % 2 == 0);
  for (; done < count; done += lights_a_draw) draws.add(done, std::min(count - done, lights_a_draw));
}

}  // namespace

ShadedImage shade_objects(Frame& f, const ObjectLights& objects, uint32_t lights_a_draw, bool own_apart) {
  auto pass = f.timer.pass("shade_objects", "gl");
  const ShadedImage image = begin_shading(f);
  glBlendEquation(GL_FUNC_ADD);
  bind_lights(f, objects);
  InstanceDrawer drawer(f, DrawStreams::all);
  for (const ObjectLights::Object& object : objects.objects())
    draw_object(f, objects, object, lights_a_draw, own_apart, drawer);
  glDisable(GL_BLEND);
  const size_t pixels = size_t(f.view.width) * f.view.height;
  pass.moves(f.gpu.geometry_bytes() + pixels * 4 + objects.lights().size() * sizeof(uint32_t), pixels * 16);
  return image;
}

ListedLights listed_of_objects(Frame& f) {
  const ObjectLights& objects = f.kept<ObjectLights>();
  ListedLights lists{.indices = objects.lights()};
  for (const ObjectLights::Object& object : objects.objects()) {
    lists.first.push_back(object.first_light), lists.count.push_back(object.light_count);
  }
  lists.cell_of_pixel = indices_drawn(f, [&] {
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_EQUAL);
    InstanceDrawer drawer(f, DrawStreams::all);
    const GlProgram& program = f.program("shaders/scene.vert", "shaders/object.frag", {});
    for (size_t i = 0; i < objects.objects().size(); ++i) {
      const ObjectLights::Object& object = objects.objects()[i];
      drawer.bind(object.instance, program);
      glUniform1ui(program.uniform("object"), GLuint(i));
      drawer.draw(index_ranges(f.gpu.mesh(f.scene.instances[object.instance].mesh), object.clusters));
    }
  });
  return lists;
}

}  // namespace lightgrid
