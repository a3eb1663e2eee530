// Inputs of about a kilobyte that claim to be gigabytes. Each must be refused with a diagnostic, in a process
// that may not use a gigabyte.
#include "cli/command.h"
#include "cli/tiny_scene.h"

#include <glint/internal/package_format.h>

#include <xxhash.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::uint64_t kGibibyte = 1ULL << 30;
// The largest size of these inputs, except for a package's tables.
constexpr std::size_t kSmall = 2048;
// Half of what a scene may have; as positions it would be 1.5 GiB.
constexpr std::uint64_t kManyElements = 1ULL << 27U;

std::string big(std::uint32_t word) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) {
        bytes += static_cast<char>(word >> shift);
    }
    return bytes;
}

std::string little(std::uint32_t word) {
    const std::string bytes = big(word);
    return {bytes.rbegin(), bytes.rend()};
}

// Headers of images with nothing behind them. Readers check checksums last, if at all.
std::string hugePng(std::uint32_t size) {
    return "\x89PNG\r\n\x1A\n" + big(13) + "IHDR" + big(size) + big(size) + std::string("\x08\x06\0\0\0", 5) +
           big(0) + big(1) + "IDATx" + big(0) + big(0) + "IEND" + big(0);
}

std::string pngOfHugeChunk() {
    return "\x89PNG\r\n\x1A\n" + big(13) + "IHDR" + big(4) + big(4) + std::string("\x08\x06\0\0\0", 5) +
           big(0) + big(0x7FFFFFF0) + "IDATx" + big(0);
}

// The header claims 16000 x 16000 pixels.
std::string hugeJpeg() {
    return std::string("\xFF\xD8\xFF\xC0\0\x11\x08\x3E\x80\x3E\x80\x03\x01\x11\0\x02\x11\0\x03\x11\0\xFF\xD9",
                       23);
}

// The format is lossless; sizes have 14 bits and are stored minus 1.
std::string hugeWebp() {
    std::string data(1, '\x2F');
    data.append(little(15999U | 15999U << 14U)).append(16, '\0');
    std::string file = "RIFF";
    file.append(little(static_cast<std::uint32_t>(12 + data.size()))).append("WEBPVP8L");
    return file.append(little(static_cast<std::uint32_t>(data.size()))).append(data);
}

// UASTC with Zstandard, 16000 x 16000 pixels: the header of KTX 2.0, a level, and its data format descriptor.
std::string hugeKtx2() {
    constexpr std::uint32_t kSize = 16000;
    constexpr std::uint32_t kDescriptor = 104;
    std::string file = "\xABKTX 20\xBB\r\n\x1A\n" + little(0) + little(1) + little(kSize) + little(kSize) +
                       little(0) + little(0) + little(1) + little(1) + little(2) + little(kDescriptor) +
                       little(44);
    file.resize(80, '\0');
    file += little(kDescriptor + 44) + little(0) + little(16) + little(0) + little(kSize * kSize) + little(0);
    file += little(44) + little(0) + little(2U | 40U << 16U) + little(166U | 1U << 8U | 2U << 16U) +
            little(0x0303) + little(16) + little(0) + little(127U << 16U) + little(0) + little(0) +
            little(0xFFFFFFFFU);
    return file + std::string(16, '\0');
}

std::string hugeExr() {
    const auto attribute = [](const std::string& name, const std::string& type, const std::string& value) {
        return name + '\0' + type + '\0' + little(static_cast<std::uint32_t>(value.size())) + value;
    };
    const std::string window = little(0) + little(0) + little(8191) + little(8191);
    std::string channels;
    for (const char* name : {"B", "G", "R"}) {
        channels += name + std::string(1, '\0') + little(2) + little(0) + little(1) + little(1);
    }
    return little(20000630) + little(2) + attribute("channels", "chlist", channels + '\0') +
           attribute("compression", "compression", std::string(1, '\3')) +
           attribute("dataWindow", "box2i", window) + attribute("displayWindow", "box2i", window) +
           attribute("lineOrder", "lineOrder", std::string(1, '\0')) +
           attribute("pixelAspectRatio", "float", little(0x3F800000)) +
           attribute("screenWindowCenter", "v2f", little(0) + little(0)) +
           attribute("screenWindowWidth", "float", little(0x3F800000)) + '\0';
}

// Returns a scene with one primitive, whose positions are in accessor 0.
Json scene() {
    return Json::parse(R"({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"componentType": 5126, "count": 3, "type": "VEC3", "bufferView": 0}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri":
            "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
}

class Memory : public CommandTest {
protected:
    void SetUp() override {
#ifdef GLINT_SANITIZED
        GTEST_SKIP() << "AddressSanitizer maps terabytes; fuzzing bounds its own allocations";
#endif
        CommandTest::SetUp();
        memoryLimit_ = kGibibyte;
    }
    void write(const std::string& name, const std::string& bytes) const {
        ASSERT_LE(bytes.size(), kSmall) << name;
        writeText(path(name), bytes);
    }
    // Expects the input to be refused for that reason, and not because memory ran out.
    void expectRefused(const std::string& name, const std::vector<std::string>& arguments,
                       const std::string& id) const {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.exit, 1) << name << ": " << outcome.out << outcome.err;
        EXPECT_NE(outcome.err.find("error: "), std::string::npos) << name << ": " << outcome.err;
        EXPECT_NE(outcome.err.find("[" + id + "]"), std::string::npos) << name << ": " << outcome.err;
    }
    void expectSceneRefused(const std::string& name, const Json& gltf, const std::string& id) const {
        write("scene.gltf", gltf.dump());
        expectRefused(name, {"explain", "scene.gltf"}, id);
        expectRefused(name, {"compile", "scene.gltf", "-o", "package", "--cache", "none"}, id);
        EXPECT_FALSE(fs::exists(path("package"))) << name;
    }
    void expectImageRefused(const std::string& name, const std::string& image, const std::string& id) const {
        write("image", image);
        Json gltf = scene();
        gltf["images"] = {{{"uri", "image"}}};
        gltf["textures"] = {{{"source", 0}}};
        gltf["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
        gltf["meshes"][0]["primitives"][0]["material"] = 0;
        write("scene.gltf", gltf.dump());
        expectRefused(name, {"render", "scene.gltf", "-o", "out.png"}, id);
    }
};

TEST_F(Memory, CountsOfScenes) {
    Json gltf = scene();
    gltf["accessors"][0]["count"] = 2147483648U;
    expectSceneRefused("more elements than any scene may have", gltf, "vertex-limit");
    gltf["accessors"][0]["count"] = kManyElements;
    expectSceneRefused("more elements than the buffer view", gltf, "accessor-range");
    gltf["accessors"][0].erase("bufferView");
    expectSceneRefused("elements without a buffer view", gltf, "accessor-count");
    gltf["accessors"][0]["sparse"] = {{"count", 1},
                                      {"indices", {{"bufferView", 0}, {"componentType", 5125}}},
                                      {"values", {{"bufferView", 0}}}};
    expectSceneRefused("a sparse accessor", gltf, "accessor-count");
    gltf = scene();
    gltf["accessors"][0]["sparse"] = {{"count", kManyElements},
                                      {"indices", {{"bufferView", 0}, {"componentType", 5125}}},
                                      {"values", {{"bufferView", 0}}}};
    expectSceneRefused("substitutions of a sparse accessor", gltf, "sparse-count");
    gltf = scene();
    gltf["buffers"][0]["byteLength"] = 1ULL << 40U;
    expectSceneRefused("a buffer that is shorter than it says", gltf, "buffer-size");
}

TEST_F(Memory, ManyReadersOfOneAccessor) {
    Json gltf = scene();
    gltf["accessors"][0].erase("bufferView");
    gltf["accessors"][0]["count"] = 1U << 20U;
    Json& primitives = gltf["meshes"][0]["primitives"];
    for (int i = 0; i < 30; ++i) {
        primitives.push_back(primitives[0]);
    }
    expectSceneRefused("elements that no file holds, many times", gltf, "accessor-count");
}

TEST_F(Memory, NodesThatMultiply) {
    Json gltf = scene();
    gltf["nodes"] = Json::array();
    for (int i = 0; i < 30; ++i) {
        gltf["nodes"].push_back({{"children", {i + 1, i + 1}}});
    }
    gltf["nodes"].push_back({{"mesh", 0}});
    expectSceneRefused("two to the thirtieth of instances", gltf, "node-parents");
}

TEST_F(Memory, CompressedGeometry) {
    Json gltf = scene();
    gltf["extensionsUsed"] = gltf["extensionsRequired"] = {"EXT_meshopt_compression"};
    gltf["bufferViews"][0]["byteLength"] = 12 * kManyElements;
    gltf["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0},
                                                                       {"byteLength", 36},
                                                                       {"byteStride", 12},
                                                                       {"count", kManyElements},
                                                                       {"mode", "ATTRIBUTES"}};
    gltf["accessors"][0]["count"] = kManyElements;
    expectSceneRefused("meshopt", gltf, "meshopt-size");

    // "DRACO" 2.2, a triangular mesh, sequential, no flags; then 2^31 faces and 2^31 points as varints.
    const std::string draco = "DRACO\x02\x02\x01" + std::string(3, '\0') +
                              "\x80\x80\x80\x80\x08\x80\x80\x80\x80\x08" + std::string(15, '\0');
    write("draco.bin", draco);
    gltf = scene();
    gltf["extensionsUsed"] = gltf["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    gltf["buffers"][0] = {{"uri", "draco.bin"}, {"byteLength", draco.size()}};
    gltf["bufferViews"][0]["byteLength"] = draco.size();
    gltf["accessors"][0].erase("bufferView");
    gltf["accessors"][0]["count"] = 2147483648U;
    gltf["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", 0}, {"attributes", {{"POSITION", 0}}}};
    expectSceneRefused("Draco", gltf, "draco-size");
}

TEST_F(Memory, DeepJson) {
    write("scene.gltf", R"({"asset":{"version":"2.0"},"extras":)" + std::string(1900, '['));
    expectRefused("glTF", {"explain", "scene.gltf"}, "json-depth");
    fs::create_directory(path("package"));
    write("package/manifest.json", std::string(2000, '['));
    expectRefused("manifest", {"lint", "package"}, "manifest-format");
    write("profile.json", std::string(2000, '['));
    writeTinyScene(path(""));
    expectRefused("profile", {"explain", "scene.gltf", "--merge", "profile:profile.json"}, "profile-format");
}

TEST_F(Memory, LockedIds) {
    writeTinyScene(path(""));
    for (const char* id : {"4294967295", "2147483648", "65536"}) {
        write("ids.lock", std::string("version 1\n") + id + " unlit\n");
        expectRefused(id, {"compile", "scene.gltf", "-o", "package", "--lock", "ids.lock"}, "lock-format");
    }
}

TEST_F(Memory, ImagesOfScenes) {
    expectImageRefused("PNG", hugePng(16000), "image-decode");
    expectImageRefused("chunk of a PNG", pngOfHugeChunk(), "image-decode");
    expectImageRefused("JPEG", hugeJpeg(), "image-decode");
    expectImageRefused("WebP", hugeWebp(), "image-size");
    expectImageRefused("KTX2", hugeKtx2(), "image-size");
}

TEST_F(Memory, Pictures) {
    for (const auto& [name, bytes] :
         {std::pair("huge.png", hugePng(8192)), {"chunk.png", pngOfHugeChunk()}, {"huge.exr", hugeExr()}}) {
        write(name, bytes);
        expectRefused(name, {"compare", name, name}, "image-format");
    }
}

// Tests every count of the tables, with hashes that are right.
TEST_F(Memory, TablesOfPackages) {
    writeTinyScene(path(""));
    memoryLimit_ = 0;
    ASSERT_EQ(run({"compile", "scene.gltf", "-o", "package", "--strategy", "visibility"}).exit, 0);
    memoryLimit_ = kGibibyte;
    ASSERT_EQ(run({"inspect", "package"}).exit, 0);
    const std::string whole = readText(path("package/tables.bin"));
    package::PackageHeader header{};
    ASSERT_GT(whole.size(), sizeof header);
    std::memcpy(&header, whole.data(), sizeof header);
    const auto expectDamaged = [&](const std::string& name, package::PackageHeader changed,
                                   std::string tables) {
        changed.contentHash = 0;
        changed.contentHash =
            XXH3_64bits_withSeed(tables.data() + sizeof changed, tables.size() - sizeof changed,
                                 XXH3_64bits(&changed, sizeof changed));
        std::memcpy(tables.data(), &changed, sizeof changed);
        writeText(path("package/tables.bin"), tables);
        expectRefused(name, {"inspect", "package"}, "package-altered");
    };
    package::PackageHeader changed = header;
    changed.caseCount = 0xFFFFFFFF;
    expectDamaged("cases", changed, whole);
    changed = header;
    changed.sectionCount = 0xFFFFFFFF;
    expectDamaged("sections", changed, whole);
    for (std::uint32_t i = 0; i < header.sectionCount; ++i) {
        for (const std::uint64_t count : {std::uint64_t{0xFFFFFFFF}, ~std::uint64_t{0} / 2}) {
            const std::size_t at = sizeof header + i * sizeof(package::PackageSection);
            package::PackageSection section{};
            std::memcpy(&section, whole.data() + at, sizeof section);
            section.count = count;
            std::string tables = whole;
            std::memcpy(tables.data() + at, &section, sizeof section);
            expectDamaged("section " + std::to_string(i), header, tables);
        }
    }
}

TEST_F(Memory, Modules) {
    // Readers often allocate by the bound of identifiers.
    std::string words;
    for (const std::uint32_t word : {0x07230203U, 0x00010500U, 0U, 0xFFFFFFFFU, 0U, 2U << 16U | 17U, 1U,
                                     3U << 16U | 14U, 0U, 1U, 2U << 16U | 19U, 0xFFFFFFFEU}) {
        words += little(word);
    }
    write("bound.spv", words);
    expectRefused("identifiers", {"lint", "bound.spv"}, "spirv-invalid");
}

}  // namespace
}  // namespace glint::testing
