// The light buffer of a light pre-pass renderer (Engel, "Designing a Renderer for Multiple Lights: The Light
// Pre-Pass Renderer", ShaderX7, 2009): sums over point and spot lights of what depends on light, normal and
// viewer alone, and the radiance of a material under them (docs/details/light_prepass.md#equations).
//   LAMBERT: no specular term.
//   PREPASS_FIFTH_TERM, PREPASS_LUMINANCE, PREPASS_BENT, PREPASS_STORED: how the material's shininess takes part
//   (prepass-specular); without any of them it does not.
//   SKIN, MINNAERT: materials of these models take the luminance of the sums for the cosine, as the article's
//   appendix has it (docs/details/light_prepass.md#skin-and-minnaert).
#pragma once

#include "shared/punctual_light.h"

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

// Largest sum that a material takes: its products with lobes stay finite.
#define LARGEST_LIGHT 1e30f

// A light's part in the sums. n: the lights' exponent, with PREPASS_STORED the material's; I: the largest channel of the radiant intensity, which
// stands for a colourless light; g: (1 - v.h)^5, Schlick's term.
SHARED_STRUCT(LightTerms) {
  Real3 diffuse;  // channels 1 to 3: n.l attenuation (1 - g) radiant intensity
  real specular;  // channel 4: n.l (n.h)^n attenuation I
  real weight;    // channel 5: n.l attenuation I
  real rim;       // channel 6: channel 4 times g
};

// The material pass reads these beside the light buffer.
SHARED_STRUCT(LightBufferParams) {
  real exponent;   // n; not read with PREPASS_STORED
  real reference;  // a light of this size is 1 to equation 8.5.7: the scale of buffers in fixed point
};

// normal and to_viewer are unit vectors.
SHARED_FUNCTION LightTerms light_terms(Real3 normal, Real3 to_viewer, Arrival arrival, PunctualLight light,
                                       real exponent) {
  LightTerms t;
  real n_dot_l = min_real(max_real(dot3(normal, arrival.to_light), REAL(0.0f)), REAL(1.0f));
  // Finite; only the last products, with intensities, may overflow: to infinity, never to NaN.
  real arriving = arrival.attenuation * n_dot_l;
#ifdef LAMBERT
  real diffuse = arriving;
  t.specular = REAL(0.0f);
  t.weight = REAL(0.0f);
  t.rim = REAL(0.0f);
#else
  Real3 h = add3(arrival.to_light, to_viewer);
  real h_squared = max_real(dot3(h, h), REAL(1e-8f));
  Real3 across = cross3(normal, h);
  real facing = dot3(normal, h) * n_dot_l;
  real lobe = facing > REAL(0.0f) ? arriving * power_of_cosine(exponent, h_squared, dot3(across, across))
                                  : REAL(0.0f);
  real grazing = max_real(mad_real(-0.5f, sqrt_real(h_squared), 1.0f), REAL(0.0f));
  real grazing2 = grazing * grazing;
  real grazing5 = grazing2 * grazing2 * grazing;
  real intensity =
      max_real(REAL(light.color.x TINTED(arrival, x)),
               max_real(REAL(light.color.y TINTED(arrival, y)), REAL(light.color.z TINTED(arrival, z))));
  real diffuse = arriving * (1.0f - grazing5);
  t.specular = lobe * intensity;
  t.weight = arriving * intensity;
  t.rim = lobe * grazing5 * intensity;
#endif
  t.diffuse = real3(diffuse * light.color.x TINTED(arrival, x), diffuse * light.color.y TINTED(arrival, y),
                    diffuse * light.color.z TINTED(arrival, z));
  return t;
}

// The same of a light at a point of view space.
SHARED_FUNCTION LightTerms terms_at(Real3 position, Real3 normal, Real3 to_viewer, Arrival arrival,
                                    PunctualLight light, real exponent) {
#ifdef LIT_BY_EFFECTS
  if (effects_light(OF_LIGHT(light), false)) {
    Real3 to_light = offset_to_light(position, light);
    LitTerms lit = effects_terms(OF_LIGHT(light), normal, to_viewer, exponent, to_light);
    real share = part_besides_distance(arrival, to_light);
    real intensity =
        max_real(REAL(light.color.x TINTED(arrival, x)),
                 max_real(REAL(light.color.y TINTED(arrival, y)), REAL(light.color.z TINTED(arrival, z))));
    real diffuse = lit.diffuse * share;
    LightTerms t;
    t.diffuse = real3(diffuse * light.color.x TINTED(arrival, x), diffuse * light.color.y TINTED(arrival, y),
                      diffuse * light.color.z TINTED(arrival, z));
    t.specular = lit.specular * share * intensity;
    t.weight = lit.weight * share * intensity;
    t.rim = lit.rim * share * intensity;
    return t;
  }
#endif
  return light_terms(normal, to_viewer, arrival, light, exponent);
}

SHARED_FUNCTION LightTerms add_terms(LightTerms a, LightTerms b) {
  LightTerms t;
  t.diffuse = add3(a.diffuse, b.diffuse);
  t.specular = a.specular + b.specular;
  t.weight = a.weight + b.weight;
  t.rim = a.rim + b.rim;
  return t;
}

SHARED_FUNCTION LightTerms no_terms() {
  LightTerms t;
  t.diffuse = real3(REAL(0.0f), REAL(0.0f), REAL(0.0f));
  t.specular = REAL(0.0f);
  t.weight = REAL(0.0f);
  t.rim = REAL(0.0f);
  return t;
}

SHARED_FUNCTION real finite_light(real x) { return min_real(x, REAL(LARGEST_LIGHT)); }

SHARED_FUNCTION LightTerms finite_terms(LightTerms t) {
  LightTerms f;
  f.diffuse = real3(finite_light(t.diffuse.x), finite_light(t.diffuse.y), finite_light(t.diffuse.z));
  f.specular = finite_light(t.specular);
  f.weight = finite_light(t.weight);
  f.rim = finite_light(t.rim);
  return f;
}

#if defined(PREPASS_LUMINANCE) || defined(PREPASS_STORED)
#define READS_LUMINANCE
#elif defined(SKIN) || defined(MINNAERT)
#define READS_LUMINANCE
#endif
#ifdef READS_LUMINANCE
SHARED_FUNCTION real luminance_of_terms(LightTerms t) {
  return 0.2126f * t.diffuse.x + 0.7152f * t.diffuse.y + 0.0722f * t.diffuse.z;
}
#endif

// The light that the models of the appendix take for a cosine of 1, of the reference light: as bright as the
// brightest light is at half its range, not at an eighth.
#define LIGHT_OF_COSINE_1 0.0625f

// The light that a surface reflects diffusely, without a coat over it. The sums are finite.
#if defined(SKIN) || defined(MINNAERT)
SHARED_FUNCTION Real3 diffuse_of_terms(ShadingPoint p, LightTerms t, LightBufferParams of) {
  real cosine = min_real(luminance_of_terms(t) / (LIGHT_OF_COSINE_1 * of.reference), REAL(1.0f));
  Real3 reflectance = DIFFUSE_AT(p, cosine);
#ifdef SKIN
  // The article's term is not 0 at a luminance of 0. At most the light that arrives leaves elsewhere.
  real rolled = smooth_step_of((cosine + p.roll_off) * p.roll_scale) - smooth_step_of(cosine);
  real share = min_real(max_real(rolled, REAL(0.0f)) / max_real(cosine, REAL(1e-30f)), REAL(1.0f));
  reflectance = add3(reflectance, scale3(p.subsurface, share));
#endif
  return real3(reflectance.x * t.diffuse.x, reflectance.y * t.diffuse.y, reflectance.z * t.diffuse.z);
}
#else
SHARED_FUNCTION Real3 diffuse_of_terms(ShadingPoint p, LightTerms t, LightBufferParams of) {
  return real3(p.diffuse.x * t.diffuse.x, p.diffuse.y * t.diffuse.y, p.diffuse.z * t.diffuse.z);
}
#endif

#ifndef LAMBERT
SHARED_FUNCTION real shininess_of(real alpha_squared) { return 2.0f / alpha_squared - 2.0f; }

// The exponent of a material of this perceptual roughness, as its lobe has it.
SHARED_FUNCTION real shininess_of_roughness(real roughness) {
  real perceptual = max_real(roughness, REAL(ROUGHNESS_FLOOR));
  real alpha = perceptual * perceptual;
  return shininess_of(alpha * alpha);
}

// base^exponent for a base in [0, 1].
SHARED_FUNCTION real power_of_unit(real base, real exponent) {
  return power_of(min_real(max_real(base, REAL(1e-30f)), REAL(1.0f)), exponent);
}

// A sum of highlights of this exponent, times the lobe's normalisation.
SHARED_FUNCTION real normalised_highlight(real highlight, real shininess) {
  return highlight * (shininess + 2.0f) * (0.125f / SHADING_PI);
}

// Channel 4 with the exponent of a material of this alpha^2, normalised.
SHARED_FUNCTION real highlight_of(LightTerms t, real alpha_squared, LightBufferParams of) {
  real shininess = shininess_of(alpha_squared);
#if defined(PREPASS_FIFTH_TERM)
  real highlight =
      t.weight * power_of_unit(t.specular / max_real(t.weight, REAL(1e-30f)), shininess / of.exponent);
#elif defined(PREPASS_LUMINANCE) || defined(PREPASS_STORED)
  real luminance = luminance_of_terms(t);
  real highlight =
      luminance * power_of_unit(t.specular / max_real(luminance, REAL(1e-30f)), shininess / of.exponent);
#elif defined(PREPASS_BENT)
  real bent = of.reference * power_of_unit(t.specular / of.reference, shininess / of.exponent);
  real highlight = t.specular > REAL(0.0f) ? bent : REAL(0.0f);  // 0^0 too
#else
  shininess = of.exponent;
  real highlight = t.specular;
#endif
  return normalised_highlight(highlight, shininess);
}
#endif

// Radiance of a surface without base lighting. The terms are sums of light_terms.
SHARED_FUNCTION Real3 light_of_terms(ShadingPoint p, LightTerms sums, LightBufferParams of) {
  LightTerms t = finite_terms(sums);
  Real3 diffuse = diffuse_of_terms(p, t, of);
#ifdef SPECULAR
  // The sums hold 1 - g, also for the part that no reflection takes away.
  diffuse = scale3(diffuse, p.diffuse_facing + p.diffuse_always);
#endif
#ifdef LAMBERT
  return diffuse;
#else
#ifdef PREPASS_STORED
  // The sum has the exponent of the base. Only a coat needs another one.
  real shininess = shininess_of(p.lobe.alpha_squared);
  of.exponent = max_real(shininess, REAL(1.0f));
  real highlight = normalised_highlight(t.specular, shininess);
#else
  real highlight = highlight_of(t, p.lobe.alpha_squared, of);
#endif
  // Schlick's term: the mean over the highlight, or that of a half vector along the normal.
#ifdef PREPASS_FIFTH_TERM
  real share = min_real(t.rim / max_real(t.specular, REAL(1e-30f)), REAL(1.0f));
#else
  real grazing = max_real(1.0f - p.lobe.n_dot_v, REAL(0.0f));
  real share = grazing * grazing * grazing * grazing * grazing;
#endif
  real rim = highlight * share, facing = highlight * (1.0f - share);
#ifdef SPECULAR
  rim = rim * p.f90;
#endif
  Real3 base = real3(diffuse.x + p.f0.x * facing + rim, diffuse.y + p.f0.y * facing + rim,
                     diffuse.z + p.f0.z * facing + rim);
#ifdef CLEARCOAT
  // The coat reflects about the base's normal, the only one that the light buffer has.
  real coat = p.coat * highlight_of(t, p.coat_lobe.alpha_squared, of);
  base = add3(UNDER_COAT(p, base), real3(coat, coat, coat));
#endif
  return base;
#endif
}

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
