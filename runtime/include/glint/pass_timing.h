// The times of a frame's passes.
#pragma once

#include <cstdint>
#include <string>

namespace glint {

// The part of a frame that a time belongs to. docs/design.md explains it in "Passes of a frame".
enum class Pass : std::uint32_t {
    Frame,  // the whole frame, with Timing::Frame
    Hits,   // a round of rays, from their list to their shaded hits, with Timing::Frame
    Gbuffer,
    Lighting,
    EffectWalk,
    EffectRays,
    PathRays,
    RayDispatch,
    Trace,
    Count,
    Offset,
    Copy,
    CheckOrder,
    Shade,  // the shading of hits, except in passes of one case
    ShadeCase,
    ShadowDispatch,
    Shadow,
    Compose,
};

struct PassTiming {
    std::string name;  // for people; it is also the debug label of the pass
    double milliseconds = 0.0;
    Pass pass = Pass::Frame;
    std::uint32_t shaderId = 0;  // the shader ID of Pass::ShadeCase
};

}  // namespace glint
