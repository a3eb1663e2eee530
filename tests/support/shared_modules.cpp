#include "support/shared_modules.h"

#include "emit/module_files.h"
#include "emit/modules.h"
#include "spirv/compiler.h"

#include <optional>
#include <utility>

namespace glint::testing {

compiler::ModuleCache& sharedModules() {
    constexpr std::uint64_t kMaxBytes = 512ULL << 20;
    static compiler::CacheStore store({GLINT_BINARY_DIR "/tests/cache", kMaxBytes, {}});
    static compiler::ModuleCache cache(store, compiler::moduleCompiler());
    return cache;
}

Result<std::vector<std::uint32_t>> compileComputeOnce(const std::string& name, const std::string& glsl) {
    const compiler::TextHash text = compiler::hashOfText("compute shader of a test\n" + glsl);
    if (std::optional<compiler::CachedModule> found = sharedModules().find(text)) {
        return std::move(found->spirv);
    }
    GLINT_TRY(auto compiled, compiler::compileMeasured({name, compiler::ShaderStage::Compute, glsl, {}}, {}));
    sharedModules().put(text, compiled);
    return std::move(compiled.spirv);
}

}  // namespace glint::testing
