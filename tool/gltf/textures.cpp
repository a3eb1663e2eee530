#include "gltf/textures.h"

#include "gltf/codecs/codecs.h"
#include "gltf/document/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace glint::gltf {

// ---- Images ----

namespace {

constexpr const char* kStore = "store the image as PNG, JPEG or WebP";

const Json& imageJson(const Document& document, int image) {
    return document.json()["images"][static_cast<std::size_t>(image)];
}

std::string imagePointer(int image) {
    return fmt::format("/images/{}", image);
}

std::string lowerCase(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

// Returns the media type that an image names, or that of its data URI: in lower case, without parameters.
std::string mediaType(const Json& image) {
    const std::string uri = memberOr<std::string>(image, "uri", "");
    std::string type = memberOr<std::string>(image, "mimeType", "");
    if (type.empty() && isDataUri(uri)) {
        type = uri.substr(5);
    }
    return lowerCase(type.substr(0, type.find_first_of("; ,")));
}

std::string nameOf(const Json& json, int image) {
    if (std::string name = memberOr<std::string>(json, "name", ""); !name.empty()) {
        return name;
    }
    const std::string uri = memberOr<std::string>(json, "uri", "");
    if (!uri.empty() && !isDataUri(uri)) {
        if (std::string file = std::filesystem::path(percentDecode(uri)).filename().string(); !file.empty()) {
            return file;
        }
    }
    return fmt::format("image {}", image);
}

// Returns the encoded bytes. `storage` owns them if they are not in a buffer view.
Result<ByteView> encodedBytes(Document& document, int image, base::Bytes& storage) {
    const Json& json = imageJson(document, image);
    if (const Json* view = find(json, "bufferView")) {
        return document.bufferView(view->get<int>());
    }
    GLINT_TRY(storage, document.readUri(memberOr<std::string>(json, "uri", ""), imagePointer(image)));
    return ByteView(storage);
}

Status checkSize(Document& document, const Image& image) {
    const int limit = document.options().maxImageSize;
    if (image.width <= 0 || image.height <= 0 || image.width > limit || image.height > limit) {
        return document.error(
            "image-size", image.pointer,
            fmt::format("is {} x {} pixels; the limit is {} either way", image.width, image.height, limit),
            "scale the image down");
    }
    if (!document.chargeImage(byteCount(image))) {
        return document.error("image-size", image.pointer, "the scene's images ask for too much memory",
                              "scale the images down");
    }
    return okStatus();
}

void warnOfDeviations(Document& document, ByteView bytes, const Codec& codec, const Image& image) {
    if (&codec != &kBasisu && &codec != &kDds) {
        return;
    }
    if (const Result<BlockFile> file = readBlockFile(bytes)) {
        for (const std::string& deviation : file->deviations) {
            document.warn("ktx2-metadata", image.pointer, deviation,
                          &codec == &kDds ? "make the DDS file without it"
                                          : "make the KTX2 file by the rules of KHR_texture_basisu");
        }
    }
}

Diagnostic decodeError(std::string where, std::string message, const char* hint = kStore) {
    return makeError("image-decode", std::move(where), std::move(message), hint);
}

Diagnostic refusal(std::string where, const Codec& codec, const Diagnostic& fault) {
    return decodeError(std::move(where),
                       fmt::format("is a {} image that can't be decoded: {}", codec.name, fault.message),
                       &codec == &kBasisu && !hasBasisu() ? kBasisuHint : kStore);
}

// Reads the header. Returns the codec of the image.
Result<const Codec*> readHeader(ByteView bytes, const std::string& where, Image& image) {
    const Codec* const codec = findCodec(bytes);
    if (codec == nullptr) {
        const std::string_view format = foreignFormat(bytes);
        return decodeError(where, bytes.empty() ? "is empty"
                                  : format.empty()
                                      ? "is neither PNG nor JPEG, WebP, KTX2 or DDS"
                                      : fmt::format("is a {} image, which Glint does not read", format));
    }
    if (const Status status = codec->readHeader(bytes, image); !status) {
        return refusal(where, *codec, status.error());
    }
    return codec;
}

Status decode(ByteView bytes, const std::string& where, const Codec& codec, Image& image) {
    Status status = codec.decode(bytes, image);
    return status ? status : refusal(where, codec, status.error());
}

// Warns if the file says that the image is of another type than its bytes are.
void compareType(Document& document, int index, const Codec& codec) {
    const Json& json = imageJson(document, index);
    const bool named = find(json, "mimeType") != nullptr || isDataUri(memberOr<std::string>(json, "uri", ""));
    const std::string given = mediaType(json);
    if (named && given != codec.type) {
        document.warn(
            "image-type", imagePointer(index),
            fmt::format("says that it is \"{}\", but it is {}; it is read as what it is", given, codec.type),
            "correct the type");
    }
}

// Reads the header, and the pixels if something needs them.
Status read(Document& document, int index, ByteView bytes, Image& image) {
    const std::string where = document.where(image.pointer);
    GLINT_TRY(const Codec* const codec, readHeader(bytes, where, image));
    GLINT_TRY_DO(checkSize(document, image));
    if (document.options().decodeImages) {
        GLINT_TRY_DO(decode(bytes, where, *codec, image));
    }
    compareType(document, index, *codec);
    warnOfDeviations(document, bytes, *codec, image);
    return okStatus();
}

enum class Decodable : std::uint8_t {
    Yes,
    No,
    NeedsBasisu,  // a KTX2 image, in a build without hasBasisu()
};

// Returns whether Glint can decode the image, judging by its type and the name of its file. It opens no file.
Decodable decodability(const Document& document, int image) {
    const Json& json = imageJson(document, image);
    const std::string type = mediaType(json);
    const std::string uri = lowerCase(memberOr<std::string>(json, "uri", ""));
    const auto endsWith = [&](std::string_view end) { return !isDataUri(uri) && uri.ends_with(end); };
    if (type == "image/ktx2" || endsWith(".ktx2")) {
        return hasBasisu() ? Decodable::Yes : Decodable::NeedsBasisu;
    }
    const bool isForeign = type == "image/avif" || endsWith(".ktx") || endsWith(".avif");
    return isForeign ? Decodable::No : Decodable::Yes;
}

// Reads the image's name, and its pixels or its file if ImportOptions ask for them. Errors: "image-data" (no
// source or two), "image-decode", "image-size", and those of reading files. If only
// ImportOptions::trustTextures asks for the file, an image that can't be read is no error, but a note, and
// has no file.
Result<Image> importImage(Document& document, int index) {
    const Json& json = imageJson(document, index);
    Image image;
    image.name = nameOf(json, index);
    image.pointer = imagePointer(index);
    if (find(json, kAtRunTime) != nullptr) {
        image.isAtRunTime = true;
        return image;
    }
    const bool hasView = find(json, "bufferView") != nullptr;
    const std::string uri = memberOr<std::string>(json, "uri", "");
    if (hasView == !uri.empty()) {
        return document.error("image-data", image.pointer,
                              hasView ? "has both a \"uri\" and a \"bufferView\""
                                      : "has neither a \"uri\" nor a \"bufferView\"",
                              "export the scene again");
    }
    if (hasView && find(json, "mimeType") == nullptr) {
        document.warn("image-type", image.pointer,
                      "is in a buffer view and has no \"mimeType\"; its first bytes tell the type",
                      "give the type");
    }
    const ImportOptions& options = document.options();
    if (!options.decodeImages && !options.trustTextures && !options.keepImageFiles) {
        return image;
    }
    base::Bytes storage;
    const Result<ByteView> bytes = encodedBytes(document, index, storage);
    const Status status = bytes ? read(document, index, *bytes, image) : Status(bytes.error());
    // Nothing but --trust-textures asks for the image, and planning does without.
    if (!status && !options.decodeImages && !options.keepImageFiles) {
        document.warnings().push_back(unknownTexels(status.error()));
        return image;
    }
    if (!status) {
        return status.error();
    }
    const bool isKept = options.keepImageFiles || (options.trustTextures && !options.decodeImages);
    if (isKept && storage.empty()) {
        image.file.assign(bytes->begin(), bytes->end());
    } else if (isKept) {
        image.file = std::move(storage);
    }
    return image;
}

}  // namespace

Diagnostic unknownTexels(const Diagnostic& error) {
    return {Severity::Note, "texture-unknown", error.where,
            fmt::format("{} ({}), so what it holds is not known", error.message, error.id), error.hint};
}

Diagnostic cantDecode(const Scene& scene, const Image& image, const Codec& codec, const Diagnostic& fault) {
    return refusal(fmt::format("{}#{}", scene.path, image.pointer), codec, fault);
}

Result<Texels> texelsOf(const Scene& scene, const Image& image) {
    if (!image.pixels.empty()) {
        return Texels{image, image.format, image.pixels};
    }
    const std::string where = fmt::format("{}#{}", scene.path, image.pointer);
    Image decoded;
    GLINT_TRY(const Codec* const codec, readHeader(image.file, where, decoded));
    GLINT_TRY_DO(decode(image.file, where, *codec, decoded));
    return Texels{decoded, decoded.format, std::move(decoded.pixels)};
}

// ---- Textures and samplers ----

namespace {

// The numbers are glTF's.
constexpr int kNearest = 9728;
constexpr int kLinear = 9729;

bool setWrap(int value, Wrap& wrap) {
    switch (value) {
        case 10497:
            wrap = Wrap::Repeat;
            return true;
        case 33071:
            wrap = Wrap::ClampToEdge;
            return true;
        case 33648:
            wrap = Wrap::MirroredRepeat;
            return true;
        default:
            return false;
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
    const std::vector<tinygltf::Sampler>& samplers = document.model().samplers;
    for (std::size_t i = 0; i < samplers.size(); ++i) {
        const tinygltf::Sampler& file = samplers[i];
        Sampler sampler;
        const auto warnUnless = [&](bool isKnown, const char* member, int value) {
            if (!isKnown) {
                document.warn("sampler-value", fmt::format("/samplers/{}/{}", i, member),
                              fmt::format("{} is no known value; the default is used", value));
            }
        };
        warnUnless(setWrap(file.wrapS, sampler.wrapU), "wrapS", file.wrapS);
        warnUnless(setWrap(file.wrapT, sampler.wrapV), "wrapT", file.wrapT);
        warnUnless(setMinification(file.minFilter, sampler), "minFilter", file.minFilter);
        warnUnless(setMagnification(file.magFilter, sampler), "magFilter", file.magFilter);
        scene.samplers.push_back(sampler);
    }
}

TextureTable::TextureTable(Document& document, Scene& scene)
    : document_(document),
      scene_(scene),
      textures_(document.model().textures.size()),
      images_(arraySize(document.json(), "/images")) {}

Result<int> TextureTable::use(int texture) {
    std::optional<int>& known = textures_[static_cast<std::size_t>(texture)];
    if (!known) {
        GLINT_TRY(known, append(texture));
    }
    return *known;
}

const Image& TextureTable::imageOf(int texture) const {
    const int image = scene_.textures[static_cast<std::size_t>(texture)].image;
    return scene_.images[static_cast<std::size_t>(image)];
}

// Returns the image of the file that the texture shows, or -1 with a warning if it has none in a format that
// Glint knows. A KTX2 image that this build does not decode is an error, unless there is another image and
// the file does not require KHR_texture_basisu.
Result<int> TextureTable::chooseImage(int texture) {
    constexpr const char* kEffect = "materials render without it";
    const tinygltf::Texture& file = document_.model().textures[static_cast<std::size_t>(texture)];
    const std::string pointer = fmt::format("/textures/{}", texture);
    const int plain = file.source;
    // Later candidates are those that a reader without the extensions would take.
    int basisu = -1;
    const bool mayFallBack = !document_.requiresExtension("KHR_texture_basisu");
    std::vector<int> candidates;
    for (const char* const name : kImageExtensions) {
        const Value* const extension = extensionOf(file.extensions, name);
        candidates.push_back(extension == nullptr ? -1 : memberOr(*extension, "source", -1));
    }
    candidates.push_back(plain);
    for (const int image : candidates) {
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
    if (file.extensions.empty()) {
        document_.note("texture-source", pointer, fmt::format("has no source; {}", kEffect));
        return -1;
    }
    document_.warn("texture-source", pointer,
                   fmt::format("has a source only through {}, which Glint does not support; {}",
                               file.extensions.begin()->first, kEffect),
                   kStore);
    return -1;
}

Result<int> TextureTable::append(int texture) {
    GLINT_TRY(const auto chosen, chooseImage(texture));
    if (chosen < 0) {
        return -1;
    }
    GLINT_TRY(const auto image, useImage(chosen));
    int sampler = document_.model().textures[static_cast<std::size_t>(texture)].sampler;
    if (sampler < 0) {
        if (!defaultSampler_) {
            defaultSampler_ = static_cast<int>(scene_.samplers.size());
            scene_.samplers.emplace_back();
        }
        sampler = *defaultSampler_;
    }
    scene_.textures.push_back({image, sampler});
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
