// Light pre-pass (docs/techniques/light_prepass.md).
#pragma once

#include "plan/settings.h"

namespace lightgrid {

// The specular term that the light buffer keeps, and the format of the image of normals.
enum class PrepassSpecular { plain, fifth_term, luminance, bent };
enum class NormalFormat { floats, octahedral, spheremap, xyz8 };

}  // namespace lightgrid

namespace lightgrid::setting {

inline const Setting<PrepassSpecular> prepass_specular{
    250,
    "prepass-specular",
    "the specular term of the light buffer: of the lights' shininess; or raised to the material's, after "
    "division by a fifth term, by the luminance of the diffuse ones, or as it is",
    {{"plain", PrepassSpecular::plain},
     {"fifth-term", PrepassSpecular::fifth_term},
     {"luminance", PrepassSpecular::luminance},
     {"bent", PrepassSpecular::bent}}};

inline const Setting<int> prepass_shininess{260,
                                            "prepass-shininess",
                                            "the lights' specular exponent in the light buffer",
                                            {"32", "2", "8", "128", "512"}};

inline const Setting<NormalFormat> normals{270,
                                           "normals",
                                           "the image of normals: floats, or 32 bits per pixel: two of 16 "
                                           "(octahedral, or a sphere map), or three of 8",
                                           {{"float", NormalFormat::floats},
                                            {"octahedral", NormalFormat::octahedral},
                                            {"spheremap", NormalFormat::spheremap},
                                            {"xyz8", NormalFormat::xyz8}}};

}  // namespace lightgrid::setting
