#include <glint/layers.h>

#include <algorithm>

namespace glint::package {
namespace {

using Subject = LayerInfo::Subject;
using Format = LayerInfo::Format;
using Mean = LayerInfo::Mean;

constexpr LayerInfo::FormatInfo kFormats[] = {
    {Format::Float1, 4, "r32f", 1},   {Format::Float4, 16, "rgba32f", 4},
    {Format::Half4, 8, "rgba16f", 4}, {Format::Snorm4, 8, "rgba16_snorm", 4},
    {Format::Integer, 4, "r32ui", 1},
};

// To add a layer, add a row here, and its line to docs/layers.md. A layer with a function needs it in
// shaders/layers/; one with a tally needs its macro in the passes whose work it counts.
constexpr LayerInfo kRows[] = {
    {.number = 1,
     .name = "depth",
     .what = "distance along the camera's axis, metres; 0: no surface",
     .subject = Subject::Surface,
     .format = Format::Float1,
     .channels = "Z",
     .function = "primaryDepth",
     .absent = "vec4(0.0)"},
    {.number = 2,
     .name = "position",
     .what = "of the surface in the world, metres",
     .subject = Subject::Surface,
     .format = Format::Float4,
     .channels = "XYZ",
     .isPlace = true,
     .function = "primaryPosition",
     .absent = "vec4(0.0)"},
    {.number = 3,
     .name = "geometric-normal",
     .what = "of the triangle in the world, towards the viewer; a unit vector",
     .subject = Subject::Surface,
     .format = Format::Snorm4,
     .channels = "XYZ",
     .function = "primaryGeometricNormal",
     .absent = "vec4(0.0)"},
    {.number = 4,
     .name = "normal",
     .what = "of shading, in the world; the mean of unit vectors",
     .subject = Subject::Surface,
     .format = Format::Snorm4,
     .channels = "XYZ",
     .mean = Mean::Mean,
     .continues = true,
     .function = "primaryNormal",
     .absent = "vec4(0.0)"},
    {.number = 5,
     .name = "albedo",
     .what = "the share of a white sky's light that comes back, by all lobes; at least 1/1024",
     .subject = Subject::Surface,
     .format = Format::Half4,
     .channels = "RGB",
     .mean = Mean::Mean,
     .continues = true,
     .function = "primaryAlbedo",
     .absent = "vec4(0.0)"},
    {.number = 6,
     .name = "albedo-diffuse",
     .what = "the same by the diffuse lobes",
     .subject = Subject::Surface,
     .format = Format::Half4,
     .channels = "RGB",
     .mean = Mean::Mean,
     .continues = true,
     .function = "primaryDiffuseAlbedo",
     .absent = "vec4(0.0)"},
    {.number = 7,
     .name = "albedo-specular",
     .what = "the same by reflection of microfacets, coat and sheen",
     .subject = Subject::Surface,
     .format = Format::Half4,
     .channels = "RGB",
     .mean = Mean::Mean,
     .continues = true,
     .function = "primarySpecularAlbedo",
     .absent = "vec4(0.0)"},
    {.number = 8,
     .name = "albedo-transmission",
     .what = "the same by specular transmission",
     .subject = Subject::Surface,
     .format = Format::Half4,
     .channels = "RGB",
     .mean = Mean::Mean,
     .continues = true,
     .function = "primaryTransmissionAlbedo",
     .absent = "vec4(0.0)"},
    {.number = 9,
     .name = "roughness",
     .what = "perceptual, of the base's microfacets: the square root of alpha",
     .subject = Subject::Surface,
     .format = Format::Float1,
     .channels = "R",
     .mean = Mean::Mean,
     .continues = true,
     .function = "primaryRoughness",
     .absent = "vec4(0.0)"},
    {.number = 10,
     .name = "emission",
     .what =
         "light of no other light's: what surfaces emit, unlit materials, and the sky where no surface is",
     .subject = Subject::Surface,
     .format = Format::Float4,
     .channels = "RGB",
     .mean = Mean::Mean,
     .continues = true,
     .function = "primaryEmission",
     .absent = "vec4(sky, 0.0)"},
    {.number = 11,
     .name = "material",
     .what = "number of the material; 4294967295: no surface",
     .subject = Subject::Surface,
     .format = Format::Integer,
     .channels = "I",
     .function = "primaryMaterial",
     .absent = "uvec4(0xFFFFFFFFu)"},
    {.number = 12,
     .name = "shader",
     .what = "shader ID of the material's case; 4294967295: no surface",
     .subject = Subject::Surface,
     .format = Format::Integer,
     .channels = "I",
     .function = "primaryShader",
     .absent = "uvec4(0xFFFFFFFFu)"},
    {.number = 13,
     .demands = LayerInfo::kHistory,
     .name = "motion",
     .what = "from here to where the point was in the frame before: pixels right and down, metres of depth",
     .subject = Subject::Surface,
     .format = Format::Half4,
     .channels = "XYZ",
     .function = "primaryMotion",
     .absent = "skyMotion(direction, direction)"},
    {.number = 14,
     .name = "radiance",
     .what = "light that the source adds to the picture",
     .subject = Subject::Light,
     .format = Format::Float4,
     .channels = "RGB",
     .mean = Mean::Mean,
     .continues = true},
    {.number = 15,
     .name = "demodulated",
     .what = "the same over the albedo of the lobes that bring it",
     .subject = Subject::Light,
     .format = Format::Float4,
     .channels = "RGB",
     .from = "radiance"},
    {.number = 16,
     .name = "variance",
     .what = "of the luminance of single samples; 0 with one sample",
     .subject = Subject::Light,
     .format = Format::Float1,
     .channels = "V",
     .continues = true,
     .from = "radiance"},
    {.number = 17,
     .demands = LayerInfo::kRays,
     .name = "distance",
     .what = "that the ray travelled from the surface, metres; 0: no ray, 65504: it left the scene",
     .subject = Subject::Ray,
     .format = Format::Float1,
     .channels = "Z"},
    {.number = 18,
     .demands = LayerInfo::kHistory | LayerInfo::kRays,
     .name = "virtual-motion",
     .what = "as motion, of what the surface shows: the mirrored or refracted point",
     .subject = Subject::Ray,
     .format = Format::Half4,
     .channels = "XYZ"},
    {.number = 19,
     .name = "bounce-radiance",
     .what = "as radiance, of one bounce of the paths; the last also has what further ones bring",
     .subject = Subject::Bounce,
     .format = Format::Float4,
     .channels = "RGB",
     .mean = Mean::Mean,
     .continues = true},
    {.number = 20,
     .name = "bounce-demodulated",
     .what = "as demodulated, of one bounce",
     .subject = Subject::Bounce,
     .format = Format::Float4,
     .channels = "RGB",
     .from = "bounce-radiance"},
    {.number = 21,
     .name = "bounce-variance",
     .what = "as variance, of one bounce",
     .subject = Subject::Bounce,
     .format = Format::Float1,
     .channels = "V",
     .continues = true,
     .from = "bounce-radiance"},
    {.number = 22,
     .demands = LayerInfo::kRays,
     .name = "bounce-distance",
     .what = "length of the bounce's ray, metres; 0: no ray, 65504: it left the scene",
     .subject = Subject::Bounce,
     .format = Format::Float1,
     .channels = "Z"},
    {.number = 23,
     .name = "lobes",
     .what = "bits of the lobes of the surface's key; 4294967295: no surface",
     .subject = Subject::Surface,
     .format = Format::Integer,
     .channels = "I",
     .isDiagnostic = true,
     .function = "primaryLobes",
     .absent = "uvec4(0xFFFFFFFFu)"},
    {.number = 24,
     .name = "branches",
     .what = "features, beyond those of its case, that the shading of the pixel's subgroup runs",
     .subject = Subject::Surface,
     .format = Format::Integer,
     .channels = "I",
     .isDiagnostic = true,
     .function = "primaryBranches",
     .absent = "uvec4(0xFFFFFFFFu)"},
    {.number = 25,
     .name = "footprint",
     .what = "width of the pixel on the surface across the view, metres; 0: no surface",
     .subject = Subject::Surface,
     .format = Format::Float1,
     .channels = "R",
     .isDiagnostic = true,
     .function = "primaryFootprint",
     .absent = "vec4(0.0)"},
    {.number = 26,
     .name = "texture-level",
     .what = "finest level that the surface reads, below 0: texels are larger than pixels; 65504: no texture",
     .subject = Subject::Surface,
     .format = Format::Float1,
     .channels = "R",
     .isDiagnostic = true,
     .function = "primaryTextureLevel",
     .absent = "vec4(65504.0)"},
    {.number = 27,
     .demands = LayerInfo::kRays,
     .name = "hit-shader",
     .what = "shader ID of what the ray hit; 4294967295: no ray, the two before: it left the scene, or ended "
             "on screen",
     .subject = Subject::Ray,
     .format = Format::Integer,
     .channels = "I",
     .isDiagnostic = true},
    {.number = 28,
     .name = "rays",
     .what = "rays that all passes traced for the pixel, over all samples",
     .subject = Subject::Work,
     .format = Format::Integer,
     .channels = "I",
     .mean = Mean::Sum,
     .isDiagnostic = true,
     .absent = "uvec4(0u)",
     .tally = "GLINT_TALLY_RAYS"},
    {.number = 29,
     .demands = LayerInfo::kQueries,
     .name = "candidates",
     .what = "triangles whose alpha these rays tested",
     .subject = Subject::Work,
     .format = Format::Integer,
     .channels = "I",
     .mean = Mean::Sum,
     .isDiagnostic = true,
     .absent = "uvec4(0u)",
     .tally = "GLINT_TALLY_CANDIDATES"},
    {.number = 30,
     .name = "non-finite",
     .what = "samples that are not a number and count as black; those that are infinite count 65536 each",
     .subject = Subject::Work,
     .format = Format::Integer,
     .channels = "I",
     .mean = Mean::Sum,
     .isDiagnostic = true,
     .absent = "uvec4(0u)",
     .tally = "GLINT_TALLY_NON_FINITE"},
    {.number = 31,
     .demands = LayerInfo::kClock,
     .name = "clocks",
     .what = "ticks of the device's clock that shading the pixel and its rays took, over all samples",
     .subject = Subject::Work,
     .format = Format::Integer,
     .channels = "I",
     .mean = Mean::Sum,
     .isDiagnostic = true,
     .absent = "uvec4(0u)",
     .tally = "GLINT_TALLY_CLOCKS"},
    {.number = 32,
     .name = "workgroup",
     .what = "number of the workgroup that shaded the hit, within its dispatch; 4294967295: no hit, or no "
             "workgroup",
     .subject = Subject::Ray,
     .format = Format::Integer,
     .channels = "I",
     .isDiagnostic = true,
     .absent = "uvec4(0xFFFFFFFFu)",
     .tally = "GLINT_TALLY_WORKGROUP"},
    {.number = 33,
     .name = "cases-run",
     .what = "cases that the subgroup ran one after the other to shade the hit; 4294967295: as workgroup",
     .subject = Subject::Ray,
     .format = Format::Integer,
     .channels = "I",
     .isDiagnostic = true,
     .absent = "uvec4(0xFFFFFFFFu)",
     .tally = "GLINT_TALLY_CASES"},
};

}  // namespace

const LayerInfo::FormatInfo& infoOf(LayerInfo::Format format) {
    return *std::ranges::find(kFormats, format, &LayerInfo::FormatInfo::format);
}

std::span<const LayerInfo> layerTable() {
    return kRows;
}

const LayerInfo* findLayer(std::string_view name) {
    const auto* const found = std::ranges::find(kRows, name, &LayerInfo::name);
    return found == std::end(kRows) ? nullptr : found;
}

const LayerInfo* findLayer(std::uint32_t number) {
    const auto* const found = std::ranges::find(kRows, number, &LayerInfo::number);
    return found == std::end(kRows) ? nullptr : found;
}

bool hasSources(const LayerInfo& info) {
    return info.subject == LayerInfo::Subject::Light || info.subject == LayerInfo::Subject::Ray ||
           info.subject == LayerInfo::Subject::Bounce;
}

std::string layerName(const LayerInfo& info, std::string_view source, std::uint32_t bounce) {
    std::string name(info.name);
    if (hasSources(info)) {
        name = std::string(source) + "." + name;
    }
    return bounce == 0 ? name : name + "." + std::to_string(bounce);
}

LayerInfo::Pass passOf(const LayerInfo::Entry& entry) {
    const LayerInfo* const info = findLayer(entry.layer);
    if (info != nullptr && !info->tally.empty()) {
        return LayerInfo::Pass::Several;
    }
    const bool ofSurface = info != nullptr && info->subject == LayerInfo::Subject::Surface;
    return ofSurface || entry.effect == 0 ? LayerInfo::Pass::FirstHits : LayerInfo::Pass::Compose;
}

std::uint32_t demandsOf(std::span<const PackageLayer> layers) {
    std::uint32_t demands = 0;
    for (const PackageLayer& layer : layers) {
        demands |= layer.info->demands;
    }
    return demands;
}

std::uint32_t layerBounces(std::span<const PackageLayer> layers) {
    std::uint32_t bounces = 0;
    for (const PackageLayer& layer : layers) {
        bounces = std::max(bounces, layer.bounce);
    }
    return bounces;
}

bool showsWalkedLight(const LayerInfo::Entry& entry, std::uint32_t walks) {
    const LayerInfo* const info = findLayer(entry.layer);
    const bool isLight = info != nullptr && (info->subject == LayerInfo::Subject::Light ||
                                             info->subject == LayerInfo::Subject::Bounce);
    return isLight && (entry.effect & walks) != 0;
}

bool showWalkedLight(std::span<const PackageLayer> layers, std::uint32_t walks) {
    return std::ranges::any_of(layers, [&](const PackageLayer& layer) {
        return showsWalkedLight({layer.info->number, layer.effect, layer.bounce}, walks);
    });
}

std::uint32_t bytesOf(std::span<const PackageLayer> layers) {
    std::uint32_t bytes = 0;
    for (const PackageLayer& layer : layers) {
        bytes += infoOf(layer.info->format).bytes;
    }
    return bytes;
}

}  // namespace glint::package
