#include "base/clock.h"
#include "base/files.h"
#include "base/parallel.h"
#include "cache/store.h"
#include "gltf/codecs/codecs.h"

#include <glint/session/textures.h>

#include <algorithm>
#include <atomic>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace glint::session {

namespace {

constexpr std::string_view kKind = "texture";
// This number increases when the same file gives other blocks.
constexpr std::uint64_t kPackerVersion = 2;

std::string_view textOf(std::span<const std::uint8_t> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Returns everything that the blocks of an image depend on. Two hashes stand for the file's bytes.
std::string keyOf(const gltf::Image& image, const gltf::ImageUse& use, const gltf::FitOptions& options) {
    const bool hasAlpha = (use.channels & 8U) != 0;
    const auto format = targetFormat(use, hasAlpha, true, options.formats);
    compiler::Packer packer;
    packer.add(kPackerVersion).add(base::hashBytes(image.file, 0)).add(base::hashBytes(image.file, 1));
    for (const bool flag :
         {use.isColor, use.isData, use.isNormals, options.decodeEmission && use.isEmission}) {
        packer.add(flag ? 1U : 0U);
    }
    packer.add(std::uint64_t{use.channels}).add(static_cast<std::uint64_t>(format));
    packer.add(std::uint64_t{use.roughness}).add(std::uint64_t{use.glossiness});
    return packer.take();
}

std::string pack(const gltf::FittedImage& image) {
    compiler::Packer packer;
    packer.add(static_cast<std::uint64_t>(image.levels)).add(static_cast<std::uint64_t>(image.format));
    for (const TexelChannel channel : image.channels) {
        packer.add(static_cast<std::uint64_t>(channel));
    }
    packer.add(textOf(image.texels)).add(textOf(image.decoded));
    return packer.take();
}

// Returns nothing if `bytes` is no image of this size.
std::optional<gltf::FittedImage> unpack(std::string_view bytes, const gltf::Image& image) {
    compiler::Unpacker unpacker(bytes);
    const std::uint64_t levels = unpacker.number().value_or(0);
    const std::uint64_t format = unpacker.number().value_or(kTexelFormatCount);
    gltf::FittedImage fitted;
    for (TexelChannel& channel : fitted.channels) {
        channel = static_cast<TexelChannel>(std::min<std::uint64_t>(unpacker.number().value_or(0), 5));
    }
    const std::string_view texels = unpacker.text().value_or("");
    const std::string_view decoded = unpacker.text().value_or("");
    if (!unpacker.atEnd() || format >= kTexelFormatCount || levels == 0 || levels > 32) {
        return std::nullopt;
    }
    static_cast<gltf::ImageShape&>(fitted) = image;
    fitted.levels = static_cast<int>(levels);
    fitted.format = static_cast<TexelFormat>(format);
    const auto width = static_cast<std::uint32_t>(image.width);
    const auto height = static_cast<std::uint32_t>(image.height);
    if (texels.size() != bytesOfLevels(fitted.format, width, height, static_cast<std::uint32_t>(levels))) {
        return std::nullopt;
    }
    fitted.texels.assign(texels.begin(), texels.end());
    fitted.decoded.assign(decoded.begin(), decoded.end());
    return fitted;
}

// Reads the images of a scene, each on some thread.
class Loader {
public:
    Loader(const gltf::Scene& scene, const TextureOptions& options)
        : scene_(scene),
          options_(options),
          uses_(imageUses(scene)),
          images_(scene.images.size(), Result<gltf::FittedImage>(gltf::FittedImage{})) {}

    Result<std::shared_ptr<const TextureSet>> load() {
        const base::Clock::time_point begin = base::Clock::now();
        base::runParallel(images_.size(), static_cast<int>(options_.threads), [this](std::size_t i) {
            images_[i] = read(scene_.images[i], uses_[i]);
            return true;
        });
        auto set = std::make_shared<TextureSet>();
        for (Result<gltf::FittedImage>& image : images_) {
            if (!image) {
                return image.error();
            }
            set->images.push_back(std::move(*image));
        }
        set->found = found_;
        set->notes = notes();
        set->milliseconds = base::millisecondsSince(begin);
        return std::shared_ptr<const TextureSet>(std::move(set));
    }

private:
    // Returns whether the blocks of the image are worth keeping: packing takes far longer than reading them.
    bool isKept(const gltf::Image& image) const {
        const gltf::Codec* const codec = gltf::findCodec(image.file);
        return options_.cache != nullptr && options_.fit.compress && gltf::hasBasisu() && codec != nullptr &&
               codec != &gltf::kBasisu && codec != &gltf::kDds;
    }

    Result<gltf::FittedImage> read(const gltf::Image& image, gltf::ImageUse use) {
        use.isColor = use.isColor || !use.isData;
        const bool kept = isKept(image);
        const std::string key = kept ? keyOf(image, use, options_.fit) : std::string();
        if (kept) {
            const std::optional<std::string> found = options_.cache->find(kKind, key);
            if (std::optional<gltf::FittedImage> fitted = found ? unpack(*found, image) : std::nullopt) {
                ++found_;
                return std::move(*fitted);
            }
        }
        Result<gltf::FittedImage> fitted = fitImage(scene_, image, use, options_.fit);
        if (kept && fitted && isBlockFormat(fitted->format)) {
            options_.cache->put(kKind, key, pack(*fitted));
        }
        return fitted;
    }

    std::vector<Diagnostic> notes() const {
        const char* why = nullptr;
        const gltf::ImageUse color{true, false, false, false, 15};
        if (!gltf::hasBasisu()) {
            why = "this Glint was built without the sources of Basis Universal, which pack blocks";
        } else if (!isBlockFormat(gltf::targetFormat(color, true, true, options_.fit.formats))) {
            why = "the device reads no BC formats";
        }
        if (why == nullptr || !options_.fit.compress || scene_.images.empty()) {
            return {};
        }
        return {Diagnostic{Severity::Note, "texture-compression", scene_.path,
                           std::string("textures are not compressed: ") + why,
                           "leave out --compress-textures"}};
    }

    const gltf::Scene& scene_;
    const TextureOptions& options_;
    std::vector<gltf::ImageUse> uses_;
    std::vector<Result<gltf::FittedImage>> images_;
    std::atomic<std::uint32_t> found_{0};
};

}  // namespace

Result<std::shared_ptr<const TextureSet>> loadTextures(const gltf::Scene& scene,
                                                       const TextureOptions& options) {
    return Loader(scene, options).load();
}

void useTextures(std::shared_ptr<const TextureSet> textures, SceneViewData& data) {
    data.images.clear();
    data.textures.clear();
    addTextures(std::move(textures), data);
}

void addTextures(std::shared_ptr<const TextureSet> textures, SceneViewData& data) {
    for (const gltf::FittedImage& image : textures->images) {
        data.images.push_back({static_cast<std::uint32_t>(image.width),
                               static_cast<std::uint32_t>(image.height), image.texels, image.format,
                               static_cast<std::uint32_t>(image.levels), image.channels, image.decoded,
                               image.dimension, static_cast<std::uint32_t>(image.layers)});
    }
    data.textures.push_back(std::move(textures));
}

}  // namespace glint::session
