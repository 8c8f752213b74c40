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
    "what goes to the host, where a frame's time ends: the image as floats, or the bytes of a display, "
    "tone-mapped at its exposure",
    {{"float", PictureFormat::floats}, {"bytes", PictureFormat::bytes}},
    {.common = true, .shown = [](const Settings& s) { return s[picture] == PictureFormat::bytes; }}};

// Exposure of pictures, in stops, by which steps of the display are counted and pictures become bytes; none:
// it is chosen from the picture.
inline const Setting<std::optional<double>> display_ev{0.0};

}  // namespace lightgrid::setting
