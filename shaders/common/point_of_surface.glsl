// From the surface at a fragment to the point that light is reflected at. After surface.glsl,
// position.glsl and shared/brdf.h.
#include "shaders/common/fragment_place.glsl"

#ifdef HAS_SURFACE_VALUES
#include "shaders/common/number_of_draw.glsl"
#endif

ShadingPoint point_of_surface(Surface s) {
  vec3 place = fragment_place();
  vec3 position = position_of_pixel(place.xy, place.z);
  vec3 to_viewer = direction_to_viewer(position);
  ShadingPoint p = shading_point(position, to_viewer, s.normal, s.base_color, s.metallic, s.roughness);
#ifdef HAS_SURFACE_VALUES
  p.surface = values_of_surface(int(surface_number_of_draw));
#endif
#ifdef SPECULAR
  p = with_specular(p, s.metallic, s.f0, s.f90);
#endif
#ifdef SKIN
  p = with_skin(p, s.subsurface, s.roll_off);
#endif
#ifdef MINNAERT
  p = with_minnaert(p, to_viewer, s.minnaert_k);
#endif
#ifdef CLEARCOAT
  p = with_coat(p, s.coat_normal, s.coat, s.coat_roughness);
#endif
  return p;
}
