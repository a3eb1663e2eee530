// A scene whose frames have layers, and which may move from frame to frame.
#pragma once

#include "render/harness.h"

#include <cstdint>
#include <map>
#include <memory>
#include <string>

namespace glint::testing {

// All layers of a renderer's last recording, on the host.
class LayerSet {
public:
    // Fails the test for each that can't be read.
    explicit LayerSet(Renderer& renderer);

    // Pixels are numbered row by row. A layer that is not there fails the test.
    float at(const std::string& layer, std::size_t pixel, std::size_t component) const;
    std::uint32_t integer(const std::string& layer, std::size_t pixel) const;
    double sum(const std::string& layer) const;

    std::uint32_t width = 0;
    std::uint32_t height = 0;

private:
    const LayerValues& find(const std::string& layer) const;
    std::map<std::string, LayerValues> layers_;
};

// Keeps its renderer, so that each frame has the one before.
class LayeredScene : public PosedScene {
public:
    LayeredScene(const gltf::Scene& posed, const compiler::CompileSettings& settings, std::uint32_t width,
                 std::uint32_t height);

    Renderer& renderer() {
        return *renderer_;
    }
    // Draws a frame of one sample with the first camera, after the device has taken over the current pose of
    // `scene`.
    LinearImage render();

    FrameOptions frame;  // the camera of the last frame

private:
    std::unique_ptr<Renderer> renderer_;
    double aspect_ = 1.0;
};

}  // namespace glint::testing
