#include "gltf/textures.h"

#include "gltf/codecs/basisu.h"
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
    const std::string uri = textMember(image, "uri");
    std::string type = textMember(image, "mimeType");
    if (type.empty() && isDataUri(uri)) {
        type = uri.substr(5);
    }
    return lowerCase(type.substr(0, type.find_first_of("; ,")));
}

std::string nameOf(const Json& json, int image) {
    if (std::string name = textMember(json, "name"); !name.empty()) {
        return name;
    }
    const std::string uri = textMember(json, "uri");
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
    GLINT_TRY(storage, document.readUri(textMember(json, "uri"), imagePointer(image)));
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
    std::string problem;
    if (const std::optional<BlockFile> file = readBlockFile(bytes, problem)) {
        for (const std::string& deviation : file->deviations) {
            document.warn("ktx2-metadata", image.pointer, deviation,
                          &codec == &kDds ? "make the DDS file without it"
                                          : "make the KTX2 file by the rules of KHR_texture_basisu");
        }
    }
}

// The fault of an image, and its remedy.
struct Failure {
    std::string message;
    const char* hint = kStore;
};

Failure cantDecode(const Codec& codec, const std::string& problem) {
    return {fmt::format("is a {} image that can't be decoded: {}", codec.name, problem),
            &codec == &kBasisu && !hasBasisu() ? kBasisuHint : kStore};
}

std::optional<Failure> readHeader(ByteView bytes, Image& image, const Codec*& codec) {
    codec = findCodec(bytes);
    if (codec == nullptr) {
        const std::string_view format = foreignFormat(bytes);
        return Failure{bytes.empty()    ? "is empty"
                       : format.empty() ? "is neither PNG nor JPEG, WebP, KTX2 or DDS"
                                        : fmt::format("is a {} image, which Glint does not read", format)};
    }
    std::string problem;
    if (!codec->readHeader(bytes, image, problem)) {
        return cantDecode(*codec, problem);
    }
    return std::nullopt;
}

// Warns if the file says that the image is of another type than its bytes are.
void compareType(Document& document, int index, const Codec& codec) {
    const Json& json = imageJson(document, index);
    const bool named = find(json, "mimeType") != nullptr || isDataUri(textMember(json, "uri"));
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
    const auto fail = [&](Failure failure) {
        return document.error("image-decode", image.pointer, std::move(failure.message), failure.hint);
    };
    const Codec* codec = nullptr;
    if (std::optional<Failure> failure = readHeader(bytes, image, codec)) {
        return fail(std::move(*failure));
    }
    GLINT_TRY_DO(checkSize(document, image));
    const ImportOptions& options = document.options();
    std::string problem;
    if (options.decodeImages && !codec->decode(bytes, image, problem)) {
        return fail(cantDecode(*codec, problem));
    }
    compareType(document, index, *codec);
    warnOfDeviations(document, bytes, *codec, image);
    return okStatus();
}

}  // namespace

Decodable decodability(const Document& document, int image) {
    const Json& json = imageJson(document, image);
    const std::string type = mediaType(json);
    const std::string uri = lowerCase(textMember(json, "uri"));
    const auto endsWith = [&](std::string_view end) { return !isDataUri(uri) && uri.ends_with(end); };
    if (type == "image/ktx2" || endsWith(".ktx2")) {
        return hasBasisu() ? Decodable::Yes : Decodable::NeedsBasisu;
    }
    const bool isForeign = type == "image/avif" || endsWith(".ktx") || endsWith(".avif");
    return isForeign ? Decodable::No : Decodable::Yes;
}

Result<Image> importImage(Document& document, int index) {
    const Json& json = imageJson(document, index);
    Image image;
    image.name = nameOf(json, index);
    image.pointer = imagePointer(index);
    const bool hasView = find(json, "bufferView") != nullptr;
    const std::string uri = textMember(json, "uri");
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

Diagnostic unknownTexels(const Diagnostic& error) {
    return {Severity::Note, "texture-unknown", error.where,
            fmt::format("{} ({}), so what it holds is not known", error.message, error.id), error.hint};
}

Status decodeFile(const Scene& scene, Image& image) {
    const Codec* codec = nullptr;
    std::optional<Failure> failure = readHeader(image.file, image, codec);
    std::string problem;
    if (!failure && !codec->decode(image.file, image, problem)) {
        failure = cantDecode(*codec, problem);
    }
    return failure ? makeError("image-decode", fmt::format("{}#{}", scene.path, image.pointer),
                               std::move(failure->message), failure->hint)
                   : okStatus();
}

// ---- Textures and samplers ----

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
    const std::vector<tinygltf::Sampler>& samplers = document.model().samplers;
    for (std::size_t i = 0; i < samplers.size(); ++i) {
        // Takes the number of that member by `set`, which returns whether it knows the number.
        const auto read = [&](const char* member, int value, const auto& set) {
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
        read("wrapS", samplers[i].wrapS, wrapInto(sampler.wrapU));
        read("wrapT", samplers[i].wrapT, wrapInto(sampler.wrapV));
        read("minFilter", samplers[i].minFilter, [&](int value) { return setMinification(value, sampler); });
        read("magFilter", samplers[i].magFilter, [&](int value) { return setMagnification(value, sampler); });
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
    const tinygltf::Texture& file = document_.model().textures[static_cast<std::size_t>(texture)];
    const std::string pointer = fmt::format("/textures/{}", texture);
    const int plain = file.source;
    // Later candidates are those that a reader without the extensions would take.
    int basisu = -1;
    const bool mayFallBack = !document_.requiresExtension("KHR_texture_basisu");
    std::vector<int> candidates;
    for (const char* const name : kImageExtensions) {
        const Value* const extension = extensionOf(file.extensions, name);
        candidates.push_back(extension == nullptr ? -1 : indexMember(*extension, "source"));
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
    Result<int> chosen = chooseImage(texture);
    if (!chosen || *chosen < 0) {
        return chosen;
    }
    Result<int> image = useImage(*chosen);
    if (!image) {
        return image;
    }
    int sampler = document_.model().textures[static_cast<std::size_t>(texture)].sampler;
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
