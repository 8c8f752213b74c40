// Shadows of point and spot lights that lidr finds itself (docs/techniques/lidr.md#shadows): what shaders
// read to decide whether one of the plan's own_shadowed lights is hidden from a pixel
// (shaders/common/index_shadow.glsl).
#pragma once

#include "passes/common/light_source.h"
#include "passes/light_index/caster_draws.h"
#include "passes/shadows/view_shadow_maps.h"
#include "plan/settings/shadows.h"

namespace lightgrid {

// With prepass-soft, of the share beside each index: 16 values, since pcf3 has ten. Eight bits would take as
// much room as an index does.
constexpr uint32_t shadow_share_bits = 4;

// 0: the view's light index images have no shares.
inline uint32_t share_bits_of(const ViewState& seen) {
  return seen.plan.shadows.own && seen.plan.settings[setting::lidr_shadows] == LidrShadows::prepass_soft
             ? shadow_share_bits
             : 0;
}

class IndexShadows : public PassCache {
 public:
  explicit IndexShadows(PassContext& work);
  bool follow(PassContext& work) override;
  size_t memory_bytes() const override;

  // Once a frame, after its depth image: the triangles that pixels show, unless find_shadows has drawn them
  // in this frame (numbered), and shadow maps or volumes. Throws Error(machine) if the device has no doubles,
  // or if an OpenGL cannot read as many bytes.
  void find(PassContext& work, bool numbered);

  // The defines and textures with which a program includes index_shadow.glsl.
  GlLightLoop input(PassContext& work) const;

  // With shadow volumes: draws those of these lights, which share no pixel, before a program reads them.
  // input() must be bound. Leaves another framebuffer bound.
  void draw_casters(PassContext& work, std::span<const LightVolume> lights) const {
    if (casters_) casters_->draw(work, lights);
  }

  // The shares that a frame's programs found, at each pixel in a light's rectangle: for the oracle.
  HostShadows read(PassContext& work, const LightVolumes& volumes) const;
  ShadowFigures figures(const PassContext& work) const;

 private:
  void upload_corners(PassContext& work);
  void upload_view(PassContext& work);
  void draw_maps(PassContext& work);

  struct Table {
    GlBuffer buffer;
    GlTexture texture;
    size_t bytes = 0;
    void put(const std::vector<uint32_t>& words);  // as GL_RGBA32UI
  };

  std::shared_ptr<RayScene> scene_;
  SharedTexture corners_;  // corners of the scene's triangles
  NamedKernel corners_kernel_;
  int shape_ = -1, instances_ = -1;  // versions of the scene that corners_ has
  std::optional<ViewShadowMaps> maps_;
  std::optional<CasterDraws> casters_;
  SharedTexture texels_;
  Table lights_, faces_;
  GlBuffer view_block_;
  GLuint triangles_ = 0;  // the frame's
  bool view_uploaded_ = false;
};

}  // namespace lightgrid
