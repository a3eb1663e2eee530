// Tests a package as C++ source: a program must get from it the same as from the package's folder.
#include "emit/package/header.h"
#include "sample_scene.h"
#include "support/must.h"

#include <glint/package.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

namespace fs = std::filesystem;

// Writes every file below the given folder.
constexpr const char* kDump = R"(
#include "sample_package.h"

#include <fstream>
#include <string>

int main(int, char** argv) {
    for (const glint::package::EmbeddedFile& file : glint::scene_sample::embeddedPackage()) {
        std::ofstream stream(std::string(argv[1]) + "/" + std::string(file.name), std::ios::binary);
        stream.write(reinterpret_cast<const char*>(file.bytes.data()), static_cast<std::streamsize>(file.bytes.size()));
    }
}
)";

class EmbedSource : public ::testing::Test {
protected:
    EmbedSource() : scene_(makeSampleScene()) {
        scene_.path = "folder/sample.gltf";
        compiler::CompileSettings settings;
        settings.strategies = package::kStrategyVisibility;
        settings.emitGlsl = true;
        package_ = compileSample(settings);
    }
    Status write(const fs::path& source) const {
        GLINT_TRY(auto staged, stageEmbeddedSource(gltf::SceneList(std::span(&scene_, 1)), package_, source));
        for (base::StagedFile& file : staged) {
            GLINT_TRY_DO(file.commit());
        }
        return okStatus();
    }

    TemporaryFolder folder_;
    gltf::Scene scene_;
    compiler::CompiledPackage package_;
};

int runCommand(const std::string& command) {
    return std::system(command.c_str());
}

std::vector<std::string> filesOf(const fs::path& folder) {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        names.push_back(entry.path().filename().string());
    }
    std::ranges::sort(names);
    return names;
}

TEST_F(EmbedSource, HoldsTheFilesThatTheRuntimeReads) {
    must(write(folder_.path() / "new" / "sample_package.cpp"));
    const fs::path code = folder_.path() / "new";
    std::ofstream(code / "dump.cpp") << kDump;
    const std::string compile =
        std::string(GLINT_CXX_COMPILER) + " -std=c++20 -Wall -Wextra -Wpedantic -Wconversion -Werror -I\"" +
        GLINT_SOURCE_DIR + "/runtime/include\" \"" + (code / "dump.cpp").string() + "\" \"" +
        (code / "sample_package.cpp").string() + "\" -o \"" + (code / "dump").string() + "\"";
    ASSERT_EQ(runCommand(compile), 0);
    const fs::path dumped = folder_.path() / "dumped";
    fs::create_directory(dumped);
    ASSERT_EQ(runCommand("\"" + (code / "dump").string() + "\" \"" + dumped.string() + "\""), 0);

    std::vector<std::string> expected;
    for (const compiler::PackageFile& file : package_.files) {
        if (file.name == "tables.bin" || file.name.ends_with(".spv")) {
            expected.push_back(file.name);
            const base::Bytes bytes = must(base::readFile(dumped / file.name));
            EXPECT_EQ(bytes, file.bytes) << file.name;
        }
    }
    EXPECT_GT(expected.size(), 10U);
    EXPECT_EQ(filesOf(dumped), expected);
}

TEST_F(EmbedSource, FilesThatStayTheSameKeepTheirTime) {
    const fs::path source = folder_.path() / "a.cpp";
    ASSERT_TRUE(write(source));
    const fs::file_time_type early = fs::file_time_type::clock::now() - std::chrono::hours(1);
    fs::last_write_time(source, early);
    fs::last_write_time(folder_.path() / "a.h", early);
    ASSERT_TRUE(write(source));
    EXPECT_EQ(fs::last_write_time(source), early);

    // The tables change, but the declaration stays.
    compiler::PackageFile& tables =
        *std::ranges::find(package_.files, "tables.bin", &compiler::PackageFile::name);
    base::Bytes changed(tables.bytes.begin(), tables.bytes.end());
    changed.back() ^= 1;
    tables = {"tables.bin", std::move(changed)};
    ASSERT_TRUE(write(source));
    EXPECT_NE(fs::last_write_time(source), early);
    EXPECT_EQ(fs::last_write_time(folder_.path() / "a.h"), early);
    EXPECT_EQ(filesOf(folder_.path()), (std::vector<std::string>{"a.cpp", "a.h"}));
}

TEST_F(EmbedSource, AFailureLeavesTheEarlierSource) {
    const fs::path source = folder_.path() / "a.cpp";
    std::ofstream(source) << "earlier";
    fs::create_directories(folder_.path() / "a.h" / "in the way");
    EXPECT_EQ(mustFail(write(source)).id, "file-write");
    const base::Bytes kept = must(base::readFile(source));
    EXPECT_EQ(std::string(kept.begin(), kept.end()), "earlier");
    EXPECT_EQ(filesOf(folder_.path()), (std::vector<std::string>{"a.cpp", "a.h"}));
}

// Names are written into comments and literals of the code.
TEST_F(EmbedSource, NamesOfFilesEndNoComment) {
    scene_.path = "line\\\nbreak.gltf";
    const compiler::EmbeddedSource made =
        makeEmbeddedSource(gltf::SceneList(std::span(&scene_, 1)), package_, "sample_package.h");
    EXPECT_EQ(made.header.find("\\\n"), std::string::npos);
    EXPECT_NE(made.header.find("namespace glint::scene_line_break {"), std::string::npos) << made.header;
}

}  // namespace
}  // namespace glint::testing
