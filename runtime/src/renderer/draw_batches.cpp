#include "renderer/draw_batches.h"

#include <algorithm>

namespace glint {
namespace {

// Returns one past the last draw of the instance whose draws begin at `first`.
std::size_t endOfInstance(std::span<const Draw> draws, std::size_t first) {
    std::size_t end = first + 1;
    while (end < draws.size() && draws[end].instance == draws[first].instance) {
        ++end;
    }
    return end;
}

bool isAlike(const Draw& a, const Draw& b) {
    return a.primitive == b.primitive && a.vertexCount == b.vertexCount && a.doubleSided == b.doubleSided &&
           a.mirrored == b.mirrored && a.hidden == b.hidden;
}

}  // namespace

std::vector<DrawBatch> batchDraws(std::span<const Draw> draws) {
    std::vector<DrawBatch> batches;
    for (std::size_t first = 0; first < draws.size();) {
        const std::size_t stride = endOfInstance(draws, first) - first;
        const std::span<const Draw> own = draws.subspan(first, stride);
        std::size_t end = first + stride;
        while (
            end < draws.size() && endOfInstance(draws, end) - end == stride &&
            draws[end].geometry == draws[end - stride].geometry + stride &&
            std::equal(own.begin(), own.end(), draws.begin() + static_cast<std::ptrdiff_t>(end), isAlike)) {
            end += stride;
        }
        for (const Draw& draw : own) {
            if (!draw.hidden) {
                batches.push_back({draw.geometry, static_cast<std::uint32_t>(stride),
                                   static_cast<std::uint32_t>((end - first) / stride), draw.vertexCount,
                                   draw.doubleSided, draw.mirrored});
            }
        }
        first = end;
    }
    return batches;
}

}  // namespace glint
