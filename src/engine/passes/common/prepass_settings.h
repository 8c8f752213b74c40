// Light pre-pass (docs/techniques/light_prepass.md).
#pragma once

#include "plan/settings.h"

namespace lightgrid {

// The specular term that the light buffer keeps, its colour space, and the format of the image of normals.
enum class PrepassSpecular { plain, fifth_term, luminance, bent, stored };
enum class LightBufferColor { rgb, luv };
enum class NormalFormat { floats, octahedral, spheremap, xyz8 };

}  // namespace lightgrid

namespace lightgrid::setting {

inline const Setting<PrepassSpecular> prepass_specular{
    250,
    "prepass-specular",
    "how light_prepass finds a material's highlight from the sum of one fixed exponent: as it is; or raised "
    "to the material's exponent after division by a fifth term, by the luminance of the diffuse sum, or by a "
    "constant; stored: the sum has the material's exponent, from a roughness next to each normal",
    {{"plain", PrepassSpecular::plain},
     {"fifth-term", PrepassSpecular::fifth_term},
     {"luminance", PrepassSpecular::luminance},
     {"bent", PrepassSpecular::bent},
     {"stored", PrepassSpecular::stored}}};

inline const Setting<LightBufferColor> light_buffer_color{
    255,
    "light-buffer",
    "colours of light_prepass's light buffer: red, green and blue, or hue and luminance (CIE 1976 u', v' and "
    "Y)",
    {{"rgb", LightBufferColor::rgb}, {"luv", LightBufferColor::luv}}};

inline const Setting<int> prepass_shininess{260,
                                            "prepass-shininess",
                                            "specular exponent of the sums in the light buffer",
                                            {"32", "2", "8", "128", "512"}};

inline const Setting<NormalFormat> normals{
    270,
    "normals",
    "format of light_prepass's normals: floats; or 32 bits per pixel, as two numbers of 16 bits (octahedral, "
    "or a sphere map) or three of 8",
    {{"float", NormalFormat::floats},
     {"octahedral", NormalFormat::octahedral},
     {"spheremap", NormalFormat::spheremap},
     {"xyz8", NormalFormat::xyz8}}};

}  // namespace lightgrid::setting
