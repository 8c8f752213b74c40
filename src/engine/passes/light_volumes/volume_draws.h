// Draws lights one after the other on the pixels that their volumes select: for passes that add what each
// light does there.
#pragma once

#include "passes/common/surface_numbers.h"
#include "passes/light_volumes/light_volumes.h"
#include "plan/settings/surfaces.h"

namespace lightgrid {

// The methods of the setting volume-culling (docs/techniques/deferred.md), for one fragment shader.
class VolumeDraws {
 public:
  // fragment takes LIGHT_VOLUME (the light comes with its volume, else as a uniform `light`), DEPTH_BOUNDS
  // (the uniform depth_bounds) and EARLY_TESTS (discarded pixels reset their mark too) besides `defines`.
  VolumeDraws(PassContext& work, LightVolumes& volumes, const char* fragment,
              std::vector<std::string> defines);

  const GlProgram& program() const { return *program_; }

  // Draws volumes first ... end - 1 of the view's LightVolumes into the bound framebuffer, which has the
  // frame's depth.
  void draw(size_t first, size_t end);

 private:
  bool drawn_as_volumes() const;
  void draw_back_faces(size_t first, size_t end);
  void draw_marked(size_t first, size_t end);
  void draw_rectangles(size_t first, size_t end);
  void test_mask(size_t volume) const;

  const ViewState& seen_;
  VolumeCulling culling_;
  LightVolumes& volumes_;
  const GlProgram *program_ = nullptr, *marking_ = nullptr;
  std::vector<uint8_t> masks_;  // by light, where the stencil has masks; else empty
};

// Sets state for lights that add to the images of a framebuffer, which has the frame's depth. If volumes are
// marked in its stencil, that is cleared, unless it has the masks of the surfaces.
void begin_adding_lights(PassContext& work, GLuint framebuffer);

struct ScreenBounds {
  glm::ivec2 first, end;  // pixels: first <= p < end
  glm::vec2 depth{0, 1};  // values of the depth image, ascending
};

// The rectangle is bounded by the sphere's tangents, if it has any, and by the volume's rectangle. The
// interval is that of the sphere along the view axis, within the volume's.
ScreenBounds screen_bounds(const View& view, const LightVolume& volume);

}  // namespace lightgrid
