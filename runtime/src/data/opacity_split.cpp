#include "data/opacity_split.h"

#include "context/parallel.h"
#include "data/materials.h"
#include "data/vertex_format.h"
#include "package/package.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>

namespace glint {
namespace {

using opacity::AlphaLookup;
using opacity::AlphaMaterial;
using opacity::AlphaTexels;
using opacity::AlphaTriangle;
using opacity::State;

// Triangles whose states one thread finds at a time.
constexpr std::size_t kTrianglesOfJob = 512;
// The size of a micro-triangle, in texels, below which one more level is not worth its bytes.
constexpr double kTexelsOfMicroTriangle = 2.0;

float floatAt(const MaterialTable& materials, std::uint32_t material, std::uint32_t offset) {
    float value = 0.0F;
    std::memcpy(&value, &materials.bytes[std::size_t{material} * materials.recordBytes + offset],
                sizeof value);
    return value;
}

bool readsTexture(const package::OpacityEntry& opacity, const package::PrimitiveEntry& entry) {
    return opacity.texture != package::OpacityEntry::kNone && (entry.key.inputs & opacity.textureInput) != 0;
}

// The alpha of a texel of RGBA with 8 bits a channel, after the image's channels.
std::uint8_t alphaOf(const std::uint8_t* texel, TexelChannel channel) {
    switch (channel) {
        case TexelChannel::Zero:
            return 0;
        case TexelChannel::One:
            return 255;
        default:
            return texel[static_cast<std::size_t>(channel)];
    }
}

// The alpha of an image's first level, and the error that the device's own may have.
struct KnownAlpha {
    AlphaTexels texels;
    int steps = 0;
};

// Returns nothing for an image whose texels only the device can read.
std::optional<KnownAlpha> knownAlpha(const ImageView& image) {
    if (isBlockFormat(image.format)) {
        return std::nullopt;
    }
    const std::size_t count = std::size_t{image.width} * image.height;
    KnownAlpha known{{image.width, image.height, std::vector<std::uint8_t>(count)}};
    std::span<const std::uint8_t> texels = image.pixels;
    std::vector<std::uint8_t> narrow;
    if (image.format == TexelFormat::Rgba16) {
        // The device may have them in 8 bits.
        known.steps = 1;
        narrow = narrowRgba16(texels.first(8 * count));
        texels = narrow;
    }
    for (std::size_t i = 0; i < count; ++i) {
        known.texels.alpha[i] = alphaOf(&texels[4 * i], image.channels[3]);
    }
    return known;
}

// Texture coordinates as shaders read them (host/geometry.glsl).
std::vector<std::array<float, 2>> coordinatesOf(std::span<const std::array<float, 2>> given,
                                                SceneView::VertexForm form) {
    std::vector<std::array<float, 2>> read(given.begin(), given.end());
    if (form != SceneView::VertexForm::Compact || given.empty()) {
        return read;
    }
    const std::optional<std::vector<std::uint32_t>> words = packTexCoords(given);
    if (!words) {
        return read;
    }
    for (std::size_t i = 0; i < read.size(); ++i) {
        const std::uint32_t word = (*words)[4 + i];
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const auto least = std::bit_cast<float>((*words)[axis]);
            const auto step = std::bit_cast<float>((*words)[2 + axis]);
            read[i][axis] = least + step * static_cast<float>(axis == 0 ? word & 0xFFFFU : word >> 16U);
        }
    }
    return read;
}

std::vector<float> vertexAlphaOf(std::span<const std::array<float, 4>> colors, SceneView::VertexForm form) {
    std::vector<float> alpha;
    alpha.reserve(colors.size());
    const std::optional<PackedColors> packed =
        form == SceneView::VertexForm::Compact && !colors.empty() ? packColors(colors) : std::nullopt;
    for (std::size_t i = 0; i < colors.size(); ++i) {
        if (!packed) {
            alpha.push_back(colors[i][3]);
        } else if (packed->bits == 8) {
            alpha.push_back(static_cast<float>(packed->words[i] >> 24U) / 255.0F);
        } else {
            alpha.push_back(static_cast<float>(packed->words[2 * i + 1] >> 16U) / 65535.0F);
        }
    }
    return alpha;
}

// A primitive about which something may be decided.
struct Candidate {
    std::uint32_t primitive = 0;
    AlphaMaterial material;
    opacity::ErrorModel model;
    std::vector<std::array<float, 2>> coordinates;
    std::vector<float> vertexAlpha;
    std::vector<State> states;                   // one for each triangle
    std::vector<opacity::TriangleStates> parts;  // if micromaps are made: of each triangle
};

class Decider {
public:
    Decider(const Package& package, const PackageScene& known, const SceneView& scene,
            const MaterialTable& materials, const BlasCapacity& capacity, std::uint32_t level)
        : opacity_(*package.opacity()),
          known_(known),
          scene_(scene),
          materials_(materials),
          capacity_(capacity),
          level_(level) {}

    DecidedTriangles decide() {
        for (std::uint32_t i = 0; i < scene_.primitives.size(); ++i) {
            addCandidate(i);
        }
        findStates();
        DecidedTriangles decided;
        decided.sorted.resize(scene_.primitives.size());
        for (const Candidate& candidate : candidates_) {
            sortTriangles(candidate, decided);
        }
        return decided;
    }

private:
    bool mayChange(const package::PrimitiveEntry& entry) const {
        const bool moved =
            scene_.moves && std::ranges::find(scene_.materials, entry.materialIndex,
                                              &MaterialView::material) != scene_.materials.end();
        return moved || (scene_.streamsTextures && readsTexture(opacity_, entry));
    }

    // The alpha of a model with code of its own, or without glTF's base colour.
    static bool isUnknown(std::uint32_t model) {
        return model != 0 && ((model & gpu::kModelChangesAlpha) != 0 || (model & gpu::kModelBaseColor) == 0);
    }

    bool isDecidable(const PrimitiveView& view, const package::PrimitiveEntry& entry) const {
        constexpr std::uint32_t kOther =
            gpu::kGeometryBlended | gpu::kGeometryPassesLight | gpu::kGeometryEmitter;
        const bool hasCode = entry.key.hasAny(opacity_.code) || isUnknown(entry.key.model);
        const std::size_t triangles = view.indices.size() / 3;
        return (entry.geometryFlags & gpu::kGeometryAlphaTested) != 0 &&
               (entry.geometryFlags & kOther) == 0 && !hasCode && triangles > 0 &&
               triangles <= capacity_.triangles && !mayChange(entry);
    }

    void addCandidate(std::uint32_t primitive) {
        const PrimitiveView& view = scene_.primitives[primitive];
        const package::PrimitiveEntry& entry = *known_.findPrimitive(view.mesh, view.primitive);
        if (!isDecidable(view, entry)) {
            return;
        }
        Candidate candidate;
        candidate.primitive = primitive;
        candidate.material.factor = floatAt(materials_, entry.materialIndex, opacity_.factor);
        candidate.material.cutoff = floatAt(materials_, entry.materialIndex, opacity_.cutoff);
        if (readsTexture(opacity_, entry) && !addLookup(view, entry, candidate)) {
            return;
        }
        if ((entry.key.inputs & opacity_.vertexColorInput) != 0) {
            candidate.vertexAlpha = vertexAlphaOf(view.colors, scene_.vertices);
        }
        candidate.states.resize(view.indices.size() / 3);
        candidate.parts.resize(level_ > 0 ? candidate.states.size() : 0);
        candidates_.push_back(std::move(candidate));
    }

    // Reads as samplePoint() of hit/surface_point.glsl does. Returns whether its texels are known.
    bool addLookup(const PrimitiveView& view, const package::PrimitiveEntry& entry, Candidate& candidate) {
        const gpu::TextureRecord texture = textureAt(materials_, entry.materialIndex, opacity_.texture);
        const std::optional<KnownAlpha>& alpha = alphaOfImage(known_.textures[texture.textureIndex].image);
        if (!alpha) {
            return false;
        }
        const package::SamplerEntry& sampler = known_.samplers[texture.samplerIndex];
        AlphaLookup lookup;
        lookup.texels = &alpha->texels;
        lookup.wrapU = static_cast<opacity::Wrap>(sampler.wrapU);
        lookup.wrapV = static_cast<opacity::Wrap>(sampler.wrapV);
        lookup.linear = sampler.magnification != 0 || sampler.minification != 0;
        if ((entry.key.inputs & opacity_.transformInput) != 0) {
            lookup.rowU = {texture.rowU.x, texture.rowU.y, texture.rowU.z};
            lookup.rowV = {texture.rowV.x, texture.rowV.y, texture.rowV.z};
        }
        candidate.material.lookup = lookup;
        candidate.model.texelSteps = alpha->steps;
        const bool second = (entry.key.inputs & opacity_.texCoord1Input) != 0 &&
                            ((entry.key.inputs & opacity_.texCoord0Input) == 0 || texture.texCoord != 0);
        candidate.coordinates = coordinatesOf(second ? view.texCoords1 : view.texCoords0, scene_.vertices);
        return true;
    }

    const std::optional<KnownAlpha>& alphaOfImage(std::uint32_t image) {
        const auto [place, isNew] = images_.try_emplace(image);
        if (isNew) {
            place->second = std::make_unique<std::optional<KnownAlpha>>(knownAlpha(scene_.images[image]));
        }
        return *place->second;
    }

    void findStates() {
        std::vector<std::pair<std::size_t, std::size_t>> jobs;  // candidate, first triangle
        for (std::size_t i = 0; i < candidates_.size(); ++i) {
            for (std::size_t first = 0; first < candidates_[i].states.size(); first += kTrianglesOfJob) {
                jobs.emplace_back(i, first);
            }
        }
        forEach(jobs.size(), [&](std::size_t job) {
            Candidate& candidate = candidates_[jobs[job].first];
            const std::size_t first = jobs[job].second;
            const std::size_t end = std::min(first + kTrianglesOfJob, candidate.states.size());
            for (std::size_t triangle = first; triangle < end; ++triangle) {
                const AlphaTriangle made = triangleOf(candidate, triangle);
                candidate.states[triangle] = opacity::stateOf(candidate.material, made, candidate.model);
                if (level_ > 0 && !opacity::isKnown(candidate.states[triangle])) {
                    candidate.parts[triangle] = opacity::statesOf(candidate.material, made, level_,
                                                                  kTexelsOfMicroTriangle, candidate.model);
                }
            }
        });
    }

    AlphaTriangle triangleOf(const Candidate& candidate, std::size_t triangle) const {
        const std::span<const std::uint32_t> corners =
            scene_.primitives[candidate.primitive].indices.subspan(3 * triangle, 3);
        AlphaTriangle made;
        for (std::size_t i = 0; i < 3 && !candidate.coordinates.empty(); ++i) {
            made.uv[i] = candidate.coordinates[corners[i]];
        }
        if (!candidate.vertexAlpha.empty()) {
            made.vertexAlpha = {candidate.vertexAlpha[corners[0]], candidate.vertexAlpha[corners[1]],
                                candidate.vertexAlpha[corners[2]]};
        }
        return made;
    }

    void sortTriangles(const Candidate& candidate, DecidedTriangles& decided) const {
        const std::span<const std::uint32_t> indices = scene_.primitives[candidate.primitive].indices;
        const auto count = [&](State state) {
            return static_cast<std::uint32_t>(std::ranges::count(candidate.states, state));
        };
        const std::uint32_t opaque = count(State::Opaque);
        const std::uint32_t transparent = count(State::Transparent);
        decided.tested += candidate.states.size();
        decided.opaque += opaque;
        decided.transparent += transparent;
        if (opaque + transparent == 0 && level_ == 0) {
            return;
        }
        std::vector<std::uint32_t>& sorted = decided.sorted[candidate.primitive];
        const auto append = [&](auto&& belongs) {
            for (std::size_t i = 0; i < candidate.states.size(); ++i) {
                if (belongs(candidate.states[i])) {
                    const std::span<const std::uint32_t> corners = indices.subspan(3 * i, 3);
                    sorted.insert(sorted.end(), corners.begin(), corners.end());
                }
            }
        };
        append([](State state) { return !opacity::isKnown(state); });
        append([](State state) { return state == State::Opaque; });
        append([](State state) { return state == State::Transparent; });
        const auto all = static_cast<std::uint32_t>(candidate.states.size());
        // If all triangles are transparent, one of them is tested, because a BLAS can't be empty.
        const std::uint32_t tested = std::max(all - opaque - transparent, all == transparent ? 1U : 0U);
        decided.splits[candidate.primitive] = {tested, opaque};
        if (level_ > 0 && all > opaque + transparent) {
            std::vector<opacity::TriangleStates> parts;
            for (std::size_t i = 0; i < candidate.states.size(); ++i) {
                if (!opacity::isKnown(candidate.states[i])) {
                    parts.push_back(candidate.parts[i]);
                }
            }
            decided.micromaps[candidate.primitive] = opacity::packMicromaps(parts);
        }
    }

    const package::OpacityEntry& opacity_;
    const PackageScene& known_;
    const SceneView& scene_;
    const MaterialTable& materials_;
    const BlasCapacity& capacity_;
    std::uint32_t level_;
    std::map<std::uint32_t, std::unique_ptr<std::optional<KnownAlpha>>> images_;
    std::vector<Candidate> candidates_;
};

template <typename T>
void appendBytes(std::vector<std::uint8_t>& bytes, const T& value) {
    const auto* const first = reinterpret_cast<const std::uint8_t*>(&value);
    bytes.insert(bytes.end(), first, first + sizeof value);
}

}  // namespace

DecidedTriangles decideTriangles(const Package& package, const PackageScene& known, const SceneView& scene,
                                 std::span<const std::uint8_t> materials, const BlasCapacity& capacity,
                                 std::uint32_t level) {
    if (package.opacity() == nullptr || scene.opacity == SceneView::OpacityUse::Tested) {
        return {};
    }
    const MaterialTable table = tableWith(known.materials, materials);
    return Decider(package, known, scene, table, capacity, level).decide();
}

std::vector<std::uint8_t> alphaInputs(const package::OpacityEntry& opacity, const MaterialTable& materials,
                                      const package::PrimitiveEntry& entry) {
    std::vector<std::uint8_t> bytes;
    constexpr auto kNone = package::OpacityEntry::kNone;
    const std::uint32_t inputs = opacity.textureInput | opacity.texCoord0Input | opacity.texCoord1Input |
                                 opacity.transformInput | opacity.vertexColorInput;
    appendBytes(bytes, entry.key.inputs & inputs);
    appendBytes(bytes, entry.key.lobes & opacity.code.lobes);
    appendBytes(bytes, entry.key.inputs & opacity.code.inputs);
    appendBytes(bytes, entry.key.model & (gpu::kModelChangesAlpha | gpu::kModelBaseColor));
    appendBytes(bytes, floatAt(materials, entry.materialIndex, opacity.factor));
    appendBytes(bytes, floatAt(materials, entry.materialIndex, opacity.cutoff));
    if (opacity.texture != kNone && readsTexture(opacity, entry)) {
        const gpu::TextureRecord texture = textureAt(materials, entry.materialIndex, opacity.texture);
        appendBytes(bytes, texture.textureIndex);
        appendBytes(bytes, texture.samplerIndex);
        appendBytes(bytes, texture.texCoord);
        appendBytes(bytes, texture.rowU);
        appendBytes(bytes, texture.rowV);
    }
    return bytes;
}

}  // namespace glint
