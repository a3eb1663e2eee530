#include "synthetic/case_materials.h"

#include "synthetic/textures.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <span>
#include <string>
#include <string_view>

namespace glint::synthetic {

namespace {

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

}  // namespace

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
    for (materials::TextureInfo& info : material.textures) {
        if (info.texture >= 0) {
            info.texture = &info == &material.texture("normalTexture") ? kFlat : kWhite;
        }
    }
    return made;
}

}  // namespace glint::synthetic
