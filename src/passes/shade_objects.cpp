// Forward shading object by object, in as many draws as its lights take. Objects stand outside and their
// draws inside: the first one puts over what is there, so that of two surfaces of one depth the later stands,
// as it does in shade_forward.
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
  if (part == Part::lights) defines.emplace_back("ADDED");
  return f.program("shaders/scene.vert", "shaders/forward.frag", defines);
}

class ObjectDraws {
 public:
  ObjectDraws(Frame& f, const ObjectLights& objects, const ObjectLights::Object& object, InstanceDrawer& drawer)
      : f_(f),
        objects_(objects),
        object_(object),
        drawer_(drawer),
        ranges_(index_ranges(f.gpu.mesh(f.scene.instances[object.instance].mesh), object.clusters)) {}

  void draw(Part part, uint32_t first, uint32_t count) {
    const GlProgram& program = program_of(f_, objects_, f_.plan.features_of_instance[object_.instance], part);
    drawer_.bind(object_.instance, program);
    if (part != Part::own) {
      glUniform2i(program.uniform("lights_of_draw"), GLint(object_.first_light + first), GLint(count));
    }
    part == Part::lights ? glEnable(GL_BLEND) : glDisable(GL_BLEND);
    drawer_.draw(ranges_);
  }

 private:
  Frame& f_;
  const ObjectLights& objects_;
  const ObjectLights::Object& object_;
  InstanceDrawer& drawer_;
  IndexRanges ranges_;
};

void draw_object(Frame& f, const ObjectLights& objects, const ObjectLights::Object& object, uint32_t lights_a_draw,
                 bool own_apart, InstanceDrawer& drawer) {
  ObjectDraws draws(f, objects, object, drawer);
  const bool unlit =
      f.scene.materials[f.scene.meshes[f.scene.instances[object.instance].mesh].material].unlit;
  const uint32_t count = unlit ? 0 : object.light_count;
  uint32_t done = own_apart ? 0 : std::min(count, lights_a_draw);
  draws.draw(done > 0 ? Part::own_and_lights : Part::own, 0, done);
  for (; done < count; done += lights_a_draw)
    draws.draw(Part::lights, done, std::min(count - done, lights_a_draw));
}

}  // namespace

ShadedImage shade_objects(Frame& f, const ObjectLights& objects, uint32_t lights_a_draw, bool own_apart) {
  auto pass = f.timer.pass("shade_objects", "gl");
  const ShadedImage image = begin_shading(f);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE, GL_ONE);
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
