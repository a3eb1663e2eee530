// Reads and writes image files by extension: .png (8-bit sRGB, tone mapped) and .exr (32-bit float, linear).
// It also reads radiance from .hdr.
#pragma once

#include "image/exr.h"
#include "image/png.h"

#include <glint/image.h>
#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace glint::image {

enum class ImageFormat : std::uint8_t { Png, Exr };

// Returns the format by the extension, in upper or lower case. Error "image-extension".
Result<ImageFormat> imageFormat(const std::filesystem::path& path);

// Returns linear pixels. A PNG goes through the inverse sRGB function, but its tone mapping can't be undone.
// Has the errors of readFile(), decodePng() and decodeExr().
Result<LinearImage> readImage(const std::filesystem::path& path);

// Returns the picture as a display shows it, exposed by `exposure` stops and tone mapped.
DisplayImage toDisplayImage(const LinearImage& image, double exposure);

enum class RadianceFormat : std::uint8_t { Hdr, Exr };

// Returns the format of a picture that holds radiance, by the extension, in upper or lower case. Error
// "image-extension".
Result<RadianceFormat> radianceFormat(const std::filesystem::path& path);

// Has the errors of readFile(), decodeHdr() and decodeExr().
Result<LinearImage> readRadiance(const std::filesystem::path& path);

// Writes a PNG exposed by `exposure` stops and tone mapped, or an EXR as it is, without exposure. An EXR also
// has the layers; a PNG has room for none. An existing file is replaced as a whole or not at all.
Status writeImage(const std::filesystem::path& path, const LinearImage& image, double exposure,
                  std::span<const ExrLayer> layers = {});
// Writes PNG only. Errors "image-extension" for other extensions, "png-encode", "file-write".
Status writeImage(const std::filesystem::path& path, const DisplayImage& image);

// --- Decodes Radiance RGBE pictures (.hdr) in memory ---

// Returns linear RGB with alpha 1, first row on top. Files may be run-length encoded or flat, in the format
// 32-bit_rle_rgbe with the orientation -Y +X. EXPOSURE is not applied. Errors "image-format", "image-size".
Result<LinearImage> decodeHdr(std::span<const std::uint8_t> bytes, const std::string& where);

}  // namespace glint::image
