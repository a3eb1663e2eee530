// Fuzzes tables.bin. Its hashes would reject every change at once, so each input is loaded three times: as it
// is; with a header whose hash fits; and also with modules that fit the tables.
#include "fuzz/fuzz_target.h"
#include "package/package.h"

#include <glint/internal/package_format.h>
#include <glint/package.h>

#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

namespace {

using Bytes = std::vector<std::uint8_t>;
namespace package = glint::package;

// A module without contents, but with everything that the loader checks.
constexpr std::array<std::uint32_t, 5> kModule{0x07230203, 0x00010500, 0, 1, 0};

std::span<const std::uint8_t> moduleBytes() {
    return {reinterpret_cast<const std::uint8_t*>(kModule.data()), sizeof kModule};
}

// Corrects the header's statements about the bytes after it.
void seal(Bytes& tables) {
    package::PackageHeader header{};
    std::memcpy(&header, tables.data(), sizeof header);
    std::memcpy(header.magic, package::kMagic, sizeof header.magic);
    header.version = package::kVersion;
    header.fileBytes = tables.size();
    header.interopHash = glint::interopHash();
    header.contentHash = 0;
    header.contentHash = XXH3_64bits_withSeed(tables.data() + sizeof header, tables.size() - sizeof header,
                                              XXH3_64bits(&header, sizeof header));
    std::memcpy(tables.data(), &header, sizeof header);
}

// Returns the section of that kind, if it lies within the bytes.
package::PackageSection findSection(const Bytes& tables, package::SectionKind kind) {
    constexpr std::size_t kMaxSections = 16;
    for (std::size_t i = 0; i < kMaxSections; ++i) {
        const std::size_t at = sizeof(package::PackageHeader) + i * sizeof(package::PackageSection);
        package::PackageSection section{};
        if (at + sizeof section > tables.size()) {
            break;
        }
        std::memcpy(&section, tables.data() + at, sizeof section);
        if (section.kind == kind && section.offset <= tables.size()) {
            return section;
        }
    }
    return {};
}

// Sets every entry's size and hash to those of kModule. Returns the names of their files.
std::vector<std::string> fitModules(Bytes& tables) {
    const package::PackageSection modules = findSection(tables, package::SectionKind::Modules);
    const package::PackageSection strings = findSection(tables, package::SectionKind::Strings);
    std::vector<std::string> names;
    for (std::uint64_t i = 0; i < modules.count; ++i) {
        const std::uint64_t at = modules.offset + i * sizeof(package::ModuleEntry);
        package::ModuleEntry entry{};
        if (at + sizeof entry > tables.size()) {
            break;
        }
        std::memcpy(&entry, tables.data() + at, sizeof entry);
        entry.bytes = moduleBytes().size();
        entry.hash = XXH3_64bits(kModule.data(), sizeof kModule);
        std::memcpy(tables.data() + at, &entry, sizeof entry);
        const std::uint64_t first = strings.offset + entry.file.offset;
        if (first + entry.file.length <= tables.size()) {
            names.emplace_back(reinterpret_cast<const char*>(tables.data() + first), entry.file.length);
        }
    }
    return names;
}

// Reads everything that a renderer would read.
std::size_t use(const glint::Package& loaded) {
    std::size_t sum = loaded.caseCount() + loaded.bucketCount();
    for (const package::CaseEntry& entry : loaded.cases()) {
        sum += loaded.string(entry.name).size();
    }
    for (const package::ModuleEntry& entry : loaded.modules()) {
        const auto words = loaded.spirv({entry.role, entry.index, entry.tracer});
        glint::fuzz::require(!words.empty(), "every module of a package has words");
        sum += words.back();
    }
    for (std::uint32_t i = 0; i < loaded.sceneCount(); ++i) {
        const glint::PackageScene scene = loaded.scene(i);
        glint::fuzz::require(loaded.findScene(scene.name) == i, "a scene is found by its name");
        for (const package::PrimitiveEntry& entry : scene.primitives) {
            glint::fuzz::require(entry.shaderId < loaded.caseCount(), "a primitive's shader exists");
            glint::fuzz::require(entry.materialIndex < scene.materials.size(),
                                 "a primitive's material exists");
            glint::fuzz::require(scene.findPrimitive(entry.mesh, entry.primitive) == &entry,
                                 "a primitive is found by mesh and number");
        }
        for (const package::SamplerEntry& sampler : scene.samplers) {
            sum += sampler.mipmapped;
        }
    }
    return sum;
}

void load(const Bytes& tables, const std::vector<std::string>& modules) {
    std::vector<package::EmbeddedFile> files{{package::kTablesFile, tables}};
    for (const std::string& name : modules) {
        files.push_back({name, moduleBytes()});
    }
    const glint::Result<glint::Package> loaded = glint::Package::load(files);
    if (loaded) {
        use(*loaded);
    } else {
        glint::fuzz::require(!loaded.error().id.empty(), "an error of the loader has an id");
    }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes tables(data, data + size);
    load(tables, {});
    if (size < sizeof(package::PackageHeader)) {
        return 0;
    }
    seal(tables);
    load(tables, {});
    const std::vector<std::string> modules = fitModules(tables);
    seal(tables);
    load(tables, modules);
    return 0;
}
