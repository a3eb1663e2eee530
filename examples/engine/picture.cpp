#include "picture.h"

#include <stb_image_write.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <initializer_list>
#include <string_view>

namespace engine {
namespace {

// Reinhard's curve and the sRGB transfer function.
std::uint8_t display(float linear) {
    const float mapped = std::max(linear, 0.0F) / (1.0F + std::max(linear, 0.0F));
    const float coded =
        mapped <= 0.0031308F ? 12.92F * mapped : 1.055F * std::pow(mapped, 1.0F / 2.4F) - 0.055F;
    return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(coded, 0.0F, 1.0F)));
}

bool writePng(const Picture& picture, const std::string& file) {
    std::vector<std::uint8_t> bytes;
    for (const auto& pixel : picture.pixels) {
        for (std::size_t i = 0; i < 3; ++i) {
            bytes.push_back(display(pixel[i]));
        }
    }
    const auto width = static_cast<int>(picture.width);
    return stbi_write_png(file.c_str(), width, static_cast<int>(picture.height), 3, bytes.data(),
                          3 * width) != 0;
}

// An OpenEXR file of uncompressed scan lines (openexr.com, "OpenEXR File Layout"). It is little-endian, as
// the machines with Vulkan are.
class ExrFile {
public:
    template <typename T>
    void add(T value) {
        const auto* const from = reinterpret_cast<const char*>(&value);
        bytes.append(from, sizeof value);
    }

    void addText(std::string_view text) {
        bytes.append(text);
        bytes.push_back('\0');
    }

    template <typename T>
    void addAttribute(std::string_view name, std::string_view type, std::initializer_list<T> values) {
        addText(name);
        addText(type);
        add(static_cast<std::int32_t>(values.size() * sizeof(T)));
        for (const T value : values) {
            add(value);
        }
    }

    std::string bytes;
};

bool writeExr(const Picture& picture, const std::string& file) {
    constexpr std::string_view kChannels = "BGR";  // in the alphabet's order
    constexpr std::int32_t kFloat = 2;
    ExrFile exr;
    exr.add(std::int32_t{20000630});  // what every file begins with
    exr.add(std::int32_t{2});         // the version, of scan lines
    exr.addText("channels");
    exr.addText("chlist");
    exr.add(static_cast<std::int32_t>(kChannels.size() * 18 + 1));
    for (const char channel : kChannels) {
        exr.addText(std::string(1, channel));
        for (const std::int32_t value : {kFloat, 0, 1, 1}) {  // its type, not for perception, every pixel
            exr.add(value);
        }
    }
    exr.add('\0');
    const auto width = static_cast<std::int32_t>(picture.width);
    const auto height = static_cast<std::int32_t>(picture.height);
    exr.addAttribute<std::uint8_t>("compression", "compression", {0});
    exr.addAttribute<std::int32_t>("dataWindow", "box2i", {0, 0, width - 1, height - 1});
    exr.addAttribute<std::int32_t>("displayWindow", "box2i", {0, 0, width - 1, height - 1});
    exr.addAttribute<std::uint8_t>("lineOrder", "lineOrder", {0});
    exr.addAttribute<float>("pixelAspectRatio", "float", {1.0F});
    exr.addAttribute<float>("screenWindowCenter", "v2f", {0.0F, 0.0F});
    exr.addAttribute<float>("screenWindowWidth", "float", {1.0F});
    exr.add('\0');
    // The places of the lines in the file, then the lines: channel by channel.
    const std::size_t lineBytes = kChannels.size() * picture.width * sizeof(float);
    const std::size_t firstLine = exr.bytes.size() + picture.height * sizeof(std::uint64_t);
    for (std::uint64_t y = 0; y < picture.height; ++y) {
        exr.add(static_cast<std::uint64_t>(firstLine + y * (2 * sizeof(std::int32_t) + lineBytes)));
    }
    for (std::int32_t y = 0; y < height; ++y) {
        exr.add(y);
        exr.add(static_cast<std::int32_t>(lineBytes));
        for (const std::size_t channel : {2, 1, 0}) {
            for (std::size_t x = 0; x < picture.width; ++x) {
                exr.add(picture.pixels[static_cast<std::size_t>(y) * picture.width + x][channel]);
            }
        }
    }
    std::ofstream stream(file, std::ios::binary);
    stream.write(exr.bytes.data(), static_cast<std::streamsize>(exr.bytes.size()));
    return stream.good();
}

}  // namespace

void writePicture(const Picture& picture, const std::string& file) {
    const bool written = file.ends_with(".exr") ? writeExr(picture, file) : writePng(picture, file);
    if (!written) {
        fail("cannot write " + file);
    }
}

}  // namespace engine
