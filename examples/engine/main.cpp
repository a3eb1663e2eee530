// A small renderer that uses Glint for its materials and its reflections, and nothing of Glint's scene or
// frame.
#include "frame.h"
#include "gpu.h"
#include "world.h"

#include <stb_image_write.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <string>
#include <vector>

namespace {

// Reinhard's curve and the sRGB transfer function.
std::uint8_t display(float linear) {
    const float mapped = std::max(linear, 0.0F) / (1.0F + std::max(linear, 0.0F));
    const float coded =
        mapped <= 0.0031308F ? 12.92F * mapped : 1.055F * std::pow(mapped, 1.0F / 2.4F) - 0.055F;
    return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(coded, 0.0F, 1.0F)));
}

// Turns all instances but the first, which is the floor, about their own vertical axis.
std::vector<std::array<float, 12>> turned(const engine::World& world, float angle) {
    std::vector<std::array<float, 12>> transforms;
    const float cosine = std::cos(angle);
    const float sine = std::sin(angle);
    for (const engine::Instance& instance : world.instances) {
        std::array<float, 12> rows = instance.objectToWorld;
        for (std::size_t row = 0; &instance != world.instances.data() && row < 3; ++row) {
            const float x = rows[4 * row];
            const float z = rows[4 * row + 2];
            rows[4 * row] = cosine * x - sine * z;
            rows[4 * row + 2] = sine * x + cosine * z;
        }
        transforms.push_back(rows);
    }
    return transforms;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 5) {
        std::cerr << "usage: engine SCENE.gltf PACKAGE SHADERS OUTPUT.png [full|compact] [FRAMES]\n"
                     "Renders frames of a scene, in which all but the floor turns, and writes the last.\n";
        return 2;
    }
    const auto format =
        argc > 5 && std::string(argv[5]) == "compact" ? engine::Format::Compact : engine::Format::Full;
    const int frames = argc > 6 ? std::max(std::atoi(argv[6]), 1) : 1;
    const glint::Result<glint::Package> package = glint::Package::load(std::filesystem::path(argv[2]));
    if (!package) {
        engine::fail(toString(package.error()));
    }
    engine::FrameSettings settings;
    engine::Gpu gpu(false);
    const engine::World world = engine::readGltf(
        argv[1], format, static_cast<float>(settings.width) / static_cast<float>(settings.height));
    engine::Picture picture;
    {
        engine::Engine engine(gpu, *package, world, argv[3], settings);
        const auto begin = std::chrono::steady_clock::now();
        for (int i = 0; i < frames; ++i) {
            engine.frame(turned(world, 0.05F * static_cast<float>(i)));
        }
        picture = engine.picture();
        const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - begin;
        std::cout << frames << " frames, " << elapsed.count() / frames << " ms each, " << engine.rays()
                  << " reflection rays\n";
    }
    std::vector<std::uint8_t> bytes;
    for (const auto& pixel : picture.pixels) {
        for (std::size_t i = 0; i < 3; ++i) {
            bytes.push_back(display(pixel[i]));
        }
    }
    const auto width = static_cast<int>(picture.width);
    if (stbi_write_png(argv[4], width, static_cast<int>(picture.height), 3, bytes.data(), 3 * width) == 0) {
        engine::fail(std::string("cannot write ") + argv[4]);
    }
    return 0;
}
