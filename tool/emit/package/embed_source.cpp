#include "emit/package/embed_source.h"

#include "emit/context.h"
#include "emit/package/header.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

namespace glint::compiler {

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
std::uint64_t wordAt(const base::Bytes& bytes, std::size_t offset) {
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
                                   "#include <glint/embedded_file.h>\n\n"
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

Status writeEmbeddedSource(const gltf::SceneList& scenes, const CompiledPackage& package,
                           const fs::path& source) {
    GLINT_TRY(auto staged, stageEmbeddedSource(scenes, package, source));
    for (base::StagedFile& file : staged) {
        if (Status written = file.commit(); !written) {
            return writeError(source, written.error());
        }
    }
    return okStatus();
}

}  // namespace glint::compiler
