#include "oracle/scene/picture.h"

#include <algorithm>
#include <atomic>
#include <thread>

namespace glint::oracle {
namespace {

template <class PixelAt>
Picture pictureOf(const View& view, const PixelAt& pixelAt) {
    Picture picture{view.width(), view.height(), {}};
    picture.pixels.resize(static_cast<std::size_t>(view.width()) * view.height());
    forRows(view.height(), [&](std::uint32_t y) {
        for (std::uint32_t x = 0; x < view.width(); ++x) {
            picture.pixels[static_cast<std::size_t>(y) * view.width() + x] = pixelAt(x, y);
        }
    });
    return picture;
}

}  // namespace

void forRows(std::uint32_t count, const std::function<void(std::uint32_t)>& row, std::uint32_t threads) {
    std::atomic<std::uint32_t> next = 0;
    std::vector<std::jthread> workers(threads > 0 ? threads
                                                  : std::max(std::thread::hardware_concurrency(), 1U));
    for (std::jthread& thread : workers) {
        thread = std::jthread([&] {
            for (std::uint32_t y = next++; y < count; y = next++) {
                row(y);
            }
        });
    }
}

View viewOf(const CameraView& camera, std::uint32_t width, std::uint32_t height) {
    const Vec3 forward = toVec(camera.forward);
    const Vec3 up = toVec(camera.up);
    return {{toVec(camera.position), forward},
            glm::cross(forward, up) * static_cast<double>(camera.halfWidth),
            up * static_cast<double>(camera.halfHeight),
            camera.orthographic,
            camera.near,
            width,
            height};
}

Picture centrePicture(const SceneRenderer& renderer, const View& view) {
    return samplePicture(renderer, view, 1);
}

Picture samplePicture(const SceneRenderer& renderer, const View& view, std::uint32_t count) {
    constexpr double kRoot = 1.32471795724474602596;
    return pictureOf(view, [&](std::uint32_t x, std::uint32_t y) {
        Pixel pixel;
        for (std::uint32_t i = 0; i < count; ++i) {
            const Vec2 point =
                glm::fract(Vec2(0.5) + static_cast<double>(i) * Vec2(1.0 / kRoot, 1.0 / (kRoot * kRoot)));
            const CameraLight light = renderer.radiance(view.ray(x + point.x, y + point.y));
            pixel.mean += light.mean / static_cast<double>(count);
            pixel.variance += light.variance / static_cast<double>(count);
        }
        return pixel;
    });
}

Picture meanPicture(const SceneRenderer& renderer, const View& view, const Strata& strata) {
    return pictureOf(view, [&](std::uint32_t x, std::uint32_t y) {
        Random random(static_cast<std::uint64_t>(y) << 32U | x);
        Vec3 chance(0.0);
        double points = 0.0;
        const Estimate light = average(strata, random, [&](Vec2 point) {
            const CameraLight found = renderer.radiance(view.ray(x + point.x, y + point.y));
            chance += found.variance;
            points += 1.0;
            return found.mean;
        });
        return Pixel{light.mean, light.error,
                     glm::max(light.square - light.mean * light.mean, Vec3(0.0)) + chance / points};
    });
}

LinearImage toImage(const Picture& picture) {
    LinearImage image{picture.width, picture.height, {}};
    for (const Pixel& pixel : picture.pixels) {
        image.pixels.push_back({static_cast<float>(pixel.mean.x), static_cast<float>(pixel.mean.y),
                                static_cast<float>(pixel.mean.z), 1.0F});
    }
    return image;
}

}  // namespace glint::oracle
