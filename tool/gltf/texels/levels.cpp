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

// IEC 61966-2-1.
double decodeSrgb(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}
double encodeSrgb(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

// Translates between the codes of a channel and linear numbers.
class Coding {
public:
    Coding(PixelFormat format, LevelFilter filter)
        : most_(format == PixelFormat::Rgba16 ? 65535 : 255),
          filter_(filter),
          decode_(most_ + std::size_t{1}) {
        for (std::size_t code = 0; code < decode_.size(); ++code) {
            const double value = static_cast<double>(code) / most_;
            decode_[code] = static_cast<float>(filter == LevelFilter::Color     ? decodeSrgb(value)
                                               : filter == LevelFilter::Normals ? 2.0 * value - 1.0
                                                                                : value);
        }
        // The darkest step of 8 bits is twenty steps of this table.
        if (filter == LevelFilter::Color && most_ == 255) {
            encode_.resize(kTableSteps + std::size_t{1});
            for (std::size_t i = 0; i < encode_.size(); ++i) {
                encode_[i] = static_cast<std::uint8_t>(
                    std::lround(255.0 * encodeSrgb(static_cast<double>(i) / kTableSteps)));
            }
        }
    }

    Value decode(const std::array<std::uint32_t, 4>& codes) const {
        return {decode_[codes[0]], decode_[codes[1]], decode_[codes[2]],
                static_cast<float>(codes[3]) / static_cast<float>(most_)};
    }

    std::array<std::uint32_t, 4> encode(Value value) const {
        if (filter_ == LevelFilter::Normals) {
            const float length = std::sqrt(value[0] * value[0] + value[1] * value[1] + value[2] * value[2]);
            for (std::size_t i = 0; i < 3; ++i) {
                value[i] = length > 0.0F ? value[i] / length * 0.5F + 0.5F : value[i] * 0.5F + 0.5F;
            }
        }
        std::array<std::uint32_t, 4> codes{};
        for (std::size_t i = 0; i < 4; ++i) {
            codes[i] = filter_ == LevelFilter::Color && i < 3 ? encodeColor(value[i]) : rounded(value[i]);
        }
        return codes;
    }

private:
    static constexpr std::size_t kTableSteps = 65535;

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
    LevelFilter filter_;
    std::vector<float> decode_;         // by code
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
    half.values.reserve(static_cast<std::size_t>(half.width) * static_cast<std::size_t>(half.height));
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
void complete(Texels& texels, LevelFilter filter) {
    const int most = fullLevels(texels.width, texels.height);
    if (texels.levels >= most) {
        return;
    }
    const Coding coding(texels.format, filter);
    const auto sizeOf = [](int size, int level) { return std::max(size >> level, 1); };
    const int width = sizeOf(texels.width, texels.levels - 1);
    const int height = sizeOf(texels.height, texels.levels - 1);
    const std::size_t last = texels.bytes.size() - sizeof(std::array<Code, 4>) *
                                                       static_cast<std::size_t>(width) *
                                                       static_cast<std::size_t>(height);
    LinearLevel level = halved(width, height, [&](int x, int y) {
        std::array<Code, 4> texel{};
        std::memcpy(
            texel.data(),
            &texels
                 .bytes[last + sizeof texel * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                               static_cast<std::size_t>(x))],
            sizeof texel);
        return coding.decode({texel[0], texel[1], texel[2], texel[3]});
    });
    append<Code>(level, coding, texels.bytes);
    while (++texels.levels < most) {
        const LinearLevel before = std::move(level);
        level = halved(before.width, before.height, [&](int x, int y) {
            return before.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(before.width) +
                                 static_cast<std::size_t>(x)];
        });
        append<Code>(level, coding, texels.bytes);
    }
}

}  // namespace

int fullLevels(int width, int height) {
    return std::bit_width(static_cast<std::uint32_t>(std::max(width, height)));
}

void completeLevels(Texels& texels, LevelFilter filter) {
    if (texels.format == PixelFormat::Rgba16) {
        complete<std::uint16_t>(texels, filter);
    } else {
        complete<std::uint8_t>(texels, filter);
    }
}

}  // namespace glint::gltf
