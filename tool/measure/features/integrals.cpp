#include "base/lists.h"
#include "measure/features/checks.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace glint::measure {

namespace {

constexpr double kQuarterPi = std::numbers::pi / 4.0;

// The concentric map of Shirley and Chiu, "A Low Distortion Map Between Disk and Square" (1997), from [-1,
// 1]² to the unit disc, and then to the hemisphere so that areas stay.
Direction fromSquare(double a, double b) {
    double radius = 0.0;
    double angle = 0.0;
    if (std::abs(a) > std::abs(b)) {
        radius = a;
        angle = kQuarterPi * b / a;
    } else if (b != 0.0) {
        radius = b;
        angle = 2.0 * kQuarterPi - kQuarterPi * a / b;
    }
    const double across = radius * std::sqrt(std::max(2.0 - radius * radius, 0.0));
    return {across * std::cos(angle), across * std::sin(angle), 1.0 - radius * radius};
}

// The inverse; z >= 0.
std::array<double, 2> toSquare(const Direction& direction) {
    const double squared = direction[0] * direction[0] + direction[1] * direction[1];
    // 1 - z loses its digits near the pole.
    const double radius = std::sqrt(squared / (1.0 + std::min(direction[2], 1.0)));
    if (squared == 0.0) {
        return {0.0, 0.0};
    }
    double angle = std::atan2(direction[1], direction[0]);
    angle = angle < -kQuarterPi ? angle + 8.0 * kQuarterPi : angle;
    if (angle < kQuarterPi) {
        return {radius, radius * angle / kQuarterPi};
    }
    if (angle < 3.0 * kQuarterPi) {
        return {radius * (2.0 * kQuarterPi - angle) / kQuarterPi, radius};
    }
    if (angle < 5.0 * kQuarterPi) {
        return {-radius, -radius * (angle - 4.0 * kQuarterPi) / kQuarterPi};
    }
    return {radius * (angle - 6.0 * kQuarterPi) / kQuarterPi, -radius};
}

constexpr std::uint32_t kDeepestLevel = 17;

// A square of a hemisphere at one level of a quadtree. All squares of a level have the same solid angle. The
// edges of the two roots are the horizon.
struct HemisphereCell {
    bool lower = false;
    std::uint32_t level = 0;
    std::uint32_t x = 0;  // below 2^level
    std::uint32_t y = 0;

    HemisphereCell child(std::uint32_t number) const {
        return {lower, level + 1, 2 * x + number % 2, 2 * y + number / 2};
    }
    double solidAngle() const {
        return std::ldexp(2.0 * std::numbers::pi, -2 * static_cast<int>(level));
    }
    // The direction at (u, v) in [0, 1]² of the square.
    Direction at(double u, double v) const {
        const double scale = std::ldexp(2.0, -static_cast<int>(level));
        Direction direction = fromSquare((x + u) * scale - 1.0, (y + v) * scale - 1.0);
        direction[2] = lower ? -direction[2] : direction[2];
        return direction;
    }
    // A number that sorts cells along a curve that stays near itself: the Morton order of their corners.
    std::uint64_t place() const {
        std::uint64_t code = lower ? 1 : 0;
        for (std::uint32_t bit = kDeepestLevel; bit-- > 0;) {
            const std::uint32_t shift = kDeepestLevel - level;
            code = code << 2U | (((y << shift) >> bit & 1U) << 1U) | ((x << shift) >> bit & 1U);
        }
        return code;
    }
};

// The place of a direction: the cell of kDeepestLevel that has it.
HemisphereCell cellOf(const Direction& direction) {
    const std::array<double, 2> place = toSquare({direction[0], direction[1], std::abs(direction[2])});
    constexpr double kSide = 1U << kDeepestLevel;
    const auto index = [](double coordinate) {
        return static_cast<std::uint32_t>(std::clamp((coordinate + 1.0) * 0.5 * kSide, 0.0, kSide - 1.0));
    };
    return {direction[2] < 0.0, kDeepestLevel, index(place[0]), index(place[1])};
}

// Returns whether `cell` is `outer` or within it.
bool liesWithin(const HemisphereCell& cell, const HemisphereCell& outer) {
    const std::uint32_t shift = cell.level - outer.level;
    return cell.lower == outer.lower && cell.level >= outer.level && cell.x >> shift == outer.x &&
           cell.y >> shift == outer.y;
}

// Cells start at this level, which has 32 squares on the sphere.
constexpr std::uint32_t kFirstLevel = 2;
// A square is split until a split changes its integral by less than this.
constexpr double kSplitChange = 1e-5;
// The most directions at which one lobe is evaluated, unless its first squares already need more.
constexpr std::uint64_t kMostEvaluations = 100000;
// The least number of samples that a bin of the comparison should expect.
constexpr double kSamplesOfBin = 12.0;

// Gauss and Legendre's three points on [0, 1]: exact for polynomials up to the fifth degree.
constexpr double kNodes[] = {0.112701665379258, 0.5, 0.887298334620742};
constexpr double kWeights[] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
constexpr std::size_t kNodesOfCell = 9;

void addTo(LobeValues& sum, const LobeValues& values, double weight) {
    sum.density += weight * values.density;
    for (std::size_t channel = 0; channel < 3; ++channel) {
        sum.reflected[channel] += weight * values.reflected[channel];
        sum.whole[channel] += weight * values.whole[channel];
    }
}

double largestDifference(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

// A square that waits to be split.
struct Waiting {
    std::size_t lobe = 0;
    HemisphereCell cell;
    LobeValues integral;
    std::vector<HemisphereCell> samples;  // those that fell into it
};

// A square that is not split further.
struct Bin {
    std::uint64_t place = 0;
    double share = 0.0;  // integral of the density
    std::size_t samples = 0;
};

// The probability that chi-square with so many degrees of freedom is at least `statistic`.
double chiSquareTail(double statistic, double freedom) {
    // Wilson and Hilferty 1931: the cube root of chi-square over its degrees of freedom is nearly normal.
    const double spread = 2.0 / (9.0 * freedom);
    return 0.5 * std::erfc((std::cbrt(statistic / freedom) - (1.0 - spread)) / std::sqrt(2.0 * spread));
}

class Integration {
public:
    Integration(std::span<const std::vector<Direction>> samples, const LobeFunction& function)
        : samples_(samples), function_(function), results_(samples.size()), bins_(samples.size()) {}

    Result<std::vector<LobeIntegrals>> run() {
        GLINT_TRY_DO(start());
        while (!waiting_.empty()) {
            GLINT_TRY_DO(split());
        }
        for (std::size_t lobe = 0; lobe < samples_.size(); ++lobe) {
            compareSamples(lobe);
        }
        return std::move(results_);
    }

private:
    // Returns the integral over each of the squares.
    Result<std::vector<LobeValues>> integrate(
        const std::vector<std::pair<std::size_t, HemisphereCell>>& cells) {
        std::vector<LobeQuery> queries;
        queries.reserve(cells.size() * kNodesOfCell);
        for (const auto& [lobe, cell] : cells) {
            for (const double v : kNodes) {
                for (const double u : kNodes) {
                    queries.push_back({lobe, cell.at(u, v)});
                }
            }
            results_[lobe].evaluations += kNodesOfCell;
        }
        GLINT_TRY(const auto values, function_(queries));
        std::vector<LobeValues> integrals(cells.size());
        for (std::size_t i = 0; i < cells.size(); ++i) {
            for (std::size_t node = 0; node < kNodesOfCell; ++node) {
                addTo(integrals[i], values[i * kNodesOfCell + node],
                      kWeights[node / 3] * kWeights[node % 3] * cells[i].second.solidAngle());
            }
        }
        return integrals;
    }

    Status start() {
        std::vector<std::pair<std::size_t, HemisphereCell>> cells;
        constexpr std::uint32_t kSide = 1U << kFirstLevel;
        for (std::size_t lobe = 0; lobe < samples_.size(); ++lobe) {
            std::vector<HemisphereCell> places;
            for (const Direction& direction : samples_[lobe]) {
                if (direction == Direction{}) {
                    results_[lobe].lost += 1.0 / static_cast<double>(samples_[lobe].size());
                } else {
                    places.push_back(cellOf(direction));
                }
            }
            for (std::uint32_t i = 0; i < 2 * kSide * kSide; ++i) {
                const HemisphereCell cell{i >= kSide * kSide, kFirstLevel, i % kSide, i / kSide % kSide};
                cells.emplace_back(lobe, cell);
                waiting_.push_back({lobe, cell, {}, within(places, cell)});
            }
        }
        GLINT_TRY(const auto integrals, integrate(cells));
        for (std::size_t i = 0; i < waiting_.size(); ++i) {
            waiting_[i].integral = integrals[i];
        }
        return okStatus();
    }

    static std::vector<HemisphereCell> within(const std::vector<HemisphereCell>& places,
                                              const HemisphereCell& outer) {
        std::vector<HemisphereCell> found;
        std::ranges::copy_if(places, std::back_inserter(found),
                             [&](const HemisphereCell& cell) { return liesWithin(cell, outer); });
        return found;
    }

    // Splits every square that waits, and keeps the quarters of those that it changed.
    Status split() {
        std::vector<std::pair<std::size_t, HemisphereCell>> cells;
        for (const Waiting& square : waiting_) {
            for (std::uint32_t number = 0; number < 4; ++number) {
                cells.emplace_back(square.lobe, square.cell.child(number));
            }
        }
        GLINT_TRY(const auto integrals, integrate(cells));
        std::vector<std::size_t> kept(samples_.size());
        std::vector<Waiting> next;
        for (std::size_t i = 0; i < waiting_.size(); ++i) {
            Waiting& square = waiting_[i];
            const std::span<const LobeValues> quarters(integrals.data() + 4 * i, 4);
            if (!refines(square, quarters, kept[square.lobe])) {
                continue;
            }
            for (std::uint32_t number = 0; number < 4; ++number) {
                const HemisphereCell cell = square.cell.child(number);
                next.push_back({square.lobe, cell, quarters[number], within(square.samples, cell)});
            }
            kept[square.lobe] += 4;  // they have four quarters each
        }
        waiting_ = std::move(next);
        return okStatus();
    }

    // Adds the square to the result unless its quarters should be split in turn.
    bool refines(const Waiting& square, std::span<const LobeValues> quarters, std::size_t kept) {
        LobeValues sum;
        for (const LobeValues& quarter : quarters) {
            addTo(sum, quarter, 1.0);
        }
        const double density = std::abs(sum.density - square.integral.density);
        const double whole = std::max(largestDifference(sum.whole, square.integral.whole),
                                      largestDifference(sum.reflected, square.integral.reflected));
        // Nodes may have missed a lobe that samples find.
        const auto samples = static_cast<double>(square.samples.size());
        const double expected = sum.density * static_cast<double>(samples_[square.lobe].size());
        const bool missed = samples > 8.0 && samples > 3.0 * expected;
        const bool splits = std::max(density, whole) > kSplitChange || missed;
        if (splits && square.cell.level + 2 <= kDeepestLevel &&
            results_[square.lobe].evaluations + kept * kNodesOfCell * 4 <= kMostEvaluations) {
            return true;
        }
        LobeIntegrals& result = results_[square.lobe];
        result.density += sum.density;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            result.reflected[channel] += sum.reflected[channel];
            result.whole[channel] += sum.whole[channel];
        }
        result.densityError += density;
        result.wholeError += whole;
        bins_[square.lobe].push_back({square.cell.place(), sum.density, square.samples.size()});
        return false;
    }

    // Compares how many samples fell into squares that lie together with how many the density expects.
    void compareSamples(std::size_t lobe) {
        const auto count = static_cast<double>(samples_[lobe].size());
        if (count == 0.0) {
            return;
        }
        std::vector<Bin>& bins = bins_[lobe];
        std::ranges::sort(bins, {}, &Bin::place);
        // The last bin has the samples without a direction.
        LobeIntegrals& result = results_[lobe];
        bins.push_back({~0ULL, std::max(1.0 - result.density, 0.0),
                        static_cast<std::size_t>(std::llround(result.lost * count))});
        double statistic = 0.0;
        double freedom = -1.0;
        double expected = 0.0;
        double found = 0.0;
        auto remaining = base::sumOf<double>(bins, [&](const Bin& bin) { return count * bin.share; });
        for (const Bin& bin : bins) {
            expected += count * bin.share;
            found += static_cast<double>(bin.samples);
            remaining -= count * bin.share;
            const bool isLast = &bin == &bins.back();
            if ((expected >= kSamplesOfBin && remaining >= kSamplesOfBin) || isLast) {
                statistic += (found - expected) * (found - expected) / std::max(expected, 1e-3);
                freedom += 1.0;
                expected = 0.0;
                found = 0.0;
            }
        }
        result.significance = freedom < 1.0 ? 1.0 : chiSquareTail(statistic, freedom);
    }

    std::span<const std::vector<Direction>> samples_;
    const LobeFunction& function_;
    std::vector<LobeIntegrals> results_;
    std::vector<std::vector<Bin>> bins_;
    std::vector<Waiting> waiting_;
};

}  // namespace

Result<std::vector<LobeIntegrals>> integrateLobes(std::span<const std::vector<Direction>> samples,
                                                  const LobeFunction& function) {
    return Integration(samples, function).run();
}

}  // namespace glint::measure
