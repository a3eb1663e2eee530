#include "spirv/compiler.h"

#include "spirv/join.h"
#include "spirv/link.h"
#include "spirv/optimize.h"
#include "spirv/reader.h"
#include "spirv_source_hash.h"

#include <fmt/format.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>
#include <glslang/SPIRV/spirv.hpp>
#include <glslang/build_info.h>
#include <spirv-tools/libspirv.h>
#include <spirv-tools/libspirv.hpp>

#include <algorithm>
#include <charconv>
#include <mutex>
#include <optional>
#include <string_view>
#include <utility>

namespace glint::compiler {

namespace {

// glslang keeps tables for the life of the process. Once made, all threads share them.
bool initializeGlslang() {
    static std::once_flag once;
    static bool initialized = false;
    std::call_once(once, [] { initialized = glslang::InitializeProcess(); });
    return initialized;
}

EShLanguage toGlslang(ShaderStage stage) {
    switch (stage) {
        case ShaderStage::Vertex:
            return EShLangVertex;
        case ShaderStage::Fragment:
            return EShLangFragment;
        case ShaderStage::Compute:
            break;
        case ShaderStage::RayGeneration:
            return EShLangRayGen;
        case ShaderStage::ClosestHit:
            return EShLangClosestHit;
        case ShaderStage::AnyHit:
            return EShLangAnyHit;
        case ShaderStage::Miss:
            return EShLangMiss;
    }
    return EShLangCompute;
}

std::string_view trim(std::string_view text) {
    constexpr std::string_view kBlank = " \t\r\n";
    const std::size_t first = text.find_first_not_of(kBlank);
    if (first == std::string_view::npos) {
        return {};
    }
    return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

// Returns the length of a "file:line" at the start of `text`, or 0. The file's name ends at the first colon
// that a number and another colon follow.
std::size_t placeLength(std::string_view text) {
    for (std::size_t colon = text.find(':'); colon != std::string_view::npos;
         colon = text.find(':', colon + 1)) {
        const char* const digits = text.data() + colon + 1;
        int line = 0;
        const auto [end, error] = std::from_chars(digits, text.data() + text.size(), line);
        if (error == std::errc() && end != text.data() + text.size() && *end == ':') {
            return static_cast<std::size_t>(end - text.data());
        }
    }
    return 0;
}

// Makes a diagnostic of the first error in glslang's log, which reads "ERROR: file:line: message".
Diagnostic makeGlslError(const ShaderSource& source, std::string_view log) {
    constexpr std::string_view kPrefix = "ERROR: ";
    constexpr const char* kHint = "this is a defect of Glint; please report it with the scene";
    const std::size_t start = log.find(kPrefix);
    if (start == std::string_view::npos) {
        const std::string_view text = trim(log);
        return makeError("glsl", source.name, text.empty() ? "does not compile" : std::string(text), kHint);
    }
    std::string_view line = log.substr(start + kPrefix.size());
    constexpr std::string_view kNoBody = "No function definition (body) found:";
    if (const std::size_t place = line.find(kNoBody); place != std::string_view::npos) {
        // The next line has the function with its parameters.
        const std::string_view function = trim(line.substr(place + kNoBody.size()));
        return makeError("glsl", source.name,
                         fmt::format("{} has no body", function.substr(0, function.find_first_of("(\n"))),
                         "write one, or include a .spv file that has the function");
    }
    line = trim(line.substr(0, line.find('\n')));
    const std::size_t length = placeLength(line);
    if (length == 0) {
        return makeError("glsl", source.name, std::string(line), kHint);
    }
    return makeError("glsl", std::string(line.substr(0, length)),
                     std::string(trim(line.substr(length + 1))) + " (in " + source.name + ")", kHint);
}

// Returns glslang's translation of the source with the functions of its libraries, without any optimisation.
Result<std::vector<std::uint32_t>> translate(const ShaderSource& source) {
    if (!initializeGlslang()) {
        return makeError("glsl", source.name, "glslang can't be initialised");
    }
    constexpr int kDefaultVersion = 460;
    constexpr auto kMessages = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules);
    const EShLanguage stage = toGlslang(source.stage);
    const LinkedGlsl linked = takeLibraries(source.glsl);
    const char* const text = linked.glsl.c_str();
    const int length = static_cast<int>(linked.glsl.size());
    const char* const name = source.name.c_str();

    glslang::TShader shader(stage);
    shader.setStringsWithLengthsAndNames(&text, &length, &name, 1);
    shader.setEnvInput(glslang::EShSourceGlsl, stage, glslang::EShClientVulkan, 100);
    shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_2);
    shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_5);
    if (!shader.parse(GetDefaultResources(), kDefaultVersion, false, kMessages)) {
        return makeGlslError(source, shader.getInfoLog());
    }
    glslang::TProgram program;
    program.addShader(&shader);
    if (!program.link(kMessages)) {
        return makeGlslError(source, program.getInfoLog());
    }
    glslang::SpvOptions options;
    options.disableOptimizer = true;  // SPIRV-Tools optimises instead, with the passes that we choose.
    std::vector<std::uint32_t> words;
    glslang::GlslangToSpv(*program.getIntermediate(stage), words, &options);
    return linked.libraries.empty() ? words : linkFunctions(std::move(words), linked.libraries, source.name);
}

// Returns the functions that must stay functions: those of the source, and those that cross the border of the
// module.
std::vector<std::string> functionsApart(const ShaderSource& source, const LinkNames& names) {
    std::vector<std::string> apart = source.functionsApart;
    apart.insert(apart.end(), names.exported.begin(), names.exported.end());
    apart.insert(apart.end(), names.imported.begin(), names.imported.end());
    return apart;
}

}  // namespace

Result<std::vector<std::uint32_t>> compileShader(const ShaderSource& source,
                                                 const ShaderCompileOptions& options) {
    GLINT_TRY(auto translated, translate(source));
    GLINT_TRY(auto optimized, options.optimize || options.halvesAll || relaxesPrecision(translated)
                                  ? optimizeSpirv(translated, source.name, source.functionsApart,
                                                  options.debugInfo, options.halvesAll)
                                  : foldSpirv(translated, source.name, options.debugInfo));
    GLINT_TRY_DO(validateSpirv(optimized, source.name));
    return optimized;
}

Result<std::vector<std::uint32_t>> compileLinkable(const ShaderSource& source, const LinkNames& names,
                                                   const ShaderCompileOptions& options) {
    GLINT_TRY(auto translated, translate(source));
    GLINT_TRY(const auto optimized,
              optimizeSpirv(translated, source.name, functionsApart(source, names), true, options.halvesAll));
    GLINT_TRY(auto linkable, makeLinkable(optimized, names, source.name, options.debugInfo));
    GLINT_TRY_DO(validateSpirv(linkable, source.name, SpirvUse::Link));
    return linkable;
}

Result<std::vector<std::uint32_t>> compilePart(const ShaderSource& source, const LinkNames& names,
                                               const ShaderCompileOptions& options) {
    GLINT_TRY(auto translated, translate(source));
    if (!names.exported.empty()) {
        GLINT_TRY(const auto parsed, parseModule(translated, source.name));
        if (sharesVariables(parsed)) {
            translated.resize(kSpirvHeaderWords);
            return translated;
        }
    }
    GLINT_TRY(const auto optimized,
              optimizePart(translated, source.name, functionsApart(source, names), options.halvesAll));
    return makeLinkable(optimized, names, source.name, true);
}

bool isJoinable(std::span<const std::uint32_t> part) {
    return part.size() > kSpirvHeaderWords;
}

Result<std::vector<std::uint32_t>> joinParts(std::span<const std::span<const std::uint32_t>> parts,
                                             const std::string& name, const ShaderCompileOptions& options,
                                             int jobs) {
    GLINT_TRY(auto joined, joinModules(parts, name, options.debugInfo));
    GLINT_TRY(const auto parsed, parseModule(joined, name));
    if (std::optional<std::vector<std::uint32_t>> cleared = clearGlobals(parsed, tracesByPipeline(joined))) {
        joined = std::move(*cleared);
    } else {
        GLINT_TRY_DO(clearJoined(joined, name, options.debugInfo));
    }
    GLINT_TRY_DO(validateJoined(joined, name, jobs));
    return joined;
}

std::string compilerIdentity() {
    return fmt::format("glslang {}; {}; {}", glslangVersion(), spvSoftwareVersionDetailsString(),
                       kSpirvSourceHash);
}

bool supportsPositionFetch() {
    return GLSLANG_VERSION_MAJOR > 12 || (GLSLANG_VERSION_MAJOR == 12 && GLSLANG_VERSION_MINOR >= 2);
}

std::string glslangVersion() {
    const glslang::Version version = glslang::GetVersion();
    return fmt::format("{}.{}.{}{}", version.major, version.minor, version.patch,
                       version.flavor == nullptr ? "" : version.flavor);
}

std::string spirvToolsVersion() {
    return spvSoftwareVersionString();
}

Result<std::string> disassemble(const std::vector<std::uint32_t>& words) {
    spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_2);
    std::string message;
    tools.SetMessageConsumer(
        [&](spv_message_level_t, const char*, const spv_position_t&, const char* text) { message = text; });
    std::string text;
    constexpr std::uint32_t kOptions = SPV_BINARY_TO_TEXT_OPTION_NO_HEADER |
                                       SPV_BINARY_TO_TEXT_OPTION_FRIENDLY_NAMES |
                                       SPV_BINARY_TO_TEXT_OPTION_INDENT;
    if (!tools.Disassemble(words, &text, kOptions)) {
        return makeError("spirv-format", {}, "can't be disassembled: " + message,
                         "expected a SPIR-V module, little endian");
    }
    return text;
}

}  // namespace glint::compiler
