// The picture that goes to the host.
#pragma once

#include "plan/settings.h"

namespace lightgrid {

// The part of a frame that goes to the host: linear light, or the bytes that a display shows
// (passes/tone_map.h).
enum class PictureFormat { floats, bytes };

}  // namespace lightgrid

namespace lightgrid::setting {

inline const Setting<PictureFormat> picture{
    650,
    "picture",
    "what is copied to the host at the end of a frame: the image in floats, or the tone-mapped bytes of a "
    "display",
    {{"float", PictureFormat::floats}, {"bytes", PictureFormat::bytes}},
    {.common = true, .shown = [](const Settings& s) { return s[picture] == PictureFormat::bytes; }}};

// Exposure of pictures, in stops, by which steps of the display are counted and pictures become bytes; none:
// it is chosen from the picture.
inline const Setting<std::optional<double>> display_ev{0.0};

}  // namespace lightgrid::setting
