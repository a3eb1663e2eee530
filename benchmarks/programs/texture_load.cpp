// glint_texture_load: measures how much processor time the images of scenes take until a device can have
// them, and how much memory they take there. Rounds of the scenes alternate. It can also write the images of
// a scene as PNG, to compare the same picture in two kinds of files.
#include "gltf/codecs/codecs.h"
#include "gltf/import.h"
#include "gltf/texels/levels.h"
#include "image/image_file.h"
#include "program.h"

#include <glint/session/textures.h>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <sys/resource.h>
#include <vector>

namespace glint {

namespace {

struct Arguments {
    std::vector<std::string> scenes;
    int rounds = 5;
    bool compress = false;
    bool unpack = false;
    std::string png;
};

double processorMilliseconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto milliseconds = [](const timeval& time) {
        return 1e3 * static_cast<double>(time.tv_sec) + 1e-3 * static_cast<double>(time.tv_usec);
    };
    return milliseconds(usage.ru_utime) + milliseconds(usage.ru_stime);
}

// The formats of most desktop devices.
TexelFormats desktopFormats(bool blocks) {
    using enum TexelFormat;
    TexelFormats formats;
    for (const TexelFormat format : {Rgba8, Rgba16, Bc1, Bc2, Bc3, Bc4, Bc5, Bc7}) {
        if (isBlockFormat(format) && !blocks) {
            continue;
        }
        formats.add(format, false);
        if (infoOf(format).hasSrgb) {
            formats.add(format, true);
        }
    }
    return formats;
}

struct Round {
    double processorMs = 0.0;
    std::uint64_t texels = 0;
    std::uint64_t bytes = 0;
    std::map<std::string, int> formats;
};

Result<Round> load(const std::string& file, const Arguments& arguments) {
    const double begin = processorMilliseconds();
    GLINT_TRY(const auto scene, gltf::importScene(file, {.keepImageFiles = true}));
    session::TextureOptions options;
    options.fit.formats = desktopFormats(!arguments.unpack);
    options.fit.compress = arguments.compress;
    GLINT_TRY(const auto textures, session::loadTextures(scene, options));
    Round round;
    round.processorMs = processorMilliseconds() - begin;
    for (const gltf::FittedImage& image : textures->images) {
        ++round.formats[infoOf(image.format).name];
        round.texels += pixelCount(image, 0);
        // The device makes the levels that texels lack.
        const int levels =
            isBlockFormat(image.format) ? image.levels : gltf::fullLevels(image.width, image.height);
        for (int level = 0; level < levels; ++level) {
            round.bytes += levelBytes(image, image.format, level);
        }
    }
    return round;
}

// Writes red, green and blue of the images of a scene.
Status writePngs(const std::string& file, const std::filesystem::path& folder) {
    GLINT_TRY(const auto scene, gltf::importScene(file, {.decodeImages = true}));
    for (const gltf::Image& image : scene.images) {
        image::DisplayImage picture{
            static_cast<std::uint32_t>(image.width), static_cast<std::uint32_t>(image.height), {}};
        for (std::size_t i = 0; i < pixelCount(image, 0); ++i) {
            picture.pixels.push_back({image.pixels[4 * i], image.pixels[4 * i + 1], image.pixels[4 * i + 2]});
        }
        const std::string name = std::filesystem::path(image.name).stem().string() + ".png";
        GLINT_TRY_DO(image::writeImage(folder / name, picture));
    }
    return okStatus();
}

Status run(const Arguments& arguments) {
    if (!arguments.png.empty()) {
        return writePngs(arguments.scenes.front(), arguments.png);
    }
    std::vector<std::vector<double>> times(arguments.scenes.size());
    std::vector<Round> last(arguments.scenes.size());
    for (int round = 0; round < arguments.rounds; ++round) {
        for (std::size_t i = 0; i < arguments.scenes.size(); ++i) {
            GLINT_TRY(last[i], load(arguments.scenes[i], arguments));
            times[i].push_back(last[i].processorMs);
        }
    }
    for (std::size_t i = 0; i < arguments.scenes.size(); ++i) {
        std::ranges::sort(times[i]);
        std::string formats;
        for (const auto& [name, count] : last[i].formats) {
            formats += fmt::format(" {} {}", count, name);
        }
        fmt::print(
            "{}: {:.0f} ms of processor time ({:.0f} to {:.0f}), {} texels, {} bytes, {:.2f} a texel;{}\n",
            arguments.scenes[i], times[i][times[i].size() / 2], times[i].front(), times[i].back(),
            last[i].texels, last[i].bytes,
            static_cast<double>(last[i].bytes) /
                static_cast<double>(std::max<std::uint64_t>(last[i].texels, 1)),
            formats);
    }
    return okStatus();
}

}  // namespace

}  // namespace glint

int main(int count, char** words) {
    glint::Arguments arguments;
    return glint::benchmarks::runProgram(
        "Measures how long the images of scenes take to load, and their size on a desktop device.",
        {{"scenes", &arguments.scenes, "glTF files", glint::benchmarks::kNeeded},
         glint::benchmarks::roundsOption(arguments.rounds, "rounds of each scene"),
         {"--compress", &arguments.compress, "compress PNG, JPEG and WebP, without a cache"},
         {"--unpack", &arguments.unpack, "as for a device without block formats"},
         {"--png", &arguments.png, "write the first scene's images to this folder, and measure nothing"}},
        count, words, [&] { return glint::run(arguments); });
}
