#include "gltf/texels/texel_bounds.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <utility>
#include <variant>
#include <vector>

namespace glint::gltf {

// TexelBounds::Levels has members of these types, so they can't be in an anonymous namespace.
namespace bounds {

// See the head of texel_bounds.h.
constexpr double kSubTexel = 1.0 / 16.0;
constexpr double kAnisotropicReach = 16.0;

// A device's coordinates differ from those in double precision by the rounding of a few operations.
constexpr double kSingle = 8.0 / (1 << 23);
// Barycentric coordinates of 16 bits, each of the three off by up to one step (shaders/hit/record.glsl).
constexpr double kPackedBarycentrics = 2.0 / 65535.0;

// Texels [first, last] along one axis.
struct Span {
    int first = 0;
    int last = -1;
};

// The texels that are reached along one axis: after wrapping these can be up to three spans.
struct Reach {
    std::array<Span, 3> spans{};
    int count = 0;

    void add(int first, int last) {
        assert(count < 3 && first <= last);
        spans[static_cast<std::size_t>(count++)] = {first, last};
    }
};

Reach everywhere(int size) {
    Reach reach;
    reach.add(0, size - 1);
    return reach;
}

// Texels [first, last] before wrapping, which are fewer than one period.
Reach repeated(std::int64_t first, std::int64_t last, int size) {
    const std::int64_t start = (first % size + size) % size;
    const std::int64_t end = start + (last - first);
    Reach reach;
    reach.add(static_cast<int>(start), static_cast<int>(std::min<std::int64_t>(end, size - 1)));
    if (end >= size) {
        reach.add(0, static_cast<int>(end - size));
    }
    return reach;
}

Reach mirrored(std::int64_t first, std::int64_t last, int size) {
    const std::int64_t period = 2 * std::int64_t{size};
    std::int64_t place = (first % period + period) % period;
    const std::int64_t end = place + (last - first);
    Reach reach;
    while (place <= end) {
        const std::int64_t tile = place / size;
        const std::int64_t stop = std::min(end, (tile + 1) * size - 1);
        const auto from = static_cast<int>(place % size);
        const auto to = static_cast<int>(stop % size);
        if (tile % 2 == 0) {
            reach.add(from, to);
        } else {
            reach.add(size - 1 - to, size - 1 - from);
        }
        place = stop + 1;
    }
    return reach;
}

// The texels of a level of `size` that coordinates in [low, high] reach.
Reach reachOf(double low, double high, int size, Wrap wrap, bool linear, double margin) {
    const double begin = std::floor(low * size - margin - (linear ? 0.5 : 0.0));
    const double end = std::floor(high * size + margin - (linear ? 0.5 : 0.0)) + (linear ? 1.0 : 0.0);
    constexpr double kLargest = 1e9;
    if (!(begin > -kLargest) || !(end < kLargest)) {
        return everywhere(size);
    }
    const auto first = static_cast<std::int64_t>(begin);
    const auto last = static_cast<std::int64_t>(end);
    if (wrap == Wrap::ClampToEdge) {
        Reach reach;
        const std::int64_t most = size - 1;
        reach.add(static_cast<int>(std::clamp<std::int64_t>(first, 0, most)),
                  static_cast<int>(std::clamp<std::int64_t>(last, 0, most)));
        return reach;
    }
    if (last - first + 1 >= size) {
        return everywhere(size);
    }
    return wrap == Wrap::Repeat ? repeated(first, last, size) : mirrored(first, last, size);
}

// A rectangle of texels, all ends included.
struct Area {
    Span columns;
    Span rows;
};

// The areas of one level that a box reaches.
template <typename Visit>
void forEachArea(const TexCoordBox& box, const LookupKind& kind, int level, bool mayBeLast, int width,
                 int height, const Visit& visit) {
    const Sampler& sampler = kind.sampler;
    const bool isFine = level == 0;
    const bool linear =
        sampler.minification == Filter::Linear || (isFine && sampler.magnification == Filter::Linear);
    const bool stretches = kind.anisotropic && !kind.finestLevel && sampler.mipmapped &&
                           sampler.minification == Filter::Linear && sampler.mip == Filter::Linear;
    Reach columns = everywhere(width);
    Reach rows = everywhere(height);
    if (!stretches || !mayBeLast) {
        const double margin = kSubTexel + (stretches ? kAnisotropicReach : 0.0);
        columns = reachOf(box.low[0], box.high[0], width, sampler.wrapU, linear, margin);
        rows = reachOf(box.low[1], box.high[1], height, sampler.wrapV, linear, margin);
    }
    for (int i = 0; i < columns.count; ++i) {
        for (int j = 0; j < rows.count; ++j) {
            visit(Area{columns.spans[static_cast<std::size_t>(i)], rows.spans[static_cast<std::size_t>(j)]});
        }
    }
}

int levelsRead(const LookupKind& kind, int levels) {
    return kind.finestLevel || !kind.sampler.mipmapped ? 1 : levels;
}

template <typename Code>
using CodeTexel = std::array<Code, 4>;

// Bounds of all texels of one level, and of squares of 4, 16, 64 … texels.
template <typename Code>
class LevelBounds {
public:
    using Texel = CodeTexel<Code>;

    // `greatest` is empty where the texels are known exactly.
    LevelBounds(int width, int height, std::vector<Texel> least, std::vector<Texel> greatest) {
        grids_.push_back({width, height, std::move(least), std::move(greatest)});
        while (grids_.back().width > 1 || grids_.back().height > 1) {
            grids_.push_back(coarser(grids_.back()));
        }
    }

    int width() const {
        return grids_.front().width;
    }
    int height() const {
        return grids_.front().height;
    }
    TexelRange at(int x, int y) const {
        return grids_.front().at(x, y);
    }

    void join(const Area& area, TexelRange& range) const {
        join(grids_.size() - 1, area, 0, 0, range);
    }

    // Returns a texel of the area with the least or greatest code of a channel that is at most, or at least,
    // `code`.
    TexelPlace find(const Area& area, std::size_t channel, bool greatest, std::uint16_t code) const {
        return find(grids_.size() - 1, area, 0, 0, [&](const TexelRange& range) {
            return greatest ? range.greatest[channel] >= code : range.least[channel] <= code;
        });
    }

private:
    static constexpr int kBranch = 4;

    // Each cell covers kBranch times as many texels along an axis as those of the grid before.
    struct Grid {
        int width = 0;
        int height = 0;
        std::vector<Texel> least;
        std::vector<Texel> greatest;

        TexelRange at(int x, int y) const {
            const std::size_t place = placeOfTexel(x, y, width);
            const Texel& low = least[place];
            const Texel& high = greatest.empty() ? low : greatest[place];
            return {{low[0], low[1], low[2], low[3]}, {high[0], high[1], high[2], high[3]}};
        }
    };

    static Grid coarser(const Grid& fine) {
        Grid grid{(fine.width + kBranch - 1) / kBranch, (fine.height + kBranch - 1) / kBranch, {}, {}};
        const std::size_t cells = placeOfTexel(0, grid.height, grid.width);
        Texel most;
        most.fill(std::numeric_limits<Code>::max());
        grid.least.assign(cells, most);
        grid.greatest.assign(cells, Texel{});
        for (int y = 0; y < fine.height; ++y) {
            for (int x = 0; x < fine.width; ++x) {
                const std::size_t from = placeOfTexel(x, y, fine.width);
                const std::size_t to = placeOfTexel(x / kBranch, y / kBranch, grid.width);
                const Texel& high = fine.greatest.empty() ? fine.least[from] : fine.greatest[from];
                for (std::size_t i = 0; i < 4; ++i) {
                    grid.least[to][i] = std::min(grid.least[to][i], fine.least[from][i]);
                    grid.greatest[to][i] = std::max(grid.greatest[to][i], high[i]);
                }
            }
        }
        return grid;
    }

    // The part of the area that a cell covers, in texels of the level; empty if there is none.
    struct Cell {
        Area part;
        bool isEmpty = false;
        bool isWhole = false;
    };
    Cell cellOf(std::size_t depth, const Area& area, int x, int y) const {
        const int size = 1 << (2 * depth);
        const Span columns{x * size, std::min((x + 1) * size, width()) - 1};
        const Span rows{y * size, std::min((y + 1) * size, height()) - 1};
        Cell cell;
        cell.part = {{std::max(area.columns.first, columns.first), std::min(area.columns.last, columns.last)},
                     {std::max(area.rows.first, rows.first), std::min(area.rows.last, rows.last)}};
        cell.isEmpty =
            cell.part.columns.first > cell.part.columns.last || cell.part.rows.first > cell.part.rows.last;
        cell.isWhole = cell.part.columns.first == columns.first && cell.part.columns.last == columns.last &&
                       cell.part.rows.first == rows.first && cell.part.rows.last == rows.last;
        return cell;
    }

    // Calls visit(x, y) for the cells below cell (x, y) of `depth` that the area touches.
    template <typename Visit>
    void forEachChild(std::size_t depth, const Area& area, const Visit& visit) const {
        const int size = 1 << (2 * (depth - 1));
        for (int y = area.rows.first / size; y <= area.rows.last / size; ++y) {
            for (int x = area.columns.first / size; x <= area.columns.last / size; ++x) {
                visit(x, y);
            }
        }
    }

    void join(std::size_t depth, const Area& area, int x, int y, TexelRange& range) const {
        const TexelRange held = grids_[depth].at(x, y);
        if (range.encloses(held)) {
            return;
        }
        const Cell cell = cellOf(depth, area, x, y);
        if (cell.isWhole || depth == 0) {
            range.join(held);
            return;
        }
        forEachChild(depth, cell.part,
                     [&](int column, int row) { join(depth - 1, cell.part, column, row, range); });
    }

    template <typename Wanted>
    TexelPlace find(std::size_t depth, const Area& area, int x, int y, const Wanted& isWanted) const {
        const Cell cell = cellOf(depth, area, x, y);
        if (cell.isEmpty || !isWanted(grids_[depth].at(x, y))) {
            return {};
        }
        if (depth == 0) {
            return {0, x, y};
        }
        TexelPlace found;
        forEachChild(depth, cell.part, [&](int column, int row) {
            if (found.level < 0) {
                found = find(depth - 1, cell.part, column, row, isWanted);
            }
        });
        return found;
    }

    std::vector<Grid> grids_;  // that of texels first
};

template <typename Code>
class LevelsOf {
public:
    using Texel = CodeTexel<Code>;

    LevelsOf(Texels texels, const LevelRules& rules) : rules_(rules), given_(texels.levels) {
        if (rules.complete && !rules.isUnknown) {
            completeLevels(texels, rules.filters);
        }
        const int count = rules.complete ? fullLevels(texels.width, texels.height) : texels.levels;
        std::size_t offset = 0;
        for (int level = 0; level < count; ++level) {
            const int width = sizeOfLevel(texels.width, level);
            const int height = sizeOfLevel(texels.height, level);
            const std::size_t number = placeOfTexel(0, height, width);
            std::vector<Texel> values;
            if (level < texels.levels) {
                values.resize(number);
                std::memcpy(values.data(), &texels.bytes[offset], number * sizeof(Texel));
                offset += number * sizeof(Texel);
            }
            if (level < given_) {
                levels_.emplace_back(width, height, std::move(values), std::vector<Texel>());
            } else {
                addMade(width, height, std::move(values), level - given_ + 1);
            }
        }
        for (const LevelBounds<Code>& level : levels_) {
            level.join({{0, level.width() - 1}, {0, level.height() - 1}}, whole_);
        }
    }

    int count() const {
        return static_cast<int>(levels_.size());
    }
    const TexelRange& whole() const {
        return whole_;
    }

    void join(const TexCoordBox& box, const LookupKind& kind, TexelRange& range) const {
        for (int level = 0; level < levelsRead(kind, count()); ++level) {
            const LevelBounds<Code>& bounds = levels_[static_cast<std::size_t>(level)];
            forEachArea(box, kind, level, mayBeLast(level), bounds.width(), bounds.height(),
                        [&](const Area& area) { bounds.join(area, range); });
        }
    }

    TexelPlace find(const TexCoordBox& box, const LookupKind& kind, std::size_t channel, bool greatest,
                    std::uint16_t code) const {
        TexelPlace found;
        for (int level = 0; level < levelsRead(kind, count()) && found.level < 0; ++level) {
            const LevelBounds<Code>& bounds = levels_[static_cast<std::size_t>(level)];
            forEachArea(box, kind, level, mayBeLast(level), bounds.width(), bounds.height(),
                        [&](const Area& area) {
                            if (found.level < 0) {
                                found = bounds.find(area, channel, greatest, code);
                                found.level = found.level < 0 ? -1 : level;
                            }
                        });
        }
        return found;
    }

private:
    bool mayBeLast(int level) const {
        return level + 1 == count() || (rules_.mayStop && level + 1 >= given_);
    }

    // A level that Glint or the device makes. `values` are those that Glint makes of it, or none. `steps`
    // counts the made levels up to this one.
    void addMade(int width, int height, std::vector<Texel> values, int steps) {
        const LevelBounds<Code>& finer = levels_.back();
        const bool blits =
            rules_.mayBlit && isPowerOfTwo(levels_.front().width()) && isPowerOfTwo(levels_.front().height());
        // Vectors become unit vectors again, which leaves the hull; devices do not make those levels.
        if (rules_.filters[0] == LevelFilter::Normals && !rules_.isUnknown) {
            levels_.emplace_back(width, height, std::move(values), std::vector<Texel>());
            return;
        }
        // One code for each level, of 8 bits, to which devices may round 16. Two where they translate sRGB,
        // in which llvmpipe is off by up to 0.7 % of linear light.
        const int codes = rules_.filters[0] == LevelFilter::Color ? 2 : 1;
        const int slack = rules_.isUnknown ? std::numeric_limits<Code>::max()
                          : blits          ? steps * codes * kStep
                                           : 0;
        std::vector<Texel> least(placeOfTexel(0, height, width));
        std::vector<Texel> greatest(least.size());
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const std::size_t place = placeOfTexel(x, y, width);
                const Span columns = covered(x, width, finer.width());
                const Span rows = covered(y, height, finer.height());
                TexelRange hull;
                for (int row = rows.first; row <= rows.last; ++row) {
                    for (int column = columns.first; column <= columns.last; ++column) {
                        hull.join(finer.at(column, row));
                    }
                }
                for (std::size_t i = 0; i < 4; ++i) {
                    const int value = values.empty() ? 0 : values[place][i];
                    const int low = std::max<int>(hull.least[i], value - slack);
                    const int high = std::min<int>(hull.greatest[i], value + slack);
                    // Means of single precision can leave the hull by one code. Means of powers, as roughness
                    // has, are in the hull like others.
                    least[place][i] = static_cast<Code>(std::min(low, high));
                    greatest[place][i] = static_cast<Code>(std::max(low, high));
                }
            }
        }
        levels_.emplace_back(width, height, std::move(least), std::move(greatest));
    }

    // The texels of a level of size `from` that texel `index` of the next one, of size `to`, averages.
    static Span covered(int index, int to, int from) {
        const auto place = [&](std::int64_t number) { return number * from; };
        return {static_cast<int>(place(index) / to), static_cast<int>((place(index + 1) + to - 1) / to - 1)};
    }

    static constexpr int kStep = std::numeric_limits<Code>::max() / 255;

    LevelRules rules_;
    int given_;  // levels of the file
    std::vector<LevelBounds<Code>> levels_;
    TexelRange whole_;
};

}  // namespace bounds

std::array<materials::ValueInterval, 4> valuesOf(const TexelRange& range, PixelFormat format, int tolerance) {
    const int most = format == PixelFormat::Rgba16 ? 65535 : 255;
    const auto narrowed = [](double number) { return std::round(number * 255.0) / 255.0; };
    std::array<materials::ValueInterval, 4> values{};
    for (std::size_t i = 0; i < 4; ++i) {
        const bool isBlack = range.greatest[i] == 0;
        const bool isWhite = range.least[i] == most;
        const double low = std::max(range.least[i] - (isWhite ? 0 : tolerance), 0) / double(most);
        const double high = std::min(range.greatest[i] + (isBlack ? 0 : tolerance), most) / double(most);
        values[i] = {std::min(low, narrowed(low)), std::max(high, narrowed(high))};
    }
    return values;
}

bool hasKnownTexels(const Image& image) {
    return image.dimension == package::TextureEntry::Dimension::Flat &&
           (image.storage == Storage::Texels ||
            (image.storage == Storage::Blocks && image.levels == fullLevels(image.width, image.height)));
}

LevelRules levelRulesOf(const Image& image, const ImageUse& use) {
    LevelRules rules;
    rules.filters = levelFiltersOf(use);
    rules.isUnknown = use.isColor && use.isData;
    rules.mayBlit = blitsSuit(use);
    rules.mayStop = image.storage != Storage::Texels;
    rules.tolerance = image.storage == Storage::Texels ? 0 : 1;
    return rules;
}

TexCoordBox boxOf(std::span<const Float2> corners, const materials::TextureTransform& transform) {
    const materials::TransformRows rows = rowsOf(transform);
    TexCoordBox box;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const std::array<double, 3>& row = rows[axis];
        double low = std::numeric_limits<double>::infinity();
        double high = -low;
        double magnitude = 0.0;
        bool isKnown = true;
        for (const Float2& corner : corners) {
            const double value = row[0] * corner[0] + row[1] * corner[1] + row[2];
            isKnown = isKnown && std::isfinite(value);
            low = std::min(low, value);
            high = std::max(high, value);
            magnitude = std::max(
                magnitude, std::abs(row[0] * corner[0]) + std::abs(row[1] * corner[1]) + std::abs(row[2]));
        }
        const double margin = bounds::kSingle * magnitude + bounds::kPackedBarycentrics * (high - low);
        box.low[axis] = isKnown ? low - margin : -std::numeric_limits<double>::infinity();
        box.high[axis] = isKnown ? high + margin : std::numeric_limits<double>::infinity();
    }
    return box;
}

bool TexelRange::encloses(const TexelRange& other) const {
    for (std::size_t i = 0; i < 4; ++i) {
        if (other.least[i] < least[i] || other.greatest[i] > greatest[i]) {
            return false;
        }
    }
    return true;
}

void TexelRange::join(const TexelRange& other) {
    for (std::size_t i = 0; i < 4; ++i) {
        least[i] = std::min(least[i], other.least[i]);
        greatest[i] = std::max(greatest[i], other.greatest[i]);
    }
}

struct TexelBounds::Levels {
    std::variant<bounds::LevelsOf<std::uint8_t>, bounds::LevelsOf<std::uint16_t>> of;
};

TexelBounds::TexelBounds(Texels texels, const LevelRules& rules) {
    if (texels.format == PixelFormat::Rgba16) {
        levels_.reset(new Levels{bounds::LevelsOf<std::uint16_t>(std::move(texels), rules)});
    } else {
        levels_.reset(new Levels{bounds::LevelsOf<std::uint8_t>(std::move(texels), rules)});
    }
}

TexelRange TexelBounds::whole() const {
    return std::visit([](const auto& levels) { return levels.whole(); }, levels_->of);
}

void TexelBounds::joinOver(const TexCoordBox& box, const LookupKind& kind, TexelRange& range) const {
    const auto join = [&](const auto& levels) {
        if (!range.encloses(levels.whole())) {
            levels.join(box, kind, range);
        }
    };
    std::visit(join, levels_->of);
}

TexelPlace TexelBounds::find(const TexCoordBox& box, const LookupKind& kind, const TexelRange& range,
                             std::size_t channel, bool greatest) const {
    const std::uint16_t code = greatest ? range.greatest[channel] : range.least[channel];
    const auto find = [&](const auto& levels) { return levels.find(box, kind, channel, greatest, code); };
    return std::visit(find, levels_->of);
}

}  // namespace glint::gltf
