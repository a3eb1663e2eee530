// Renders the materials of a comparison with Glint.
#pragma once

#include "oracle/spec/views.h"
#include "render/harness.h"

#include <glint/environment.h>

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <tuple>
#include <vector>

namespace glint::spec {

// The mean over a picture's pixels, all of which show the same, and its standard error.
struct Measured {
    Vec3 mean{0.0};
    Vec3 error{0.0};
};

struct DeviceOptions {
    bool compensation = true;
    std::uint32_t size = 32;  // pixels, of a square picture
    std::uint32_t samples = 16;
};

// One package with all materials in one case, one scene and one renderer.
class Device {
public:
    Device(const Rows& rows, const DeviceOptions& options);
    ~Device();

    // The image is that of the map's texels.
    static std::unique_ptr<Environment> makeEnvironment(const Map& map);

    // What a view of a plane shows under the lights alone. One sample, because nothing is random. The picture
    // is made once.
    Measured underLights(std::size_t row, const View& view, const Environment& any);
    // What it shows under the map alone.
    Measured underMap(std::size_t row, const View& view, const Environment& map, Transport transport);

    // What a sphere shows of the map, by zone. Pixels with n·v below 0.1 are left out.
    std::array<Measured, 3> onSphere(std::size_t row, const Environment& map, Transport transport);

private:
    LinearImage picture(const Vec3& center, const Vec3& direction, float halfWidth, FrameOptions frame,
                        std::uint32_t samples);
    Measured render(std::size_t row, const View& view, FrameOptions frame, std::uint32_t samples);

    DeviceOptions options_;
    std::size_t rowCount_ = 0;
    std::map<std::tuple<std::size_t, double, double>, Measured> lit_;  // by row and view
    std::unique_ptr<testing::LoadedScene> loaded_;
    std::unique_ptr<Renderer> renderer_;
};

}  // namespace glint::spec
