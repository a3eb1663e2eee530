#include "gltf/textures.h"

#include "gltf/codecs/basisu.h"
#include "gltf/codecs/compression.h"
#include "gltf/codecs/images.h"
#include "gltf/document/extensions.h"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace glint::gltf {

namespace {

// The numbers are glTF's.
constexpr int kNearest = 9728;
constexpr int kLinear = 9729;

std::optional<Wrap> wrapOf(int value) {
    switch (value) {
        case 10497:
            return Wrap::Repeat;
        case 33071:
            return Wrap::ClampToEdge;
        case 33648:
            return Wrap::MirroredRepeat;
        default:
            return std::nullopt;
    }
}

bool setMinification(int value, Sampler& sampler) {
    // From 9984 on, bit 0 is the filter and bit 1 that between mips.
    constexpr int kWithMips = 9984;
    if (value == kNearest || value == kLinear) {
        sampler.mipmapped = false;
        sampler.mip = Filter::Nearest;
        sampler.minification = value == kNearest ? Filter::Nearest : Filter::Linear;
    } else if (value >= kWithMips && value < kWithMips + 4) {
        sampler.minification = (value & 1) == 0 ? Filter::Nearest : Filter::Linear;
        sampler.mip = (value & 2) == 0 ? Filter::Nearest : Filter::Linear;
    } else {
        return value == -1;
    }
    return true;
}

bool setMagnification(int value, Sampler& sampler) {
    if (value == kNearest) {
        sampler.magnification = Filter::Nearest;
    }
    return value == -1 || value == kNearest || value == kLinear;
}

}  // namespace

void importSamplers(Document& document, Scene& scene) {
    const Json& samplers = arrayMember(document.json(), "samplers");
    for (std::size_t i = 0; i < samplers.size(); ++i) {
        // Takes the number of that member by `set`, which returns whether it knows the number.
        const auto read = [&](const char* member, int fallback, const auto& set) {
            const int value = integerMember(samplers[i], member, fallback);
            if (!set(value)) {
                document.warn("sampler-value", fmt::format("/samplers/{}/{}", i, member),
                              fmt::format("{} is no known value; the default is used", value));
            }
        };
        const auto wrapInto = [](Wrap& wrap) {
            return [&wrap](int value) {
                const std::optional<Wrap> known = wrapOf(value);
                wrap = known.value_or(Wrap::Repeat);
                return known.has_value();
            };
        };
        Sampler sampler;
        constexpr int kRepeat = 10497;
        read("wrapS", kRepeat, wrapInto(sampler.wrapU));
        read("wrapT", kRepeat, wrapInto(sampler.wrapV));
        read("minFilter", -1, [&](int value) { return setMinification(value, sampler); });
        read("magFilter", -1, [&](int value) { return setMagnification(value, sampler); });
        scene.samplers.push_back(sampler);
    }
}

TextureTable::TextureTable(Document& document, Scene& scene)
    : document_(document),
      scene_(scene),
      textures_(arraySize(document.json(), "/textures")),
      images_(arraySize(document.json(), "/images")) {}

Result<int> TextureTable::use(int texture) {
    std::optional<int>& known = textures_[static_cast<std::size_t>(texture)];
    if (!known) {
        Result<int> index = append(texture);
        if (!index) {
            return index;
        }
        known = *index;
    }
    return *known;
}

// Returns the image of the file that the texture shows, or -1 with a warning if it has none in a format that
// Glint knows. A KTX2 image that this build does not decode is an error, unless there is another image and
// the file does not require KHR_texture_basisu.
Result<int> TextureTable::chooseImage(int texture) {
    constexpr const char* kStore = "store the image as PNG, JPEG or WebP";
    constexpr const char* kEffect = "materials render without it";
    const Json& json = document_.json()["textures"][static_cast<std::size_t>(texture)];
    const std::string pointer = fmt::format("/textures/{}", texture);
    const int plain = indexMember(json, "source");
    // Later candidates are those that a reader without the extensions would take.
    int basisu = -1;
    const bool mayFallBack = !requiresExtension(document_, "KHR_texture_basisu");
    for (const int image :
         {extensionSource(json, "EXT_texture_webp"), extensionSource(json, "KHR_texture_basisu"),
          extensionSource(json, "MSFT_texture_dds"), plain}) {
        const Decodable decodable = image < 0 ? Decodable::No : decodability(document_, image);
        if (decodable == Decodable::Yes && (basisu < 0 || mayFallBack)) {
            if (basisu >= 0) {
                document_.note("texture-basisu", pointer,
                               fmt::format("/images/{} is KTX2, which this build of Glint does not decode; "
                                           "/images/{} is used",
                                           basisu, image),
                               kBasisuHint);
            }
            return image;
        }
        basisu = decodable == Decodable::NeedsBasisu ? image : basisu;
    }
    if (basisu >= 0) {
        return document_.error(
            "texture-basisu", pointer,
            fmt::format("/images/{} is KTX2, which this build of Glint does not decode", basisu),
            kBasisuHint);
    }
    if (plain >= 0) {
        document_.warn("texture-source", pointer,
                       fmt::format("/images/{} has a format that Glint does not read; {}", plain, kEffect),
                       kStore);
        return -1;
    }
    const Json* extensions = find(json, "extensions");
    if (extensions == nullptr || extensions->empty()) {
        document_.note("texture-source", pointer, fmt::format("has no source; {}", kEffect));
        return -1;
    }
    document_.warn("texture-source", pointer,
                   fmt::format("has a source only through {}, which Glint does not support; {}",
                               extensions->begin().key(), kEffect),
                   kStore);
    return -1;
}

Result<int> TextureTable::append(int texture) {
    Result<int> chosen = chooseImage(texture);
    if (!chosen || *chosen < 0) {
        return chosen;
    }
    Result<int> image = useImage(*chosen);
    if (!image) {
        return image;
    }
    int sampler = indexMember(document_.json()["textures"][static_cast<std::size_t>(texture)], "sampler");
    if (sampler < 0) {
        if (!defaultSampler_) {
            defaultSampler_ = static_cast<int>(scene_.samplers.size());
            scene_.samplers.emplace_back();
        }
        sampler = *defaultSampler_;
    }
    scene_.textures.push_back({*image, sampler});
    return static_cast<int>(scene_.textures.size()) - 1;
}

Result<int> TextureTable::useImage(int image) {
    std::optional<int>& known = images_[static_cast<std::size_t>(image)];
    if (!known) {
        GLINT_TRY(auto imported, importImage(document_, image));
        known = static_cast<int>(scene_.images.size());
        scene_.images.push_back(std::move(imported));
    }
    return *known;
}

}  // namespace glint::gltf
