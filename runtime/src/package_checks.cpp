// What the elements of tables.bin promise each other.
#include "package_state.h"

#include <algorithm>
#include <array>
#include <set>
#include <tuple>

namespace glint {

std::string moduleRoleName(package::ModuleRole role) {
    static constexpr std::array kNames{"GBufferVertex", "GBufferFragment", "Lighting",  "ReflectionRays",
                                       "RayDispatch",   "UberShade",       "Trace",     "BucketCount",
                                       "BucketOffset",  "BucketCopy",      "ShadeMiss", "ShadeCase",
                                       "Compose"};
    const auto number = static_cast<std::uint32_t>(role);
    if (number == 0 || number > kNames.size()) {
        return "role " + std::to_string(number);
    }
    return kNames[number - 1];
}

namespace {

using package::ModuleRole;

constexpr ModuleRole kSharedRoles[] = {ModuleRole::GBufferVertex, ModuleRole::GBufferFragment,
                                       ModuleRole::Lighting,      ModuleRole::ReflectionRays,
                                       ModuleRole::RayDispatch,   ModuleRole::Compose};
constexpr ModuleRole kVisibilityRoles[] = {ModuleRole::Trace, ModuleRole::BucketCount,
                                           ModuleRole::BucketOffset, ModuleRole::BucketCopy,
                                           ModuleRole::ShadeMiss};
constexpr std::uint32_t kLastAlphaMode = 2;
constexpr std::uint32_t kLastWrap = 2;

Diagnostic altered(const std::string& where, std::string message) {
    return makeError("package-altered", where, std::move(message),
                     "compile the package again with `glint compile`");
}

bool inStrings(const Package::State& state, package::StringRef ref) {
    return std::uint64_t{ref.offset} + ref.length <= state.strings.size();
}

std::string_view text(const Package::State& state, package::StringRef ref) {
    return {state.strings.data() + ref.offset, ref.length};
}

Status checkModuleEntries(const Package::State& state, const std::string& where) {
    std::set<std::tuple<ModuleRole, std::uint32_t>> seen;
    std::map<std::string_view, std::tuple<std::uint64_t, std::uint64_t>> files;
    for (const package::ModuleEntry& module : state.modules) {
        const std::string name = moduleRoleName(module.role);
        if (module.role < ModuleRole::GBufferVertex || module.role > ModuleRole::Compose) {
            return altered(where, "a module has the unknown " + name);
        }
        if (!inStrings(state, module.file)) {
            return altered(where, "the file name of module " + name + " is out of range");
        }
        const bool isCase = module.role == ModuleRole::ShadeCase;
        if (isCase ? module.shaderId >= state.header.caseCount : module.shaderId != 0) {
            return altered(where, "module " + name + " has shader ID " + std::to_string(module.shaderId) +
                                      " of " + std::to_string(state.header.caseCount));
        }
        if (!seen.emplace(module.role, module.shaderId).second) {
            return altered(where, "module " + name + " is there twice");
        }
        const std::tuple contents(module.bytes, module.hash);
        if (files.emplace(text(state, module.file), contents).first->second != contents) {
            return altered(where, "two modules disagree on the contents of the file that they share");
        }
    }
    return okStatus();
}

// The strategy bits say what the modules can do, no more and no less.
Status checkStrategies(const Package::State& state, const std::string& where) {
    const auto has = [&](ModuleRole role, std::uint32_t shaderId = 0) {
        return std::ranges::any_of(state.modules, [&](const package::ModuleEntry& module) {
            return module.role == role && module.shaderId == shaderId;
        });
    };
    const std::uint32_t strategies = state.header.strategies;
    constexpr std::uint32_t kKnown = package::kStrategyUber | package::kStrategyVisibility;
    if (strategies == 0 || (strategies & ~kKnown) != 0) {
        return altered(where, "the strategy bits " + std::to_string(strategies) + " are unknown");
    }
    for (const ModuleRole role : kSharedRoles) {
        if (!has(role)) {
            return altered(where, "the package lacks its module " + moduleRoleName(role));
        }
    }
    if (has(ModuleRole::UberShade) != ((strategies & package::kStrategyUber) != 0)) {
        return altered(where, "the modules do not agree with the strategy uber");
    }
    const bool visibility = (strategies & package::kStrategyVisibility) != 0;
    for (const ModuleRole role : kVisibilityRoles) {
        if (has(role) != visibility) {
            return altered(where,
                           "module " + moduleRoleName(role) + " does not agree with the strategy visibility");
        }
    }
    const auto shadeCases = static_cast<std::size_t>(
        std::ranges::count(state.modules, ModuleRole::ShadeCase, &package::ModuleEntry::role));
    // IDs are unique and below the count by now: as many modules as cases is one for each.
    if (shadeCases != (visibility ? state.header.caseCount : 0)) {
        return altered(where, "there are " + std::to_string(shadeCases) + " shading modules for " +
                                  std::to_string(state.header.caseCount) + " cases");
    }
    return okStatus();
}

Status checkCases(const Package::State& state, const std::string& where) {
    if (state.cases.size() != state.header.caseCount) {
        return altered(where, "the header names " + std::to_string(state.header.caseCount) +
                                  " cases, there are " + std::to_string(state.cases.size()));
    }
    for (const package::CaseEntry& entry : state.cases) {
        if (!inStrings(state, entry.name)) {
            return altered(where, "the name of a case is out of range");
        }
        if ((entry.always & entry.sometimes) != 0) {
            return altered(where, "a case has a feature both always and sometimes");
        }
    }
    return okStatus();
}

Status checkPrimitive(const Package::State& state, const package::PrimitiveEntry& entry,
                      const std::string& where) {
    const std::string name =
        "primitive " + std::to_string(entry.primitive) + " of mesh " + std::to_string(entry.mesh);
    if (entry.shaderId >= state.header.caseCount) {
        return altered(where, name + " has shader ID " + std::to_string(entry.shaderId) + " of " +
                                  std::to_string(state.header.caseCount));
    }
    if (entry.materialIndex >= state.materials.size()) {
        return altered(where, name + " has material " + std::to_string(entry.materialIndex) + " of " +
                                  std::to_string(state.materials.size()));
    }
    const std::uint64_t key = std::uint64_t{entry.featureInputs} << 32 | entry.featureLobes;
    const package::CaseEntry& shadedBy = state.cases[entry.shaderId];
    // The key may hold more than its case knows: lobes that primary surfaces have and hits do not keep.
    if ((shadedBy.always & ~key) != 0) {
        return altered(where, name + " lacks features that its case takes for granted");
    }
    constexpr std::uint32_t kKnownFlags =
        gpu::kGeometryAlphaTested | gpu::kGeometryDoubleSided | gpu::kGeometryMasked;
    if ((entry.geometryFlags & ~kKnownFlags) != 0 || entry.alphaMode > kLastAlphaMode) {
        return altered(where, name + " has unknown flags");
    }
    if ((entry.geometryFlags & gpu::kGeometryAlphaTested) != 0 && state.header.alphaTested == 0) {
        return altered(where, name + " is alpha tested, and the package is not");
    }
    return okStatus();
}

Status checkPrimitives(const Package::State& state, const std::string& where) {
    const auto key = [](const package::PrimitiveEntry& entry) {
        return std::tuple(entry.mesh, entry.primitive);
    };
    const package::PrimitiveEntry* previous = nullptr;
    for (const package::PrimitiveEntry& entry : state.primitives) {
        if (previous != nullptr && key(*previous) >= key(entry)) {
            return altered(where, "the primitives are not in order");
        }
        previous = &entry;
        if (Status status = checkPrimitive(state, entry, where); !status) {
            return status;
        }
    }
    return okStatus();
}

Status checkTextures(const Package::State& state, const std::string& where) {
    // A slot that no key reads holds zero, whether or not there is a texture zero.
    const std::size_t textureEnd = std::max<std::size_t>(state.textures.size(), 1);
    const std::size_t samplerEnd = std::max<std::size_t>(state.samplers.size(), 1);
    for (const gpu::MaterialRecord& material : state.materials) {
        for (const gpu::TextureRecord& texture : material.textures) {
            if (texture.textureIndex >= textureEnd || texture.samplerIndex >= samplerEnd ||
                texture.texCoord > 1) {
                return altered(where, "material " + std::to_string(&material - state.materials.data()) +
                                          " refers to a texture, sampler or UV set that does not exist");
            }
        }
    }
    if (!std::ranges::all_of(state.textures, [](const auto& texture) { return texture.srgb <= 1; })) {
        return altered(where, "a texture has an unknown colour space");
    }
    const auto known = [](const package::SamplerEntry& sampler) {
        return sampler.wrapU <= kLastWrap && sampler.wrapV <= kLastWrap && sampler.magnification <= 1 &&
               sampler.minification <= 1 && sampler.mip <= 1 && sampler.mipmapped <= 1;
    };
    if (!std::ranges::all_of(state.samplers, known)) {
        return altered(where, "a sampler has an unknown mode");
    }
    return okStatus();
}

}  // namespace

Status checkTables(const Package::State& state, const std::string& where) {
    if (state.header.alphaTested > 1) {
        return altered(where, "the alpha policy " + std::to_string(state.header.alphaTested) + " is unknown");
    }
    for (const auto check :
         {checkCases, checkModuleEntries, checkStrategies, checkPrimitives, checkTextures}) {
        if (Status status = check(state, where); !status) {
            return status;
        }
    }
    return okStatus();
}

}  // namespace glint
