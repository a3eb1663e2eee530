#include "image.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <future>
#include <thread>

// Functions of stb get internal linkage, because another part of the program may carry its own copy. The
// analyser sees only declarations, because findings within stb are not ours to fix.
#ifndef __clang_analyzer__
#ifndef __clang_analyzer__  // third-party code is not linted
#define STB_IMAGE_WRITE_IMPLEMENTATION
#endif
#define STB_IMAGE_WRITE_STATIC
#endif
#include <stb_image_write.h>

namespace gallery {

namespace {

std::uint8_t toByte(float value) {
    return static_cast<std::uint8_t>(std::lround(glm::clamp(value, 0.0F, 1.0F) * 255.0F));
}

// Calls visit(index, uv) once for every pixel; rows are shared among the cores. Pixels do not depend on each
// other, so the result does not depend on the number of threads.
void forEachPixel(int width, int height, const std::function<void(std::size_t, const glm::vec2&)>& visit) {
    const int threads = static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 16U));
    const auto rows = [&](int first) {
        for (int y = first; y < height; y += threads) {
            for (int x = 0; x < width; ++x) {
                visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                          static_cast<std::size_t>(x),
                      {(static_cast<float>(x) + 0.5F) / static_cast<float>(width),
                       (static_cast<float>(y) + 0.5F) / static_cast<float>(height)});
            }
        }
    };
    std::vector<std::future<void>> work;
    for (int thread = 1; thread < threads; ++thread) {
        work.push_back(std::async(std::launch::async, rows, thread));
    }
    rows(0);
}

}  // namespace

Image paint(int width, int height, int channels, const std::function<glm::vec4(const glm::vec2&)>& colorOf) {
    Image image{width, height, channels, {}};
    image.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                        static_cast<std::size_t>(channels));
    forEachPixel(width, height, [&](std::size_t index, const glm::vec2& uv) {
        const glm::vec4 color = colorOf(uv);
        for (int channel = 0; channel < channels; ++channel) {
            image.pixels[index * static_cast<std::size_t>(channels) + static_cast<std::size_t>(channel)] =
                toByte(color[channel]);
        }
    });
    return image;
}

HeightField sculpt(int size, const std::function<float(const glm::vec2&)>& heightOf) {
    HeightField field{size, {}};
    field.heights.resize(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
    forEachPixel(size, size,
                 [&](std::size_t index, const glm::vec2& uv) { field.heights[index] = heightOf(uv); });
    return field;
}

Image normalMap(const HeightField& field) {
    // These are central differences over two pixels of 1 / size each.
    const float scale = 0.5F * static_cast<float>(field.size);
    return paint(field.size, field.size, 3, [&](const glm::vec2& uv) {
        const int x = static_cast<int>(uv.x * static_cast<float>(field.size));
        const int y = static_cast<int>(uv.y * static_cast<float>(field.size));
        const float slopeRight = (field.at(x + 1, y) - field.at(x - 1, y)) * scale;
        const float slopeUp = (field.at(x, y - 1) - field.at(x, y + 1)) * scale;
        const glm::vec3 normal = glm::normalize(glm::vec3(-slopeRight, -slopeUp, 1.0F));
        return glm::vec4(normal * 0.5F + 0.5F, 1.0F);
    });
}

Environment paintEnvironment(int width, int height,
                             const std::function<glm::vec3(const glm::vec3&)>& radianceOf) {
    Environment environment{width, height, {}};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const float azimuth =
                ((static_cast<float>(x) + 0.5F) / static_cast<float>(width) - 0.5F) * glm::two_pi<float>();
            const float polar =
                (static_cast<float>(y) + 0.5F) / static_cast<float>(height) * glm::pi<float>();
            const float across = std::sin(polar);
            const glm::vec3 radiance =
                radianceOf({across * std::cos(azimuth), std::cos(polar), across * std::sin(azimuth)});
            environment.pixels.insert(environment.pixels.end(), {radiance.x, radiance.y, radiance.z});
        }
    }
    return environment;
}

namespace {

// A function for stb_image_write that appends to the vector `context`.
void append(void* context, void* data, int size) {
    auto* out = static_cast<std::vector<std::uint8_t>*>(context);
    const auto* begin = static_cast<const std::uint8_t*>(data);
    out->insert(out->end(), begin, begin + size);
}

}  // namespace

glint::Result<std::vector<std::uint8_t>> encodeHdr(const Environment& environment) {
    std::vector<std::uint8_t> bytes;
    if (stbi_write_hdr_to_func(append, &bytes, environment.width, environment.height, 3,
                               environment.pixels.data()) == 0) {
        return glint::makeError("hdr-encode", "", "cannot encode an environment without pixels",
                                "give it a width and a height");
    }
    return bytes;
}

glint::Result<std::vector<std::uint8_t>> encodePng(const Image& image) {
    if (image.width <= 0 || image.height <= 0 || image.channels <= 0) {
        return glint::makeError("png-encode", "", "cannot encode an image without pixels",
                                "give it a width, a height and channels");
    }
    std::vector<std::uint8_t> bytes;
    const int done = stbi_write_png_to_func(append, &bytes, image.width, image.height, image.channels,
                                            image.pixels.data(), image.width * image.channels);
    if (done == 0) {
        return glint::makeError("png-encode", "", "cannot encode a PNG of this size", "free some memory");
    }
    return bytes;
}

}  // namespace gallery
