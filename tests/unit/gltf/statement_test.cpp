// Runs the statements of glTF's texts that concern a reader. The files in statements/ list them: each row has
// an edit of a small file, and what Glint must do with the edited file. The same rows are the tables of
// docs/gltf.md. GLINT_UPDATE_DOCUMENTS=1 in the environment writes them there instead of comparing them.
#include "unit/gltf/gltf_builder.h"
#include "unit/gltf/packed_scenes.h"

#include <glint/session/scene_view.h>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace glint::test {
namespace {

namespace fs = std::filesystem;
using Ordered = nlohmann::ordered_json;

const std::string kFolder = GLINT_SOURCE_DIR "/tests/unit/gltf/statements";
const std::string kDocument = GLINT_SOURCE_DIR "/docs/gltf.md";
constexpr std::string_view kBegin = "<!-- statements: begin -->\n";
constexpr std::string_view kEnd = "<!-- statements: end -->\n";

std::string readText(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

// ---- Rows ----

// One text of Khronos, and its rows.
struct Chapter {
    std::string title;
    std::string address;
    Ordered rows;
};

const std::vector<Chapter>& chapters() {
    static const std::vector<Chapter> kChapters = [] {
        std::vector<fs::path> files;
        for (const auto& entry : fs::directory_iterator(kFolder)) {
            files.push_back(entry.path());
        }
        std::ranges::sort(files);
        std::vector<Chapter> all;
        for (const fs::path& file : files) {
            for (const Ordered& chapter : Ordered::parse(readText(file))) {
                all.push_back({chapter.at("title"), chapter.at("address"), chapter.at("rows")});
            }
        }
        return all;
    }();
    return kChapters;
}

// Returns "warns" of "warns image-type".
std::string verbOf(const Ordered& row) {
    const std::string text = row.at("glint");
    return text.substr(0, text.find(' '));
}

// Returns "image-type" of "warns image-type".
std::string idOf(const Ordered& row) {
    const std::string text = row.at("glint");
    const std::size_t space = text.find(' ');
    return space == std::string::npos ? "" : text.substr(space + 1);
}

// ---- Files ----

// A triangle with all attributes but colours, a material, a texture and a camera. It breaks no rule.
GltfBuilder triangleBase() {
    GltfBuilder builder;
    Json& primitive = builder.addTriangle();
    primitive["attributes"]["NORMAL"] = builder.addAccessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
    primitive["attributes"]["TANGENT"] = builder.addAccessor<float>({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, 4);
    primitive["attributes"]["TEXCOORD_0"] = builder.addAccessor<float>({0, 0, 1, 0, 0, 1}, 2);
    primitive["indices"] = builder.addAccessor<std::uint16_t>({0, 1, 2}, 1);
    primitive["material"] = 0;
    builder.append("materials",
                   Json::parse(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})"));
    builder.append("textures", {{"source", 0}, {"sampler", 0}});
    builder.append("samplers", Json::object());
    builder.append("images", {{"uri", std::string("data:image/png;base64,") + kPng8}});
    builder.append("cameras",
                   Json::parse(R"({"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}})"));
    builder.append("nodes", {{"camera", 0}});
    builder.append("scenes", {{"nodes", {0, 1}}});
    builder.root["scene"] = 0;
    return builder;
}

// An animation that moves the triangle's node from 0 to (2, 0, 0) between 1 s and 2 s.
GltfBuilder movingBase() {
    GltfBuilder builder = triangleBase();
    const int times = builder.addAccessor<float>({1, 2}, 1);
    const int places = builder.addAccessor<float>({0, 0, 0, 2, 0, 0}, 3);
    builder.append("animations",
                   {{"samplers", {{{"input", times}, {"output", places}}}},
                    {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}});
    return builder;
}

// Two joints, nodes 2 and 3, which the triangle follows.
GltfBuilder skinnedBase() {
    GltfBuilder builder = triangleBase();
    Json& attributes = builder.root["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = builder.addAccessor<std::uint8_t>({0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, 4);
    attributes["WEIGHTS_0"] =
        builder.addAccessor<float>({0.5F, 0.5F, 0, 0, 0.25F, 0.75F, 0, 0, 1, 0, 0, 0}, 4);
    const std::vector<float> matrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    std::vector<float> matrices = matrix;
    matrices.insert(matrices.end(), matrix.begin(), matrix.end());
    builder.append("skins", {{"joints", {2, 3}}, {"inverseBindMatrices", builder.addAccessor(matrices, 16)}});
    builder.append("nodes", {{"children", {3}}});
    builder.append("nodes", Json::object());
    builder.root["nodes"][0]["skin"] = 0;
    builder.root["scenes"][0]["nodes"].push_back(2);
    return builder;
}

// Two targets that move the positions by (1, 0, 0) and (0, 1, 0).
GltfBuilder morphedBase() {
    GltfBuilder builder = triangleBase();
    Json& primitive = builder.root["meshes"][0]["primitives"][0];
    primitive["targets"].push_back(
        {{"POSITION", builder.addAccessor<float>({1, 0, 0, 1, 0, 0, 1, 0, 0}, 3)}});
    primitive["targets"].push_back(
        {{"POSITION", builder.addAccessor<float>({0, 1, 0, 0, 1, 0, 0, 1, 0}, 3)}});
    return builder;
}

GltfBuilder baseNamed(const std::string& name) {
    static const std::map<std::string, std::function<GltfBuilder()>> kBases{
        {"triangle", triangleBase},
        {"moving", movingBase},
        {"skinned", skinnedBase},
        {"morphed", morphedBase},
        {"draco", [] { return dracoScene(DracoMethod::Sequential); }},
        {"meshopt", meshoptScene},
        {"webp", webpScene}};
    return kBases.at(name)();
}

template <typename T>
int addAccessor(GltfBuilder& builder, const Ordered& value, const std::string& type) {
    std::vector<T> numbers;
    for (const Ordered& number : value.at(type)) {
        // JSON has no infinity and no NaN.
        numbers.push_back(number.is_string() ? static_cast<T>(std::stod(number.get<std::string>()))
                                             : number.get<T>());
    }
    const int index = builder.addAccessor(numbers, value.at("of").get<int>());
    builder.root["accessors"].back().merge_patch(Json(value.value("with", Ordered::object())));
    return index;
}

// Adds what {"f32": [1, 2, 3], "of": 3, "with": {"normalized": true}} describes, wherever it stands in an
// edit, and puts the accessor's index into its place. {"bytes": [1, 2], "stride": 4} makes a buffer view.
Json resolved(GltfBuilder& builder, const Ordered& value) {
    if (value.is_object() && value.contains("of")) {
        static const std::map<std::string,
                              std::function<int(GltfBuilder&, const Ordered&, const std::string&)>>
            kTypes{{"f32", addAccessor<float>},         {"i8", addAccessor<std::int8_t>},
                   {"u8", addAccessor<std::uint8_t>},   {"i16", addAccessor<std::int16_t>},
                   {"u16", addAccessor<std::uint16_t>}, {"u32", addAccessor<std::uint32_t>}};
        const std::string type = value.begin().key();
        return kTypes.at(type)(builder, value, type);
    }
    if (value.is_object() && value.contains("bytes")) {
        const auto bytes = value["bytes"].get<base::Bytes>();
        return builder.addView(bytes.data(), bytes.size(), value.value("stride", std::size_t{0}));
    }
    if (!value.is_structured()) {
        return Json(value);
    }
    Json all = value.is_array() ? Json::array() : Json::object();
    for (const auto& [name, member] : value.items()) {
        if (value.is_array()) {
            all.push_back(resolved(builder, member));
        } else {
            all[name] = resolved(builder, member);
        }
    }
    return all;
}

// Applies {"/materials/0/alphaMode": "MASK", "/nodes/1": null}: null removes.
void edit(GltfBuilder& builder, const Ordered& edits) {
    for (const auto& [place, value] : edits.items()) {
        const Json::json_pointer pointer(place);
        if (!value.is_null()) {
            builder.root[pointer] = resolved(builder, value);
            continue;
        }
        Json& parent = builder.root[pointer.parent_pointer()];
        if (parent.is_array()) {
            parent.erase(std::stoul(pointer.back()));
        } else {
            parent.erase(pointer.back());
        }
    }
}

// Returns the file of a row with one of its edits: JSON, or a GLB whose bytes the row changes, too.
std::string fileOf(const Ordered& row, const Ordered& edits) {
    GltfBuilder builder = baseNamed(row.value("base", "triangle"));
    edit(builder, edits);
    std::string text = row.contains("glb") ? builder.glb() : builder.text();
    for (const Ordered& change : row.value("text", Ordered::array())) {
        const auto from = change[0].get<std::string>();
        const std::size_t at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        text.replace(at == std::string::npos ? 0 : at, from.size(), change[1].get<std::string>());
    }
    if (!row.contains("glb")) {
        return text;
    }
    const Ordered set = row["glb"].value("set", Ordered::object());
    for (const auto& [place, byte] : set.items()) {
        text.at(std::stoul(place)) = static_cast<char>(byte.get<int>());
    }
    for (const Ordered& byte : row["glb"].value("append", Ordered::array())) {
        text += static_cast<char>(byte.get<int>());
    }
    if (row["glb"].value("length", false)) {
        text.replace(8, 4, word(static_cast<std::uint32_t>(text.size())));
    }
    return text;
}

// ---- What was read ----

Json describe(const gltf::Primitive& primitive) {
    Json all{{"material", primitive.material},
             {"positions", primitive.positions},
             {"normals", primitive.normals},
             {"tangents", primitive.tangents},
             {"texCoords0", primitive.texCoords0},
             {"texCoords1", primitive.texCoords1},
             {"colors", primitive.colors},
             {"indices", primitive.indices},
             {"joints", primitive.influences.joints},
             {"weights", primitive.influences.weights}};
    for (const gltf::MorphTarget& target : primitive.targets) {
        all["targets"].push_back(
            {{"positions", target.positions}, {"normals", target.normals}, {"tangents", target.tangents}});
    }
    return all;
}

Json describe(const materials::Material& material) {
    static const std::map<materials::AlphaMode, std::string> kModes{{materials::AlphaMode::Opaque, "OPAQUE"},
                                                                    {materials::AlphaMode::Mask, "MASK"},
                                                                    {materials::AlphaMode::Blend, "BLEND"}};
    Json all{{"alphaMode", kModes.at(material.alphaMode)},
             {"doubleSided", material.doubleSided},
             {"unlit", material.isUnlit()}};
    for (const materials::Parameter& parameter : material.model().parameters) {
        const auto value = material[parameter.name];
        all[parameter.name] =
            value.size() == 1 ? Json(value[0]) : Json(std::vector(value.begin(), value.end()));
    }
    for (const materials::MaterialTexture& texture : material.model().textures) {
        const materials::TextureInfo& info = material.texture(texture.name);
        all[texture.name] = {{"texture", info.texture},
                             {"texCoord", info.texCoord},
                             {"offset", info.transform.offset},
                             {"rotation", info.transform.rotation},
                             {"scale", info.transform.scale}};
    }
    return all;
}

// Returns the scene as JSON, from which rows name values by pointers.
Json describe(const gltf::Scene& scene) {
    Json all;
    for (const gltf::Mesh& mesh : scene.meshes) {
        Json primitives = Json::array();
        for (const gltf::Primitive& primitive : mesh.primitives) {
            primitives.push_back(describe(primitive));
        }
        all["meshes"].push_back({{"primitives", primitives}, {"weights", mesh.weights}});
    }
    for (const materials::Material& material : scene.materials) {
        all["materials"].push_back(describe(material));
    }
    for (const gltf::Node& node : scene.nodes) {
        all["nodes"].push_back({{"mesh", node.mesh},
                                {"source", node.source},
                                {"skin", node.skin},
                                {"world", node.world},
                                {"weights", node.weights},
                                {"shown", node.shown}});
    }
    for (const gltf::Light& light : scene.lights) {
        all["lights"].push_back({{"color", light.color},
                                 {"intensity", light.intensity},
                                 {"range", light.range},
                                 {"innerConeAngle", light.innerConeAngle},
                                 {"outerConeAngle", light.outerConeAngle},
                                 {"position", light.position},
                                 {"direction", light.direction}});
    }
    for (const gltf::Camera& camera : scene.cameras) {
        all["cameras"].push_back({{"yfov", camera.yfov},
                                  {"znear", camera.znear},
                                  {"zfar", camera.zfar},
                                  {"xmag", camera.xmag},
                                  {"ymag", camera.ymag},
                                  {"world", camera.world}});
    }
    for (const gltf::Sampler& sampler : scene.samplers) {
        all["samplers"].push_back({{"wrapU", sampler.wrapU},
                                   {"wrapV", sampler.wrapV},
                                   {"magnification", sampler.magnification},
                                   {"minification", sampler.minification},
                                   {"mip", sampler.mip},
                                   {"mipmapped", sampler.mipmapped}});
    }
    for (const gltf::Texture& texture : scene.textures) {
        all["textures"].push_back({{"image", texture.image}, {"sampler", texture.sampler}});
    }
    for (const gltf::Skin& skin : scene.skins) {
        all["skins"].push_back({{"joints", skin.joints}, {"inverseBinds", skin.inverseBinds}});
    }
    for (const gltf::Animation& animation : scene.animations) {
        all["animations"].push_back({{"channels", animation.channels.size()}});
    }
    for (const gltf::Image& image : scene.images) {
        all["images"].push_back({{"width", image.width}, {"pixels", image.pixels}});
    }
    all["counts"] = {{"lights", scene.lights.size()}, {"nodes", scene.nodes.size()}};
    return all;
}

bool isNear(const Json& read, const Json& expected) {
    constexpr double kTolerance = 1e-5;
    if (read.is_number() && expected.is_number()) {
        return std::abs(read.get<double>() - expected.get<double>()) <=
               kTolerance * std::max(1.0, std::abs(expected.get<double>()));
    }
    if (!read.is_array() || !expected.is_array() || read.size() != expected.size()) {
        return read == expected;
    }
    for (std::size_t i = 0; i < read.size(); ++i) {
        if (!isNear(read[i], expected[i])) {
            return false;
        }
    }
    return true;
}

void compareReads(const Ordered& row, gltf::Scene scene) {
    if (row.contains("time")) {
        std::vector<std::size_t> animations(scene.animations.size());
        std::iota(animations.begin(), animations.end(), 0U);
        session::applyPose(session::poseAt(scene, animations, row["time"].get<double>()), scene);
    }
    const Json all = describe(scene);
    const Ordered reads = row.value("reads", Ordered::object());
    for (const auto& [place, value] : reads.items()) {
        const Json::json_pointer pointer(place);
        ASSERT_TRUE(all.contains(pointer)) << place;
        EXPECT_PRED2(isNear, all[pointer], Json(value)) << place;
    }
}

// Imports a row's file, and checks what comes of it.
void checkFile(const Ordered& row, const Ordered& edits) {
    const bool decode = row.value("decode", true);
    const Result<gltf::Scene> scene =
        importText(fileOf(row, edits), {.decodeImages = decode, .variant = row.value("variant", "")});
    const std::string verb = verbOf(row);
    const std::string id = idOf(row);
    if (verb == "refuses") {
        ASSERT_FALSE(scene.ok()) << "was read";
        EXPECT_EQ(scene.error().id, id) << toString(scene.error());
        return;
    }
    ASSERT_TRUE(scene.ok()) << toString(scene.error());
    const std::vector<Diagnostic> warnings = readingWarnings(*scene);
    for (const Diagnostic& warning : warnings) {
        EXPECT_EQ(warning.id, id) << toString(warning);
        EXPECT_EQ(warning.severity, verb == "warns" ? Severity::Warning : Severity::Note)
            << toString(warning);
    }
    EXPECT_EQ(warnings.empty(), id.empty()) << "told nothing";
    compareReads(row, *scene);
}

class Statement : public testing::Test {
public:
    explicit Statement(const Ordered& row) : row_(row) {}
    void TestBody() override {
        const Ordered edits = row_.value("edits", Ordered::object());
        for (const Ordered& one : edits.is_array() ? edits : Ordered::array({edits})) {
            SCOPED_TRACE(one.dump());
            checkFile(row_, one);
        }
    }

private:
    const Ordered& row_;
};

bool hasFile(const Ordered& row) {
    return row.contains("edits") || row.contains("reads") || row.contains("text") || row.contains("glb");
}

// One test for each row that has a file.
const bool kRegistered = [] {
    for (const Chapter& chapter : chapters()) {
        for (const Ordered& row : chapter.rows) {
            if (hasFile(row)) {
                const std::string name = row.at("id");
                testing::RegisterTest("GltfStatements", name.c_str(), nullptr, nullptr, __FILE__, __LINE__,
                                      [&row] { return new Statement(row); });
            }
        }
    }
    return true;
}();

// ---- The list itself ----

// Adds "Suite.Test" for each TEST(Suite, Test), TEST_F and so on.
void collectTests(const std::string& text, std::set<std::string>& names) {
    constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_";
    constexpr std::string_view kBlanks = " \n";
    for (std::size_t at = text.find("TEST"); at != std::string::npos; at = text.find("TEST", at + 1)) {
        const std::size_t open = text.find_first_not_of("TESTFP_", at);
        if (open == std::string::npos || text[open] != '(') {
            continue;
        }
        const std::size_t comma = text.find_first_not_of(kLetters, open + 1);
        const std::size_t test = text.find_first_not_of(kBlanks, comma + 1);
        if (comma != std::string::npos && text[comma] == ',' && test != std::string::npos) {
            names.insert(text.substr(open + 1, comma - open - 1) + "." +
                         text.substr(test, text.find_first_not_of(kLetters, test) - test));
        }
    }
}

// The names of all tests of the repository.
std::set<std::string> testNames() {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(GLINT_SOURCE_DIR "/tests")) {
        if (entry.path().extension() == ".cpp") {
            collectTests(readText(entry.path()), names);
        }
    }
    return names;
}

TEST(GltfStatementList, IsWhole) {
    ASSERT_FALSE(chapters().empty());
    const std::set<std::string> tests = testNames();
    std::set<std::string> ids;
    for (const Chapter& chapter : chapters()) {
        for (const Ordered& row : chapter.rows) {
            const std::string id = row.at("id");
            EXPECT_TRUE(ids.insert(id).second) << id << " is there twice";
            EXPECT_FALSE(row.at("statement").get<std::string>().empty()) << id;
            EXPECT_TRUE(row.contains("section")) << id;
            static const std::set<std::string> kMembers{"id",    "section", "statement", "glint", "base",
                                                        "edits", "text",    "glb",       "reads", "time",
                                                        "test",  "why",     "variant",   "decode"};
            for (const auto& [member, value] : row.items()) {
                EXPECT_TRUE(kMembers.contains(member)) << id << ": " << member;
            }
            const std::string verb = verbOf(row);
            const std::string diagnostic = idOf(row);
            if (verb == "not") {
                EXPECT_EQ(row.at("glint"), "not concerned") << id;
                EXPECT_TRUE(row.contains("why") && !hasFile(row)) << id;
                continue;
            }
            EXPECT_TRUE(verb == "draws" || verb == "notes" || verb == "warns" || verb == "refuses") << id;
            EXPECT_EQ(diagnostic.empty(), verb == "draws") << id;
            EXPECT_TRUE(hasFile(row) || row.contains("test")) << id << " has neither a file nor a test";
            if (row.contains("test")) {
                EXPECT_TRUE(tests.contains(row["test"].get<std::string>())) << row["test"];
            }
        }
    }
}

// ---- The document ----

std::string answerOf(const Ordered& row) {
    const std::string verb = verbOf(row);
    const std::string why = row.contains("why") ? fmt::format(": {}", row["why"].get<std::string>()) : "";
    if (verb == "not") {
        return "not concerned" + why;
    }
    if (verb == "notes") {
        return fmt::format("draws, with a note `{}`{}", idOf(row), why);
    }
    return idOf(row).empty() ? verb + why : fmt::format("{} `{}`{}", verb, idOf(row), why);
}

std::string testsOf(const Ordered& row) {
    std::string text = hasFile(row) ? fmt::format("`GltfStatements.{}`", row["id"].get<std::string>()) : "";
    if (row.contains("test")) {
        text += fmt::format("{}`{}`", text.empty() ? "" : ", ", row["test"].get<std::string>());
    }
    return text;
}

std::string tables() {
    std::map<std::string, int> counts;
    std::string text;
    for (const Chapter& chapter : chapters()) {
        text += fmt::format("\n## {}\n\n[The text]({})\n\n", chapter.title, chapter.address);
        text += "| section | statement | Glint | test |\n|---|---|---|---|\n";
        for (const Ordered& row : chapter.rows) {
            ++counts[verbOf(row)];
            text += fmt::format("| {} | {} | {} | {} |\n", row["section"].get<std::string>(),
                                row["statement"].get<std::string>(), answerOf(row), testsOf(row));
        }
    }
    const int rows = std::accumulate(counts.begin(), counts.end(), 0,
                                     [](int sum, const auto& count) { return sum + count.second; });
    return fmt::format(
               "There are {} statements. For {} of them Glint draws as they ask and says nothing, for {} it "
               "draws with a note, for {} it draws with a warning, for {} it refuses the file, and {} do not "
               "concern a renderer.\n",
               rows, counts["draws"], counts["notes"], counts["warns"], counts["refuses"], counts["not"]) +
           text;
}

TEST(GltfStatementList, IsThatOfTheDocument) {
    const std::string document = readText(kDocument);
    const std::size_t begin = document.find(kBegin);
    const std::size_t end = document.find(kEnd);
    ASSERT_TRUE(begin < end && end != std::string::npos) << "the tables' place is missing";
    const std::size_t first = begin + kBegin.size();
    const std::string expected = tables();
    if (std::getenv("GLINT_UPDATE_DOCUMENTS") != nullptr) {
        std::ofstream(kDocument, std::ios::binary)
            << document.substr(0, first) << expected << document.substr(end);
        return;
    }
    EXPECT_EQ(document.substr(first, end - first), expected)
        << "write them anew: GLINT_UPDATE_DOCUMENTS=1 ctest -R GltfStatementList";
}

}  // namespace
}  // namespace glint::test
