// Compares the path tracer with closed forms.
#include "oracle/light.h"
#include "oracle/refraction.h"
#include "oracle/transport/path_scene.h"

namespace {

using namespace glint;
using namespace glint::oracle;

Json glowing(double albedo, double emission) {
    Json material = diffuseMaterial(Vec3(albedo));
    material["emissiveFactor"] = {emission, 0.5 * emission, 0.0};
    return material;
}

// Every wall emits e and reflects ρ, so all of n scatterings together give e (1 + ρ + … + ρⁿ), and no end of
// them e / (1 - ρ).
TEST(PathOracle, AClosedBoxOfDiffuseWallsIsAGeometricSeries) {
    constexpr double kAlbedo = 0.6;
    SceneFile file;
    file.addBox(std::vector<int>(6, file.addMaterial(glowing(kAlbedo, 0.5))), {-1, -1, -1}, {1, 2, 1}, true);
    const gltf::Scene scene = file.import();
    const Ray ray = rayTo({0.2, 0.1, 0.4}, {-1, 0.7, -0.3});
    for (const std::uint32_t bounces : {0U, 1U, 4U, kUnlimited}) {
        for (const std::uint32_t roulette : {4U, 0U, kUnlimited}) {
            SCOPED_TRACE(::testing::Message() << bounces << " bounces, roulette from " << roulette);
            const double sum = bounces == kUnlimited
                                   ? 1.0 / (1.0 - kAlbedo)
                                   : (1.0 - std::pow(kAlbedo, bounces + 2.0)) / (1.0 - kAlbedo);
            expectLight(scene, {}, {.bounces = bounces, .rouletteFrom = roulette}, ray,
                        sum * Vec3(0.5, 0.25, 0.0), 0.02, 2000);
        }
    }
}

constexpr Vec3 kCorner(-0.5, 1.0, -0.7);
constexpr Vec3 kAlong(1.0, 0.0, 0.0);
constexpr Vec3 kAcross(0.0, 0.0, 1.2);
const Vec3 kFloorPlace(0.4, 0.0, 0.3);

// Adds a floor of albedo 0.8, and above it a quad that emits downwards, or upwards.
void addLamp(SceneFile& file, bool downwards, bool doubleSided) {
    file.addQuad(file.addMaterial(diffuseMaterial(Vec3(0.8))), {-5, 0, 5}, {10, 0, 0}, {0, 0, -10});
    Json lamp = emissiveMaterial({4.0, 2.0, 1.0});
    lamp["doubleSided"] = doubleSided;
    file.addQuad(file.addMaterial(lamp), kCorner, downwards ? kAlong : kAcross, downwards ? kAcross : kAlong);
}

Ray toFloor() {
    return rayTo({0.9, 0.6, 2.0}, kFloorPlace);
}

TEST(PathOracle, AnEmissiveQuadLightsByLambertsFormula) {
    const double factor = formFactorOfQuad(kFloorPlace, {0, 1, 0}, kCorner, kAlong, kAcross);
    for (const bool downwards : {true, false}) {
        for (const bool doubleSided : {true, false}) {
            SceneFile file;
            addLamp(file, downwards, doubleSided);
            const Vec3 light = downwards || doubleSided ? 0.8 * factor * Vec3(4.0, 2.0, 1.0) : Vec3(0.0);
            for (const std::uint32_t bounces : {0U, kUnlimited}) {
                expectLight(file.import(), {}, {.bounces = bounces}, toFloor(), light, 0.01);
            }
        }
    }
}

// The half of the quad towards +x is black in the emissive texture.
TEST(PathOracle, AnEmissiveTextureLightsByItsTexels) {
    SceneFile file;
    addLamp(file, true, false);
    gltf::Scene scene = file.import();
    gltf::Image image;
    image.width = 2;
    image.height = 1;
    image.pixels = {255, 255, 255, 255, 0, 0, 0, 255};
    scene.images = {image};
    gltf::Sampler sampler;
    sampler.magnification = gltf::Filter::Nearest;
    scene.samplers = {sampler};
    scene.textures = {{0, 0}};
    scene.materials.back().texture("emissiveTexture").texture = 0;
    scene.meshes.back().primitives[0].texCoords0 = {{0.0F, 0.0F}, {1.0F, 0.0F}, {1.0F, 1.0F}, {0.0F, 1.0F}};
    const double factor = formFactorOfQuad(kFloorPlace, {0, 1, 0}, kCorner, 0.5 * kAlong, kAcross);
    expectLight(scene, {}, {}, toFloor(), 0.8 * factor * Vec3(4.0, 2.0, 1.0), 0.01);
}

// A black veil passes 1 - alpha, whether a ray to the light or the path itself finds the light. A lamp
// without a size is found by rays to lights alone.
TEST(PathOracle, BlendedSurfacesPassTheirShare) {
    SceneFile file;
    addLamp(file, true, false);
    Json veil = diffuseMaterial(Vec3(0.0), true);
    veil["pbrMetallicRoughness"]["baseColorFactor"] = {0.0, 0.0, 0.0, 0.25};
    veil["alphaMode"] = "BLEND";
    file.addQuad(file.addMaterial(veil), {-4, 0.9, 4}, {8, 0, 0}, {0, 0, -8});
    const Vec3 place(0.9, 0.0, 0.3);
    file.addLight({{"type", "point"}, {"intensity", 2.0}}, {0.9, 2.0, 0.3}, place);
    const gltf::Scene scene = file.import();
    const double factor = formFactorOfQuad(place, {0, 1, 0}, kCorner, kAlong, kAcross);
    for (const ShadowThrough through : {ShadowThrough::Opaque, ShadowThrough::Alpha, ShadowThrough::Glass}) {
        SCOPED_TRACE(static_cast<int>(through));
        const double lamp = through == ShadowThrough::Opaque ? 0.0 : 0.75 * 0.8 / kPi * 2.0 / 4.0;
        expectLight(scene, {}, {.shadowThrough = through}, rayTo({0.9, 0.6, 2.0}, place),
                    0.75 * 0.8 * factor * Vec3(4.0, 2.0, 1.0) + Vec3(lamp), 0.02);
    }
}

// The last surface before the sky is the eleventh mirror.
TEST(PathOracle, AMirrorCorridorIsAPowerOfItsReflectance) {
    constexpr double kReflectance = 0.9;
    SceneFile file;
    const int mirror =
        file.addMaterial({{"pbrMetallicRoughness",
                           {{"baseColorFactor", {kReflectance, kReflectance, kReflectance, 1.0}},
                            {"metallicFactor", 1.0},
                            {"roughnessFactor", 0.0}}}});
    file.addQuad(mirror, {-0.5, -50, 0}, {0, 0, -10}, {0, 100, 0});
    file.addQuad(mirror, {0.5, -50, -10}, {0, 0, 10}, {0, 100, 0});
    const gltf::Scene scene = file.import();
    const Ray ray = rayTo({0, 0, 0}, {1.0, 0.0, -0.9});
    const double cosine = ray.direction.x;
    const double fresnel = kReflectance + (1.0 - kReflectance) * std::pow(1.0 - cosine, 5.0);
    for (const std::uint32_t roulette : {4U, kUnlimited}) {
        const auto expectPower = [&](std::uint32_t bounces, double truth) {
            expectLight(scene, uniformSky(1.0), {.bounces = bounces, .rouletteFrom = roulette}, ray,
                        Vec3(truth), 0.02, 2000, 1e-5);
        };
        expectPower(9, 0.0);
        expectPower(10, std::pow(fresnel, 11.0));
        expectPower(kUnlimited, std::pow(fresnel, 11.0));
    }
}

// Light is reflected at both sides of a slab any number of times: (1 - F)² a / (1 - F² a²), where a passes
// once.
TEST(PathOracle, ASlabOfGlassIsTheSeriesOfItsReflections) {
    const Vec3 color(0.3, 0.6, 0.9);
    SceneFile file;
    const Glass glass{1.5, 1.0, 0.5, color, 0.0};
    file.addBox(std::vector<int>(6, file.addMaterial(glassMaterial(glass))), {-900, -0.4, -900},
                {900, 0.0, 900}, false);
    const gltf::Scene scene = file.import();
    // Only light from below counts: the sky is its cosine there, and black above.
    const GradientSky below{Vec3(0.0), Vec3(0.0), Vec3(1.0)};
    for (const double angle : {0.0, 0.6, 1.1}) {
        const Ray ray = rayTo({-std::sin(angle), std::cos(angle), 0.0}, {0, 0, 0});
        const double cosine = std::cos(angle);
        const double within = std::sqrt(1.0 - squared(std::sin(angle) / 1.5));
        const double reflected = reflectance(Fresnel::Schlick, 1.0, 1.5, cosine);
        const Vec3 once = glm::exp(-absorptionOf(color, 0.5) * (0.4 / within));
        const Vec3 truth =
            cosine * squared(1.0 - reflected) * once / (1.0 - squared(reflected) * once * once);
        expectLight(scene, below, {}, ray, truth, 0.01, 20000, 1e-5);
        expectLight(scene, below, {.bounces = 0}, ray, truth, 0.01, 20000, 1e-5);
    }
}

// Every chord within a sphere is as long as the first, so under a uniform sky F + (1 - F)² a / (1 - F a).
TEST(PathOracle, ASphereOfGlassAbsorbsAlongItsChords) {
    const Vec3 color(0.9, 0.5, 0.2);
    SceneFile file;
    file.addSphere(file.addMaterial(glassMaterial({1.5, 1.0, 0.8, color, 0.0})), {0, 0, 0}, 0.5, 300);
    const gltf::Scene scene = file.import();
    for (const double aside : {0.0, 0.2, 0.4}) {
        const double sine = aside / 0.5;
        const double cosine = std::sqrt(1.0 - sine * sine);
        const double within = std::sqrt(1.0 - squared(sine / 1.5));
        const double reflected = reflectance(Fresnel::Schlick, 1.0, 1.5, cosine);
        const Vec3 once = glm::exp(-absorptionOf(color, 0.8) * (2.0 * 0.5 * within));
        const Vec3 truth = Vec3(reflected) + squared(1.0 - reflected) * once / (1.0 - reflected * once);
        // The facets lie inside of the sphere, by 2e-5 of its radius at most.
        expectLight(scene, uniformSky(1.0), {}, {{aside, 0.003, 3.0}, {0, 0, -1}}, truth, 0.01, 10000, 1e-3);
    }
}

// The floor under a pane of thin glass sees 1 - F of a white sky. The pane reflects F of what the floor sends
// up, and the floor sends it up again.
TEST(PathOracle, LightThroughThinGlassIsCountedOnce) {
    SceneFile file;
    file.addQuad(file.addMaterial(diffuseMaterial(Vec3(0.8))), {-500, 0, 500}, {1000, 0, 0}, {0, 0, -1000});
    Json pane = glassMaterial({1.5, 0.0, 0.0, Vec3(1.0), 0.0});
    pane["doubleSided"] = true;
    file.addQuad(file.addMaterial(pane), {-500, 1, 500}, {1000, 0, 0}, {0, 0, -1000});
    const gltf::Scene scene = file.import();
    // 2 ∫ F(μ) μ dμ.
    const double mean = 0.04 + 0.96 / 21.0;
    const double first = 0.8 * (1.0 - mean);
    for (const ShadowThrough through : {ShadowThrough::Opaque, ShadowThrough::Alpha, ShadowThrough::Glass}) {
        SCOPED_TRACE(static_cast<int>(through));
        const Ray ray = rayTo({0, 0.5, 0.3}, {0, 0, 0});
        expectLight(scene, uniformSky(1.0), {.bounces = 0, .shadowThrough = through}, ray, Vec3(first), 0.01,
                    20000, 1e-3);
        // All of the reflections between the two.
        expectLight(scene, uniformSky(1.0), {.shadowThrough = through}, ray, Vec3(first / (1.0 - 0.8 * mean)),
                    0.01, 20000, 1e-3);
    }
}

TEST(PathOracle, AThinPaneShadesALampOnTheStraightLine) {
    SceneFile file;
    file.addQuad(file.addMaterial(diffuseMaterial(Vec3(0.8))), {-5, 0, 5}, {10, 0, 0}, {0, 0, -10});
    Json pane = glassMaterial({1.5, 0.0, 0.0, Vec3(1.0), 0.0});
    pane["pbrMetallicRoughness"]["baseColorFactor"] = {0.9, 0.5, 0.2, 1.0};
    file.addQuad(file.addMaterial(pane), {-4, 1, 4}, {8, 0, 0}, {0, 0, -8});
    file.addLight({{"type", "point"}, {"intensity", 3.0}}, {0, 2, 0}, {0, 0, 0});
    const gltf::Scene scene = file.import();
    const Vec3 place(1.5, 0, 0);
    const double cosine = 2.0 / 2.5;
    const double arriving = 3.0 / 6.25 * cosine * 0.8 / kPi;
    const double passes = 1.0 - reflectance(Fresnel::Schlick, 1.0, 1.5, cosine);
    const Ray ray = rayTo({1.7, 0.5, 0.5}, place);
    expectLight(scene, {}, {.bounces = 0, .shadowThrough = ShadowThrough::Alpha}, ray, Vec3(0.0), 0.0, 100);
    expectLight(scene, {}, {.bounces = 0, .shadowThrough = ShadowThrough::Glass}, ray,
                arriving * passes * Vec3(0.9, 0.5, 0.2), 1e-6, 100);
}

// A sphere lights as a point does, unless the floor hides part of it.
TEST(PathOracle, LampsWithASizeLightByTheirCap) {
    for (const double height : {2.0, 0.4}) {
        SceneFile file;
        file.addQuad(file.addMaterial(diffuseMaterial(Vec3(0.8))), {-5, 0, 5}, {10, 0, 0}, {0, 0, -10});
        file.addLight({{"type", "point"}, {"intensity", 3.0}}, {1, height, 0}, {1, 0, 0});
        const gltf::Scene scene = file.import();
        const double distance = std::hypot(1.0, height);
        const Circle lamp{Vec3(1.0, height, 0.0) / distance, std::asin(0.8 / distance)};
        const double truth = 3.0 / squared(distance) * irradianceAboveHorizon(lamp, {0, 1, 0}) * 0.8 / kPi;
        expectLight(scene, {}, {.sizes = {0.8, 0.0}}, rayTo({0.3, 0.5, 0.5}, {0, 0, 0}), Vec3(truth), 4e-3,
                    10000);
    }
}

}  // namespace
