#include "inspect/package.h"

#include "base/files.h"
#include "base/lists.h"
#include "base/text.h"
#include "spirv/compiler.h"

#include <glint/internal/package_format.h>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <interop/scene.h>
#include <string_view>

namespace glint::inspect {

namespace {

std::map<std::string_view, std::uint64_t> bytesByFile(const InspectedPackage& inspected) {
    std::map<std::string_view, std::uint64_t> bytes;
    for (const InspectedModule& module : inspected.modules) {
        bytes[inspected.package.string(module.entry->file)] = module.entry->bytes;
    }
    return bytes;
}

bool isOfCase(const InspectedModule& module) {
    return package::findRole(module.entry->role)->repeated == package::Repeated::ByCase;
}

// Returns the names that select a module, apart from its shader's ID.
std::vector<std::string> namesOf(const InspectedPackage& inspected, const InspectedModule& module) {
    const std::string file = inspected.file(module);
    std::vector<std::string> names{file, file.substr(0, file.rfind('.')),
                                   std::string(package::roleName(module.entry->role))};
    if (isOfCase(module)) {
        names.emplace_back(inspected.package.string(inspected.package.cases()[module.entry->index].name));
    }
    return names;
}

std::vector<const InspectedModule*> findModules(const InspectedPackage& inspected,
                                                const std::string& wanted) {
    std::uint32_t id = 0;
    const char* const end = wanted.data() + wanted.size();
    const auto parsed = std::from_chars(wanted.data(), end, id);
    if (parsed.ec == std::errc() && parsed.ptr == end) {
        return inspected.modulesOf(id);
    }
    std::vector<const InspectedModule*> found;
    for (const InspectedModule& module : inspected.modules) {
        const std::vector<std::string> names = namesOf(inspected, module);
        if (std::ranges::find(names, wanted) != names.end()) {
            found.push_back(&module);
        }
    }
    return found;
}

Diagnostic unknownModule(const InspectedPackage& inspected, const std::string& wanted) {
    std::set<std::string> names;
    std::vector<std::string> shaders;
    for (const InspectedModule& module : inspected.modules) {
        names.merge([&] {
            const std::vector<std::string> some = namesOf(inspected, module);
            return std::set<std::string>(some.begin(), some.end());
        }());
        shaders.emplace_back(package::roleName(module.entry->role));
    }
    shaders.erase(std::unique(shaders.begin(), shaders.end()), shaders.end());
    const std::vector<std::string> all(names.begin(), names.end());
    return makeError(
        "module-unknown", inspected.folder,
        fmt::format("has no module \"{}\"{}{}", wanted, base::enumeration(shaders),
                    base::suggestion(wanted, all)),
        "use the ID of a shader that has modules of its own, or the name of a role, a shader or a file");
}

}  // namespace

Result<Manifest> readManifest(const std::filesystem::path& folder) {
    GLINT_TRY(auto read, compiler::readManifest(folder));
    Manifest manifest{std::move(read), {}, {}};
    for (const compiler::ManifestCase& shader : manifest.shaders) {
        manifest.shares[shader.id] = shader.share;
        for (const auto& [place, name] : shader.materials) {
            if (!name.empty()) {
                manifest.materialNames[{place.scene, place.index}] = name;
            }
        }
    }
    return manifest;
}

std::size_t InspectedPackage::caseCount() const {
    return static_cast<std::size_t>(std::ranges::count_if(
        package.cases(), [](const package::CaseEntry& entry) { return entry.keyCount > 0; }));
}

std::vector<const InspectedModule*> InspectedPackage::modulesOf(std::uint32_t shaderId) const {
    std::vector<const InspectedModule*> found;
    for (const InspectedModule& module : modules) {
        if (isOfCase(module) && module.entry->index == shaderId) {
            found.push_back(&module);
        }
    }
    return found;
}

std::string InspectedPackage::materialName(const MaterialPlace& material) const {
    const auto found = manifest.materialNames.find(material);
    return found != manifest.materialNames.end() ? found->second
                                                 : fmt::format("material {}", material.second);
}

std::string InspectedPackage::file(const InspectedModule& module) const {
    return std::string(package.string(module.entry->file));
}

std::string InspectedPackage::variantOf(std::uint32_t scene) const {
    return scene < manifest.scenes.size() ? manifest.scenes[scene].variant : std::string();
}

std::size_t InspectedPackage::uniqueFiles() const {
    return bytesByFile(*this).size();
}

std::uint64_t InspectedPackage::spirvBytes() const {
    return base::sumOf<std::uint64_t>(bytesByFile(*this), [](const auto& file) { return file.second; });
}

Result<InspectedPackage> inspectPackage(const Package& package, const Manifest& manifest,
                                        std::string folder) {
    InspectedPackage inspected{package, manifest, std::move(folder), {}, {}};
    for (const package::ModuleEntry& entry : package.modules()) {
        GLINT_TRY(const auto statistics,
                  compiler::measureSpirv(package.spirv({entry.role, entry.index, entry.tracer})));
        inspected.modules.push_back({&entry, statistics});
    }
    for (std::uint32_t scene = 0; scene < package.sceneCount(); ++scene) {
        for (const package::PrimitiveEntry& primitive : package.scene(scene).primitives) {
            inspected.materials[primitive.shaderId].insert({scene, primitive.materialIndex});
        }
    }
    return inspected;
}

Result<std::vector<Disassembly>> disassembleModules(const InspectedPackage& inspected,
                                                    const std::string& wanted) {
    std::vector<Disassembly> list;
    for (const InspectedModule* module : findModules(inspected, wanted)) {
        const auto words = inspected.package.spirv(module->key());
        GLINT_TRY(auto text, compiler::disassemble({words.begin(), words.end()}));
        list.push_back({module, std::move(text)});
    }
    if (list.empty()) {
        return unknownModule(inspected, wanted);
    }
    return list;
}

}  // namespace glint::inspect
