// Tests on a Vulkan device with synchronization validation: no test may leave a message.
#pragma once

#include "package_builder.h"

#include <glint/renderer.h>

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace glint::test {

// The arrays to which a SceneView points.
struct TestScene {
    struct Mesh {
        std::uint32_t mesh = 0;
        std::uint32_t primitive = 0;
        std::vector<std::array<float, 3>> positions;
        std::vector<std::uint32_t> indices;
    };
    struct Pixels {
        std::uint32_t width = 0;
        std::uint32_t height = 0;
        std::vector<std::uint8_t> bytes;
        ImageView::Format format = ImageView::Format::Rgba8;
        std::uint32_t levels = 1;
    };
    std::vector<Mesh> meshes;
    std::vector<InstanceView> instances;
    std::vector<Pixels> images;
    std::vector<LightView> lights;
    SceneView::TraversalOrder traversalOrder = SceneView::TraversalOrder::Auto;

    // The view is valid until a member changes.
    SceneView view();

private:
    std::vector<PrimitiveView> primitiveViews_;
    std::vector<ImageView> imageViews_;
};

// Returns a square of two triangles with side 2 in the plane z = `z`, counter-clockwise seen from +z.
TestScene::Mesh makeSquare(std::uint32_t mesh, std::uint32_t primitive, float z = 0.0F);
// Returns a scene of one such square, at z = 0.
TestScene squareScene();

using Rows = std::array<float, 12>;
inline constexpr Rows kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

// Returns a camera at z = `z` that looks at the origin.
CameraView makeCamera(float z);

class DeviceTest : public testing::Test {
protected:
    void SetUp() override;
    void TearDown() override;

    Context& context() {
        return *context_;
    }
    // Writes and loads a package.
    Package load(const PackageSpec& spec);
    // Fails the test and returns null if there is an error.
    std::unique_ptr<GpuScene> upload(const Package& package, TestScene& scene);
    std::unique_ptr<Renderer> makeRenderer(const Package& package, GpuScene& scene,
                                           package::Strategy strategy, std::uint32_t width,
                                           std::uint32_t height);

    TemporaryFolder folder_;
    std::unique_ptr<Context> context_;
};

}  // namespace glint::test
