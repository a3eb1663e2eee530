#include "gltf/texels/fit.h"

#include "gltf/codecs/codecs.h"
#include "gltf/texels/levels.h"
#include "gltf/textures.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <initializer_list>
#include <optional>
#include <span>
#include <utility>

namespace glint::gltf {

namespace {

constexpr std::uint32_t kRedGreen = 3;
constexpr std::uint32_t kAlpha = 8;

bool suits(TexelFormat format, const ImageUse& use, const TexelFormats& formats) {
    return (!use.isColor || formats.has(format, true)) && (!use.isData || formats.has(format, false));
}

bool canPack(TexelFormat format) {
    return format == TexelFormat::Bc1 || format == TexelFormat::Bc3 || format == TexelFormat::Bc4 ||
           format == TexelFormat::Bc5 || format == TexelFormat::Bc7;
}

// The channels of the image that a format of one or two channels holds.
std::array<int, 2> heldChannels(const ImageUse& use, TexelFormat format) {
    const std::uint32_t read = use.isNormals ? kRedGreen : use.channels;
    const int first = read == 0 ? 0 : std::countr_zero(read);
    const std::uint32_t rest = read & (read - 1U);
    const int second = rest == 0 ? first : std::countr_zero(rest);
    const std::uint32_t channels = infoOf(format).channels;
    return {channels <= 2 ? first : 0, channels == 2 ? second : 1};
}

// Where shaders find the channels of the image.
TexelChannels channelsOf(const ImageUse& use, TexelFormat format) {
    const std::array<int, 2> held = heldChannels(use, format);
    TexelChannels channels = kChannelsAsStored;
    if (infoOf(format).channels <= 2) {
        channels = {TexelChannel::Zero, TexelChannel::Zero, TexelChannel::Zero, TexelChannel::One};
        channels[static_cast<std::size_t>(held[0])] = TexelChannel::R;
        if (infoOf(format).channels == 2) {
            channels[static_cast<std::size_t>(held[1])] = TexelChannel::G;
        }
    }
    return channels;
}

// Packs a level of RGBA8. Blocks at the border repeat the last texels.
void packLevel(TexelFormat format, const std::array<int, 2>& channels, std::span<const std::uint8_t> pixels,
               std::uint32_t width, std::uint32_t height, std::vector<std::uint8_t>& blocks) {
    std::array<std::uint8_t, 16> block{};
    BlockTexels texels;
    for (std::uint32_t top = 0; top < height; top += 4) {
        for (std::uint32_t left = 0; left < width; left += 4) {
            for (std::uint32_t i = 0; i < 16; ++i) {
                const std::size_t x = std::min(left + i % 4, width - 1);
                const std::size_t y = std::min(top + i / 4, height - 1);
                std::memcpy(texels[i].data(), &pixels[4 * (y * width + x)], 4);
            }
            packBlock(format, texels, channels, block.data());
            blocks.insert(blocks.end(), block.begin(), block.begin() + infoOf(format).blockBytes);
        }
    }
}

// Packs the levels [first, levels) of RGBA8.
void packLevels(const Texels& texels, int first, const std::array<int, 2>& channels, FittedImage& fitted) {
    std::size_t offset = 0;
    for (int level = 0; level < texels.levels; ++level) {
        const int width = sizeOfLevel(texels.width, level);
        const int height = sizeOfLevel(texels.height, level);
        const std::size_t bytes = 4 * placeOfTexel(0, height, width);
        for (int layer = 0; layer < layersOfLevel(texels, level); ++layer) {
            if (level >= first) {
                packLevel(fitted.format, channels, std::span(texels.bytes).subspan(offset, bytes),
                          static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height),
                          fitted.texels);
            }
            offset += bytes;
        }
    }
    fitted.levels = texels.levels;
}

std::vector<std::uint8_t> narrowed(const std::vector<std::uint8_t>& wide) {
    std::vector<std::uint8_t> narrow(wide.size() / 2);
    for (std::size_t i = 0; i < narrow.size(); ++i) {
        std::uint16_t value = 0;
        std::memcpy(&value, &wide[2 * i], sizeof value);
        narrow[i] = static_cast<std::uint8_t>((value + 128U) / 257U);
    }
    return narrow;
}

class Fitter {
public:
    Fitter(const Scene& scene, const Image& image, const ImageUse& use, const FitOptions& options)
        : scene_(scene), image_(image), use_(use), options_(options) {
        static_cast<ImageShape&>(fitted_) = image;
    }

    Result<FittedImage> fit() {
        const Codec* const codec = image_.file.empty() ? nullptr : findCodec(image_.file);
        const bool hasBlocks = codec == &kBasisu || codec == &kDds;
        GLINT_TRY_DO(hasBlocks ? fitBlocks() : fitTexels());
        if (options_.decodeEmission && use_.isEmission && isBlockFormat(fitted_.format)) {
            GLINT_TRY_DO(decode());
            const auto bytes = static_cast<std::ptrdiff_t>(4 * pixelCount(image_, 0));
            fitted_.decoded.assign(texels_->bytes.begin(), texels_->bytes.begin() + bytes);
        }
        return std::move(fitted_);
    }

private:
    // Unpacks all levels of the file, once.
    Status decode() {
        if (!texels_) {
            GLINT_TRY(texels_, texelsOf(scene_, image_));
        }
        return okStatus();
    }

    Status fitBlocks() {
        const auto refuse = [&](const Diagnostic& fault) {
            return cantDecode(scene_, image_, *findCodec(image_.file), fault);
        };
        const Result<BlockFile> file = readBlockFile(image_.file);
        if (!file) {
            return refuse(file.error());
        }
        const TexelFormat format =
            file->format ? *file->format : targetFormat(use_, file->hasAlpha, false, options_.formats);
        if (!isBlockFormat(format) || !suits(format, use_, options_.formats) ||
            (isVolume(image_) && !hasVolumes(format))) {
            return fitTexels();
        }
        // The transcoder knows no channels but red and alpha for these.
        if (!file->format && infoOf(format).channels <= 2) {
            GLINT_TRY_DO(decode());
            compress(format);
            return okStatus();
        }
        fitted_.format = format;
        if (file->format && !file->hasAlpha) {
            fitted_.channels[3] = TexelChannel::One;
        }
        Result<base::Bytes> blocks =
            file->format ? blocksOf(*file, image_.file) : transcodeBasis(*file, image_.file, format);
        if (!blocks) {
            return refuse(blocks.error());
        }
        fitted_.texels = std::move(*blocks);
        return completeBlocks();
    }

    // Makes the levels that the file lacks.
    Status completeBlocks() {
        const int most = fullLevels(image_.width, image_.height);
        if (image_.levels >= most || isVolume(image_) || !canPack(fitted_.format) || !hasBasisu()) {
            return okStatus();
        }
        GLINT_TRY_DO(decode());
        completeLevels(*texels_, levelFiltersOf(use_));
        packLevels(*texels_, image_.levels, {0, 1}, fitted_);
        return okStatus();
    }

    Status fitTexels() {
        GLINT_TRY_DO(decode());
        if (options_.compress && hasBasisu() && !isVolume(image_)) {
            const bool hasAlpha = (use_.channels & kAlpha) != 0;
            const TexelFormat format = targetFormat(use_, hasAlpha, true, options_.formats);
            if (isBlockFormat(format)) {
                compress(format);
                return okStatus();
            }
        }
        const bool blits = blitsSuit(use_) && isPowerOfTwo(image_.width) && isPowerOfTwo(image_.height);
        if (options_.allLevels || !blits) {
            completeLevels(*texels_, levelFiltersOf(use_));
        }
        fitted_.format = texels_->format == PixelFormat::Rgba16 ? TexelFormat::Rgba16 : TexelFormat::Rgba8;
        fitted_.levels = texels_->levels;
        fitted_.texels = std::move(texels_->bytes);
        texels_.reset();
        return okStatus();
    }

    void compress(TexelFormat format) {
        if (texels_->format == PixelFormat::Rgba16) {
            texels_->bytes = narrowed(texels_->bytes);
            texels_->format = PixelFormat::Rgba8;
        }
        completeLevels(*texels_, levelFiltersOf(use_));
        fitted_.format = format;
        fitted_.channels = channelsOf(use_, format);
        packLevels(*texels_, 0, heldChannels(use_, format), fitted_);
    }

    const Scene& scene_;
    const Image& image_;
    const ImageUse& use_;
    const FitOptions& options_;
    FittedImage fitted_;
    std::optional<Texels> texels_;
};

}  // namespace

TexelFormat targetFormat(const ImageUse& use, bool hasAlpha, bool packs, const TexelFormats& formats) {
    const auto first = [&](std::initializer_list<TexelFormat> wanted) {
        const auto* const found = std::ranges::find_if(wanted, [&](TexelFormat format) {
            return suits(format, use, formats) && (!packs || canPack(format));
        });
        return found == wanted.end() ? TexelFormat::Rgba8 : *found;
    };
    using enum TexelFormat;
    const int channels = std::popcount(use.channels);
    if (use.isNormals || (!use.isColor && channels == 2)) {
        return first({Bc5, Bc7, Astc4x4});
    }
    if (!use.isColor && channels == 1) {
        return first({Bc4, Bc7, Astc4x4});
    }
    return first({Bc7, hasAlpha ? Bc3 : Bc1, Astc4x4});
}

Result<FittedImage> fitImage(const Scene& scene, const Image& image, const ImageUse& use,
                             const FitOptions& options) {
    return Fitter(scene, image, use, options).fit();
}

}  // namespace glint::gltf
