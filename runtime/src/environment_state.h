// What the renderer sees of an Environment.
#pragma once

#include "resources.h"
#include "sky_harmonics.h"

#include <glint/environment.h>

namespace glint {

// Members are destroyed in reverse: the pool's memory last.
struct Environment::State {
    explicit State(Context::State& contextState) : context(contextState), pool(contextState) {}

    Context::State& context;
    MemoryPool pool;
    DeviceImage map;  // a mip a level; layout SHADER_READ_ONLY_OPTIMAL
    UniqueSampler sampler;
    float scale = 1.0F;  // radiance of a texel's 1
    SkyHarmonics harmonics{};
    Statistics statistics;
};

}  // namespace glint
