#include "emit/package/header.h"

#include "emit/context.h"
#include "emit/material_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace glint::compiler {

namespace {

struct TypeSize {
    std::string_view name;
    std::uint32_t bytes;
    std::uint32_t alignment;
};

constexpr TypeSize kTypes[] = {{"uint", 4, 4},  {"float", 4, 4}, {"vec2", 8, 4},  {"vec3", 12, 4},
                               {"vec4", 16, 4}, {"uvec2", 8, 4}, {"uvec4", 16, 4}};
constexpr TypeSize kAddress{"GLINT_ADDRESS(", 8, 8};

const TypeSize* findType(std::string_view name) {
    const auto* const found = std::ranges::find(kTypes, name, &TypeSize::name);
    return name.starts_with(kAddress.name) ? &kAddress : found == std::end(kTypes) ? nullptr : found;
}

constexpr std::uint32_t alignedTo(std::uint32_t value, std::uint32_t alignment) {
    return (value + alignment - 1) / alignment * alignment;
}

// Cuts the first line off `text`, and returns it without its comment and the blanks around it.
std::string_view takeLine(std::string_view& text) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    line = line.substr(0, line.find("//"));
    const std::size_t first = std::min(line.find_first_not_of(' '), line.size());
    line.remove_prefix(first);
    return line.substr(0, line.find_last_not_of(' ') + 1);
}

// Adds the member that a line declares: "vec4 objectToWorld[3];".
Status addMember(std::string_view line, StructLayout& layout, std::uint32_t& alignment) {
    const std::size_t blank = line.find(' ');
    const TypeSize* const type = findType(line.substr(0, blank));
    if (type == nullptr || blank == std::string_view::npos || !line.ends_with(';')) {
        return makeError(
            "internal", "shaders/interop",
            fmt::format("{} has a member that is no scalar, vector or address: {}", layout.name, line),
            "use a type of interop/types.h");
    }
    std::string_view name = line.substr(blank + 1, line.size() - blank - 2);
    std::uint32_t count = 1;
    if (const std::size_t bracket = name.find('['); bracket != std::string_view::npos) {
        std::from_chars(name.data() + bracket + 1, name.data() + name.size(), count);
        name = name.substr(0, bracket);
    }
    const std::uint32_t offset = alignedTo(layout.bytes, type->alignment);
    layout.members.push_back({std::string(name), offset});
    layout.bytes = offset + count * type->bytes;
    alignment = std::max(alignment, type->alignment);
    return okStatus();
}

}  // namespace

Result<std::vector<StructLayout>> interopLayouts(std::string_view declarations) {
    constexpr std::string_view kBegin = "struct ";
    std::vector<StructLayout> layouts;
    while (!declarations.empty()) {
        const std::string_view begin = takeLine(declarations);
        if (!begin.starts_with(kBegin)) {
            continue;
        }
        StructLayout layout{
            std::string(begin.substr(kBegin.size(), begin.find(" {") - kBegin.size())), 0, {}};
        if (findType(layout.name) != nullptr) {
            continue;  // a vector of GLSL in C++
        }
        std::uint32_t alignment = 1;
        for (std::string_view line = takeLine(declarations); line != "};"; line = takeLine(declarations)) {
            if (declarations.empty()) {
                return makeError("internal", "shaders/interop", layout.name + " has no end",
                                 "end it with };");
            }
            // Members that GLSL has only in some packages are always there in C++.
            if (line.empty() || line.starts_with('#')) {
                continue;
            }
            GLINT_TRY_DO(addMember(line, layout, alignment));
        }
        layout.bytes = alignedTo(layout.bytes, alignment);
        layouts.push_back(std::move(layout));
    }
    return layouts;
}

// --- glint_tables.h ---

namespace mustache = kainjow::mustache;

namespace {

// Returns an ASCII string literal. Octal escapes end after three digits, so the next character can't extend
// them.
std::string cppLiteral(std::string_view text) {
    std::string literal = "\"";
    for (const char character : text) {
        const auto code = static_cast<unsigned char>(character);
        if (character == '"' || character == '\\') {
            literal += '\\';
            literal += character;
        } else if (code < 0x20 || code > 0x7E || character == '?') {
            literal += fmt::format("\\{:03o}", code);
        } else {
            literal += character;
        }
    }
    return literal + "\"";
}

mustache::data featureList(const materials::MaterialModel& model) {
    mustache::data list(mustache::data::type::list);
    for (const materials::Feature& info : model.features) {
        if (info.model >= 0) {
            continue;
        }
        mustache::data entry;
        entry.set("name", materials::capitalized(info.name));
        entry.set("bit", fmt::format("{}", info.bit));
        entry.set("gltf", commentText(info.gltf));
        list.push_back(entry);
    }
    return list;
}

mustache::data caseMasks(const Plan& plan) {
    mustache::data list(mustache::data::type::list);
    for (const Case& shaderCase : plan.cases) {
        mustache::data entry;
        entry.set("name", shaderCase.name);
        const auto [always, sometimes] = plan.model->caseWords(shaderCase.always, shaderCase.sometimes);
        entry.set("always", fmt::format("{:#x}ULL", shaderCase.always.shared()));
        entry.set("sometimes", fmt::format("{:#x}ULL", shaderCase.sometimes.shared()));
        entry.set("own",
                  fmt::format("{:#x}U, {{{:#x}U}}, {{{:#x}U}}", always.model,
                              fmt::join(always.own.words, "U, "), fmt::join(sometimes.own.words, "U, ")));
        list.push_back(entry);
    }
    return list;
}

mustache::data materialNames(const gltf::Scene& scene) {
    mustache::data list(mustache::data::type::list);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        mustache::data entry;
        entry.set("index", fmt::format("{}", i));
        entry.set("literal", cppLiteral(scene.materials[i].name));
        list.push_back(entry);
    }
    return list;
}

mustache::data sceneTables(const gltf::SceneList& scenes) {
    mustache::data list(mustache::data::type::list);
    for (std::size_t i = 0; i < scenes.scenes().size(); ++i) {
        const gltf::Scene& scene = scenes.scenes()[i];
        mustache::data entry;
        entry.set("index", fmt::format("{}", i));
        entry.set("literal", cppLiteral(scenes.name(i)));
        entry.set("hasMaterials", !scene.materials.empty());
        entry.set("materialCount", fmt::format("{}", scene.materials.size()));
        entry.set("materialNames", materialNames(scene));
        list.push_back(entry);
    }
    return list;
}

mustache::data materialMembers(const MaterialLayout& layout) {
    mustache::data members(mustache::data::type::list);
    const auto add = [&members](const std::string& name, std::uint32_t offset) {
        mustache::data entry;
        entry.set("member", name);
        entry.set("offset", fmt::format("{}", offset));
        members.push_back(entry);
    };
    for (const RecordField& field : layout.fields) {
        if (layout.isShared(field)) {
            add(field.name, field.offset);
        }
    }
    if (layout.ownFloats() > 0) {
        add("own", layout.ownOffset);
    }
    if (layout.textureCount > 0) {
        add("textures", layout.textureOffset);
    }
    return members;
}

// The values of the enums that records have.
mustache::data enumNames(const MaterialLayout& layout) {
    mustache::data list(mustache::data::type::list);
    for (const RecordField& field : layout.fields) {
        if (field.parameter < 0) {
            continue;
        }
        const materials::Parameter& parameter =
            layout.model->parameters[static_cast<std::size_t>(field.parameter)];
        for (std::size_t i = 0; i < parameter.names.size(); ++i) {
            list.push_back(mustache::object{{"constant", nameConstant(parameter, i)},
                                            {"value", fmt::format("{}", i)},
                                            {"field", parameter.name}});
        }
    }
    return list;
}

mustache::data layoutList(const std::vector<StructLayout>& layouts) {
    mustache::data list(mustache::data::type::list);
    for (const StructLayout& layout : layouts) {
        mustache::data members(mustache::data::type::list);
        for (const MemberLayout& member : layout.members) {
            mustache::data entry;
            entry.set("member", member.name);
            entry.set("offset", fmt::format("{}", member.offset));
            members.push_back(entry);
        }
        mustache::data entry;
        entry.set("struct", layout.name);
        entry.set("bytes", fmt::format("{}", layout.bytes));
        entry.set("members", members);
        list.push_back(entry);
    }
    return list;
}

}  // namespace

std::string headerNamespace(const std::string& scenePath) {
    std::string name = "scene_";
    for (const char character : std::filesystem::path(scenePath).stem().string()) {
        const bool valid = std::isalnum(static_cast<unsigned char>(character)) != 0;
        // C++ reserves names with two underscores in a row.
        if (valid || name.back() != '_') {
            name += valid ? character : '_';
        }
    }
    return name;
}

Result<std::string> makeHeader(const gltf::SceneList& scenes, const Plan& plan, const SourceSet& sources,
                               const PlanOptions& options) {
    GLINT_TRY(auto interop, interopDeclarations());
    GLINT_TRY(const auto layouts, interopLayouts(interop));
    mustache::data context = makeContext(scenes, options);
    addCases(context, scenes, plan, options);
    context.set("namespace", headerNamespace(scenes.scenes().front().path));
    const MaterialLayout layout = materialLayoutOf(plan);
    context.set("interop", interop);
    context.set("materialRecord", recordStruct(layout, RecordLanguage::Cpp));
    context.set("features", featureList(*plan.model));
    context.set("hasCases", !plan.cases.empty());
    context.set("caseCount", fmt::format("{}", plan.cases.size()));
    context.set("caseMasks", caseMasks(plan));
    context.set("sceneCount", fmt::format("{}", scenes.scenes().size()));
    context.set("scenes", sceneTables(scenes));
    context.set("layouts", layoutList(layouts));
    context.set("materialBytes", fmt::format("{}", layout.bytes));
    context.set("materialMembers", materialMembers(layout));
    context.set("enumNames", enumNames(layout));
    return renderTemplate(sources, "glint_tables.h.mustache", context);
}

// --- The package as C++ source ---

namespace fs = std::filesystem;

namespace {

// Files become arrays of 64-bit words. Compilers read few long numbers faster than many short ones, and every
// compiler accepts such an array, while string literals have limits.
constexpr std::size_t kWordBytes = 8;
constexpr std::size_t kWordsPerLine = 5;

// The runtime reads the tables and the modules, which are in the package's folder itself.
bool isRead(const PackageFile& file) {
    return file.name == package::kTablesFile ||
           (file.name.ends_with(".spv") && file.name.find('/') == std::string::npos);
}

// Reads a word in little-endian order; bytes beyond the end are 0.
std::uint64_t wordAt(std::span<const std::uint8_t> bytes, std::size_t offset) {
    std::uint64_t word = 0;
    for (std::size_t i = std::min(bytes.size(), offset + kWordBytes); i > offset; --i) {
        word = word << 8U | bytes[i - 1];
    }
    return word;
}

void appendArray(std::string& text, const PackageFile& file, std::size_t index) {
    const std::size_t words = (file.bytes.size() + kWordBytes - 1) / kWordBytes;
    auto out = std::back_inserter(text);
    fmt::format_to(out, "\n// {}\nconstexpr std::uint64_t kFile{}[] = {{", commentText(file.name), index);
    for (std::size_t i = 0; i < words; ++i) {
        fmt::format_to(out, "{}{:#x},", i % kWordsPerLine == 0 ? "\n" : " ",
                       wordAt(file.bytes, i * kWordBytes));
    }
    text += "\n};\n";
}

std::string firstLine(const gltf::SceneList& scenes) {
    return fmt::format("// Made by glint {} from {}. Do not edit.\n", toolVersion(),
                       commentText(scenes.fileNames()));
}

std::string makeHeaderText(const gltf::SceneList& scenes, const std::string& scope) {
    return firstLine(scenes) + fmt::format(
                                   "#pragma once\n\n"
                                   "#include <glint/package_shape.h>\n\n"
                                   "#include <span>\n\n"
                                   "namespace glint::{} {{\n\n"
                                   "// The package, for Package::load(). Static storage.\n"
                                   "std::span<const package::EmbeddedFile> embeddedPackage();\n\n"
                                   "}}  // namespace glint::{}\n",
                                   scope, scope);
}

Diagnostic writeError(const fs::path& path, const Diagnostic& cause) {
    return makeError("output-write", path.string(), cause.message,
                     "check the folder, its permissions and the free space");
}

}  // namespace

EmbeddedSource makeEmbeddedSource(const gltf::SceneList& scenes, const CompiledPackage& package,
                                  const std::string& headerName) {
    const std::string scope = headerNamespace(scenes.scenes().front().path);
    std::string text = firstLine(scenes) + fmt::format(
                                               "#include \"{}\"\n\n"
                                               "#include <bit>\n"
                                               "#include <cstdint>\n\n"
                                               "namespace glint::{} {{\n\nnamespace {{\n\n"
                                               "static_assert(std::endian::native == std::endian::little);\n",
                                               headerName, scope);
    std::string list;
    std::size_t count = 0;
    for (const PackageFile& file : package.files) {
        if (isRead(file)) {
            appendArray(text, file, count);
            list += fmt::format("        {{\"{}\", {{bytesOf(kFile{}), {}}}}},\n", file.name, count,
                                file.bytes.size());
            ++count;
        }
    }
    text += fmt::format(
        "\nconst std::uint8_t* bytesOf(const std::uint64_t* words) {{\n"
        "    return reinterpret_cast<const std::uint8_t*>(words);\n"
        "}}\n\n}}  // namespace\n\n"
        "std::span<const package::EmbeddedFile> embeddedPackage() {{\n"
        "    static const package::EmbeddedFile kFiles[] = {{\n{}    }};\n"
        "    return kFiles;\n}}\n\n}}  // namespace glint::{}\n",
        list, scope);
    return {makeHeaderText(scenes, scope), text};
}

fs::path embeddedHeader(const fs::path& source) {
    fs::path header = source;
    return header.replace_extension(".h");
}

Result<std::vector<base::StagedFile>> stageEmbeddedSource(const gltf::SceneList& scenes,
                                                          const CompiledPackage& package,
                                                          const fs::path& source) {
    const fs::path header = embeddedHeader(source);
    const EmbeddedSource made = makeEmbeddedSource(scenes, package, header.filename().string());
    // If this fails, writing the files reports it.
    std::error_code ignored;
    fs::create_directories(source.parent_path(), ignored);
    std::vector<base::StagedFile> staged;
    for (const auto& [path, text] : {std::pair(header, std::string_view(made.header)),
                                     std::pair(source, std::string_view(made.source))}) {
        base::removeAbandoned(path);
        Result<base::StagedFile> file = base::StagedFile::create(path, base::asBytes(text));
        if (!file) {
            return writeError(path, file.error());
        }
        staged.push_back(std::move(*file));
    }
    return staged;
}

}  // namespace glint::compiler
