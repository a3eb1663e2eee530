#include "gltf/images.h"

#include "gltf/uri.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_JPEG
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#include <stb/stb_image.h>

namespace glint::gltf {

namespace {

constexpr const char* kPngOrJpeg = "store the image as PNG or JPEG";

// Deflate reaches 1032 : 1 at best, and a pixel of a PNG has one bit at least.
constexpr std::uint64_t kMaxPixelsPerPngByte = 1032ULL * 8;

struct StbFree {
    void operator()(stbi_uc* pixels) const {
        stbi_image_free(pixels);
    }
};

const Json& imageJson(const Document& document, int image) {
    return document.json()["images"][static_cast<std::size_t>(image)];
}

std::string pointerOf(int image) {
    return fmt::format("/images/{}", image);
}

std::string lowerCase(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

std::string textMember(const Json& object, std::string_view name) {
    const Json* member = find(object, name);
    return member != nullptr && member->is_string() ? member->get<std::string>() : std::string();
}

// The name of what the bytes hold, where it is a format that Glint knows and does not read.
std::string_view knownFormat(ByteView bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.starts_with("\xABKTX")) {
        return "KTX";
    }
    if (text.starts_with("RIFF") && text.substr(8).starts_with("WEBP")) {
        return "WebP";
    }
    return text.starts_with("DDS ") ? "DDS" : "";
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

// The encoded bytes. `storage` keeps them where no buffer view does.
Result<ByteView> encodedBytes(Document& document, int image, Bytes& storage) {
    const Json& json = imageJson(document, image);
    if (const Json* view = find(json, "bufferView")) {
        return document.bufferView(view->get<int>());
    }
    const std::string uri = textMember(json, "uri");
    if (isDataUri(uri)) {
        std::optional<DataUri> data = decodeDataUri(uri);
        if (!data) {
            return document.error("data-uri", pointerOf(image) + "/uri", "is no valid data URI",
                                  "export the scene again");
        }
        storage = std::move(data->bytes);
    } else {
        Result<Bytes> bytes = document.readFile(uri, pointerOf(image));
        if (!bytes) {
            return bytes.error();
        }
        storage = std::move(*bytes);
    }
    return ByteView(storage);
}

Status checkSize(Document& document, int image, int width, int height, ByteView bytes) {
    const int limit = document.options().maxImageSize;
    if (width <= 0 || height <= 0 || width > limit || height > limit) {
        return document.error(
            "image-size", pointerOf(image),
            fmt::format("is {} x {} pixels; the limit is {} either way", width, height, limit),
            "scale the image down");
    }
    const auto pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    const bool isPng = bytes[0] == 0x89;
    if (isPng && pixels / kMaxPixelsPerPngByte > bytes.size()) {
        return document.error(
            "image-decode", pointerOf(image),
            fmt::format("says it has {} x {} pixels, but has only {} bytes", width, height, bytes.size()),
            "the image is damaged: export it again");
    }
    if (!document.chargeImageBytes(4 * pixels)) {
        return document.error("image-size", pointerOf(image), "the scene's images ask for too much memory",
                              "scale the images down");
    }
    return okStatus();
}

Status decode(Document& document, int index, ByteView bytes, Image& image) {
    const auto fail = [&](std::string message) {
        return document.error("image-decode", pointerOf(index), std::move(message), kPngOrJpeg);
    };
    if (const std::string_view format = knownFormat(bytes); !format.empty()) {
        return fail(fmt::format("is a {} image, which Glint does not read", format));
    }
    if (bytes.empty() || bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
        return fail(bytes.empty() ? "is empty" : "is larger than 2 GiB");
    }
    const int size = static_cast<int>(bytes.size());
    int components = 0;
    if (stbi_info_from_memory(bytes.data(), size, &image.width, &image.height, &components) == 0) {
        return fail(fmt::format("is neither PNG nor JPEG ({})", stbi_failure_reason()));
    }
    if (Status status = checkSize(document, index, image.width, image.height, bytes); !status) {
        return status;
    }
    const std::unique_ptr<stbi_uc, StbFree> pixels(
        stbi_load_from_memory(bytes.data(), size, &image.width, &image.height, &components, STBI_rgb_alpha));
    if (!pixels) {
        return fail(fmt::format("can't be decoded ({})", stbi_failure_reason()));
    }
    const auto count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 4;
    image.rgba8.assign(pixels.get(), pixels.get() + count);
    return okStatus();
}

}  // namespace

bool isDecodableImage(const Document& document, int image) {
    const Json& json = imageJson(document, image);
    std::string type = lowerCase(textMember(json, "mimeType"));
    const std::string uri = lowerCase(textMember(json, "uri"));
    if (type.empty() && isDataUri(uri)) {
        type = uri.substr(5, uri.find_first_of(";,") - 5);
    }
    if (type == "image/ktx2" || type == "image/webp" || type == "image/vnd-ms.dds" || type == "image/avif") {
        return false;
    }
    constexpr std::array<std::string_view, 5> kExtensions{".ktx2", ".ktx", ".webp", ".dds", ".avif"};
    return isDataUri(uri) || std::none_of(kExtensions.begin(), kExtensions.end(),
                                          [&](std::string_view end) { return uri.ends_with(end); });
}

Result<Image> importImage(Document& document, int index) {
    const Json& json = imageJson(document, index);
    Image image;
    image.name = nameOf(json, index);
    image.pointer = pointerOf(index);
    const bool hasView = find(json, "bufferView") != nullptr;
    const std::string uri = textMember(json, "uri");
    if (hasView == !uri.empty()) {
        return document.error("image-data", image.pointer,
                              hasView ? "has both a \"uri\" and a \"bufferView\""
                                      : "has neither a \"uri\" nor a \"bufferView\"",
                              "export the scene again");
    }
    if (!document.options().decodeImages) {
        return image;
    }
    Bytes storage;
    const Result<ByteView> bytes = encodedBytes(document, index, storage);
    if (!bytes) {
        return bytes.error();
    }
    if (Status status = decode(document, index, *bytes, image); !status) {
        return status.error();
    }
    return image;
}

}  // namespace glint::gltf
