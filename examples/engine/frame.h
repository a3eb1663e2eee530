// The engine's frames: a G-buffer, lighting with Glint's library, reflections by Glint's steps, two in
// flight.
#pragma once

#include "gpu.h"
#include "world.h"

#include <glint/package.h>

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace engine {

struct FrameSettings {
    std::uint32_t width = 640;
    std::uint32_t height = 360;
    glint::package::Strategy strategy = glint::package::kStrategyVisibility;
    // Times of Glint's steps and of the engine's own shadow rays.
    glint::package::Tracer tracer = glint::package::kTracerRayQuery;
};

struct Picture {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::array<float, 4>> pixels;  // linear, the first row on top
};

class Engine {
public:
    // `shaders` is the folder with the engine's SPIR-V.
    Engine(Gpu& gpu, const glint::Package& package, const World& world, const std::string& shaders,
           const FrameSettings& settings);
    ~Engine();
    Engine(const Engine&) = delete;
    Engine& operator=(const Engine&) = delete;

    // Submits one frame, with the instances where `transforms` has them (objectToWorld of each). It waits
    // only if two frames are in flight.
    void frame(const std::vector<std::array<float, 12>>& transforms);
    // Waits for all frames and returns the last one's picture.
    Picture picture();
    // Rays of the last frame, which must be complete.
    std::uint32_t rays();

    struct State;

private:
    std::unique_ptr<State> state_;
};

}  // namespace engine
