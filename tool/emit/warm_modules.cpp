#include "emit/warm_modules.h"

#include "base/files.h"
#include "base/parallel.h"
#include "emit/glsl/passes.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

namespace glint::compiler {

namespace {

std::pair<std::uint64_t, std::uint64_t> warmKeyOf(std::string_view name, std::string_view text) {
    const TextHash hash = hashOfText(text);
    return {hash.first, hash.second ^ (base::hashBytes(name) << 1U)};
}

}  // namespace

TextHash hashOfText(std::string_view text) {
    return {base::hashBytes(base::asBytes(text)), base::hashBytes(base::asBytes(text), 1)};
}

void WarmModules::takeSources(const SourceSet& sources) {
    auto marks = sources.marks();
    changed_.clear();
    std::ranges::set_symmetric_difference(marks_, marks, std::back_inserter(changed_));
    marks_ = std::move(marks);
    ++sources_;
}

bool WarmModules::isOf(const Glsl& candidate, const IncludedFiles& files) const {
    // Few files change between two runs, and modules include many.
    if (candidate.sources + 1 == sources_ && candidate.own == files.markOfOwn() &&
        std::ranges::none_of(changed_, [&](const auto& changed) {
            const auto read =
                std::ranges::lower_bound(candidate.read, changed.first, {}, &Read::value_type::first);
            return read != candidate.read.end() && read->first == changed.first;
        })) {
        return true;
    }
    return std::ranges::all_of(candidate.read,
                               [&](const auto& file) { return files.markOf(file.first) == file.second; });
}

std::shared_ptr<const PreparedGlsl> WarmModules::findGlsl(std::string_view name, std::string_view text,
                                                          const IncludedFiles& files) {
    const Key key = warmKeyOf(name, text);
    const std::lock_guard lock(mutex_);
    const auto known = glsl_.find(key);
    if (known == glsl_.end()) {
        return nullptr;
    }
    for (Glsl& candidate : known->second) {
        if (isOf(candidate, files)) {
            candidate.used = run_;
            candidate.own = files.markOfOwn();
            candidate.sources = sources_;
            return candidate.glsl;
        }
    }
    return nullptr;
}

void WarmModules::putGlsl(std::string_view name, std::string_view text, Read read, const IncludedFiles& files,
                          std::shared_ptr<const PreparedGlsl> glsl) {
    const std::lock_guard lock(mutex_);
    glsl_[warmKeyOf(name, text)].push_front(
        {std::move(read), std::move(glsl), run_, files.markOfOwn(), sources_});
}

std::shared_ptr<const HashedModule> WarmModules::findModule(const TextHash& text) {
    const std::lock_guard lock(mutex_);
    const auto known = modules_.find(text);
    if (known == modules_.end()) {
        return nullptr;
    }
    known->second.used = run_;
    return known->second.module;
}

void WarmModules::putModule(const TextHash& text, std::shared_ptr<const HashedModule> module) {
    const std::lock_guard lock(mutex_);
    modules_[text] = {std::move(module), run_};
}

MaterialCodeOfCases& WarmModules::codeOfCases(const Plan& plan) {
    if (!codeOfCases_ || !codeOfCases_->isOf(plan)) {
        codeOfCases_.emplace(plan);
    }
    return *codeOfCases_;
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
    const IncludedFiles files(*draft.own, sources_);
    ModuleSource& module = *draft.module;
    module.glsl = warm_ == nullptr ? nullptr : warm_->findGlsl(draft.origin, draft.text, files);
    if (module.glsl) {
        return okStatus();
    }
    WarmModules::Read read;
    const SourceLookup lookup = [&](std::string_view name) {
        if (warm_ != nullptr) {
            read.emplace_back(name, files.markOf(name));
        }
        return files.find(name);
    };
    GLINT_TRY(const auto flattened, flatten(draft.origin, draft.text, lookup, FlattenSide::Glsl));
    GlslUnit unit = dropUnused(cutDecided(flattened));
    std::string essential = essentialText(unit.text());
    module.glsl = std::make_shared<const PreparedGlsl>(std::move(unit), std::move(essential));
    if (warm_ != nullptr) {
        std::ranges::sort(read);
        read.erase(std::unique(read.begin(), read.end()), read.end());
        warm_->putGlsl(draft.origin, draft.text, std::move(read), files, module.glsl);
    }
    return okStatus();
}

Status ModuleDrafts::finish(int jobs) {
    if (warm_ != nullptr) {
        warm_->takeSources(sources_);
    }
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
