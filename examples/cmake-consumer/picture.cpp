#include "picture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>

namespace {

constexpr std::uint32_t kWidth = 320;
constexpr std::uint32_t kHeight = 180;

// Applies the transfer function of IEC 61966-2-1.
char toSrgb(float linear) {
    const float light = std::clamp(linear, 0.0F, 1.0F);
    const float encoded =
        light <= 0.0031308F ? 12.92F * light : 1.055F * std::pow(light, 1.0F / 2.4F) - 0.055F;
    return static_cast<char>(static_cast<std::uint8_t>(std::lround(255.0F * encoded)));
}

}  // namespace

glint::Result<glint::LinearImage> renderPicture(glint::Context& context, const glint::Package& package,
                                                const glint::SceneView& scene) {
    const auto uploaded = glint::GpuScene::upload(context, package, scene);
    if (!uploaded) {
        return uploaded.error();
    }
    const auto renderer = glint::Renderer::create(context, package, **uploaded,
                                                  {glint::package::kStrategyVisibility, kWidth, kHeight});
    if (!renderer) {
        return renderer.error();
    }
    glint::FrameOptions frame;
    frame.camera.position = {0.0F, 2.2F, 5.5F};
    frame.camera.forward = {0.0F, -0.316F, -0.949F};
    frame.camera.up = {0.0F, 0.949F, -0.316F};
    frame.camera.halfHeight = 0.36F;
    frame.camera.halfWidth = frame.camera.halfHeight * kWidth / kHeight;
    return (*renderer)->render(frame);
}

glint::Status writePicture(const glint::LinearImage& image, const std::string& path) {
    std::ofstream file(path, std::ios::binary);
    file << "P6\n" << image.width << ' ' << image.height << "\n255\n";
    for (const std::array<float, 4>& pixel : image.pixels) {
        const std::array<char, 3> color{toSrgb(pixel[0]), toSrgb(pixel[1]), toSrgb(pixel[2])};
        file.write(color.data(), color.size());
    }
    file.close();
    return file ? glint::okStatus() : glint::makeError("picture-write", path, "can't be written");
}
