// Tests glint render --edits: pictures against those of files that have the edits already, and its messages.
#include "cli/render_command.h"
#include "cli/schemas.h"
#include "cli/tiny_scene.h"

#include <string>
#include <utility>
#include <vector>

namespace glint::testing {
namespace {

using Json = nlohmann::json;

class Edits : public RenderCommand {
protected:
    void useScene(const TinyScene& options) {
        scene_ = writeTinyScene(path(""), options).string();
    }
    Json file() const {
        return Json::parse(readText(scene_));
    }
    std::string writeEdits(const Json& edits) const {
        const std::string file = path("edits.json").string();
        writeText(file, Json{{"edits", edits}}.dump());
        expectFits("edits", Json{{"edits", edits}});
        return file;
    }
    // Renders another file of the same folder, in which the edits are made already.
    void renderBaked(const std::string& image, const Json& gltf, std::vector<std::string> more) const {
        writeText(path("baked.gltf"), gltf.dump());
        must(runWith({"render", "baked.gltf", "-o", image, "--size", "64x36"}, more));
    }
};

// Adds the scene of another folder as a file that was merged by hand would have it.
void addOther(Json& gltf, const Json& other, const std::string& uri, Json holder) {
    const auto count = [&](const char* list) { return gltf.value(list, Json::array()).size(); };
    const std::size_t buffers = count("buffers");
    const std::size_t views = count("bufferViews");
    const std::size_t accessors = count("accessors");
    const std::size_t materials = count("materials");
    const std::size_t meshes = count("meshes");
    const std::size_t nodes = count("nodes");
    for (Json buffer : other["buffers"]) {
        buffer["uri"] = uri;
        gltf["buffers"].push_back(buffer);
    }
    for (Json view : other["bufferViews"]) {
        view["buffer"] = view["buffer"].get<std::size_t>() + buffers;
        gltf["bufferViews"].push_back(view);
    }
    for (Json accessor : other["accessors"]) {
        accessor["bufferView"] = accessor["bufferView"].get<std::size_t>() + views;
        gltf["accessors"].push_back(accessor);
    }
    for (const Json& material : other["materials"]) {
        gltf["materials"].push_back(material);
    }
    for (Json mesh : other["meshes"]) {
        Json& primitive = mesh["primitives"][0];
        for (Json& attribute : primitive["attributes"]) {
            attribute = attribute.get<std::size_t>() + accessors;
        }
        primitive["indices"] = primitive["indices"].get<std::size_t>() + accessors;
        primitive["material"] = primitive["material"].get<std::size_t>() + materials;
        gltf["meshes"].push_back(mesh);
    }
    holder["children"] = Json::array();
    for (Json node : other["nodes"]) {
        node["mesh"] = node["mesh"].get<std::size_t>() + meshes;
        holder["children"].push_back(gltf["nodes"].size());
        gltf["nodes"].push_back(node);
    }
    gltf["scenes"][0]["nodes"].push_back(nodes + other["nodes"].size());
    gltf["nodes"].push_back(holder);
}

TEST_F(Edits, EqualAFileThatHasThem) {
    std::filesystem::create_directories(path("other"));
    writeTinyScene(path("other"), {.camera = false});
    const Json other = Json::parse(readText(path("other/scene.gltf")));
    const Json small{0.25, 0.25, 0.25};
    const std::string edits = writeEdits({
        {{"frame", 1}, {"edit", "hide"}, {"node", "1"}},
        {{"frame", 2}, {"edit", "show"}, {"node", "1"}},
        {{"frame", 2}, {"edit", "move"}, {"node", "1"}, {"translation", {0.5, 0.25, 0.5}}},
        {{"frame", 2},
         {"edit", "duplicate"},
         {"node", "0"},
         {"name", "Copy"},
         {"translation", {0, 1, 0}},
         {"scale", small}},
        {{"frame", 2}, {"edit", "material"}, {"node", "Copy"}, {"material", "Spare"}},
        {{"frame", 3}, {"edit", "delete"}, {"node", "1"}},
        {{"frame", 3},
         {"edit", "add"},
         {"file", "other/scene.gltf"},
         {"name", "Other"},
         {"translation", {-1, 0.5, 0}},
         {"scale", small}},
        {{"frame", 3}, {"edit", "duplicate"}, {"node", "Other"}, {"translation", {1, 0.5, 0}}},
    });
    const std::vector<std::string> picture{"--sky", "1"};
    const Outcome outcome =
        must(render("out.exr", {"--frames", "0:3", "--edits", edits, "--sky", "1", "--validate", "--json"}));
    expectFits("render", outcome.json());
    EXPECT_EQ(outcome.json()["frames"][2]["edits"], 4);

    ASSERT_EQ(render("rest.exr", picture).exit, 0);
    expectSame("out.0000.exr", "rest.exr");
    Json baked = file();
    baked["scenes"][0]["nodes"] = {0, 2};
    renderBaked("hidden.exr", baked, picture);
    expectSame("out.0001.exr", "hidden.exr");

    baked = file();
    baked["nodes"][1]["translation"] = {0.5, 0.25, 0.5};
    baked["meshes"].push_back(baked["meshes"][0]);
    baked["meshes"][2]["primitives"][0]["material"] = 2;
    baked["nodes"].push_back({{"mesh", 2}, {"translation", {0, 1, 0}}, {"scale", small}});
    baked["scenes"][0]["nodes"] = {0, 1, 2, 3};
    renderBaked("moved.exr", baked, picture);
    expectSame("out.0002.exr", "moved.exr");

    baked["scenes"][0]["nodes"] = {0, 2, 3};
    for (const double x : {-1.0, 1.0}) {
        addOther(baked, other, "other/scene.bin", {{"translation", {x, 0.5, 0}}, {"scale", small}});
    }
    renderBaked("added.exr", baked, picture);
    expectSame("out.0003.exr", "added.exr");
    expectOther("moved.exr", "added.exr");
}

TEST_F(Edits, GoOnWhileAnAnimationPlays) {
    useScene({.animated = true});
    const std::string edits = writeEdits({
        {{"frame", 1}, {"edit", "duplicate"}, {"node", "1"}, {"name", "Twin"}, {"parent", "0"}},
        {{"frame", 1}, {"edit", "move"}, {"node", "0"}, {"translation", {0, -0.5, 1}}},
        {{"frame", 2}, {"edit", "hide"}, {"node", "1"}},
    });
    const std::vector<std::string> picture{"--sky", "1"};
    ASSERT_EQ(
        render("out.exr", {"--frames", "0:2", "--fps", "4", "--edits", edits, "--sky", "1", "--validate"})
            .exit,
        0);
    // The twin goes on with the animation, below a node that was moved.
    Json baked = file();
    baked["nodes"][0]["translation"] = {0, -0.5, 1};
    baked["nodes"][0]["children"] = {3};
    baked["nodes"].push_back(baked["nodes"][1]);
    for (const char* property : {"translation", "weights"}) {
        const Json channels = baked["animations"][0]["channels"];
        for (const Json& channel : channels) {
            if (channel["target"]["path"] == property && channel["target"]["node"] == 1) {
                Json copy = channel;
                copy["target"]["node"] = 3;
                baked["animations"][0]["channels"].push_back(copy);
            }
        }
    }
    renderBaked("twins.exr", baked, {"--sky", "1", "--time", "0.25"});
    expectSame("out.0001.exr", "twins.exr");
    baked["scenes"][0]["nodes"] = {0, 2};
    Json& channels = baked["animations"][0]["channels"];
    channels.erase(0);
    channels.erase(0);
    renderBaked("twin.exr", baked, {"--sky", "1", "--time", "0.5"});
    expectSame("out.0002.exr", "twin.exr");
}

TEST_F(Edits, ChooseAVariantWhileTheSceneIsDrawn) {
    useScene({.variants = true});
    const std::string edits = writeEdits({
        {{"frame", 1}, {"edit", "variant"}, {"variant", "Day"}},
        {{"frame", 2}, {"edit", "variant"}},
    });
    must(render("out.exr", {"--frames", "0:2", "--edits", edits, "--sky", "1", "--validate"}));
    ASSERT_EQ(render("day.exr", {"--variant", "Day", "--sky", "1"}).exit, 0);
    expectSame("out.0001.exr", "day.exr");
    expectSame("out.0000.exr", "out.0002.exr");
    expectOther("out.0000.exr", "day.exr");
}

TEST_F(Edits, ChangeLights) {
    Json gltf = file();
    gltf["extensionsUsed"].push_back("KHR_lights_punctual");
    gltf["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 20}},
                                                           {{"type", "spot"}, {"intensity", 0}}};
    for (int light = 0; light < 2; ++light) {
        gltf["nodes"].push_back({{"name", light == 0 ? "Lamp" : "Spot"},
                                 {"translation", {light, 1, 1}},
                                 {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
        gltf["scenes"][0]["nodes"].push_back(3 + light);
    }
    writeText(scene_, gltf.dump());
    const std::string edits = writeEdits({
        {{"frame", 0}, {"edit", "light"}, {"node", "Spot"}, {"color", {1, 0.25, 0.25}}, {"intensity", 30}},
        {{"frame", 0}, {"edit", "move"}, {"node", "Lamp"}, {"translation", {-1, 0.5, 0}}},
        {{"frame", 1}, {"edit", "delete"}, {"node", "Lamp"}},
        {{"frame", 1}, {"edit", "duplicate"}, {"node", "Spot"}, {"translation", {-1, 1, 1}}},
    });
    const std::vector<std::string> picture{"--sky", "0.25"};
    ASSERT_EQ(render("out.exr", {"--frames", "0:1", "--edits", edits, "--sky", "0.25", "--validate"}).exit,
              0);
    gltf["extensions"]["KHR_lights_punctual"]["lights"][1].update(
        {{"color", {1, 0.25, 0.25}}, {"intensity", 30}});
    gltf["nodes"][3]["translation"] = {-1, 0.5, 0};
    renderBaked("lit.exr", gltf, picture);
    expectSame("out.0000.exr", "lit.exr");
    Json copy = gltf["nodes"][4];
    copy["translation"] = {-1, 1, 1};
    gltf["nodes"].push_back(copy);
    gltf["scenes"][0]["nodes"] = {0, 1, 2, 4, 5};
    renderBaked("spots.exr", gltf, picture);
    expectSame("out.0001.exr", "spots.exr");
    // Without frames all edits are made.
    ASSERT_EQ(render("all.exr", {"--edits", edits, "--sky", "0.25"}).exit, 0);
    expectSame("all.exr", "out.0001.exr");
}

TEST_F(Edits, SayWhatAGivenPackageLacks) {
    useScene({.variants = true});
    const std::string edits =
        writeEdits({{{"frame", 0}, {"edit", "material"}, {"node", "1"}, {"material", "0"}},
                    {{"frame", 9}, {"edit", "hide"}, {"node", "1"}}});
    // The floor's key is among those of the package; the wall has the same attributes.
    ASSERT_EQ(run({"compile", scene_, "-o", "plain", "--no-trust-textures"}).exit, 0);
    const Outcome known =
        must(render("out.exr", {"--frames", "0:1", "--edits", edits, "--package", "plain"}));
    EXPECT_TRUE(has(known.err, "1 of 2 edits come after the last frame, 1")) << known.err;
    // A trusting package may rely on what its primitives show.
    ASSERT_EQ(run({"compile", scene_, "-o", "trusting"}).exit, 0);
    const Outcome trusting = render("x.exr", {"--edits", edits, "--package", "trusting"});
    EXPECT_EQ(trusting.exit, 1);
    EXPECT_TRUE(has(trusting.err, "[package-mismatch]")) << trusting.err;
    // No primitive of the package has the material "Spare".
    const std::string spare =
        writeEdits({{{"frame", 0}, {"edit", "material"}, {"node", "0"}, {"material", "Spare"}}});
    ASSERT_EQ(run({"compile", scene_, "-o", "package", "--fallback"}).exit, 0);
    const Outcome fallback =
        must(render("spare.exr", {"--edits", spare, "--package", "package", "--sky", "1"}));
    EXPECT_TRUE(has(fallback.err, "[edit-fallback]")) << fallback.err;
    ASSERT_EQ(render("compiled.exr", {"--edits", spare, "--sky", "1"}).exit, 0);
    expectSame("spare.exr", "compiled.exr");
}

TEST_F(Edits, OfBadFilesAreRefused) {
    struct Bad {
        Json edit;
        const char* message;
    };
    const Bad bad[] = {
        {{{"edit", "hide"}, {"node", "1"}}, "#/edits/0: error: has no member \"frame\""},
        {{{"frame", 0}, {"edit", "hid"}, {"node", "1"}}, "#/edits/0/edit: error: "},
        {{{"frame", -1}, {"edit", "hide"}, {"node", "1"}}, "#/edits/0/frame: error: "},
        {{{"frame", 0}, {"edit", "hide"}}, "#/edits/0: error: has no member \"node\""},
        {{{"frame", 0}, {"edit", "hide"}, {"node", "1"}, {"scale", {1, 1, 1}}},
         "#/edits/0/scale: error: is no member of an edit \"hide\""},
        {{{"frame", 0}, {"edit", "move"}, {"node", "1"}}, "#/edits/0: error: has neither a translation"},
        {{{"frame", 0}, {"edit", "move"}, {"node", "1"}, {"translation", {1, 2}}},
         "#/edits/0/translation: error: has 2 numbers, not 3"},
        {{{"frame", 0}, {"edit", "move"}, {"node", "1"}, {"rotation", {1, 1, 0, 0}}},
         "#/edits/0/rotation: error: is no quaternion"},
        {{{"frame", 0}, {"edit", "light"}, {"node", "1"}}, "#/edits/0: error: has neither a color"},
        {{{"frame", 0}, {"edit", "light"}, {"node", "1"}, {"intensity", 1}},
         "#/edits/0/node: error: the node has no light"},
        {{{"frame", 0}, {"edit", "material"}, {"node", "Front"}, {"material", "0"}},
         "#/edits/0/node: error: the node has no mesh"},
        {{{"frame", 0}, {"edit", "material"}, {"node", "0"}, {"material", "Wal"}}, "did you mean Wall?"},
        {{{"frame", 0}, {"edit", "material"}, {"node", "0"}, {"material", "1"}, {"primitive", 1}},
         "#/edits/0/primitive: error: the mesh has 1 primitives"},
        {{{"frame", 0}, {"edit", "delete"}, {"node", "Fron"}}, "did you mean Front?"},
        {{{"frame", 0}, {"edit", "parent"}, {"node", "0"}, {"parent", "0"}}, "#/edits/0/parent: error: "},
        {{{"frame", 0}, {"edit", "variant"}, {"variant", "Day"}}, "[variant-unknown]"},
        {{{"frame", 0}, {"edit", "add"}, {"file", "missing.glb"}}, "missing.glb"},
    };
    for (const Bad& one : bad) {
        writeText(path("bad.json"), Json{{"edits", {one.edit}}}.dump());
        const Outcome outcome = render("x.exr", {"--edits", "bad.json"});
        EXPECT_EQ(outcome.exit, 1) << one.edit;
        EXPECT_TRUE(has(outcome.err, one.message)) << one.edit << "\n" << outcome.err;
        EXPECT_FALSE(std::filesystem::exists(path("x.exr"))) << one.edit;
    }
}

}  // namespace
}  // namespace glint::testing
