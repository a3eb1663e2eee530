// The part of an Environment that the renderer sees.
#pragma once

#include "context/resources.h"
#include "sky/radiance_map.h"

#include <glint/environment.h>

namespace glint {

// Members are destroyed in reverse order: the pool's memory last.
struct Environment::State {
    explicit State(Context::State& contextState) : context(contextState), pool(contextState, "environment") {}

    VkDescriptorImageInfo image() const {
        return {sampler.get(), map.view.get(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    }

    Context::State& context;
    MemoryPool pool;
    DeviceImage map;  // one mip for each level; layout SHADER_READ_ONLY_OPTIMAL
    UniqueSampler sampler;
    // If statistics.sampled: the distribution of the map's light (sky_counts.h).
    Buffer counts;
    std::uint32_t countColumns = 0;
    std::uint32_t countRows = 0;
    float scale = 1.0F;  // radiance that a texel value of 1 stands for
    SkyHarmonics harmonics{};
    Statistics statistics;
};

}  // namespace glint
