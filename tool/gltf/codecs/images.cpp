#include "gltf/codecs/images.h"

#include "gltf/codecs/basisu.h"
#include "gltf/codecs/block_file.h"
#include "gltf/codecs/codecs.h"
#include "gltf/document/uri.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace glint::gltf {

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
    const std::string uri = textMember(json, "uri");
    if (isDataUri(uri)) {
        std::optional<DataUri> data = decodeDataUri(uri);
        if (!data) {
            return document.error("data-uri", imagePointer(image) + "/uri", "is no valid data URI",
                                  "export the scene again");
        }
        storage = std::move(data->bytes);
    } else {
        GLINT_TRY(storage, document.readFile(uri, imagePointer(image)));
    }
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
    if (!document.chargeImageBytes(byteCount(image))) {
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

// What went wrong with an image, and what to do.
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

}  // namespace glint::gltf
