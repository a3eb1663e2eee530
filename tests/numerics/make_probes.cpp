// Turns probes.glsl, with everything that it includes, into one GLSL text for the device, the same text as
// C++, and the list of its probes.
//
//   make_probes OUTPUT SOURCES…     OUTPUT: a folder; SOURCES: folders that includes are searched in
#include "base/files.h"
#include "emit/glsl/passes.h"
#include "emit/material_code.h"
#include "materials/material_model.h"
#include "resolve/host.h"
#include "translate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kRoot = R"(#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "numerics/probes.glsl"
#include "numerics/textbook.glsl"
)";

constexpr std::string_view kProofRoot = R"(#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "numerics/proofs.glsl"
)";

// Returns the part of a header that needs no device addresses: its constants.
std::string constantsOf(std::string_view header) {
    std::string text = "#include \"interop/types.h\"\nGLINT_INTEROP_BEGIN\n";
    while (!header.empty()) {
        const std::size_t end = std::min(header.find('\n'), header.size() - 1) + 1;
        if (header.starts_with("GLINT_CONSTANT(")) {
            text += header.substr(0, end);
        }
        header.remove_prefix(end);
    }
    return text + "GLINT_INTEROP_END\n";
}

// Files that were found stay in memory, because flatten() keeps views of them.
class Sources {
public:
    explicit Sources(std::vector<fs::path> folders) : folders_(std::move(folders)) {
        texts_["generated/features.glsl"] = glint::materials::builtinMaterialModel().featureDefines();
        // A scene chooses these values; here, the code that compiles the text defines them.
        texts_["generated/scene.glsl"] =
            "#if !defined(GLINT_RELAXED)\n#define GLINT_PRECISION 32\n#define GLINT_RELAXED\n#endif\n"
            "#define GLINT_USES_MODELS 0\n";
    }

    // Adds what Glint generates for a package that has every feature.
    glint::Status addGenerated() {
        glint::compiler::SourceSet generated;
        for (const glint::base::BuiltinFile& file : glint::compiler::builtinFiles()) {
            generated.add(std::string(file.name), std::string(file.text));
        }
        glint::Status status =
            glint::compiler::addMaterialCode(generated, glint::materials::builtinMaterialModel(),
                                             ~glint::materials::FeatureMask{0}, generated);
        texts_["generated/layers.glsl"] = std::string(generated.find("generated/layers.glsl").value_or(""));
        return status;
    }

    std::optional<std::string_view> find(std::string_view name) {
        const auto known = texts_.find(name);
        if (known != texts_.end()) {
            return known->second;
        }
        for (const fs::path& folder : folders_) {
            if (!fs::exists(folder / name)) {
                continue;
            }
            glint::Result<glint::base::Bytes> bytes = glint::base::readFile(folder / name);
            if (bytes) {
                const std::string text(bytes->begin(), bytes->end());
                return texts_.emplace(name, name == "interop/frame.h" ? constantsOf(text) : text)
                    .first->second;
            }
        }
        return std::nullopt;
    }

private:
    std::vector<fs::path> folders_;
    std::map<std::string, std::string, std::less<>> texts_;
};

std::string listFunctions(const std::string& glsl, const std::string& macro) {
    const std::regex kProbe(macro + R"(\((\w+)\) \{)");
    std::string list = "// Made by make_probes. Do not edit.\n";
    for (std::sregex_iterator i(glsl.begin(), glsl.end(), kProbe); i != std::sregex_iterator(); ++i) {
        list += fmt::format("LISTED_{}({})\n", macro, i->str(1));
    }
    return list;
}

glint::Status make(const fs::path& output, std::vector<fs::path> folders) {
    Sources sources(std::move(folders));
    if (glint::Status status = sources.addGenerated(); !status) {
        return status;
    }
    const auto flattened = [&](const char* name, std::string_view root) {
        return glint::compiler::flatten(
            name, root, [&](std::string_view file) { return sources.find(file); },
            glint::compiler::FlattenSide::Glsl);
    };
    const glint::Result<glint::compiler::GlslUnit> unit = flattened("probes", kRoot);
    if (!unit) {
        return unit.error();
    }
    const glint::Result<glint::compiler::GlslUnit> proofs = flattened("proofs", kProofRoot);
    if (!proofs) {
        return proofs.error();
    }
    const std::string glsl = unit->withPlaces();
    const glint::Result<std::string> cpp = glint::numerics::translateToCpp(glsl);
    if (!cpp) {
        return cpp.error();
    }
    const std::string proofGlsl = proofs->withPlaces();
    const glint::Result<std::string> proofCpp = glint::numerics::translateToCpp(proofGlsl);
    if (!proofCpp) {
        return proofCpp.error();
    }
    const std::map<std::string, std::string> files{{"probes.glsl", glsl},
                                                   {"probes.inc", *cpp},
                                                   {"probes_text.inc", "R\"glsl(" + glsl + ")glsl\"\n"},
                                                   {"probe_list.inc", listFunctions(glsl, "PROBE")},
                                                   {"proofs_text.inc", "R\"glsl(" + proofGlsl + ")glsl\"\n"},
                                                   {"proofs.inc", *proofCpp},
                                                   {"proof_list.inc", listFunctions(proofGlsl, "PROOF")}};
    for (const auto& [name, text] : files) {
        if (glint::Status status = glint::base::writeFile(output / name, text); !status) {
            return status;
        }
    }
    return glint::okStatus();
}

}  // namespace

int main(int argc, char** argv) {
    const std::vector<fs::path> arguments(argv + 1, argv + argc);
    if (arguments.size() < 2) {
        std::fputs("usage: make_probes OUTPUT SOURCES...\n", stderr);
        return 2;
    }
    const glint::Status status = make(arguments[0], {arguments.begin() + 1, arguments.end()});
    if (!status) {
        std::fprintf(stderr, "%s\n", glint::toString(status.error()).c_str());
        return 1;
    }
    return 0;
}
