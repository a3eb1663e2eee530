#include "image/image_file.h"

#include "base/files.h"
#include "base/image_limits.h"
#include "image/exr.h"
#include "image/hdr.h"
#include "image/tone.h"

#include <cctype>

namespace glint::image {

namespace {

std::string lowerCase(std::string text) {
    for (char& c : text) {
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    return text;
}

Diagnostic extensionError(const std::filesystem::path& path, const std::string& extension, std::string hint) {
    return makeError("image-extension", path.string(),
                     extension.empty() ? "has no file name extension"
                                       : "has the unknown file name extension \"" + extension + "\"",
                     std::move(hint));
}

DisplayImage toDisplayImage(const LinearImage& image, double exposure) {
    DisplayImage display{image.width, image.height, {}};
    display.pixels.reserve(image.pixels.size());
    for (const std::array<float, 4>& pixel : image.pixels) {
        display.pixels.push_back(toDisplay({pixel[0], pixel[1], pixel[2]}, exposure));
    }
    return display;
}

Status writeEncoded(const std::filesystem::path& path, const Result<base::Bytes>& bytes) {
    if (!bytes) {
        return bytes.error();
    }
    return base::writeFile(path, *bytes);
}

}  // namespace

Result<ImageFormat> imageFormat(const std::filesystem::path& path) {
    const std::string extension = lowerCase(path.extension().string());
    if (extension == ".png") {
        return ImageFormat::Png;
    }
    if (extension == ".exr") {
        return ImageFormat::Exr;
    }
    return extensionError(path, extension, "use .png or .exr");
}

Result<RadianceFormat> radianceFormat(const std::filesystem::path& path) {
    const std::string extension = lowerCase(path.extension().string());
    if (extension == ".hdr") {
        return RadianceFormat::Hdr;
    }
    if (extension == ".exr") {
        return RadianceFormat::Exr;
    }
    return extensionError(path, extension, "use .hdr or .exr");
}

Result<LinearImage> readImage(const std::filesystem::path& path) {
    GLINT_TRY(const auto format, imageFormat(path));
    GLINT_TRY(const auto bytes, base::readFile(path));
    return format == ImageFormat::Png ? decodePng(bytes, path.string()) : decodeExr(bytes, path.string());
}

Result<LinearImage> readRadiance(const std::filesystem::path& path) {
    GLINT_TRY(const auto format, radianceFormat(path));
    GLINT_TRY(const auto bytes, base::readFile(path));
    return format == RadianceFormat::Hdr ? decodeHdr(bytes, path.string()) : decodeExr(bytes, path.string());
}

Status writeImage(const std::filesystem::path& path, const LinearImage& image, double exposure,
                  std::span<const ExrLayer> layers) {
    GLINT_TRY(const auto format, imageFormat(path));
    if (format == ImageFormat::Exr) {
        return writeEncoded(path, encodeExr(image, path.string(), layers));
    }
    return writeImage(path, toDisplayImage(image, exposure));
}

Status writeImage(const std::filesystem::path& path, const DisplayImage& image) {
    GLINT_TRY(const auto format, imageFormat(path));
    if (format != ImageFormat::Png) {
        return makeError("image-extension", path.string(), "can only be written as a PNG", "use .png");
    }
    return writeEncoded(path, encodePng(image, path.string()));
}

}  // namespace glint::image
