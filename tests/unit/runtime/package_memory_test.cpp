// A package loads from memory as from its folder, and is refused for the same reasons.
#include "package_builder.h"
#include "support/must.h"

#include <glint/package.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace glint {
namespace {

using test::PackageSpec;

// The files that a program would contain.
class Files {
public:
    explicit Files(const PackageSpec& spec) {
        add(package::kTablesFile, test::serialize(spec));
        for (const test::ModuleSpec& module : spec.modules) {
            const auto* const first = reinterpret_cast<const std::uint8_t*>(module.words.data());
            add(module.file, {first, first + module.words.size() * sizeof(std::uint32_t)});
        }
    }

    void add(const std::string& name, std::vector<std::uint8_t> bytes) {
        if (find(name) == files_.end()) {
            files_.push_back({name, std::move(bytes)});
        }
    }
    std::vector<std::uint8_t>& operator[](const std::string& name) {
        return find(name)->bytes;
    }
    void remove(const std::string& name) {
        files_.erase(find(name));
    }

    Result<Package> load() const {
        std::vector<package::EmbeddedFile> views;
        for (const File& file : files_) {
            views.push_back({file.name, file.bytes});
        }
        return Package::load(views);
    }
    // Returns the ID of the error, or "" for a package that loads.
    std::string error() const {
        const Result<Package> loaded = load();
        if (loaded) {
            return "";
        }
        EXPECT_FALSE(loaded.error().where.empty());
        EXPECT_FALSE(loaded.error().hint.empty());
        return loaded.error().id;
    }

private:
    struct File {
        std::string name;
        std::vector<std::uint8_t> bytes;
    };
    std::vector<File>::iterator find(const std::string& name) {
        return std::ranges::find(files_, name, &File::name);
    }
    std::vector<File> files_;
};

std::vector<std::uint8_t> bytesOf(const auto& span) {
    const auto bytes = std::as_bytes(span);
    const auto* const first = reinterpret_cast<const std::uint8_t*>(bytes.data());
    return {first, first + bytes.size()};
}

PackageSpec makeScene() {
    PackageSpec spec = test::makeSpec();
    spec.textures = {{0, 1, {}}, {0, 0, {}}};
    spec.samplers = {{0, 1, 1, 1, 1, 1}};
    spec.materials[0].roughnessFactor = 0.25F;
    spec.primitives = {test::makePrimitive(0, 0), test::makePrimitive(2, 1)};
    return spec;
}

TEST(PackageMemory, IsThePackageOfTheFolder) {
    const PackageSpec spec = makeScene();
    const test::TemporaryFolder folder;
    test::writePackage(spec, folder.path());
    const Package fromFolder = must(Package::load(folder.path()));
    const Package fromMemory = must(Files(spec).load());  // the files are gone by now

    EXPECT_EQ(fromMemory.caseCount(), fromFolder.caseCount());
    ASSERT_EQ(fromMemory.sceneCount(), 1U);
    const PackageScene scene = fromMemory.scene(0);
    EXPECT_EQ(scene.name, fromFolder.scene(0).name);
    EXPECT_EQ(bytesOf(scene.materials.bytes), bytesOf(fromFolder.scene(0).materials.bytes));
    EXPECT_EQ(bytesOf(scene.primitives), bytesOf(fromFolder.scene(0).primitives));
    EXPECT_EQ(bytesOf(scene.textures), bytesOf(fromFolder.scene(0).textures));
    EXPECT_EQ(bytesOf(scene.samplers), bytesOf(fromFolder.scene(0).samplers));
    EXPECT_EQ(bytesOf(fromMemory.cases()), bytesOf(fromFolder.cases()));
    EXPECT_EQ(bytesOf(fromMemory.modules()), bytesOf(fromFolder.modules()));
    ASSERT_EQ(fromMemory.modules().size(), spec.modules.size());
    for (const package::ModuleEntry& module : fromMemory.modules()) {
        const package::ModuleKey key{module.role, module.index, module.tracer};
        EXPECT_FALSE(fromMemory.spirv(key).empty());
        EXPECT_EQ(bytesOf(fromMemory.spirv(key)), bytesOf(fromFolder.spirv(key)));
    }
}

TEST(PackageMemory, BytesMayBeginAnywhere) {
    const PackageSpec spec = makeScene();
    std::vector<std::vector<std::uint8_t>> storage;
    std::vector<package::EmbeddedFile> views;
    const auto add = [&](std::string_view name, const std::vector<std::uint8_t>& bytes) {
        std::vector<std::uint8_t>& shifted = storage.emplace_back(std::vector<std::uint8_t>{0xAA});
        shifted.insert(shifted.end(), bytes.begin(), bytes.end());
        views.push_back({name, std::span(shifted).subspan(1)});
    };
    add(package::kTablesFile, test::serialize(spec));
    for (const test::ModuleSpec& module : spec.modules) {
        add(module.file, bytesOf(std::span(module.words)));
    }
    const Package loaded = must(Package::load(views));
    const test::ModuleSpec& module = spec.modules[0];
    EXPECT_EQ(bytesOf(loaded.spirv(module.key)), bytesOf(std::span(module.words)));
}

TEST(PackageMemory, WhatIsMissingIsNamed) {
    const PackageSpec spec = makeScene();
    EXPECT_EQ(Package::load(std::span<const package::EmbeddedFile>{}).error().id, "package-missing");
    Files files(spec);
    files.remove(spec.modules[3].file);
    const Diagnostic loaded = mustFail(files.load());
    EXPECT_EQ(loaded.id, "package-module-missing");
    EXPECT_NE(loaded.where.find(spec.modules[3].file), std::string::npos);
}

TEST(PackageMemory, FilesThatNoTableNamesAreIgnored) {
    Files files(makeScene());
    files.add("manifest.json", {'{', '}'});
    EXPECT_EQ(files.error(), "");
}

TEST(PackageMemory, EveryTruncationIsAnError) {
    const PackageSpec spec = makeScene();
    Files files(spec);
    for (const std::string& name : {std::string(package::kTablesFile), spec.modules[0].file}) {
        const std::vector<std::uint8_t> whole = files[name];
        for (std::size_t size = 0; size < whole.size(); ++size) {
            files[name].resize(size);
            ASSERT_NE(files.error(), "") << name << ", " << size << " bytes";
            files[name] = whole;
        }
        files[name].push_back(0);
        EXPECT_NE(files.error(), "") << name << " with a byte too many";
        files[name] = whole;
    }
    EXPECT_EQ(files.error(), "");
}

TEST(PackageMemory, EveryAlteredByteIsAnError) {
    const PackageSpec spec = makeScene();
    Files files(spec);
    for (const std::string& name : {std::string(package::kTablesFile), spec.modules[0].file}) {
        for (std::size_t byte = 0; byte < files[name].size(); ++byte) {
            files[name][byte] ^= 0x10;
            ASSERT_NE(files.error(), "") << name << ", byte " << byte;
            files[name][byte] ^= 0x10;
        }
    }
    EXPECT_EQ(files.error(), "");
}

TEST(PackageMemory, OtherVersionsAreNamed) {
    PackageSpec spec = makeScene();
    spec.version = package::kVersion + 1;
    EXPECT_EQ(Files(spec).error(), "package-version");
    Files foreign(makeScene());
    foreign[package::kTablesFile].assign(4096, 0);
    EXPECT_EQ(foreign.error(), "package-foreign");
}

}  // namespace
}  // namespace glint
