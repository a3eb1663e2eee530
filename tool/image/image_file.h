// Image files by extension: .png (8-bit sRGB, tone mapped) and .exr (32-bit float, linear); radiance also
// from .hdr.
#pragma once

#include "image/png.h"

#include <glint/renderer.h>
#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <string>

namespace glint {

enum class ImageFormat : std::uint8_t { Png, Exr };

// By the extension, upper or lower case. Error "image-extension".
Result<ImageFormat> imageFormat(const std::filesystem::path& path);

// Linear pixels: a PNG through the inverse sRGB function (tone mapping can't be undone). Errors of
// readFile(), decodePng() and decodeExr().
Result<LinearImage> readImage(const std::filesystem::path& path);

enum class RadianceFormat : std::uint8_t { Hdr, Exr };

// Of pictures that hold radiance, by the extension, upper or lower case. Error "image-extension".
Result<RadianceFormat> radianceFormat(const std::filesystem::path& path);

// Errors of readFile(), decodeHdr() and decodeExr().
Result<LinearImage> readRadiance(const std::filesystem::path& path);

// PNG: exposed by `exposure` stops and tone mapped. EXR: as it is, without exposure. An existing file is
// replaced as a whole or not at all.
Status writeImage(const std::filesystem::path& path, const LinearImage& image, double exposure);
// PNG only. Errors "image-extension" for another one, "png-encode", "file-write".
Status writeImage(const std::filesystem::path& path, const DisplayImage& image);

// Error "image-size" for an image that is empty, above 16384 pixels either way or above 2^26 in all.
Status checkImageSize(std::int64_t width, std::int64_t height, const std::string& where);

}  // namespace glint
