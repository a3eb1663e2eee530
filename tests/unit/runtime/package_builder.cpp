#include "package_builder.h"

#include "package/package.h"
#include "support/effect_bits.h"

#include <xxhash.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

namespace glint::test {

using package::ModuleRole;

namespace {

// Lobes are in the low half, inputs in the high one.
package::KeyWords wordsOf(std::uint64_t features) {
    return {static_cast<std::uint32_t>(features), static_cast<std::uint32_t>(features >> 32U)};
}

struct NamedRole {
    ModuleRole role;
    const char* name;
};

const NamedRole kRoles[] = {
    {ModuleRole::GBufferVertex, "gbuffer.vert"},
    {ModuleRole::GBufferFragment, "gbuffer.frag"},
    {ModuleRole::FirstHit, "first_hit.comp"},
    {ModuleRole::EffectRays, "effect_rays.comp"},
    {ModuleRole::RayDispatch, "ray_dispatch.comp"},
    {package::roleNamed("UberShade"), "uber.comp"},
    {ModuleRole::Trace, "trace.comp"},
    {ModuleRole::BucketCount, "bucket_count.comp"},
    {ModuleRole::BucketOffset, "bucket_offset.comp"},
    {ModuleRole::BucketCopy, "bucket_copy.comp"},
    {package::roleNamed("ShadeMiss"), "shade_miss.comp"},
    {package::roleNamed("ShadeCase"), "shade_case.comp"},
    {ModuleRole::Compose, "compose.comp"},
    // This module never runs here.
    {ModuleRole::OrderCheck, "compose.comp"},
    {ModuleRole::FirstCount, "first_count.comp"},
    {ModuleRole::FirstCopy, "first_copy.comp"},
    {ModuleRole::FirstMiss, "first_miss.comp"},
};

const package::EffectInfo kEffects[] = {
    {package::kEffectShadow, package::EffectInfo::Kind::Light, 0, "shadow"},
    {package::kEffectReflection, package::EffectInfo::Kind::Rays, package::kEffectStartsOnScreen,
     "reflection"},
};

package::EffectSet effectSet() {
    package::EffectSet set;
    for (const package::EffectInfo& effect : kEffects) {
        set.add(effect);
    }
    return set;
}

// This is a module only by its header.
const std::vector<std::uint32_t> kEmptyModule{0x07230203, 0x00010500, 0, 1, 0};

PackageSpec makeWithModules(const auto& wordsOf) {
    PackageSpec spec;
    spec.interopHash = interopHash();
    spec.caseCount = 1;
    for (const package::ModuleKey& key :
         package::requiredModules({spec.strategies, spec.tracers, {}, effectSet(), false, 1, {}})) {
        const NamedRole& named = *std::ranges::find(kRoles, key.role, &NamedRole::role);
        spec.modules.push_back({key, std::string(named.name) + ".spv", wordsOf(named.name)});
    }
    for (const package::EffectInfo& effect : kEffects) {
        spec.effects.push_back({{}, effect.effect, effect.kind, effect.abilities, 0});
    }
    for (auto role = static_cast<std::uint32_t>(package::kFirstFeatureRole);
         role < static_cast<std::uint32_t>(package::Role::Count); ++role) {
        spec.features.push_back({{0, inputOf(package::Role{role})}, {}, package::Role{role}});
    }
    spec.cases = {{0, 0, "Plain"}};
    spec.materials.resize(1);
    spec.primitives = {makePrimitive(0, 0)};
    return spec;
}

class Writer {
public:
    template <typename T>
    void add(package::SectionKind kind, const std::vector<T>& elements) {
        sections_.push_back({kind, sizeof(T), content_.size(), elements.size()});
        const auto* first = reinterpret_cast<const std::uint8_t*>(elements.data());
        content_.insert(content_.end(), first, first + elements.size() * sizeof(T));
        content_.resize((content_.size() + 7) / 8 * 8);
    }

    std::vector<std::uint8_t> finish(const package::PackageHeader& header) {
        const std::size_t start = sizeof(header) + sections_.size() * sizeof(package::PackageSection);
        std::vector<std::uint8_t> bytes(start);
        for (package::PackageSection& section : sections_) {
            section.offset += start;
        }
        std::memcpy(bytes.data(), &header, sizeof(header));
        std::memcpy(bytes.data() + sizeof(header), sections_.data(), start - sizeof(header));
        bytes.insert(bytes.end(), content_.begin(), content_.end());
        reseal(bytes);
        return bytes;
    }

    std::uint32_t sectionCount() const {
        return static_cast<std::uint32_t>(sections_.size());
    }

private:
    std::vector<package::PackageSection> sections_;
    std::vector<std::uint8_t> content_;
};

package::StringRef addString(std::vector<char>& strings, const std::string& text) {
    const package::StringRef ref{static_cast<std::uint32_t>(strings.size()),
                                 static_cast<std::uint32_t>(text.size())};
    strings.insert(strings.end(), text.begin(), text.end());
    return ref;
}

std::vector<package::SceneEntry> makeScenes(const PackageSpec& spec, std::vector<char>& strings) {
    const auto count = [](const auto& list) { return static_cast<std::uint32_t>(list.size()); };
    std::vector<SceneSpec> scenes = spec.scenes;
    if (scenes.empty()) {
        scenes = {{"scene", count(spec.materials), count(spec.primitives), count(spec.textures),
                   count(spec.samplers)}};
    }
    std::vector<package::SceneEntry> entries;
    SceneSpec end;
    for (const SceneSpec& scene : scenes) {
        entries.push_back({addString(strings, scene.name), end.materials, scene.materials, end.primitives,
                           scene.primitives, end.textures, scene.textures, end.samplers, scene.samplers});
        end.materials += scene.materials;
        end.primitives += scene.primitives;
        end.textures += scene.textures;
        end.samplers += scene.samplers;
    }
    return entries;
}

}  // namespace

package::PrimitiveEntry makePrimitive(std::uint32_t mesh, std::uint32_t primitive, std::uint32_t flags) {
    package::PrimitiveEntry entry{};
    entry.mesh = mesh;
    entry.primitive = primitive;
    entry.geometryFlags = flags;
    return entry;
}

PackageSpec makeSpec() {
    return makeWithModules([](const std::string&) { return kEmptyModule; });
}

PackageSpec makeDeviceSpec() {
    return makeWithModules([](const std::string& name) { return readTestShader(name); });
}

PackageSpec makeOtherSpec() {
    PackageSpec spec = makeDeviceSpec();
    spec.caseCount = 2;
    spec.cases.push_back({0, 0, "Other"});
    for (const ModuleRole role : {ModuleRole::FirstHit, package::roleNamed("ShadeCase")}) {
        const auto first =
            std::ranges::find(spec.modules, role, [](const ModuleSpec& module) { return module.key.role; });
        ModuleSpec second = *first;
        second.key.index = 1;
        spec.modules.insert(first + 1, std::move(second));
    }
    spec.primitives[0].shaderId = 1;
    return spec;
}

std::vector<std::uint32_t> readTestShader(const std::string& name) {
    std::ifstream stream(std::filesystem::path(GLINT_TEST_SHADERS) / (name + ".spv"), std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    std::vector<std::uint32_t> words(bytes.size() / sizeof(std::uint32_t));
    std::memcpy(words.data(), bytes.data(), words.size() * sizeof(std::uint32_t));
    return words;
}

std::vector<std::uint8_t> serialize(const PackageSpec& spec) {
    std::vector<char> strings;
    std::vector<package::ModuleEntry> modules;
    for (const ModuleSpec& module : spec.modules) {
        const std::uint64_t bytes = module.words.size() * sizeof(std::uint32_t);
        modules.push_back({module.key.role, module.key.index, module.key.tracer, 0,
                           addString(strings, module.file), bytes, XXH3_64bits(module.words.data(), bytes)});
    }
    std::vector<package::CaseEntry> cases;
    for (const CaseSpec& entry : spec.cases) {
        cases.push_back({wordsOf(entry.always), wordsOf(entry.sometimes), addString(strings, entry.name),
                         entry.keyCount});
    }
    const std::vector<package::SceneEntry> scenes = makeScenes(spec, strings);
    std::vector<package::EffectEntry> effects = spec.effects;
    for (std::size_t i = 0; i < effects.size(); ++i) {
        effects[i].name =
            addString(strings, i < std::size(kEffects) ? std::string(kEffects[i].name) : "further");
    }
    std::vector<package::FieldEntry> fields = spec.fields;
    for (package::FieldEntry& field : fields) {
        field.name = addString(strings, "field " + std::to_string(field.offset));
    }
    std::vector<package::FeatureEntry> features = spec.features;
    for (package::FeatureEntry& feature : features) {
        feature.name = addString(strings, "feature " + std::to_string(static_cast<int>(feature.role)));
    }
    Writer writer;
    writer.add(package::SectionKind::Modules, modules);
    writer.add(package::SectionKind::Scenes, scenes);
    writer.add(package::SectionKind::Materials, spec.materials);
    writer.add(package::SectionKind::Primitives, spec.primitives);
    writer.add(package::SectionKind::Textures, spec.textures);
    writer.add(package::SectionKind::Samplers, spec.samplers);
    writer.add(package::SectionKind::Strings, strings);
    writer.add(package::SectionKind::Cases, cases);
    writer.add(package::SectionKind::Attributes, spec.attributes);
    writer.add(package::SectionKind::Effects, effects);
    writer.add(package::SectionKind::Features, features);
    writer.add(package::SectionKind::Fields, fields);

    package::PackageHeader header{};
    std::memcpy(header.magic, package::kMagic, sizeof(header.magic));
    header.version = spec.version;
    header.sectionCount = writer.sectionCount();
    header.strategies = spec.strategies;
    header.tracers = spec.tracers;
    header.alpha = spec.alpha;
    header.precision = spec.precision;
    header.environmentMap = spec.environmentMap ? 1 : 0;
    header.caseCount = spec.caseCount;
    header.maxBounces = 1;
    header.interopHash = spec.interopHash;
    header.materialTextureOffset = offsetof(TestMaterial, textures);
    header.materialTextureCount = 2;
    return writer.finish(header);
}

void reseal(std::vector<std::uint8_t>& tables) {
    package::PackageHeader header{};
    std::memcpy(&header, tables.data(), sizeof(header));
    header.fileBytes = tables.size();
    header.contentHash = 0;
    header.contentHash = XXH3_64bits_withSeed(tables.data() + sizeof(header), tables.size() - sizeof(header),
                                              XXH3_64bits(&header, sizeof(header)));
    std::memcpy(tables.data(), &header, sizeof(header));
}

void writeBytes(const std::filesystem::path& path, const std::vector<std::uint8_t>& bytes) {
    std::ofstream stream(path, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

void writeModules(const PackageSpec& spec, const std::filesystem::path& folder) {
    for (const ModuleSpec& module : spec.modules) {
        const auto* first = reinterpret_cast<const std::uint8_t*>(module.words.data());
        writeBytes(folder / module.file, {first, first + module.words.size() * sizeof(std::uint32_t)});
    }
}

void writePackage(const PackageSpec& spec, const std::filesystem::path& folder) {
    writeModules(spec, folder);
    writeBytes(folder / package::kTablesFile, serialize(spec));
}

}  // namespace glint::test
