#include "gltf/texels/levels.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>

namespace glint::gltf {

namespace {

using Value = std::array<float, 4>;

// A level in linear numbers; vectors are within [-1, 1].
struct LinearLevel {
    int width = 0;
    int height = 0;
    std::vector<Value> values;
};

double encodeSrgb(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

// Returns the number whose mean is taken, for a number in [0, 1] that the image stores.
double decoded(double value, LevelFilter filter) {
    switch (filter) {
        case LevelFilter::Color:
            return decodeSrgb(value);
        case LevelFilter::Normals:
            return 2.0 * value - 1.0;
        case LevelFilter::Roughness:
            return value * value;
        case LevelFilter::Glossiness:
            return (1.0 - value) * (1.0 - value);
        case LevelFilter::Data:
            break;
    }
    return value;
}

// Translates between the codes of a channel and linear numbers.
class Coding {
public:
    Coding(PixelFormat format, const LevelFilters& filters)
        : most_(format == PixelFormat::Rgba16 ? 65535 : 255), filters_(filters) {
        for (std::size_t i = 0; i < 4; ++i) {
            std::vector<float>& table = decode_[static_cast<std::size_t>(filters[i])];
            for (std::size_t code = table.size(); code <= most_; ++code) {
                table.push_back(static_cast<float>(decoded(static_cast<double>(code) / most_, filters[i])));
            }
            tables_[i] = table.data();
        }
        // The darkest step of 8 bits is twenty steps of this table.
        if (filters[0] == LevelFilter::Color && most_ == 255) {
            encode_.resize(kTableSteps + std::size_t{1});
            for (std::size_t i = 0; i < encode_.size(); ++i) {
                encode_[i] = static_cast<std::uint8_t>(
                    std::lround(255.0 * encodeSrgb(static_cast<double>(i) / kTableSteps)));
            }
        }
    }
    Coding(const Coding&) = delete;
    Coding& operator=(const Coding&) = delete;

    Value decode(const std::array<std::uint32_t, 4>& codes) const {
        return {tables_[0][codes[0]], tables_[1][codes[1]], tables_[2][codes[2]], tables_[3][codes[3]]};
    }

    std::array<std::uint32_t, 4> encode(Value value) const {
        if (filters_[0] == LevelFilter::Normals) {
            const float length = std::sqrt(value[0] * value[0] + value[1] * value[1] + value[2] * value[2]);
            for (std::size_t i = 0; i < 3; ++i) {
                value[i] = length > 0.0F ? value[i] / length * 0.5F + 0.5F : value[i] * 0.5F + 0.5F;
            }
        }
        std::array<std::uint32_t, 4> codes{};
        for (std::size_t i = 0; i < 4; ++i) {
            codes[i] = encode(value[i], filters_[i]);
        }
        return codes;
    }

private:
    static constexpr std::size_t kTableSteps = 65535;

    std::uint32_t encode(float value, LevelFilter filter) const {
        switch (filter) {
            case LevelFilter::Color:
                return encodeColor(value);
            case LevelFilter::Roughness:
                return rounded(std::sqrt(value));
            case LevelFilter::Glossiness:
                return rounded(1.0F - std::sqrt(value));
            case LevelFilter::Data:
            case LevelFilter::Normals:
                break;
        }
        return rounded(value);
    }
    std::uint32_t rounded(float value) const {
        return static_cast<std::uint32_t>(
            std::lround(std::clamp(value, 0.0F, 1.0F) * static_cast<float>(most_)));
    }
    std::uint32_t encodeColor(float value) const {
        if (encode_.empty()) {
            return rounded(static_cast<float>(encodeSrgb(value)));
        }
        return encode_[static_cast<std::size_t>(
            std::lround(std::clamp(value, 0.0F, 1.0F) * float{kTableSteps}))];
    }

    std::uint32_t most_;
    LevelFilters filters_;
    std::array<std::vector<float>, 5> decode_;  // by LevelFilter, then by code
    std::array<const float*, 4> tables_{};      // those of the channels
    std::vector<std::uint8_t> encode_;  // by kTableSteps times a linear number; empty if there is none
};

// The source texels under a texel of the next level, along one axis.
struct Taps {
    int first = 0;
    int count = 0;
    std::array<float, 4> weights{};
};

std::vector<Taps> tapsOf(int from, int to) {
    std::vector<Taps> taps(static_cast<std::size_t>(to));
    const double size = static_cast<double>(from) / to;
    for (int i = 0; i < to; ++i) {
        Taps& tap = taps[static_cast<std::size_t>(i)];
        const double begin = i * size;
        const double end = begin + size;
        tap.first = static_cast<int>(begin);
        for (int texel = tap.first; texel < from && texel < end - 1e-9; ++texel) {
            const double share = std::min(end, texel + 1.0) - std::max(begin, static_cast<double>(texel));
            tap.weights[static_cast<std::size_t>(tap.count++)] = static_cast<float>(share / size);
        }
    }
    return taps;
}

// Makes the next level; `at` returns the value of a texel of the last.
template <typename At>
LinearLevel halved(int width, int height, const At& at) {
    LinearLevel half{std::max(width / 2, 1), std::max(height / 2, 1), {}};
    const std::vector<Taps> columns = tapsOf(width, half.width);
    const std::vector<Taps> rows = tapsOf(height, half.height);
    half.values.reserve(placeOfTexel(0, half.height, half.width));
    for (const Taps& row : rows) {
        for (const Taps& column : columns) {
            Value sum{};
            for (int y = 0; y < row.count; ++y) {
                for (int x = 0; x < column.count; ++x) {
                    const Value value = at(column.first + x, row.first + y);
                    const float weight = row.weights[static_cast<std::size_t>(y)] *
                                         column.weights[static_cast<std::size_t>(x)];
                    for (std::size_t i = 0; i < 4; ++i) {
                        sum[i] += weight * value[i];
                    }
                }
            }
            half.values.push_back(sum);
        }
    }
    return half;
}

template <typename Code>
void append(const LinearLevel& level, const Coding& coding, std::vector<std::uint8_t>& bytes) {
    for (const Value& value : level.values) {
        const std::array<std::uint32_t, 4> codes = coding.encode(value);
        const std::array<Code, 4> texel{static_cast<Code>(codes[0]), static_cast<Code>(codes[1]),
                                        static_cast<Code>(codes[2]), static_cast<Code>(codes[3])};
        const auto* const begin = reinterpret_cast<const std::uint8_t*>(texel.data());
        bytes.insert(bytes.end(), begin, begin + sizeof texel);
    }
}

template <typename Code>
void complete(Texels& texels, const LevelFilters& filters) {
    const int most = fullLevels(texels.width, texels.height);
    if (texels.levels >= most || isVolume(texels)) {
        return;
    }
    const Coding coding(texels.format, filters);
    const int width = sizeOfLevel(texels.width, texels.levels - 1);
    const int height = sizeOfLevel(texels.height, texels.levels - 1);
    const std::size_t layerBytes = sizeof(std::array<Code, 4>) * placeOfTexel(0, height, width);
    std::size_t place = texels.bytes.size() - layerBytes * static_cast<std::size_t>(texels.layers);
    std::vector<LinearLevel> layers(static_cast<std::size_t>(texels.layers));
    for (LinearLevel& layer : layers) {
        layer = halved(width, height, [&](int x, int y) {
            std::array<Code, 4> texel{};
            std::memcpy(texel.data(), &texels.bytes[place + sizeof texel * placeOfTexel(x, y, width)],
                        sizeof texel);
            return coding.decode({texel[0], texel[1], texel[2], texel[3]});
        });
        append<Code>(layer, coding, texels.bytes);
        place += layerBytes;
    }
    while (++texels.levels < most) {
        for (LinearLevel& layer : layers) {
            const LinearLevel before = std::move(layer);
            layer = halved(before.width, before.height,
                           [&](int x, int y) { return before.values[placeOfTexel(x, y, before.width)]; });
            append<Code>(layer, coding, texels.bytes);
        }
    }
}

materials::ValueInterval widened(const materials::ValueInterval& value, double share) {
    const bool isWhite = value.low == 1.0;
    const bool isBlack = value.high == 0.0;
    return {isWhite ? 1.0 : value.low * (1.0 - share),
            isBlack ? 0.0 : std::min(value.high * (1.0 + share), 1.0)};
}

}  // namespace

double decodeSrgb(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

int fullLevels(int width, int height) {
    return std::bit_width(static_cast<std::uint32_t>(std::max(width, height)));
}

void completeLevels(Texels& texels, const LevelFilters& filters) {
    if (texels.format == PixelFormat::Rgba16) {
        complete<std::uint16_t>(texels, filters);
    } else {
        complete<std::uint8_t>(texels, filters);
    }
}

// ---- What materials read of images ----

LevelFilters levelFiltersOf(const ImageUse& use) {
    LevelFilters filters = filtersOf(use.isNormals ? LevelFilter::Normals
                                     : use.isColor ? LevelFilter::Color
                                                   : LevelFilter::Data);
    for (std::size_t i = 0; i < filters.size(); ++i) {
        const std::uint32_t channel = 1U << i;
        filters[i] = (use.roughness & channel) != 0    ? LevelFilter::Roughness
                     : (use.glossiness & channel) != 0 ? LevelFilter::Glossiness
                                                       : filters[i];
    }
    return filters;
}

bool blitsSuit(const ImageUse& use) {
    return !use.isNormals && (use.roughness | use.glossiness) == 0;
}

std::vector<ImageUse> imageUses(const Scene& scene) {
    std::vector<ImageUse> uses(scene.images.size());
    std::vector<bool> isUsed(scene.images.size(), false);
    // Channels that some texture reads as no roughness, and as no glossiness.
    std::vector<std::array<std::uint32_t, 2>> others(scene.images.size());
    for (const materials::Material& material : scene.materials) {
        const int emission = material.model().textureOf(package::Role::Emission);
        for (const auto& [slot, info] : material.textures) {
            if (info.texture < 0) {
                continue;
            }
            const int texture = static_cast<int>(slot);
            const auto image =
                static_cast<std::size_t>(scene.textures[static_cast<std::size_t>(info.texture)].image);
            const materials::TextureReads reads = material.readsOf(texture);
            ImageUse& use = uses[image];
            use.isNormals = reads.isNormals && (!isUsed[image] || use.isNormals);
            isUsed[image] = true;
            (material.isColor(texture) ? use.isColor : use.isData) = true;
            use.isEmission = use.isEmission || texture == emission;
            use.channels |= reads.channels;
            use.roughness |= reads.roughness;
            use.glossiness |= reads.glossiness;
            others[image][0] |= reads.channels & ~reads.roughness;
            others[image][1] |= reads.channels & ~reads.glossiness;
        }
    }
    for (std::size_t i = 0; i < uses.size(); ++i) {
        uses[i].roughness &= ~others[i][0];
        uses[i].glossiness &= ~others[i][1];
    }
    return uses;
}

double numberAsRead(double stored, bool isColor) {
    return isColor ? decodeSrgb(stored) : stored;
}

std::array<materials::ValueInterval, 4> contentAsRead(const std::array<materials::ValueInterval, 4>& stored,
                                                      bool isColor) {
    // Filters in single precision, and llvmpipe's sRGB, which is off by up to 0.7 %.
    constexpr double kFilter = 1e-5;
    constexpr double kSrgb = 0.01;
    std::array<materials::ValueInterval, 4> read{};
    for (std::size_t channel = 0; channel < 4; ++channel) {
        const materials::ValueInterval& value = stored[channel];
        read[channel] = isColor && channel < 3
                            ? widened({decodeSrgb(value.low), decodeSrgb(value.high)}, kSrgb)
                            : widened(value, kFilter);
    }
    return read;
}

}  // namespace glint::gltf
