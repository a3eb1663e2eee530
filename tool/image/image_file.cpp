#include "image/image_file.h"

#include "base/files.h"
#include "image/tone.h"

#include <array>
#include <cctype>
#include <utility>

namespace glint::image {

namespace {

std::string lowerCase(std::string text) {
    for (char& c : text) {
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    return text;
}

// Returns the format whose extension, ".png", the path has in upper or lower case.
template <typename Format>
Result<Format> formatOf(const std::filesystem::path& path,
                        const std::array<std::pair<const char*, Format>, 2>& formats) {
    const std::string extension = lowerCase(path.extension().string());
    for (const auto& [known, format] : formats) {
        if (extension == known) {
            return format;
        }
    }
    return makeError("image-extension", path.string(),
                     extension.empty() ? "has no file name extension"
                                       : "has the unknown file name extension \"" + extension + "\"",
                     std::string("use ") + formats[0].first + " or " + formats[1].first);
}

Status writeEncoded(const std::filesystem::path& path, const Result<base::Bytes>& bytes) {
    if (!bytes) {
        return bytes.error();
    }
    return base::writeFile(path, *bytes);
}

}  // namespace

DisplayImage toDisplayImage(const LinearImage& image, double exposure) {
    DisplayImage display{image.width, image.height, {}};
    display.pixels.reserve(image.pixels.size());
    for (const std::array<float, 4>& pixel : image.pixels) {
        display.pixels.push_back(toDisplay({pixel[0], pixel[1], pixel[2]}, exposure));
    }
    return display;
}

Result<ImageFormat> imageFormat(const std::filesystem::path& path) {
    return formatOf<ImageFormat>(path, {{{".png", ImageFormat::Png}, {".exr", ImageFormat::Exr}}});
}

Result<RadianceFormat> radianceFormat(const std::filesystem::path& path) {
    return formatOf<RadianceFormat>(path, {{{".hdr", RadianceFormat::Hdr}, {".exr", RadianceFormat::Exr}}});
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
