#include "emit/warm_modules.h"

#include "base/files.h"

#include <algorithm>

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

}  // namespace glint::compiler
