// Tests that bounds of texels enclose everything that a sampler gives, and not much more. The reference is a
// sampler in double precision that knows nothing of the bounds.
#include "gltf/texels/texel_bounds.h"

#include "gltf/texels/levels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>
#include <vector>

namespace glint::test {
namespace {

using gltf::Filter;
using gltf::LookupKind;
using gltf::Sampler;
using gltf::TexCoordBox;
using gltf::TexelBounds;
using gltf::TexelRange;
using gltf::Wrap;

constexpr std::array<Wrap, 3> kWraps{Wrap::Repeat, Wrap::ClampToEdge, Wrap::MirroredRepeat};

gltf::Texels randomTexels(int width, int height, std::mt19937& random, std::size_t bytesPerChannel = 1) {
    gltf::Texels texels{
        {width, height}, bytesPerChannel == 2 ? gltf::PixelFormat::Rgba16 : gltf::PixelFormat::Rgba8, {}};
    texels.bytes.resize(4 * bytesPerChannel * static_cast<std::size_t>(width * height));
    std::ranges::generate(texels.bytes, [&] { return static_cast<std::uint8_t>(random() % 256); });
    return texels;
}

// Samples levels as Vulkan 1.3 says ("Texel Input Operations").
class ReferenceSampler {
public:
    explicit ReferenceSampler(gltf::Texels texels) : texels_(std::move(texels)) {
        std::size_t offset = 0;
        for (int level = 0; level < texels_.levels; ++level) {
            starts_.push_back(offset);
            offset += bytesOfTexel() * static_cast<std::size_t>(width(level) * height(level));
        }
    }

    int levels() const {
        return texels_.levels;
    }
    int width(int level) const {
        return std::max(texels_.width >> level, 1);
    }
    int height(int level) const {
        return std::max(texels_.height >> level, 1);
    }

    // Returns codes, which filters make fractions of.
    std::array<double, 4> sample(double u, double v, int level, const Sampler& sampler, Filter filter) const {
        const double x = u * width(level);
        const double y = v * height(level);
        if (filter == Filter::Nearest) {
            return texel(std::floor(x), std::floor(y), level, sampler);
        }
        const double left = std::floor(x - 0.5);
        const double top = std::floor(y - 0.5);
        std::array<double, 4> sum{};
        for (int i = 0; i < 4; ++i) {
            const double weightX = i % 2 == 1 ? x - 0.5 - left : 1.0 - (x - 0.5 - left);
            const double weightY = i / 2 == 1 ? y - 0.5 - top : 1.0 - (y - 0.5 - top);
            const auto value = texel(left + i % 2, top + i / 2, level, sampler);
            for (std::size_t channel = 0; channel < 4; ++channel) {
                sum[channel] += weightX * weightY * value[channel];
            }
        }
        return sum;
    }

    std::array<double, 4> at(int level, int x, int y) const {
        const std::size_t place = starts_[static_cast<std::size_t>(level)] +
                                  bytesOfTexel() * static_cast<std::size_t>(y * width(level) + x);
        std::array<double, 4> value{};
        for (std::size_t i = 0; i < 4; ++i) {
            std::uint16_t code = 0;
            std::memcpy(&code, &texels_.bytes[place + i * (bytesOfTexel() / 4)], bytesOfTexel() / 4);
            value[i] = code;
        }
        return value;
    }

private:
    std::size_t bytesOfTexel() const {
        return gltf::bytesPerPixel(texels_.format);
    }

    static int wrapped(double index, int size, Wrap wrap) {
        if (wrap == Wrap::ClampToEdge) {
            return static_cast<int>(std::clamp(index, 0.0, size - 1.0));
        }
        const double period = wrap == Wrap::Repeat ? size : 2.0 * size;
        const int place = static_cast<int>(index - period * std::floor(index / period));
        return place < size ? place : 2 * size - 1 - place;
    }

    std::array<double, 4> texel(double x, double y, int level, const Sampler& sampler) const {
        return at(level, wrapped(x, width(level), sampler.wrapU), wrapped(y, height(level), sampler.wrapV));
    }

    gltf::Texels texels_;
    std::vector<std::size_t> starts_;
};

// Returns the codes that lookups in the box can combine.
TexelRange over(const TexelBounds& bounds, const TexCoordBox& box, const LookupKind& kind) {
    TexelRange range;
    bounds.joinOver(box, kind, range);
    return range;
}

using Query = std::function<TexelRange(const TexCoordBox&, const LookupKind&)>;

// Looks up at a grid of points in the box, its corners included, on all levels that the sampler can choose.
// Returns the number of results outside of the range.
int countEscapes(const ReferenceSampler& reference, const Query& query, const TexCoordBox& box,
                 const LookupKind& kind) {
    constexpr int kPoints = 7;
    const TexelRange range = query(box, kind);
    const int levels = kind.finestLevel || !kind.sampler.mipmapped ? 1 : reference.levels();
    int escapes = 0;
    for (int level = 0; level < levels; ++level) {
        for (int i = 0; i < kPoints * kPoints; ++i) {
            const double u = std::lerp(box.low[0], box.high[0], i % kPoints / (kPoints - 1.0));
            const double v = std::lerp(box.low[1], box.high[1], i / kPoints / (kPoints - 1.0));
            for (const Filter filter : {kind.sampler.minification, kind.sampler.magnification}) {
                if (level > 0 && filter != kind.sampler.minification) {
                    continue;
                }
                const auto value = reference.sample(u, v, level, kind.sampler, filter);
                for (std::size_t channel = 0; channel < 4; ++channel) {
                    constexpr double kRounding = 1e-6;
                    escapes += value[channel] < range.least[channel] - kRounding ||
                                       value[channel] > range.greatest[channel] + kRounding
                                   ? 1
                                   : 0;
                }
            }
        }
    }
    return escapes;
}

struct Trial {
    TexCoordBox box;
    LookupKind kind;
};

// Every wrap mode along both axes, every filter; boxes from points to several tiles, many with their ends on
// seams and texel centres.
std::vector<Trial> trials(int width, int height, std::mt19937& random) {
    std::vector<Trial> made;
    std::uniform_real_distribution<double> anywhere(-2.5, 2.5);
    for (int i = 0; i < 9 * 8 * 6; ++i) {
        Trial trial;
        Sampler& sampler = trial.kind.sampler;
        sampler.wrapU = kWraps[static_cast<std::size_t>(i % 3)];
        sampler.wrapV = kWraps[static_cast<std::size_t>(i / 3 % 3)];
        sampler.minification = i / 9 % 2 == 0 ? Filter::Linear : Filter::Nearest;
        sampler.magnification = i / 18 % 2 == 0 ? Filter::Linear : Filter::Nearest;
        sampler.mipmapped = i / 36 % 2 == 0;
        trial.kind.anisotropic = false;
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const int size = axis == 0 ? width : height;
            double low = anywhere(random);
            if (random() % 2 == 0) {
                low = std::round(low * 2 * size) / (2.0 * size);
            }
            const double extents[] = {0.0, 0.5 / size, 1.0 / size, 1.5 / size, 0.4, 1.0, 2.2};
            trial.box.low[axis] = low;
            trial.box.high[axis] = low + extents[random() % 7];
        }
        made.push_back(trial);
    }
    return made;
}

gltf::Texels completed(gltf::Texels texels, const gltf::LevelFilters& filters) {
    completeLevels(texels, filters);
    return texels;
}

// Runs all trials on images of many sizes. Returns the number of results that escape from what `make`
// returns.
int escapesOf(const std::function<Query(const TexelBounds&)>& make, const gltf::LevelFilters& filters = {}) {
    std::mt19937 random(7);
    int escapes = 0;
    for (const auto& [width, height] :
         std::vector<std::pair<int, int>>{{1, 1}, {2, 2}, {3, 2}, {1, 5}, {4, 4}, {7, 5}, {17, 9}, {32, 8}}) {
        const gltf::Texels texels = randomTexels(width, height, random, width == 4 ? 2 : 1);
        const ReferenceSampler reference(completed(texels, filters));
        const TexelBounds bounds(texels, {.filters = filters, .mayBlit = false});
        for (const Trial& trial : trials(width, height, random)) {
            escapes += countEscapes(reference, make(bounds), trial.box, trial.kind);
        }
    }
    return escapes;
}

Query exactly(const TexelBounds& bounds) {
    return [&](const TexCoordBox& box, const LookupKind& kind) { return over(bounds, box, kind); };
}

TEST(TexelBounds, EncloseWhatSamplersGive) {
    EXPECT_EQ(escapesOf(exactly), 0);
}

// Roots of mean squares are between the least and the greatest of their numbers, as other means are.
TEST(TexelBounds, EncloseLevelsOfRoughness) {
    using enum gltf::LevelFilter;
    constexpr gltf::LevelFilters kFilters{Roughness, Glossiness, Data, Roughness};
    EXPECT_EQ(escapesOf(exactly, kFilters), 0);
    std::mt19937 random(17);
    for (const auto& [width, height] : {std::pair{16, 16}, std::pair{13, 7}}) {
        gltf::Texels texels = randomTexels(width, height, random);
        for (std::size_t i = 0; i < texels.bytes.size(); ++i) {
            texels.bytes[i] = static_cast<std::uint8_t>(40 + 10 * (i % 4) + texels.bytes[i] % 100);
        }
        const TexelBounds finest(texels, {.filters = kFilters, .complete = false});
        const TexelBounds all(texels, {.filters = kFilters, .mayBlit = false});
        EXPECT_GT(completed(texels, kFilters).levels, texels.levels);
        EXPECT_EQ(all.whole(), finest.whole());
    }
}

TEST(TexelBounds, TheTestFindsBoundsThatAreTooNarrowByOneCode) {
    EXPECT_GT(escapesOf([](const TexelBounds& bounds) {
                  return [&](const TexCoordBox& box, const LookupKind& kind) {
                      TexelRange range = over(bounds, box, kind);
                      ++range.least[2];
                      return range;
                  };
              }),
              0);
    EXPECT_GT(escapesOf([](const TexelBounds& bounds) {
                  return [&](const TexCoordBox& box, const LookupKind& kind) {
                      TexelRange range = over(bounds, box, kind);
                      --range.greatest[0];
                      return range;
                  };
              }),
              0);
}

// A repeated texture blends its last column with its first. Bounds that stop at the seam miss it.
TEST(TexelBounds, TheTestFindsATexelThatIsMissedAtASeam) {
    EXPECT_GT(escapesOf([](const TexelBounds& bounds) {
                  return [&](const TexCoordBox& box, LookupKind kind) {
                      if (std::floor(box.low[0]) == std::floor(box.high[0])) {
                          TexCoordBox inside = box;
                          inside.low[0] -= std::floor(box.low[0]);
                          inside.high[0] -= std::floor(box.low[0]);
                          if (kind.sampler.wrapU == Wrap::Repeat) {
                              kind.sampler.wrapU = Wrap::ClampToEdge;
                              return over(bounds, inside, kind);
                          }
                      }
                      return over(bounds, box, kind);
                  };
              }),
              0);
}

// Every box of whole texels of a small image, against all texels that it touches or that are next to these.
TEST(TexelBounds, AreTightOnEveryBoxOfASmallImage) {
    std::mt19937 random(11);
    constexpr int kWidth = 6;
    constexpr int kHeight = 5;
    const gltf::Texels texels = randomTexels(kWidth, kHeight, random);
    const ReferenceSampler reference(texels);
    const TexelBounds bounds(texels, {});
    LookupKind kind{.finestLevel = true};
    const auto wrap = [](int i, int size) { return (i % size + size) % size; };
    for (const bool linear : {false, true}) {
        kind.sampler.magnification = linear ? Filter::Linear : Filter::Nearest;
        kind.sampler.minification = kind.sampler.magnification;
        for (int code = 0; code < kWidth * kWidth * kHeight * kHeight; ++code) {
            const int left = code % kWidth;
            const int right = left + code / kWidth % kWidth;
            const int top = code / (kWidth * kWidth) % kHeight;
            const int bottom = top + code / (kWidth * kWidth * kHeight);
            // From the first quarter of the first texel to the last quarter of the last one.
            const TexCoordBox box{{(left + 0.25) / kWidth, (top + 0.25) / kHeight},
                                  {(right + 0.75) / kWidth, (bottom + 0.75) / kHeight}};
            const int around = linear ? 1 : 0;
            TexelRange expected;
            for (int y = top - around; y <= bottom + around; ++y) {
                for (int x = left - around; x <= right + around; ++x) {
                    const auto value = reference.at(0, wrap(x, kWidth), wrap(y, kHeight));
                    for (std::size_t i = 0; i < 4; ++i) {
                        const auto number = static_cast<std::uint16_t>(value[i]);
                        expected.least[i] = std::min(expected.least[i], number);
                        expected.greatest[i] = std::max(expected.greatest[i], number);
                    }
                }
            }
            ASSERT_EQ(over(bounds, box, kind), expected)
                << left << ' ' << right << ' ' << top << ' ' << bottom;
        }
    }
}

TEST(TexelBounds, FindTheTexelThatDecides) {
    gltf::Texels texels{{40, 30}, gltf::PixelFormat::Rgba8, std::vector<std::uint8_t>(40 * 30 * 4, 100)};
    texels.bytes[4 * (17 * 40 + 23) + 1] = 3;
    const TexelBounds bounds(texels, {});
    const LookupKind kind{.sampler = {.mipmapped = false}};
    const TexCoordBox box{{0.5, 0.5}, {0.9, 0.9}};
    const TexelRange range = over(bounds, box, kind);
    EXPECT_EQ(range.least[1], 3);
    EXPECT_EQ(range.greatest[1], 100);
    const gltf::TexelPlace place = bounds.find(box, kind, range, 1, false);
    EXPECT_EQ(place.level, 0);
    EXPECT_EQ(place.x, 23);
    EXPECT_EQ(place.y, 17);
    EXPECT_EQ(over(bounds, {{0.1, 0.1}, {0.2, 0.2}}, kind).least[1], 100);
}

TEST(TexelBounds, CoordinatesThatAreNoNumbersReachEverything) {
    std::mt19937 random(3);
    const TexelBounds bounds(randomTexels(16, 16, random), {});
    const LookupKind kind{.sampler = {.mipmapped = false}};
    const TexelRange all = over(bounds, {{0.0, 0.0}, {1.0, 1.0}}, kind);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float huge = 3e30F;
    const gltf::Float2 broken[] = {{nan, 0.5F}, {0.5F, 0.5F}, {0.6F, 0.5F}};
    const gltf::Float2 far[] = {{huge, huge}, {huge, huge}, {huge, huge}};
    TexCoordBox box = gltf::boxOf(broken, {});
    EXPECT_EQ(box.high[0], std::numeric_limits<double>::infinity());
    box.low[1] = 0.0;
    box.high[1] = 1.0;
    EXPECT_EQ(over(bounds, box, kind), all);
    EXPECT_EQ(over(bounds, gltf::boxOf(far, {}), kind), all);
}

// KHR_texture_transform in single precision, at random weights of the corners.
TEST(TexelBounds, BoxesEncloseTransformedTriangles) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> any(-3.0F, 3.0F);
    std::uniform_real_distribution<float> unit(0.0F, 1.0F);
    for (int i = 0; i < 2000; ++i) {
        const gltf::Float2 corners[] = {
            {any(random), any(random)}, {any(random), any(random)}, {any(random), any(random)}};
        const materials::TextureTransform transform{
            {any(random), any(random)}, any(random), {any(random), any(random)}};
        const TexCoordBox box = gltf::boxOf(corners, transform);
        for (int j = 0; j < 20; ++j) {
            float b = unit(random);
            float c = unit(random);
            if (b + c > 1.0F) {
                b = 1.0F - b;
                c = 1.0F - c;
            }
            const float a = 1.0F - b - c;
            const float u = a * corners[0][0] + b * corners[1][0] + c * corners[2][0];
            const float v = a * corners[0][1] + b * corners[1][1] + c * corners[2][1];
            const float sine = std::sin(transform.rotation);
            const float cosine = std::cos(transform.rotation);
            const float moved[] = {
                cosine * transform.scale[0] * u + sine * transform.scale[1] * v + transform.offset[0],
                -sine * transform.scale[0] * u + cosine * transform.scale[1] * v + transform.offset[1]};
            for (std::size_t axis = 0; axis < 2; ++axis) {
                EXPECT_LE(box.low[axis], moved[axis]);
                EXPECT_GE(box.high[axis], moved[axis]);
            }
        }
    }
}

// Levels that a device makes by blits are rounded at each step, in any direction.
TEST(TexelBounds, EncloseLevelsOfBlits) {
    std::mt19937 random(13);
    gltf::Texels texels = randomTexels(32, 32, random);
    const TexelBounds bounds(texels, {});
    std::vector<double> values(texels.bytes.begin(), texels.bytes.end());
    for (int level = 1, size = 16; size > 0; ++level, size /= 2) {
        std::vector<double> next;
        for (int i = 0; i < size * size * 4; ++i) {
            const int channel = i % 4;
            const int x = i / 4 % size;
            const int y = i / 4 / size;
            const auto at = [&](int dx, int dy) {
                return values[static_cast<std::size_t>(4 * ((2 * y + dy) * 2 * size + 2 * x + dx) + channel)];
            };
            const double mean = (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1)) / 4.0;
            next.push_back(random() % 2 == 0 ? std::floor(mean) : std::ceil(mean));
        }
        values = std::move(next);
        LookupKind kind{.sampler = {.minification = Filter::Nearest}};
        for (int texel = 0; texel < size * size; ++texel) {
            const double u = (texel % size + 0.5) / size;
            const double v = (texel / size + 0.5) / size;
            const TexelRange range = over(bounds, {{u, v}, {u, v}}, kind);
            for (std::size_t i = 0; i < 4; ++i) {
                const double value = values[static_cast<std::size_t>(texel) * 4 + i];
                EXPECT_LE(range.least[i], value) << level;
                EXPECT_GE(range.greatest[i], value) << level;
            }
        }
    }
}

TEST(TexelBounds, AnisotropicFiltersReachFurther) {
    gltf::Texels texels{{64, 64}, gltf::PixelFormat::Rgba8, std::vector<std::uint8_t>(64 * 64 * 4, 100)};
    texels.bytes[4 * (32 * 64 + 42)] = 0;
    const TexelBounds bounds(texels, {});
    const double centre = 32.5 / 64.0;
    const TexCoordBox point{{centre, centre}, {centre, centre}};
    LookupKind kind;
    EXPECT_EQ(over(bounds, point, kind).least[0], 0);
    kind.anisotropic = false;
    EXPECT_GT(over(bounds, point, kind).least[0], 0);
}

}  // namespace
}  // namespace glint::test
