// Under a white sky of 1, a convex body that absorbs nothing shows 1 everywhere, whatever its lobes are.
#include "oracle/transport/path_scene.h"

#include <cmath>
#include <iterator>
#include <string>

namespace {

using namespace glint;
using namespace glint::oracle;

struct Body {
    std::string name;
    Json material;
    // At most. Diffuse light is what no channel of the film, the coat or the sheen reflects: the others lose
    // some.
    double absorbed = 0.0;
};

Json material(double metallic, double roughness) {
    return {{"pbrMetallicRoughness",
             {{"baseColorFactor", {1.0, 1.0, 1.0, 1.0}},
              {"metallicFactor", metallic},
              {"roughnessFactor", roughness}}}};
}

Json with(Json base, const std::string& extension, Json values) {
    base["extensions"][extension] = std::move(values);
    return base;
}

std::vector<Body> bodies() {
    Json thin = with(material(0.0, 0.3), "KHR_materials_transmission", {{"transmissionFactor", 1.0}});
    Json glass = with(with(material(0.0, 0.0), "KHR_materials_transmission", {{"transmissionFactor", 1.0}}),
                      "KHR_materials_volume", {{"thicknessFactor", 1.0}});
    Json leaf =
        with(material(0.0, 0.6), "KHR_materials_diffuse_transmission",
             {{"diffuseTransmissionFactor", 0.5}, {"diffuseTransmissionColorFactor", {1.0, 1.0, 1.0}}});
    return {{"diffuse", diffuseMaterial(), 1e-6},
            {"dielectric", material(0.0, 0.5), 2e-3},
            {"smooth dielectric", material(0.0, 0.0), 2e-3},
            {"metal", material(1.0, 0.4), 2e-3},
            {"rough metal", material(1.0, 1.0), 2e-3},
            {"mirror", material(1.0, 0.0), 2e-3},
            {"half metal", material(0.5, 0.5), 2e-3},
            {"clearcoat",
             with(material(0.0, 0.5), "KHR_materials_clearcoat",
                  {{"clearcoatFactor", 1.0}, {"clearcoatRoughnessFactor", 0.3}}),
             0.08},
            {"sheen",
             with(material(0.0, 0.5), "KHR_materials_sheen",
                  {{"sheenColorFactor", {1.0, 1.0, 1.0}}, {"sheenRoughnessFactor", 0.5}}),
             0.1},
            {"iridescence",
             with(material(0.0, 0.4), "KHR_materials_iridescence", {{"iridescenceFactor", 1.0}}), 0.08},
            {"specular", with(material(0.0, 0.4), "KHR_materials_specular", {{"specularFactor", 0.3}}), 2e-3},
            {"thin glass", thin, 0.02},
            {"glass", glass, 2e-3},
            {"dispersing glass", with(glass, "KHR_materials_dispersion", {{"dispersion", 5.0}}), 2e-3},
            {"leaf", leaf, 2e-3}};
}

TEST(PathFurnace, BodiesThatAbsorbNothingVanish) {
    for (Body& body : bodies()) {
        SCOPED_TRACE(body.name);
        SceneFile file;
        file.addSphere(file.addMaterial(body.material), {0, 0, 0}, 0.5, 96);
        const gltf::Scene scene = file.import();
        const PathTracer tracer(scene, PathSky(uniformSky(1.0)), {});
        for (const double aside : {0.05, 0.3, 0.45}) {
            SCOPED_TRACE(aside);
            const Estimate light = pathLight(tracer, {{aside, 0.004, 3.0}, {0, 0, -1}}, 2000, 3);
            // One of three colours at a time has the variance of two.
            EXPECT_LE(light.error.y, 0.07);
            EXPECT_LE(light.mean.y, 1.0 + 5.0 * light.error.y + 1e-3);
            EXPECT_GE(light.mean.y, 1.0 - 5.0 * light.error.y - body.absorbed);
        }
    }
}

// A normal that is 60° off the triangle's: (1 - cos 60°) / 2 of the diffuse light is sent below it.
TEST(PathFurnace, LightBelowASurfaceIsLostOrReflected) {
    SceneFile file;
    file.addQuad(file.addMaterial(diffuseMaterial()), {-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
    gltf::Scene scene = file.import();
    for (auto& normal : scene.meshes.at(0).primitives.at(0).normals) {
        normal = {0.8660254F, 0.0F, 0.5F};
    }
    const Ray ray = rayTo({0.3, 0.2, 2.0}, {0.1, 0.1, 0.0});
    PathSettings settings;
    expectLight(scene, uniformSky(1.0), settings, ray, Vec3(0.75), 0.02);
    settings.reflectsBelow = true;
    expectLight(scene, uniformSky(1.0), settings, ray, Vec3(1.0), 0.02);
}

// A coat without roughness whose normal texture turns it by 60°, over black: seen from above, it reflects the
// light that comes from 30° below the triangle.
TEST(PathFurnace, LightThatACoatSendsBelowIsLostOrReflected) {
    SceneFile file;
    Json black = with(diffuseMaterial(Vec3(0.0)), "KHR_materials_clearcoat", {{"clearcoatFactor", 1.0}});
    file.addQuad(file.addMaterial(black), {-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
    gltf::Scene scene = file.import();
    constexpr std::uint8_t kTurned[] = {238, 128, 191, 255};
    gltf::Image image;
    image.width = 1;
    image.height = 1;
    image.pixels.assign(std::begin(kTurned), std::end(kTurned));
    scene.images.push_back(std::move(image));
    scene.samplers.emplace_back();
    scene.textures.push_back({.image = 0, .sampler = 0});
    scene.materials.at(0).texture("clearcoatNormalTexture").texture = 0;
    gltf::Primitive& quad = scene.meshes.at(0).primitives.at(0);
    quad.texCoords0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    const Vec3 normal = glm::normalize(Vec3(kTurned[0], kTurned[1], kTurned[2]) * (2.0 / 255.0) - Vec3(1.0));
    const double reflected = 0.04 + 0.96 * std::pow(1.0 - normal.z, 5.0);
    const Ray ray = rayTo({0.1, 0.1, 2.0}, {0.1, 0.1, 0.0});
    PathSettings settings;
    expectLight(scene, uniformSky(1.0), settings, ray, Vec3(0.0), 1e-6);
    settings.reflectsBelow = true;
    expectLight(scene, uniformSky(1.0), settings, ray, Vec3(reflected), 1e-3, 20000, 2e-3);
}

}  // namespace
