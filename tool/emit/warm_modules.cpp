#include "emit/warm_modules.h"

#include "base/files.h"
#include "base/parallel.h"
#include "emit/glsl/passes.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace glint::compiler {

namespace {

// A text that is not there differs from every text that is.
constexpr std::uint64_t kAbsent = 0;

std::uint64_t markOf(std::optional<std::string_view> text) {
    return text ? base::hashBytes(*text) | 1U : kAbsent;
}

std::pair<std::uint64_t, std::uint64_t> warmKeyOf(std::string_view name, std::string_view text) {
    return {text.size(), base::hashBytes(text) ^ (base::hashBytes(name) << 1U)};
}

}  // namespace

SourceLookup WarmModules::Reader::recording() {
    return [this](std::string_view name) {
        const std::optional<std::string_view> found = lookup_(name);
        read_.emplace(name, markOf(found));
        return found;
    };
}

std::shared_ptr<const PreparedGlsl> WarmModules::findGlsl(std::string_view name, std::string_view text,
                                                          const SourceLookup& lookup) {
    const std::lock_guard lock(mutex_);
    const auto known = glsl_.find(warmKeyOf(name, text));
    if (known == glsl_.end()) {
        return nullptr;
    }
    for (Glsl& candidate : known->second) {
        const bool same = std::ranges::all_of(
            candidate.read, [&](const auto& file) { return markOf(lookup(file.first)) == file.second; });
        if (same) {
            candidate.used = run_;
            return candidate.glsl;
        }
    }
    return nullptr;
}

void WarmModules::putGlsl(std::string_view name, std::string_view text, const Reader& reader,
                          std::shared_ptr<const PreparedGlsl> glsl) {
    const std::lock_guard lock(mutex_);
    glsl_[warmKeyOf(name, text)].push_front({reader.read_, std::move(glsl), run_});
}

std::optional<CachedModule> WarmModules::findModule(std::string_view text) {
    const std::lock_guard lock(mutex_);
    const auto known = modules_.find(warmKeyOf("", text));
    if (known == modules_.end()) {
        return std::nullopt;
    }
    known->second.used = run_;
    return *known->second.module;
}

void WarmModules::putModule(std::string_view text, const CachedModule& module) {
    const std::lock_guard lock(mutex_);
    modules_[warmKeyOf("", text)] = {std::make_shared<const CachedModule>(module), run_};
}

void WarmModules::endRun() {
    const auto isOld = [&](const auto& entry) { return entry.used + kRuns < run_; };
    for (auto& [key, candidates] : glsl_) {
        std::erase_if(candidates, isOld);
    }
    std::erase_if(glsl_, [](const auto& entry) { return entry.second.empty(); });
    std::erase_if(modules_, [&](const auto& entry) { return isOld(entry.second); });
    ++run_;
}

std::string precisionDefines(package::ShadingPrecision precision) {
    // Without these, values without a precision take that of their neighbours, even mediump.
    return precision == package::ShadingPrecision::Half ? "precision highp float;\nprecision highp int;\n"
                                                        : "";
}

void insertDefines(std::string& text, const std::string& defines) {
    if (!defines.empty()) {
        text.insert(text.find('\n') + 1, defines + "#line 2\n");
    }
}

std::shared_ptr<ModuleSource> makePart(std::string name, std::vector<std::string> functions) {
    auto part = std::make_shared<ModuleSource>();
    part->stage = ShaderStage::Compute;
    part->name = std::move(name);
    part->link = LinkNames{std::move(functions), {}, false};
    return part;
}

void insertPartDefines(std::string& text, package::ShadingPrecision precision) {
    insertDefines(text,
                  precisionDefines(precision) + "#define GLINT_TRACER 0\n#define GLINT_RAY_GENERATION 0\n");
}

std::shared_ptr<ModuleSource> makeHead(const ModuleSource& module, std::vector<std::string> functions) {
    auto head = std::make_shared<ModuleSource>();
    head->key = module.key;
    head->stage = module.stage;
    head->name = module.name;
    head->link = LinkNames{{}, std::move(functions), true};
    return head;
}

void ModuleDrafts::add(std::shared_ptr<ModuleSource> module, std::string origin, std::string text,
                       const SourceSet& own) {
    drafts_.push_back({std::move(module), std::move(origin), std::move(text), &own});
}

Status ModuleDrafts::finish(const Draft& draft) const {
    const SourceLookup lookup = [&](std::string_view name) {
        const std::optional<std::string_view> found = draft.own->find(name);
        return found ? found : sources_.find(name);
    };
    ModuleSource& module = *draft.module;
    module.prepared = warm_ == nullptr ? nullptr : warm_->findGlsl(draft.origin, draft.text, lookup);
    if (!module.prepared) {
        WarmModules::Reader reader(lookup);
        GLINT_TRY(const auto flattened,
                  flatten(draft.origin, draft.text, reader.recording(), FlattenSide::Glsl));
        GlslUnit unit = dropUnused(cutDecided(flattened));
        std::string essential = essentialText(unit.text());
        module.prepared =
            std::make_shared<const PreparedGlsl>(PreparedGlsl{std::move(unit), std::move(essential)});
        if (warm_ != nullptr) {
            warm_->putGlsl(draft.origin, draft.text, reader, module.prepared);
        }
    }
    module.glsl = module.prepared->unit;
    return okStatus();
}

Status ModuleDrafts::finish(int jobs) {
    std::vector<Status> results(drafts_.size(), okStatus());
    base::runParallel(drafts_.size(), jobs, [&](std::size_t i) {
        results[i] = finish(drafts_[i]);
        return results[i].ok();
    });
    for (const Status& result : results) {
        if (!result) {
            return result;
        }
    }
    return okStatus();
}

}  // namespace glint::compiler
