// Builds packages by hand: what a compiler would write, and what it never should.
#pragma once

#include "interop/scene.h"
#include "support/temporary_folder.h"

#include <glint/internal/package_modules.h>
#include <glint/package.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

namespace glint::test {

struct ModuleSpec {
    package::ModuleKey key;
    std::string file;
    std::vector<std::uint32_t> words;
};

struct CaseSpec {
    std::uint64_t always = 0;
    std::uint64_t sometimes = 0;
    std::string name;
    std::uint32_t keyCount = 1;  // 0: retired
};

// The numbers of elements of the other lists that belong to the scene.
struct SceneSpec {
    std::string name;
    std::uint32_t materials = 0;
    std::uint32_t primitives = 0;
    std::uint32_t textures = 0;
    std::uint32_t samplers = 0;
};

// The record of a material, as tests/unit/runtime/shaders/generated/material_record.glsl has it.
struct TestMaterial {
    float roughnessFactor = 0.0F;
    gpu::TextureRecord textures[2] = {};
};

// Returns a record of a loaded package.
inline TestMaterial materialAt(const MaterialTable& table, std::size_t index) {
    TestMaterial material;
    std::memcpy(static_cast<void*>(&material), &table.bytes[index * table.recordBytes], sizeof material);
    return material;
}

// The bit of KeyWords::inputs that the feature with a role has in these packages.
constexpr std::uint32_t inputOf(package::Role role) {
    return 1U << static_cast<std::uint32_t>(role);
}

// Tests may break every member on purpose; serialize() writes what it finds.
struct PackageSpec {
    std::uint32_t version = package::kVersion;
    std::uint32_t strategies = package::kStrategyUber | package::kStrategyVisibility;
    std::uint32_t tracers = package::kTracerRayQuery;
    package::AlphaPolicy alpha = package::AlphaPolicy::Opaque;
    package::ShadingPrecision precision = package::ShadingPrecision::Single;
    bool environmentMap = false;
    std::uint32_t caseCount = 0;
    std::uint32_t interopHash = 0;
    std::vector<ModuleSpec> modules;
    std::vector<TestMaterial> materials;
    std::vector<package::PrimitiveEntry> primitives;
    std::vector<package::TextureEntry> textures;
    std::vector<package::SamplerEntry> samplers;
    std::vector<package::AttributeEntry> attributes;
    std::vector<package::EffectEntry> effects;    // their names are the builder's
    std::vector<package::FeatureEntry> features;  // the same
    std::vector<package::FieldEntry> fields;      // the same
    std::vector<CaseSpec> cases;
    std::vector<SceneSpec> scenes;  // empty: one, named "scene", that has all elements
};

// Returns one case, one material, primitive 0 of mesh 0, both strategies. Every module is the same SPIR-V
// header.
PackageSpec makeSpec();
// Returns the same with modules of the folder into which tests/unit/runtime/shaders was compiled.
PackageSpec makeDeviceSpec();
// Returns makeDeviceSpec() with a second case, which shades the primitive.
PackageSpec makeOtherSpec();
// Returns the words of a module of that folder, or nothing if there is none.
std::vector<std::uint32_t> readTestShader(const std::string& name);

package::PrimitiveEntry makePrimitive(std::uint32_t mesh, std::uint32_t primitive, std::uint32_t flags = 0);

// Returns the bytes of tables.bin with a correct header and hashes.
std::vector<std::uint8_t> serialize(const PackageSpec& spec);
// Corrects the header's hash and size after a change to the bytes.
void reseal(std::vector<std::uint8_t>& tables);

void writeBytes(const std::filesystem::path& path, const std::vector<std::uint8_t>& bytes);
void writeModules(const PackageSpec& spec, const std::filesystem::path& folder);
void writePackage(const PackageSpec& spec, const std::filesystem::path& folder);

}  // namespace glint::test
