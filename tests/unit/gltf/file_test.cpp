// Tests files: containers, buffers, URIs, JSON.
#include "gltf/document/files.h"
#include "support/must.h"
#include "unit/gltf/gltf_builder.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace glint::test {
namespace {

namespace fs = std::filesystem;

// Returns a triangle whose buffer is in the file with that URI.
std::string triangleWithBuffer(const std::string& uri, base::Bytes& bytes) {
    GltfBuilder builder;
    builder.addTriangle();
    bytes = builder.buffer;
    builder.root["buffers"] = Json::array({{{"byteLength", bytes.size()}, {"uri", uri}}});
    return builder.text();
}

// Imports a scene in "<folder>/scenes" whose buffer has that URI.
Result<gltf::Scene> importWithUri(const TemporaryFolder& folder, const std::string& uri,
                                  const gltf::ImportOptions& options = {}) {
    base::Bytes bytes;
    const std::string text = triangleWithBuffer(uri, bytes);
    const fs::path scenes = folder.path() / "scenes";
    fs::create_directories(scenes / "sub folder");
    for (const fs::path& path :
         {folder.path() / "outside.bin", scenes / "a.bin", scenes / "sub folder/b.bin"}) {
        EXPECT_TRUE(base::writeFile(path, bytes).ok());
    }
    EXPECT_TRUE(base::writeFile(scenes / "scene.gltf", text).ok());
    return importScene(scenes / "scene.gltf", options);
}

TEST(GltfFiles, OpensRelativeFilesAndRecordsThem) {
    const TemporaryFolder folder;
    for (const char* uri :
         {"a.bin", "./a.bin", "sub%20folder/b.bin", "sub folder/b.bin", "sub%20folder/../a.bin"}) {
        const gltf::Scene scene = must(importWithUri(folder, uri));
        ASSERT_EQ(scene.files.size(), 2U);
        EXPECT_EQ(scene.path, (folder.path() / "scenes/scene.gltf").string());
        EXPECT_EQ(scene.files[0].path, scene.path);
        const base::Bytes content = must(base::readFile(scene.files[1].path));
        EXPECT_EQ(scene.files[1].bytes, content.size());
        EXPECT_EQ(scene.files[1].hash, base::hashBytes(content));
    }
}

TEST(GltfFiles, RefusesToLeaveTheFolder) {
    const TemporaryFolder folder;
    const std::string absolute = (folder.path() / "scenes/a.bin").string();
    for (const std::string& uri :
         {std::string("../outside.bin"), std::string("%2e%2e/outside.bin"),
          std::string("sub folder/../../outside.bin"), absolute, std::string("file://") + absolute,
          std::string("http://localhost/a.bin"), std::string("C:/a.bin"), std::string("a.bin%00"),
          std::string("%2Fetc/passwd"), std::string("\\\\server\\a.bin"), std::string()}) {
        const Result<gltf::Scene> scene = importWithUri(folder, uri);
        ASSERT_FALSE(scene.ok()) << uri;
        EXPECT_EQ(scene.error().id, "uri-unsafe") << uri;
        EXPECT_TRUE(scene.error().where.ends_with("scene.gltf#/buffers/0/uri"));
        EXPECT_FALSE(scene.error().hint.empty());
    }
}

// Build systems give each action a folder of links into a store.
TEST(GltfFiles, FollowsLinksUnlessPathsAreStrict) {
    const TemporaryFolder folder;
    const fs::path scenes = folder.path() / "scenes";
    fs::create_directories(scenes);
    fs::create_symlink(folder.path() / "outside.bin", scenes / "link.bin");
    fs::create_directory_symlink(folder.path(), scenes / "up");
    fs::create_symlink("a.bin", scenes / "inner.bin");
    for (const std::string uri : {"link.bin", "up/outside.bin"}) {
        const gltf::Scene followed = must(importWithUri(folder, uri));
        EXPECT_EQ(followed.files.at(1).path, (scenes / uri).string());
        const Result<gltf::Scene> refused = importWithUri(folder, uri, {.strictPaths = true});
        ASSERT_FALSE(refused.ok()) << uri;
        EXPECT_EQ(refused.error().id, "uri-unsafe");
        EXPECT_TRUE(refused.error().where.ends_with("scene.gltf#/buffers/0/uri"));
    }
    EXPECT_TRUE(importWithUri(folder, "inner.bin", {.strictPaths = true}).ok());
    // The caller has named the link to the scene itself, so it is followed.
    fs::create_directories(folder.path() / "forest");
    fs::create_symlink(scenes / "scene.gltf", folder.path() / "forest/scene.gltf");
    fs::create_symlink(scenes / "a.bin", folder.path() / "forest/inner.bin");
    const Result<gltf::Scene> forest = gltf::importScene(folder.path() / "forest/scene.gltf");
    EXPECT_TRUE(forest.ok()) << toString(forest.error());
}

TEST(GltfFiles, ExplainsWhatIsMissingOrTooShort) {
    const TemporaryFolder folder;
    const Diagnostic missing = mustFail(importWithUri(folder, "none.bin"));
    EXPECT_EQ(missing.id, "file-open");
    EXPECT_NE(missing.message.find("none.bin"), std::string::npos);
    EXPECT_EQ(mustFail(importWithUri(folder, "sub folder")).id, "file-open");

    GltfBuilder builder;
    builder.addTriangle();
    builder.root["buffers"] = Json::array({{{"byteLength", 36}, {"uri", "data:;base64,AAAA"}}});
    EXPECT_EQ(mustFail(import(builder)).id, "buffer-size");
    // A buffer without a URI is valid, because others may bring its data. Glint has no data to draw then.
    builder.root["buffers"][0].erase("uri");
    const gltf::Scene without = must(import(builder));
    EXPECT_EQ(countWarnings(without, "buffer-external"), 1U);
    EXPECT_TRUE(findWarning(without, "buffer-external").where.ends_with("#/meshes/0/primitives/0"));
    EXPECT_TRUE(without.meshes.at(0).primitives.empty());

    EXPECT_EQ(gltf::importScene(folder.path() / "none.gltf").error().id, "file-open");
    EXPECT_EQ(gltf::importScene(folder.path()).error().id, "file-open");
}

TEST(GltfFiles, BoundsTheBytesRead) {
    GltfBuilder builder;
    builder.addTriangle();
    EXPECT_EQ(mustFail(import(builder, {.maxFileBytes = 100})).id, "file-size");
}

TEST(GltfJson, IsChecked) {
    const auto idOf = [](const std::string& text) {
        const Result<gltf::Scene> scene = importText(text);
        if (!scene) {
            EXPECT_NE(scene.error().where.find("scene.gltf"), std::string::npos);
            EXPECT_FALSE(scene.error().message.empty());
        }
        return scene ? std::string("imported") : scene.error().id;
    };
    EXPECT_EQ(idOf("{"), "json-syntax");
    EXPECT_EQ(idOf("[]"), "json-type");
    EXPECT_EQ(idOf("{}"), "asset-version");
    EXPECT_EQ(idOf(R"({"asset": {"version": 2}})"), "asset-version");
    EXPECT_EQ(idOf(R"({"asset": {"version": "1.0"}})"), "asset-version");
    EXPECT_EQ(idOf(R"({"asset": {"version": "2.0", "minVersion": "2.1"}})"), "asset-version");
    EXPECT_EQ(idOf(R"({"asset": {"version": "2.0"}})"), "imported");
    EXPECT_EQ(idOf(R"({"asset": {"version": "2.0"}, "nodes": {}})"), "json-type");
    EXPECT_EQ(idOf(R"({"asset": {"version": "2.0"}, "nodes": [3]})"), "json-type");
}

// A file that is unusual or wrong, and what comes of it.
struct OddFile {
    const char* what;
    std::string text;
    std::string id = "imported";  // or that of the error
    std::string place = "";       // JSON pointer of the error
    std::string warning = "";     // id
    std::string part = "";        // of the message, of error or warning
};

// A triangle; `find` is replaced by `by` in its text.
std::string triangleWith(const std::string& find, const std::string& by) {
    GltfBuilder builder;
    builder.addTriangle();
    std::string text = builder.text();
    const std::size_t place = text.find(find);
    EXPECT_NE(place, std::string::npos) << find;
    return text.replace(place, find.size(), by);
}

// A triangle with further members of the root.
std::string triangleAnd(const std::string& members) {
    return triangleWith("{", "{" + members + ",");
}

// A GLB whose JSON chunk has that padding.
std::string paddedGlb(char padding) {
    std::string json = R"({"asset":{"version":"2.0"}})";
    json.resize((json.size() + 3) / 4 * 4 + 4, padding);
    return "glTF" + word(2) + word(static_cast<std::uint32_t>(20 + json.size())) +
           chunk(0x4E4F534A, json, padding);
}

std::vector<OddFile> oddFiles() {
    const std::string data = "data:application/octet-stream;base64,";
    const std::string nested = std::string(100000, '[') + std::string(100000, ']');
    const std::string twoGigabytes = "2147483648";
    GltfBuilder triangle;
    triangle.addTriangle();
    std::string crlf = Json::parse(triangle.text()).dump(1);
    for (std::size_t i = 0; (i = crlf.find('\n', i)) != std::string::npos; i += 2) {
        crlf.insert(i, "\r");
    }
    using namespace std::string_literals;
    return {
        // Data URIs
        {"the scheme in capitals", triangleWith("data:", "DATA:")},
        {"base64 in capitals", triangleWith(";base64", ";BASE64")},
        {"a type in capitals, with parameters",
         triangleWith(data, "Data:Application/Octet-Stream;charset=utf-8;name=a;Base64,")},
        {"spaces before base64", triangleWith(";base64", "; base64")},
        {"no type", triangleWith(data, "data:;base64,")},
        {"line breaks in base64", triangleWith(data, data + "\\r\\n ")},
        {"no comma", triangleWith(";base64,", ";base64"), "data-uri", "/buffers/0/uri"},
        {"another alphabet", triangleWith(data, data + "***"), "data-uri", "/buffers/0/uri"},
        // Relative URIs
        {"an escaped way out", triangleWith(data, "%2E%2e%2F"), "uri-unsafe", "/buffers/0/uri"},
        // Text
        {"a byte order mark", "\xEF\xBB\xBF" + triangle.text()},
        {"CRLF", crlf},
        {"UTF-16", "\xFF\xFE{\0}\0"s, "scene-format", "", "", "UTF-16"},
        {"zero bytes at the end", triangle.text() + "\0\0"s, "imported", "", "json-padding", "2 zero bytes"},
        {"a GLB that is padded with spaces", paddedGlb(' ')},
        {"a GLB that is padded with zeros", paddedGlb('\0'), "imported", "", "json-padding"},
        {"a zero byte between tokens", triangleWith("{", "{\0"s), "json-syntax", "", "", "byte 1 is zero"},
        {"a zero byte and more JSON", triangle.text() + "\0{}"s, "json-syntax"},
        {"an escaped zero in a name", triangleAnd(R"("materials":[{"name":"\u0000"}])")},
        {"an escaped zero in a URI", triangleWith(data, "\\u0000"), "uri-unsafe", "/buffers/0/uri"},
        // Values
        {"a member twice: the last counts", triangleAnd(R"("asset":{"version":"1.0"})")},
        {"an object twice: the last replaces the first",
         R"({"scenes":[{"nodes":[7]}],"scenes":[],"asset":{"version":"2.0"}})"},
        {"1e400 where nothing reads it",
         triangleAnd(R"("extras":{"x":[1e400,-1.5E+999],"\"1e400":"1e400"})")},
        {"1e-400, which is 0", triangleAnd(R"("materials":[{"alphaCutoff":1e-400}])")},
        {"1e400 where something reads it", triangleAnd(R"("materials":[{"alphaCutoff":-1e400}])"),
         "json-range", "/materials/0/alphaCutoff", "", "-1e400"},
        {"1e400 in an array of numbers", triangleAnd(R"("materials":[{"emissiveFactor":[0,1e400,0]}])"),
         "json-range", "/materials/0/emissiveFactor/1", "", "1e400"},
        {"1e400 as a name", triangleAnd(R"("materials":[{"name":1e400}])"), "json-range",
         "/materials/0/name"},
        {"1e400 as an index", triangleAnd(R"("scene":1e400)"), "json-range", "/scene"},
        {"1e400 and an error of syntax", triangleAnd(R"("extras":1e400,,)"), "json-syntax"},
        {"NaN", triangleAnd(R"("extras":NaN)"), "json-syntax"},
        {"100,000 levels", triangleAnd("\"extras\":" + nested), "json-depth"},
        {"100,000 levels in a text", triangleAnd("\"extras\":\"" + nested + "\"")},
        // Claims of 2 GB
        {"a buffer", triangleWith("\"byteLength\":36,\"uri\"", "\"byteLength\":" + twoGigabytes + ",\"uri\""),
         "buffer-size", "/buffers/0"},
        {"a GLB", "glTF" + word(2) + word(0x80000000U) + word(4) + word(0x4E4F534A) + "{}  ", "glb-length"},
        {"a chunk", "glTF" + word(2) + word(24) + word(0x80000000U) + word(0x4E4F534A) + "{}  ", "glb-chunk"},
        {"an accessor", triangleWith("\"count\":3", "\"count\":" + twoGigabytes), "vertex-limit",
         "/accessors/0"},
        // Other files
        {"an empty file", "", "scene-empty", "", "", "is empty"},
        {"white space", " \r\n\t", "scene-empty", "", "", "white space"},
        {"a PNG", "\x89PNG\r\n\x1A\n", "scene-format", "", "", "PNG"},
        {"a JPEG", "\xFF\xD8\xFF\xE0", "scene-format", "", "", "JPEG"},
        {"a WebP", "RIFF\1\1\1\1WEBPVP8 ", "scene-format", "", "", "WebP"},
        {"a Radiance file", "#?RADIANCE\n", "scene-format", "", "", "HDR"},
        {"an archive", "PK\x03\x04", "scene-format", "", "", "ZIP"},
        {"a web page", "<!DOCTYPE html><html>", "scene-format", "", "", "web page"},
        {"a pointer", "version https://git-lfs.github.com/spec/v1\n", "scene-format", "", "", "Git LFS"},
        {"some text", "hello", "json-syntax"},
    };
}

TEST(GltfFiles, EachOddFileHasItsAnswer) {
    for (const OddFile& file : oddFiles()) {
        SCOPED_TRACE(file.what);
        const Result<gltf::Scene> scene = importText(file.text);
        ASSERT_EQ(scene ? "imported" : scene.error().id, file.id) << (scene ? "" : toString(scene.error()));
        if (!scene) {
            const std::string place = file.place.empty() ? "scene.gltf" : "scene.gltf#" + file.place;
            EXPECT_TRUE(scene.error().where.ends_with(place)) << scene.error().where;
            EXPECT_NE(scene.error().message.find(file.part), std::string::npos) << scene.error().message;
            EXPECT_FALSE(scene.error().hint.empty());
            continue;
        }
        const std::vector<Diagnostic> warnings = readingWarnings(*scene);
        ASSERT_EQ(warnings.size(), file.warning.empty() ? 0U : 1U)
            << (warnings.empty() ? "" : toString(warnings[0]));
        if (!file.warning.empty()) {
            EXPECT_EQ(warnings[0].id, file.warning);
            EXPECT_NE(warnings[0].message.find(file.part), std::string::npos);
        }
    }
}

std::string errorOfBytes(const std::string& bytes) {
    const Result<gltf::Scene> scene = importText(bytes);
    return scene ? "imported" : scene.error().id;
}

TEST(GltfGlb, IsReadWhateverItsName) {
    GltfBuilder builder;
    builder.addTriangle();
    const gltf::Scene scene = must(importText(builder.glb()));
    EXPECT_EQ(scene.meshes[0].primitives[0].positions[1], (gltf::Float3{1, 0, 0}));
    EXPECT_EQ(scene.files.size(), 1U);
}

TEST(GltfGlb, IsChecked) {
    GltfBuilder builder;
    builder.addTriangle();
    const std::string good = builder.glb();
    EXPECT_EQ(errorOfBytes("glTF"), "glb-length");
    EXPECT_EQ(errorOfBytes("glTF" + word(1) + good.substr(8)), "glb-version");
    EXPECT_EQ(errorOfBytes(good.substr(0, good.size() - 1)), "glb-length");
    EXPECT_EQ(errorOfBytes("glTF" + word(2) + word(0xFFFFFFFFU) + good.substr(12)), "glb-length");
    EXPECT_EQ(errorOfBytes("glTF" + word(2) + word(3) + good.substr(12)), "glb-length");
    EXPECT_EQ(errorOfBytes("glTF" + word(2) + word(12)), "glb-chunk");
    EXPECT_EQ(errorOfBytes("glTF" + word(2) + word(16) + word(0)), "glb-chunk");
    EXPECT_EQ(errorOfBytes(good.substr(0, 12) + word(0xFFFFFFFFU) + good.substr(16)), "glb-chunk");
    const std::string binaryFirst = chunk(0x004E4942, "abcd", '\0');
    EXPECT_EQ(errorOfBytes("glTF" + word(2) + word(static_cast<std::uint32_t>(binaryFirst.size() + 12)) +
                           binaryFirst),
              "glb-chunk");
    EXPECT_EQ(errorOfBytes(good + "more"), "imported");
}

TEST(GltfUri, DecodesDataUris) {
    using gltf::decodeDataUri;
    const auto text = [](std::string_view uri) {
        const auto data = decodeDataUri(uri);
        return data ? std::string(data->begin(), data->end()) : "malformed";
    };
    EXPECT_EQ(text("data:text/plain;base64,aGVsbG8="), "hello");
    EXPECT_EQ(text("data:text/plain;base64,aGVsbG8"), "hello");
    EXPECT_EQ(text("DATA:;base64,aGVsbG8%3D"), "hello");
    EXPECT_EQ(text("data:,a%20b"), "a b");
    EXPECT_EQ(text("dAtA:Text/Plain;charset=utf-8; BASE64,aGVs\r\n bG8=\n"), "hello");
    EXPECT_EQ(text("data:base64,aGVsbG8="), "aGVsbG8=");
    EXPECT_EQ(text("data:;base64,aGVsb*8="), "malformed");
    EXPECT_EQ(text("data:;base64,aGVsb"), "malformed");
    EXPECT_EQ(text("data:;base64"), "malformed");
    EXPECT_EQ(text("data:image/png;charset=x;base64,AAAA"), std::string(3, '\0'));
}

TEST(GltfUri, DecodesPercents) {
    EXPECT_EQ(gltf::percentDecode("a%20b%2Fc"), "a b/c");
    EXPECT_EQ(gltf::percentDecode("100%"), "100%");
    EXPECT_EQ(gltf::percentDecode("%4"), "%4");
    EXPECT_EQ(gltf::percentDecode("%zz"), "%zz");
    EXPECT_EQ(gltf::percentDecode("%c3%A4"), "\xC3\xA4");
    EXPECT_EQ(gltf::percentDecode("%2520"), "%20") << "once";
}

}  // namespace
}  // namespace glint::test
