// Results that one compilation leaves in memory for the next one of the same process.
#pragma once

#include "cache/module_cache.h"
#include "emit/glsl/flatten.h"

#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glint::compiler {

// A module's GLSL after flattening and pruning.
struct PreparedGlsl {
    GlslUnit unit;
    std::string essential;  // essentialText() of it
};

// Keeps the GLSL and the SPIR-V of modules whose inputs stay the same from run to run. A module's GLSL is
// found by the text that it starts with and the contents of every file that it included, by name; its SPIR-V
// by the text that makeModuleText() made. Texts are compared by size and 64-bit hash. What a run has not used
// for kRuns runs is dropped. Thread-safe but for endRun().
class WarmModules {
public:
    static constexpr std::uint64_t kRuns = 8;

    // Returns what prepare() gave for the same text, name and included files.
    std::shared_ptr<const PreparedGlsl> findGlsl(std::string_view name, std::string_view text,
                                                 const SourceLookup& lookup);
    // Passes on to `lookup` and notes what it finds.
    class Reader {
    public:
        explicit Reader(const SourceLookup& lookup) : lookup_(lookup) {}
        SourceLookup recording();

    private:
        friend class WarmModules;
        const SourceLookup& lookup_;
        std::map<std::string, std::uint64_t, std::less<>> read_;  // by name: mark of the text
    };
    void putGlsl(std::string_view name, std::string_view text, const Reader& reader,
                 std::shared_ptr<const PreparedGlsl> glsl);

    std::optional<CachedModule> findModule(std::string_view text);
    void putModule(std::string_view text, const CachedModule& module);

    // Drops what was not used lately. Call it between runs.
    void endRun();

private:
    using Key = std::pair<std::uint64_t, std::uint64_t>;  // size and hash
    struct Glsl {
        std::map<std::string, std::uint64_t, std::less<>> read;
        std::shared_ptr<const PreparedGlsl> glsl;
        std::uint64_t used = 0;  // run
    };
    struct Module {
        std::shared_ptr<const CachedModule> module;
        std::uint64_t used = 0;
    };

    std::mutex mutex_;
    std::uint64_t run_ = 0;
    // Several texts of included files for one text of a module, the latest first.
    std::map<Key, std::list<Glsl>> glsl_;
    std::map<Key, Module> modules_;
};

}  // namespace glint::compiler
