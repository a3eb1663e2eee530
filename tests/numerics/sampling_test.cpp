// Compares samples with densities: integrals of the densities, and chi-square tests of where samples land.
#include "materials.h"
#include "support/nightly.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace glint::numerics {
namespace {

constexpr std::uint64_t kSeed = 20240602;
constexpr int kSamples = 200000;

// Counts samples in cells of the sphere, even in z and azimuth, and in one more cell for samples that went
// nowhere.
class Cells {
public:
    static constexpr int kRows = 24;
    static constexpr int kColumns = 24;

    void add(const glm::dvec3& direction) {
        const int row = std::clamp(static_cast<int>((direction.z + 1.0) * 0.5 * kRows), 0, kRows - 1);
        const double turn = std::atan2(direction.y, direction.x) / (2.0 * kPi) + 0.5;
        const int column = std::clamp(static_cast<int>(turn * kColumns), 0, kColumns - 1);
        ++counts_[cellOf(row, column)];
    }
    void addLost() {
        ++lost_;
    }

    // Returns the probability that the true distribution is at least this far from what `density` expects.
    // Cells that expect fewer than ten samples are joined.
    double significance(const std::function<double(const glm::dvec3&)>& density) const {
        double statistic = 0.0;
        int cells = 0;
        double pooledExpected = 0.0;
        double pooledCount = 0.0;
        double total = 0.0;
        const auto compare = [&](double expected, double count) {
            statistic += (count - expected) * (count - expected) / expected;
            ++cells;
        };
        for (std::size_t cell = 0; cell < counts_.size(); ++cell) {
            const auto row = static_cast<int>(cell / kColumns);
            const auto column = static_cast<int>(cell % kColumns);
            const double expected = kSamples * massOf(row, column, density);
            const double count = counts_[cell];
            total += expected;
            if (expected < 10.0) {
                pooledExpected += expected;
                pooledCount += count;
            } else {
                compare(expected, count);
            }
        }
        pooledExpected += std::max(kSamples - total, 0.0);
        pooledCount += lost_;
        if (pooledExpected >= 10.0) {
            compare(pooledExpected, pooledCount);
        } else if (pooledCount > 40.0) {
            return 0.0;
        }
        // Wilson and Hilferty 1931: the cube root of chi-square over its degrees of freedom is nearly normal.
        const double freedom = cells - 1.0;
        const double spread = 2.0 / (9.0 * freedom);
        return 0.5 * std::erfc((std::cbrt(statistic / freedom) - (1.0 - spread)) / std::sqrt(2.0 * spread));
    }

private:
    static std::size_t cellOf(int row, int column) {
        return static_cast<std::size_t>(row) * kColumns + static_cast<std::size_t>(column);
    }

    using Density = std::function<double(const glm::dvec3&)>;

    struct Area {
        double z = 0.0;  // from here
        double height = 0.0;
        double phi = 0.0;
        double width = 0.0;
    };

    // Uses the midpoint rule.
    static double coarseMass(const Area& area, const Density& density) {
        constexpr int kSteps = 4;
        double sum = 0.0;
        for (int i = 0; i < kSteps; ++i) {
            for (int j = 0; j < kSteps; ++j) {
                sum += density(direction(area.z + area.height * (i + 0.5) / kSteps,
                                         area.phi + area.width * (j + 0.5) / kSteps));
            }
        }
        return sum / (kSteps * kSteps) * area.height * area.width;
    }

    // Integrates over quarters, and over their quarters if that makes a difference that samples could show.
    static double fineMass(const Area& area, const Density& density, double coarse, int depth) {
        Area quarters[4];
        double masses[4];
        double sum = 0.0;
        for (int k = 0; k < 4; ++k) {
            quarters[k] = {area.z + (k % 2 == 0 ? 0.0 : 0.5 * area.height), 0.5 * area.height,
                           area.phi + (k < 2 ? 0.0 : 0.5 * area.width), 0.5 * area.width};
            masses[k] = coarseMass(quarters[k], density);
            sum += masses[k];
        }
        if (depth == 0 || std::abs(sum - coarse) < 1e-6) {
            return sum;
        }
        sum = 0.0;
        for (int k = 0; k < 4; ++k) {
            sum += fineMass(quarters[k], density, masses[k], depth - 1);
        }
        return sum;
    }

    // Returns ∫ density over a cell.
    static double massOf(int row, int column, const Density& density) {
        const Area cell{2.0 * row / kRows - 1.0, 2.0 / kRows, (2.0 * column / kColumns - 1.0) * kPi,
                        2.0 * kPi / kColumns};
        return fineMass(cell, density, coarseMass(cell, density), 8);
    }

    std::vector<double> counts_ = std::vector<double>(kRows * kColumns);
    double lost_ = 0.0;
};

// Wrong samplers fail by many orders of magnitude; right ones fail at this level once in 10,000 seeds.
constexpr double kLevel = 1e-4;

TEST(VisibleNormals, DensityIntegratesToOne) {
    for (const glm::dvec2 alpha : {glm::dvec2(1e-4), glm::dvec2(0.02), glm::dvec2(0.3), glm::dvec2(1.0),
                                   glm::dvec2(0.05, 0.6), glm::dvec2(1e-3, 0.9)}) {
        for (const double cosine : {1e-3, 0.1, 0.5, 1.0}) {
            const glm::dvec3 view = direction(cosine, 0.7);
            // Integrates over half vectors as reflected light, whose density is smaller by 4 v·h.
            Quadrature quadrature(view);
            quadrature.addReflection(alpha);
            const double sum =
                quadrature
                    .integrate(
                        [&](const glm::dvec3& light) {
                            const glm::dvec3 h = glm::normalize(view + light);
                            const double vDotH = glm::dot(view, h);
                            return glm::dvec3(
                                vDotH > 0.0 ? glsl::visibleNormalPdf(view, h, alpha) / (4.0 * vDotH) : 0.0);
                        },
                        20000)
                    .x;
            EXPECT_NEAR(sum, 1.0, 1e-3) << "alpha (" << alpha.x << ", " << alpha.y << "), cosine " << cosine;
        }
    }
}

TEST(VisibleNormals, SamplesFollowTheDensity) {
    Engine engine(kSeed);
    for (const glm::dvec2 alpha :
         {glm::dvec2(0.08), glm::dvec2(0.4), glm::dvec2(1.0), glm::dvec2(0.1, 0.7)}) {
        for (const double cosine : {0.05, 0.5, 1.0}) {
            const glm::dvec3 view = direction(cosine, 2.1);
            Cells cells;
            for (int i = 0; i < kSamples; ++i) {
                cells.add(glsl::sampleVisibleNormal(view, alpha, {uniform(engine), uniform(engine)}));
            }
            EXPECT_GT(cells.significance(
                          [&](const glm::dvec3& h) { return glsl::visibleNormalPdf(view, h, alpha); }),
                      kLevel)
                << "alpha (" << alpha.x << ", " << alpha.y << "), cosine " << cosine << ", seed " << kSeed;
        }
    }
}

struct Family {
    const char* name = "";
    glsl::uint lobes = 0;
};

std::ostream& operator<<(std::ostream& out, const Family& family) {
    return out << family.name;
}

constexpr Family kFamilies[] = {
    {"Base", 0},
    {"Anisotropic", GLINT_ANISOTROPY},
    {"Sheen", GLINT_SHEEN},
    {"Clearcoat", GLINT_CLEARCOAT},
    {"ThinTransmission", GLINT_TRANSMISSION},
    {"Volume", GLINT_TRANSMISSION | GLINT_VOLUME},
    {"Dispersion", GLINT_TRANSMISSION | GLINT_VOLUME | GLINT_DISPERSION},
    {"DiffuseTransmission", GLINT_DIFFUSE_TRANSMISSION},
    {"AllLobes", GLINT_CLEARCOAT | GLINT_SHEEN | GLINT_ANISOTROPY | GLINT_TRANSMISSION | GLINT_VOLUME |
                     GLINT_DISPERSION | GLINT_DIFFUSE_TRANSMISSION},
};

class BsdfSampling : public testing::TestWithParam<Family> {
protected:
    // Returns a material with the family's lobes, seen from somewhere. The closer its index is to 1, the
    // sharper it refracts.
    static TestMaterial make(Engine& engine, double leastAlpha, double leastIndexStep = 0.0) {
        TestMaterial material = randomMaterial(engine, 0, leastAlpha);
        const glsl::uint lobes = GetParam().lobes;
        const auto unsuitable = [&] {
            return material.lobes != lobes || std::abs(material.bsdf.base.eta.y - 1.0) < leastIndexStep;
        };
        while (unsuitable()) {
            material = randomMaterial(engine, lobes, leastAlpha);
        }
        const double cosine = uniform(engine) < 0.3 ? uniform(engine, 0.01, 0.1) : uniform(engine, 0.1, 1.0);
        return material.seenFrom(direction(cosine, uniform(engine, 0.0, 2.0 * kPi)));
    }
    static glsl::BsdfSample sample(const TestMaterial& seen, Engine& engine) {
        const double x = uniform(engine);
        const double y = uniform(engine);
        return glsl::sampleBsdf(seen.bsdf, seen.features(), {x, y, uniform(engine)});
    }
};

TEST_P(BsdfSampling, SamplesFollowTheDensity) {
    Engine engine(kSeed + GetParam().lobes);
    for (int i = 0; i < 4; ++i) {
        const TestMaterial seen = make(engine, 0.06, 0.2);
        Cells cells;
        for (int k = 0; k < kSamples; ++k) {
            const glsl::BsdfSample s = sample(seen, engine);
            if (s.pdf > 0.0) {
                cells.add(s.direction);
            } else {
                cells.addLost();
            }
        }
        EXPECT_GT(cells.significance([&](const glm::dvec3& light) { return seen.pdf(light); }), kLevel)
            << "material " << i << " of seed " << kSeed + GetParam().lobes << ": " << seen;
    }
}

// Density and lost samples add up to 1, however sharp the lobes are.
TEST_P(BsdfSampling, DensityIntegratesToOneLessWhatIsLost) {
    Engine engine(kSeed + 1 + GetParam().lobes);
    const int count = test::nightly() ? 10 : 4;
    for (int i = 0; i < count; ++i) {
        const TestMaterial seen = make(engine, 1e-4);
        const double sum =
            quadratureOf(seen)
                .integrate([&](const glm::dvec3& light) { return glm::dvec3(seen.pdf(light)); }, 20000)
                .x;
        // With even points fewer are needed than with random ones.
        constexpr int kSide = 48;
        int lost = 0;
        for (int k = 0; k < kSide * kSide * kSide; ++k) {
            const glm::ivec3 cell(k % kSide, k / kSide % kSide, k / kSide / kSide);
            const glm::dvec3 jitter(uniform(engine), uniform(engine), uniform(engine));
            const glm::dvec3 u = (glm::dvec3(cell) + jitter) / static_cast<double>(kSide);
            lost += glsl::sampleBsdf(seen.bsdf, seen.features(), u).pdf > 0.0 ? 0 : 1;
        }
        EXPECT_NEAR(sum + static_cast<double>(lost) / (kSide * kSide * kSide), 1.0, 1e-3)
            << "material " << i << " of seed " << kSeed + 1 + GetParam().lobes << ": " << seen;
    }
}

TEST_P(BsdfSampling, MeanOfWeightsIsTheAlbedo) {
    Engine engine(kSeed + 2 + GetParam().lobes);
    const int count = test::nightly() ? 4 : 2;
    for (int i = 0; i < count; ++i) {
        const TestMaterial seen = make(engine, 1e-3);
        glm::dvec3 sum(0.0);
        glm::dvec3 squares(0.0);
        for (int k = 0; k < kSamples; ++k) {
            const glsl::BsdfSample s = sample(seen, engine);
            sum += s.weight;
            squares += s.weight * s.weight;
        }
        const glm::dvec3 mean = sum / static_cast<double>(kSamples);
        const glm::dvec3 truth = albedo(seen, 100000);
        for (int channel = 0; channel < 3; ++channel) {
            const double variance = squares[channel] / kSamples - mean[channel] * mean[channel];
            // The bound is five standard deviations of the mean, plus the quadrature's own error.
            EXPECT_NEAR(mean[channel], truth[channel],
                        5.0 * std::sqrt(std::max(variance, 0.0) / kSamples) + 1e-3)
                << "material " << i << " of seed " << kSeed + 2 + GetParam().lobes << ": " << seen;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Lobes, BsdfSampling, testing::ValuesIn(kFamilies),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

// Sobol's points are a (0, m, 2)-net, and remain one under Owen's scrambling: of 2^m samples, each elementary
// interval of area 2^-m contains one, whatever its shape.
TEST(Sequence, EveryElementaryIntervalHasOneSample) {
    for (const std::uint32_t pixel : {0U, 1U, 4095U, 0xFFFFFFFFU}) {
        for (std::uint32_t pair = 0; pair < 3; ++pair) {
            for (std::uint32_t m = 0; m <= 8; ++m) {
                const std::uint32_t count = 1U << m;
                for (std::uint32_t rows = 0; rows <= m; ++rows) {
                    std::vector<int> cells(count, 0);
                    for (std::uint32_t sample = 0; sample < count; ++sample) {
                        const glm::dvec2 u = glsl::sequencePair(pixel, sample, 7U, pair);
                        ASSERT_TRUE(u.x >= 0.0 && u.x < 1.0 && u.y >= 0.0 && u.y < 1.0);
                        const auto row = static_cast<std::uint32_t>(u.x * (1U << rows));
                        const auto column = static_cast<std::uint32_t>(u.y * (1U << (m - rows)));
                        ++cells[row * (1U << (m - rows)) + column];
                    }
                    EXPECT_EQ(std::ranges::count(cells, 1), static_cast<std::ptrdiff_t>(count))
                        << "pixel " << pixel << ", pair " << pair << ", " << count << " samples, 2^" << rows
                        << " rows";
                }
            }
        }
    }
}

}  // namespace
}  // namespace glint::numerics
