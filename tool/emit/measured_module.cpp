#include "emit/measured_module.h"

#include "emit/context.h"

#include <fmt/format.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace glint::compiler {

namespace {

Result<CachedModule> measured(Result<std::vector<std::uint32_t>> spirv) {
    if (!spirv) {
        return spirv.error();
    }
    const Result<SpirvStatistics> statistics = measureSpirv(*spirv);
    return statistics ? Result<CachedModule>(CachedModule{std::move(*spirv), *statistics})
                      : statistics.error();
}

}  // namespace

Result<CachedModule> compileMeasured(const ShaderSource& source, const ShaderCompileOptions& options,
                                     const std::optional<LinkNames>& link) {
    return measured(link ? compilePart(source, *link, options) : compileShader(source, options));
}

Result<CachedModule> joinMeasured(const ShaderSource& source, const ShaderCompileOptions& options,
                                  std::span<const CachedModule* const> parts, int jobs) {
    std::vector<std::span<const std::uint32_t>> words;
    for (const CachedModule* const part : parts) {
        if (!isJoinable(part->spirv)) {
            return measured(compileShader(source, options));
        }
        words.emplace_back(part->spirv);
    }
    return measured(joinParts(words, source.name, options, jobs));
}

std::string moduleCompiler() {
    return fmt::format("glint {}; {}", toolVersion(), compilerIdentity());
}

}  // namespace glint::compiler
