#include "synthetic/cases_scene.h"

#include "materials/material.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <numeric>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace glint::synthetic {

namespace {

// Heights in metres above the floor, which is at height 0: the camera's and the ceiling's.
constexpr double kCameraHeight = 1.0;
constexpr double kCeilingHeight = 3.0;
// The camera's vertical field of view, in radians.
constexpr double kFieldOfView = 1.0;

Extent viewExtent(double distance, double aspect) {
    const double half = distance * std::tan(kFieldOfView / 2.0);
    return {half * aspect, half};
}

// --- Textures ---

// Indices into Scene::textures.
enum CaseTexture : int {
    kWhite,    // neutral as a factor
    kFlat,     // neutral as a normal map
    kColors,   // soft squares, for colours
    kFactors,  // every channel varies about 0.8, for factors
    kBumps,    // a normal map
};

using Pixel = std::array<double, 4>;  // each channel from 0 to 1

constexpr int kSize = 64;  // pixels a side; all textures stay in the caches, so that they cost their work
                           // alone

// `pixel` is a function of u and v in [0, 1).
template <typename Make>
gltf::Image makeImage(const std::string& name, int size, const Make& pixel) {
    gltf::Image image;
    image.name = name;
    image.width = size;
    image.height = size;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const Pixel value = pixel((x + 0.5) / size, (y + 0.5) / size);
            for (const double channel : value) {
                image.pixels.push_back(
                    static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(channel, 0.0, 1.0))));
            }
        }
    }
    return image;
}

double wave(double turns) {
    return std::sin(2.0 * std::numbers::pi * turns);
}

// Returns the normal of the height 0.02 sin(2 pi 4 u) sin(2 pi 4 v), from its slopes.
Pixel bump(double u, double v) {
    constexpr double kTurns = 4.0;
    constexpr double kSlope = 0.02 * 2.0 * std::numbers::pi * kTurns;
    const double x = -kSlope * wave(kTurns * u + 0.25) * wave(kTurns * v);
    const double y = -kSlope * wave(kTurns * u) * wave(kTurns * v + 0.25);
    const double length = std::sqrt(x * x + y * y + 1.0);
    return {0.5 + 0.5 * x / length, 0.5 + 0.5 * y / length, 0.5 + 0.5 / length, 1.0};
}

// Adds the textures, their images and their sampler to a scene that has none.
void addTextures(gltf::Scene& scene) {
    constexpr double kMiddle = 128.0 / 255.0;
    scene.images = {
        makeImage("white", 4,
                  [](double, double) {
                      return Pixel{1.0, 1.0, 1.0, 1.0};
                  }),
        makeImage("flat", 4,
                  [](double, double) {
                      return Pixel{kMiddle, kMiddle, 1.0, 1.0};
                  }),
        makeImage("colors", kSize,
                  [](double u, double v) {
                      const double square = wave(2.0 * u) * wave(2.0 * v) > 0.0 ? 1.0 : 0.75;
                      return Pixel{square, square, square, 1.0};
                  }),
        makeImage("factors", kSize,
                  [](double u, double v) {
                      return Pixel{0.8 + 0.2 * wave(3.0 * u), 0.8 + 0.2 * wave(3.0 * v),
                                   0.8 + 0.2 * wave(u + v), 0.8 + 0.2 * wave(u - v)};
                  }),
        makeImage("bumps", kSize, bump),
    };
    scene.samplers = {gltf::Sampler{}};
    for (int i = 0; i < static_cast<int>(scene.images.size()); ++i) {
        scene.images[static_cast<std::size_t>(i)].pointer = "/images/" + std::to_string(i);
        scene.textures.push_back({i, 0});
    }
}

// --- Materials ---

// The cases are materials of glTF. How its features share shaders, and what that costs, is what these scenes
// are for, so they name its parameters and textures.

struct CaseMaterial {
    materials::Material material;
    // The attributes of its primitives, besides positions and texture coordinates.
    bool normals = false;
    bool tangents = false;
    bool colors = false;
};

void readTexture(materials::Material& material, std::string_view name, CaseTexture texture) {
    material.texture(name).texture = texture;
}

using Switch = void (*)(CaseMaterial& made);

constexpr Switch kCheap[] = {
    [](CaseMaterial& made) { readTexture(made.material, "baseColorTexture", kColors); },
    [](CaseMaterial& made) { readTexture(made.material, "metallicRoughnessTexture", kFactors); },
    [](CaseMaterial& made) { readTexture(made.material, "normalTexture", kBumps); },
    [](CaseMaterial& made) { readTexture(made.material, "occlusionTexture", kFactors); },
    [](CaseMaterial& made) { readTexture(made.material, "emissiveTexture", kColors); },
    [](CaseMaterial& made) { made.material["emissiveStrength"] = 2.0F; },
    [](CaseMaterial& made) { made.colors = true; },
    [](CaseMaterial& made) { made.normals = true; },
};

constexpr Switch kExpensive[] = {
    [](CaseMaterial& made) {
        made.material["sheenColorFactor"] = {0.2F, 0.2F, 0.3F};
        made.material["sheenRoughnessFactor"] = 0.5F;
    },
    [](CaseMaterial& made) { made.material["transmissionFactor"] = 0.3F; },
    [](CaseMaterial& made) {
        made.material["diffuseTransmissionFactor"] = 0.3F;
        made.material["diffuseTransmissionColorFactor"] = {0.9F, 0.8F, 0.7F};
    },
    [](CaseMaterial& made) { made.material["ior"] = 1.8F; },
    [](CaseMaterial& made) { readTexture(made.material, "normalTexture", kBumps); },
    [](CaseMaterial& made) { readTexture(made.material, "clearcoatRoughnessTexture", kFactors); },
    [](CaseMaterial& made) { readTexture(made.material, "specularColorTexture", kColors); },
    [](CaseMaterial& made) { readTexture(made.material, "iridescenceThicknessTexture", kFactors); },
};
static_assert(std::size(kCheap) == 8 && std::size(kExpensive) == 8);
static_assert(kMaxCases == 256);

// Returns all sets of eight switches, in the order of makeCaseMaterials().
std::vector<std::uint32_t> makeSets() {
    constexpr std::uint32_t kAll = kMaxCases - 1;
    // Multiplying by an odd factor permutes the numbers below 256, so that neighbours in the list differ.
    constexpr std::uint32_t kSpread = 167;
    std::vector<std::uint32_t> firsts;  // of each pair, the set that has the last switch
    for (std::uint32_t i = 0; i < kMaxCases; ++i) {
        const std::uint32_t set = i * kSpread & kAll;
        if ((set & 1U) != 0) {
            firsts.push_back(set);
        }
    }
    std::ranges::stable_sort(firsts, {}, [](std::uint32_t set) { return std::abs(std::popcount(set) - 4); });
    std::vector<std::uint32_t> sets;
    for (const std::uint32_t set : firsts) {
        sets.push_back(set);
        sets.push_back(~set & kAll);
    }
    return sets;
}

// Each case has its own colour, by the golden angle, so that a picture shows the places of the cases.
std::array<float, 4> colorOf(int index) {
    constexpr double kGoldenTurn = 0.6180339887498949;
    std::array<float, 4> color{0.0F, 0.0F, 0.0F, 1.0F};
    for (std::size_t channel = 0; channel < 3; ++channel) {
        const double turn = index * kGoldenTurn + static_cast<double>(channel) / 3.0;
        color[channel] = static_cast<float>(0.45 + 0.4 * std::cos(2.0 * 3.14159265358979 * turn));
    }
    return color;
}

CaseMaterial makePlain(int index) {
    CaseMaterial made;
    materials::Material& material = made.material;
    material.name = "case " + std::to_string(index);
    std::ranges::copy(colorOf(index), material["baseColorFactor"].begin());
    material["metallicFactor"] = 0.3F;
    material["roughnessFactor"] = 0.5F;
    return made;
}

// Adds the lobes that every expensive case has.
void addLobes(CaseMaterial& made) {
    materials::Material& material = made.material;
    made.normals = true;
    made.tangents = true;
    readTexture(material, "baseColorTexture", kColors);
    readTexture(material, "metallicRoughnessTexture", kFactors);
    material["specularFactor"] = 0.8F;
    material["specularColorFactor"] = {0.9F, 1.0F, 0.8F};
    material["clearcoatFactor"] = 0.6F;
    material["clearcoatRoughnessFactor"] = 0.2F;
    material["anisotropyStrength"] = 0.6F;
    material["anisotropyRotation"] = 0.5F;
    material["iridescenceFactor"] = 0.7F;
    material["iridescenceIor"] = 1.4F;
    material["iridescenceThicknessMinimum"] = 200.0F;
    material["iridescenceThicknessMaximum"] = 500.0F;
}

// Returns `count` materials. Eight switches make 256 sets. Sets with half of the switches come first, and
// each set is followed by the set that has exactly the other switches. So any even number of cases has each
// switch in half of them, and the average work does not grow with the number of cases.
std::vector<CaseMaterial> makeCaseMaterials(Cost cost, int count) {
    const std::span<const Switch> switches = cost == Cost::Cheap ? kCheap : kExpensive;
    const std::vector<std::uint32_t> sets = makeSets();
    std::vector<CaseMaterial> materials;
    for (int i = 0; i < count; ++i) {
        CaseMaterial made = makePlain(i);
        if (cost == Cost::Expensive) {
            addLobes(made);
        } else {
            // Without emission, EmissiveStrength and the texture would change nothing.
            made.material["emissiveFactor"] = 0.05F;
        }
        for (std::size_t bit = 0; bit < switches.size(); ++bit) {
            if ((sets[static_cast<std::size_t>(i)] >> bit & 1U) != 0) {
                switches[bit](made);
            }
        }
        materials.push_back(std::move(made));
    }
    return materials;
}

// Returns a material with the same key whose lobes and textures change next to nothing: a mirror, or a white
// surface that scatters.
CaseMaterial makeFloorMaterial(const CaseMaterial& like, Coherence coherence) {
    constexpr float kFaint = 1e-4F;
    CaseMaterial made = like;
    materials::Material& material = made.material;
    material.name = "floor";
    material["baseColorFactor"] = {0.9F, 0.9F, 0.9F, 1.0F};
    const bool mirror = coherence == Coherence::Coherent;
    // The floor is not fully metallic, because metals have no dielectric lobes. It is not fully rough,
    // because anisotropy would then have no effect.
    material["metallicFactor"] = mirror ? 1.0F - kFaint : kFaint;
    material["roughnessFactor"] = mirror ? 0.0F : 1.0F - kFaint;
    // The other factors that are above 0 stay, and hardly show.
    for (const char* const name :
         {"clearcoatFactor", "anisotropyStrength", "iridescenceFactor", "transmissionFactor",
          "diffuseTransmissionFactor", "sheenColorFactor", "emissiveFactor"}) {
        const materials::ParameterValue value = material[name];
        if (value > 0.0F) {
            value = kFaint;
        }
    }
    // 8 bits have no exact middle, so the normal would lean by a quarter of a degree.
    material["normalScale"] = kFaint;
    for (auto& [slot, info] : material.textures) {
        if (info.texture >= 0) {
            info.texture = material.readsOf(static_cast<int>(slot)).isNormals ? kFlat : kWhite;
        }
    }
    return made;
}

// --- The ceiling ---

// Tiles a side. Coherent: at most cases, 4 tiles a case, each a dozen pixels wide in a picture of 400.
// Incoherent: so many that cosine-weighted rays of neighbours spread over hundreds of tiles.
constexpr int kCoherentTiles = 32;
constexpr int kIncoherentTiles = 64;

// The distance by which an incoherent ceiling extends beyond the floor, in heights of the ceiling.
// Cosine-weighted rays miss it with a chance of about 1 / (1 + 5²).
constexpr double kReach = 5.0;

// Returns every second bit of `code`, starting with the lowest.
std::uint32_t compacted(std::uint32_t code) {
    std::uint32_t bits = 0;
    for (std::uint32_t i = 0; i < 16; ++i) {
        bits |= (code >> (2 * i) & 1U) << i;
    }
    return bits;
}

// Returns places of tiles, row * tiles + column, along a Morton curve: places that are near on the curve are
// near on the ceiling.
std::vector<std::size_t> alongCurve(int tiles) {
    std::vector<std::size_t> places(static_cast<std::size_t>(tiles) * static_cast<std::size_t>(tiles));
    for (std::uint32_t i = 0; i < places.size(); ++i) {
        places[i] = std::size_t{compacted(i >> 1)} * static_cast<std::size_t>(tiles) + compacted(i);
    }
    return places;
}

// The shuffle of Fisher and Yates, because std::shuffle differs between libraries.
void shuffle(std::vector<std::size_t>& places) {
    std::mt19937_64 random(1);
    for (std::size_t i = places.size(); i > 1; --i) {
        std::swap(places[i - 1], places[random() % i]);
    }
}

// Gives each case one tile, and distributes the rest by largest remainders.
std::vector<std::size_t> tilesOfCases(const std::vector<double>& shares, std::size_t tiles) {
    const auto all = static_cast<double>(tiles);
    std::vector<std::size_t> counts;
    counts.reserve(shares.size());
    for (const double share : shares) {
        counts.push_back(std::max<std::size_t>(1, static_cast<std::size_t>(share * all)));
    }
    std::vector<std::size_t> order(shares.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto lacks = [&](std::size_t i) { return shares[i] * all - static_cast<double>(counts[i]); };
    std::size_t given = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
    while (given < tiles) {
        ++counts[*std::ranges::max_element(order, {}, lacks)];
        ++given;
    }
    // If a minimum of one tile exceeded some shares, the surplus is taken from the largest counts.
    for (; given > tiles; --given) {
        --*std::ranges::max_element(counts);
    }
    return counts;
}

}  // namespace

int Ceiling::caseAt(double x, double z) const {
    const double column = std::floor((x / extent.x + 1.0) / 2.0 * tiles);
    const double row = std::floor((z / extent.z + 1.0) / 2.0 * tiles);
    if (!(column >= 0.0 && column < tiles && row >= 0.0 && row < tiles)) {
        return -1;
    }
    return cases[place(static_cast<int>(row), static_cast<int>(column))];
}

std::vector<double> sharesOf(const CasesOptions& options) {
    std::vector<double> shares(static_cast<std::size_t>(options.cases), 1.0);
    if (options.shares == Shares::Zipf) {
        for (std::size_t i = 0; i < shares.size(); ++i) {
            shares[i] = 1.0 / static_cast<double>(i + 1);
        }
    }
    const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
    for (double& share : shares) {
        share /= sum;
    }
    return shares;
}

Ceiling makeCeiling(const CasesOptions& options) {
    const bool coherent = options.coherence == Coherence::Coherent;
    Ceiling ceiling;
    ceiling.tiles = coherent ? kCoherentTiles : kIncoherentTiles;
    if (coherent) {
        // The mirror shows the view of a camera as far below the floor as the real one is above it.
        ceiling.extent = viewExtent(kCameraHeight + kCeilingHeight, options.aspect);
    } else {
        const Extent floor = viewExtent(kCameraHeight, options.aspect);
        ceiling.extent = {floor.x + kReach * kCeilingHeight, floor.z + kReach * kCeilingHeight};
    }
    std::vector<std::size_t> places = alongCurve(ceiling.tiles);
    if (!coherent) {
        shuffle(places);
    }
    ceiling.cases.resize(places.size());
    std::size_t next = 0;
    const std::vector<std::size_t> counts = tilesOfCases(sharesOf(options), places.size());
    for (std::size_t i = 0; i < counts.size(); ++i) {
        for (std::size_t n = 0; n < counts[i]; ++n) {
            ceiling.cases[places[next++]] = static_cast<int>(i);
        }
    }
    return ceiling;
}

// --- The scene ---

namespace {

// A rectangle at a height. Its front is its upper or its lower side.
struct Square {
    double x0 = 0.0;
    double z0 = 0.0;
    double x1 = 0.0;
    double z1 = 0.0;
    double height = 0.0;
    bool facesUp = true;
};

gltf::Primitive makePrimitive(const CaseMaterial& attributes, int material, std::string pointer) {
    gltf::Primitive primitive;
    primitive.pointer = std::move(pointer);
    primitive.material = material;
    primitive.colorContent =
        attributes.colors ? materials::ColorContent::Varying : materials::ColorContent::None;
    return primitive;
}

void addSquare(gltf::Primitive& primitive, const CaseMaterial& attributes, const Square& square) {
    const auto first = static_cast<std::uint32_t>(primitive.positions.size());
    for (const auto& [u, v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
        const double x = u == 0 ? square.x0 : square.x1;
        const double z = v == 0 ? square.z0 : square.z1;
        primitive.positions.push_back(
            {static_cast<float>(x), static_cast<float>(square.height), static_cast<float>(z)});
        primitive.texCoords0.push_back({static_cast<float>(u), static_cast<float>(v)});
        if (attributes.normals) {
            primitive.normals.push_back({0.0F, square.facesUp ? 1.0F : -1.0F, 0.0F});
        }
        if (attributes.tangents) {
            // V grows along z. That is cross(n, t) w for a square that faces down; a square that faces up
            // needs the opposite sign.
            primitive.tangents.push_back({1.0F, 0.0F, 0.0F, square.facesUp ? -1.0F : 1.0F});
        }
        if (attributes.colors) {
            const float shade = u == v ? 1.0F : 0.85F;
            primitive.colors.push_back({shade, shade, shade, 1.0F});
        }
    }
    // The order is counter-clockwise as seen from the front.
    constexpr std::uint32_t kUp[] = {0, 2, 1, 0, 3, 2};
    constexpr std::uint32_t kDown[] = {0, 1, 2, 0, 2, 3};
    for (const std::uint32_t corner : square.facesUp ? kUp : kDown) {
        primitive.indices.push_back(first + corner);
    }
}

gltf::Mesh makeFloor(const CaseMaterial& attributes, int material, double aspect) {
    constexpr double kMargin = 1.01;  // extent beyond the picture's edge
    const Extent extent = viewExtent(kCameraHeight, aspect);
    gltf::Mesh mesh{"floor", {makePrimitive(attributes, material, "/meshes/0/primitives/0")}};
    addSquare(mesh.primitives[0], attributes,
              {-kMargin * extent.x, -kMargin * extent.z, kMargin * extent.x, kMargin * extent.z, 0.0, true});
    return mesh;
}

// Makes one primitive for each case, from all of its tiles.
gltf::Mesh makeTiles(const Ceiling& ceiling, const std::vector<CaseMaterial>& cases) {
    gltf::Mesh mesh{"ceiling", {}};
    for (std::size_t i = 0; i < cases.size(); ++i) {
        mesh.primitives.push_back(
            makePrimitive(cases[i], static_cast<int>(i), fmt::format("/meshes/1/primitives/{}", i)));
    }
    const auto edge = [&](double extent, int i) { return extent * (2.0 * i / ceiling.tiles - 1.0); };
    for (int row = 0; row < ceiling.tiles; ++row) {
        for (int column = 0; column < ceiling.tiles; ++column) {
            const auto place = ceiling.place(row, column);
            const auto index = static_cast<std::size_t>(ceiling.cases[place]);
            addSquare(
                mesh.primitives[index], cases[index],
                {edge(ceiling.extent.x, column), edge(ceiling.extent.z, row),
                 edge(ceiling.extent.x, column + 1), edge(ceiling.extent.z, row + 1), kCeilingHeight, false});
        }
    }
    return mesh;
}

gltf::Matrix4 identity() {
    return {1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0};
}

// The camera looks straight down: its -Z is the world's -Y, its +Y is the world's -Z.
gltf::Camera makeCamera() {
    gltf::Camera camera;
    camera.name = "above";
    camera.yfov = kFieldOfView;
    camera.world = {1.0, 0.0, 0.0, 0.0, 0.0, 0.0,           -1.0, 0.0,
                    0.0, 1.0, 0.0, 0.0, 0.0, kCameraHeight, 0.0,  1.0};
    return camera;
}

// Places the lights on a circle half way up. Their total flux does not depend on `count`.
void addLights(gltf::Scene& scene, int count) {
    for (int i = 0; i < count; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / count;
        gltf::Light light;
        light.name = fmt::format("light {}", i);
        light.type = gltf::LightType::Point;
        light.intensity = 10.0F / static_cast<float>(count);
        light.position = {static_cast<float>(std::cos(angle)), static_cast<float>(kCeilingHeight / 2.0),
                          static_cast<float>(std::sin(angle))};
        scene.lights.push_back(std::move(light));
    }
}

gltf::Node placing(const std::string& name, int number) {
    gltf::Node node;
    node.name = name;
    node.world = identity();
    node.source = number;
    return node;
}

}  // namespace

std::string_view nameOf(Cost cost) {
    return cost == Cost::Cheap ? "cheap" : "expensive";
}

std::string_view nameOf(Coherence coherence) {
    return coherence == Coherence::Coherent ? "coherent" : "incoherent";
}

std::string_view nameOf(Shares shares) {
    return shares == Shares::Uniform ? "uniform" : "zipf";
}

gltf::Scene makeCasesScene(const CasesOptions& options) {
    gltf::Scene scene;
    scene.path = fmt::format("{}-{}-{}-{}.synthetic", options.cases, nameOf(options.cost),
                             nameOf(options.coherence), nameOf(options.shares));
    addTextures(scene);
    const std::vector<CaseMaterial> cases = makeCaseMaterials(options.cost, options.cases);
    const CaseMaterial floor = makeFloorMaterial(cases[0], options.coherence);
    for (const CaseMaterial& made : cases) {
        scene.materials.push_back(made.material);
    }
    scene.materials.push_back(floor.material);
    scene.meshes = {makeFloor(floor, options.cases, options.aspect), makeTiles(makeCeiling(options), cases)};
    for (int mesh = 0; mesh < 2; ++mesh) {
        scene.nodes.push_back(placing(scene.meshes[static_cast<std::size_t>(mesh)].name, mesh));
        scene.nodes.back().mesh = mesh;
    }
    scene.cameras = {makeCamera()};
    scene.nodes.push_back(placing("above", 2));
    scene.nodes.back().camera = 0;
    scene.nodes.back().world = scene.cameras[0].world;
    addLights(scene, options.lights);
    return scene;
}

// --- The similarity of neighbouring hits ---

namespace {

constexpr std::uint32_t kBlockWidth = 8;
constexpr std::uint32_t kBlockHeight = 4;
constexpr std::uint32_t kMaxBlocks = 4096;

// Returns a number in [0, 1) with the 53 bits of a double.
double unit(std::mt19937_64& random) {
    return static_cast<double>(random() >> 11) * 0x1p-53;
}

double pairs(double count) {
    return count * (count - 1.0) / 2.0;
}

// Finds the cases that the rays of a picture hit.
class Rays {
public:
    Rays(const CasesOptions& options, std::uint32_t width, std::uint32_t height)
        : mirror_(options.coherence == Coherence::Coherent),
          ceiling_(makeCeiling(options)),
          floor_(viewExtent(kCameraHeight, static_cast<double>(width) / height)),
          width_(width),
          height_(height) {}

    // Returns -1 if the ray hits no tile.
    int caseOf(std::uint32_t x, std::uint32_t y) {
        const double fromX = floor_.x * (2.0 * (x + 0.5) / width_ - 1.0);
        const double fromZ = floor_.z * (2.0 * (y + 0.5) / height_ - 1.0);
        if (mirror_) {
            // The reflected ray continues with the same slope.
            const double growth = 1.0 + kCeilingHeight / kCameraHeight;
            return ceiling_.caseAt(growth * fromX, growth * fromZ);
        }
        // The direction is cosine-weighted: a point of the unit disk is lifted onto the hemisphere (Malley).
        const double squared = unit(random_);
        const double angle = 2.0 * std::numbers::pi * unit(random_);
        const double reach = kCeilingHeight * std::sqrt(squared / std::max(1.0 - squared, 1e-12));
        return ceiling_.caseAt(fromX + reach * std::cos(angle), fromZ + reach * std::sin(angle));
    }

private:
    bool mirror_;
    Ceiling ceiling_;
    Extent floor_;
    std::uint32_t width_;
    std::uint32_t height_;
    std::mt19937_64 random_{1};
};

}  // namespace

double coherentShareOf(const CasesOptions& options, std::uint32_t width, std::uint32_t height) {
    const std::uint32_t columns = std::max(1U, width / kBlockWidth);
    const std::uint32_t rows = std::max(1U, height / kBlockHeight);
    const std::uint64_t blocks = std::uint64_t{columns} * rows;
    const std::uint64_t looked = std::min<std::uint64_t>(blocks, kMaxBlocks);
    Rays rays(options, width, height);
    std::vector<double> all(static_cast<std::size_t>(options.cases), 0.0);
    double alike = 0.0;
    double compared = 0.0;
    for (std::uint64_t i = 0; i < looked; ++i) {
        const std::uint64_t block = i * blocks / looked;
        const auto left = static_cast<std::uint32_t>(block % columns) * kBlockWidth;
        const auto top = static_cast<std::uint32_t>(block / columns) * kBlockHeight;
        std::vector<double> counts(all.size(), 0.0);
        double hits = 0.0;
        for (std::uint32_t y = top; y < std::min(top + kBlockHeight, height); ++y) {
            for (std::uint32_t x = left; x < std::min(left + kBlockWidth, width); ++x) {
                const int hit = rays.caseOf(x, y);
                if (hit >= 0) {
                    counts[static_cast<std::size_t>(hit)] += 1.0;
                    hits += 1.0;
                }
            }
        }
        for (std::size_t c = 0; c < counts.size(); ++c) {
            alike += pairs(counts[c]);
            all[c] += counts[c];
        }
        compared += pairs(hits);
    }
    double sum = 0.0;
    double squares = 0.0;
    for (const double count : all) {
        sum += count;
        squares += count * count;
    }
    const double random = sum > 0.0 ? squares / (sum * sum) : 1.0;
    if (random >= 1.0 || compared <= 0.0) {
        return 1.0;
    }
    return (alike / compared - random) / (1.0 - random);
}

}  // namespace glint::synthetic
