#include "cli/planted.h"

#include "base/files.h"
#include "cli/command.h"
#include "spirv/compiler.h"

#include <glint/internal/package_format.h>

#include <gtest/gtest.h>

#include <cstring>
#include <span>
#include <vector>

namespace glint::testing {

namespace {

namespace fs = std::filesystem;

template <typename T>
T at(const std::string& bytes, std::size_t offset) {
    T value{};
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

package::PackageSection sectionOf(const std::string& tables, package::SectionKind kind) {
    const auto header = at<package::PackageHeader>(tables, 0);
    for (std::uint32_t i = 0; i < header.sectionCount; ++i) {
        const auto section =
            at<package::PackageSection>(tables, sizeof header + i * sizeof(package::PackageSection));
        if (section.kind == kind) {
            return section;
        }
    }
    ADD_FAILURE() << "the tables lack a section";
    return {};
}

// Stores the length and the hash of the file's new bytes, then the hash of the tables.
std::string withModule(std::string tables, const std::string& file, std::span<const std::uint8_t> spirv) {
    const package::PackageSection modules = sectionOf(tables, package::SectionKind::Modules);
    const package::PackageSection strings = sectionOf(tables, package::SectionKind::Strings);
    for (std::uint64_t i = 0; i < modules.count; ++i) {
        const std::size_t place = modules.offset + i * modules.elementBytes;
        auto entry = at<package::ModuleEntry>(tables, place);
        if (tables.substr(strings.offset + entry.file.offset, entry.file.length) == file) {
            entry.bytes = spirv.size();
            entry.hash = base::hashBytes(spirv);
            std::memcpy(tables.data() + place, &entry, sizeof entry);
        }
    }
    auto header = at<package::PackageHeader>(tables, 0);
    header.contentHash = 0;
    const std::span whole(reinterpret_cast<const std::uint8_t*>(tables.data()), tables.size());
    const std::span head(reinterpret_cast<const std::uint8_t*>(&header), sizeof header);
    header.contentHash = base::hashBytes(whole.subspan(sizeof header), base::hashBytes(head));
    std::memcpy(tables.data(), &header, sizeof header);
    return tables;
}

}  // namespace

void plant(const fs::path& package, const std::string& source, const std::string& from,
           const std::string& to) {
    std::string glsl = readText(package / "glsl" / source);
    const std::size_t found = glsl.find(from);
    ASSERT_NE(found, std::string::npos) << source << " lacks " << from;
    glsl.replace(found, from.size(), to);
    const auto words = compiler::compileShader({source, compiler::ShaderStage::Compute, glsl}, {});
    ASSERT_TRUE(words.ok()) << words.error().message;
    const std::span bytes(reinterpret_cast<const std::uint8_t*>(words->data()),
                          words->size() * sizeof(std::uint32_t));
    const std::string file = fs::path(source).stem().string() + ".spv";
    writeText(package / file, std::string(bytes.begin(), bytes.end()));
    writeText(package / "tables.bin", withModule(readText(package / "tables.bin"), file, bytes));
}

void plantInFirstHits(const fs::path& package, const std::string& from, const std::string& to) {
    int planted = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(package / "glsl")) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with("first_") && readText(entry.path()).find(from) != std::string::npos) {
            plant(package, name, from, to);
            ++planted;
        }
    }
    ASSERT_GT(planted, 0) << from;
}

}  // namespace glint::testing
