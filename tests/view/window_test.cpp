// Uses the window of glint view as a person does: keys, mouse moves and clicks go through an X server, and
// what it shows is read back from there. The validation layers are on, and any message of theirs fails the
// run.
#include "cli/command.h"
#include "cli/tiny_scene.h"
#include "image/image_file.h"
#include "settings/descriptor.h"
#include "view/virtual_screen.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::uint32_t kWidth = 320;
constexpr std::uint32_t kHeight = 180;

const VirtualScreen& screen() {
    static const VirtualScreen kScreen;
    return kScreen;
}

class WindowTest : public CommandTest {
protected:
    void SetUp() override {
        if (!screen().isRunning()) {
            GTEST_SKIP() << "no Xvfb (scripts/setup.sh --window installs it)";
        }
        CommandTest::SetUp();
    }

    // Runs the window with a script and fails the test unless it ends well.
    Outcome view(const std::string& script, const std::vector<std::string>& more = {}) const {
        writeText(path("script"), script);
        std::vector<std::string> words{"view", "scene.gltf", "--spp", "2", "--validate"};
        words.insert(words.end(), more.begin(), more.end());
        if (std::ranges::find(more, "--size") == more.end()) {
            words.insert(words.end(), {"--size", "320x180"});
        }
        Outcome outcome =
            must(runAs({GLINT_VIEW_SCRIPT, "script"}, words, {{"DISPLAY", screen().display()}}));
        return outcome;
    }
    Json report(const std::string& file) const {
        return Json::parse(readText(path(file)), nullptr, false);
    }
    LinearImage image(const std::string& file) const {
        const Result<LinearImage> read = image::readImage(path(file));
        EXPECT_TRUE(read.ok()) << file;
        return read ? *read : LinearImage{};
    }
};

// Values of a PNG that is `levels` of 255 away, in linear light, lie within this.
constexpr float kOneLevel = 0.01F;

// Returns the share of the pixels of the area that differ by more than a level of 8 bits. The images may be
// of different sizes; the area begins at the top left of both.
double shareDiffering(const LinearImage& a, const LinearImage& b, std::uint32_t left, std::uint32_t right,
                      std::uint32_t bottom) {
    std::size_t differing = 0;
    for (std::uint32_t y = 0; y < bottom; ++y) {
        for (std::uint32_t x = left; x < right; ++x) {
            const auto& p = a.pixels[std::size_t{y} * a.width + x];
            const auto& q = b.pixels[std::size_t{y} * b.width + x];
            bool differs = false;
            for (std::size_t i = 0; i < 3; ++i) {
                differs = differs || std::abs(p[i] - q[i]) > kOneLevel;
            }
            differing += differs ? 1 : 0;
        }
    }
    return static_cast<double>(differing) / (static_cast<double>(right - left) * bottom);
}

double shareDiffering(const LinearImage& a, const LinearImage& b) {
    return shareDiffering(a, b, 0, std::min(a.width, b.width), std::min(a.height, b.height));
}

// The picture is what `glint render` makes, the window shows it, and the command beside a screenshot makes it
// again, also from a camera that somebody has moved.
TEST_F(WindowTest, ShowsThePictureOfRender) {
    writeTinyScene(path(""));
    view(R"(
        wait complete
        picture window.png
        click Screenshot
        wait complete
        drag 100 60 150 75
        wheel 2
        hold w 0.2
        drag 200 60 205 62 2
        wait complete
        key p
        wait complete
        report moved.json
        quit
    )");
    const std::string search = fs::path(commandPath()).parent_path().string() + ":" + std::getenv("PATH");
    for (const std::string name : {"scene-001", "scene-002"}) {
        fs::rename(path(name + ".png"), path(name + "-shot.png"));
        const Outcome again = runProgram({"sh", name + ".sh"}, {{"PATH", search}});
        ASSERT_EQ(again.exit, 0) << readText(path(name + ".sh")) << again.err;
        const LinearImage shot = image(name + "-shot.png");
        ASSERT_EQ(shot.width, kWidth);
        ASSERT_EQ(shot.height, kHeight);
        EXPECT_EQ(shareDiffering(shot, image(name + ".png")), 0.0) << name;
    }
    const LinearImage window = image("window.png");
    ASSERT_GT(window.width, kWidth);
    EXPECT_EQ(shareDiffering(window, image("scene-001.png"), 0, kWidth, kHeight), 0.0);
    EXPECT_GT(shareDiffering(image("scene-001.png"), image("scene-002.png")), 0.3);
    EXPECT_TRUE(has(report("moved.json").at("camera"), "/")) << report("moved.json").at("camera");
}

// Returns steps that give a setting another value, and that value.
std::pair<std::string, std::string> touch(const compiler::Descriptor& row) {
    // Where the first other value is none for this scene or device.
    static const std::map<std::string, std::string, std::less<>> kValues{
        {"size", "300x170"},
        {"spp", "3"},
        {"ao-radius", "2"},
        {"strategy", "uber"},
        {"tracer", "ray-query"},
        {"precision", "32"},
        {"merge", "all"},
        {"seed", "5"},
        {"effects", "auto,shadow"},
        {"hit-lobes", "all"},
        {"alpha", "tested"},
        {"sky", "0.5"},
        {"max-shaders", "40"},
        {"bounces", "2"},
        {"ssr", "4"},
        {"lights", "2"},
        {"environment-rotation", ""},
        {"environment-intensity", ""},
    };
    const compiler::Settings usual;
    const std::string name(row.name);
    std::string value;
    const std::vector<compiler::SettingWord> words = wordsOf(row);
    if (const auto found = kValues.find(name); found != kValues.end()) {
        value = found->second;
    } else if (row.values.form == compiler::ValueForm::Switch) {
        value = row.values.text(usual) == "on" ? "off" : "on";
    } else if (!words.empty()) {
        value = std::ranges::find_if(words, [&](const compiler::SettingWord& word) {
                    return word.name != row.values.text(usual);
                })->name;
    } else {
        const double middle = std::min(row.values.max, std::max(row.values.min, 0.0) + 1.0);
        value = row.values.form == compiler::ValueForm::Whole || middle >= 1.0 ? "1" : "0.5";
        value = value == row.values.text(usual) ? "2" : value;
    }
    if (value.empty()) {
        return {"", row.values.text(usual)};
    }
    if (row.values.form == compiler::ValueForm::Switch) {
        return {"click " + name + "\n", value};
    }
    if (row.values.form == compiler::ValueForm::Text) {
        return {"enter " + name + " " + value + "\n", value};
    }
    const bool isWord = std::ranges::find(words, value, &compiler::SettingWord::name) != words.end();
    if (row.values.form == compiler::ValueForm::List && !isWord) {
        return {"choose " + name + " " + value.substr(value.rfind(',') + 1) + "\n", value};
    }
    if (isWord) {
        return {"choose " + name + " " + value + "\n", value};
    }
    if (words.empty()) {
        return {"number " + name + " " + value + "\n", value};
    }
    return {"click " + name + "\nenter " + name + "= " + value + "\n", value};
}

// Every control of the table is clicked or typed into. The first one is refused by the device, which lacks
// position fetch with the validation layers. So the packages that are compiled meanwhile make no pipelines,
// and what was shown stays, until all controls were touched.
TEST_F(WindowTest, EverySettingHasAControl) {
    writeTinyScene(path(""));
    std::string script = "wait complete\nclick position-fetch\nwait failed\n";
    std::map<std::string, std::string> expected;
    for (const compiler::Descriptor& row : compiler::settingsTable()) {
        const std::string name(row.name);
        if ((row.commands & compiler::kOfRender) == 0 || name == "size" || name == "position-fetch") {
            continue;
        }
        const auto [steps, value] = touch(row);
        script += steps;
        expected[name] = value;
    }
    script += R"(
        wait failed
        report failed.json
        click reset:position-fetch
        wait complete
        report all.json
        enter size 72x400
        wait complete
        report sized.json
        quit
    )";
    expected["position-fetch"] = "off";
    // A small window: most of the time goes into drawing the panel.
    view(script, {"--size", "64x420"});
    const Json failed = report("failed.json");
    EXPECT_TRUE(has(failed.at("error").get<std::string>(), "position-fetch")) << failed.at("error");
    EXPECT_EQ(failed.at("strategy"), "visibility");
    const Json all = report("all.json");
    EXPECT_TRUE(all.at("error").is_null()) << all.at("error");
    for (const auto& [name, value] : expected) {
        EXPECT_EQ(all.at("settings").at(name), value) << name;
    }
    EXPECT_EQ(all.at("strategy"), "uber");
    EXPECT_EQ(all.at("samples"), 3);
    const Json sized = report("sized.json");
    EXPECT_EQ(sized.at("width"), 72);
    EXPECT_EQ(sized.at("height"), 400);
}

TEST_F(WindowTest, PanelsKeysAndTheWindowItself) {
    writeTinyScene(path(""), {.animated = true});
    fs::create_directories(path("other"));
    writeTinyScene(path("other"), {.masked = true});
    view(R"(
        wait complete
        # a pixel of the floor
        click 160 140
        wait control tab Pixel
        report pick.json
        click tab Passes
        wait complete
        report passes.json
        click tab Scene
        click memory of the scene
        click memory of a frame
        click tab Messages
        click Copy all
        click Clear
        click Help
        report help.json
        picture help.png
        key Escape
        # the window
        key Tab
        wait complete
        report wide.json
        key Tab
        size 700 400
        wait complete
        report large.json
        minimise
        pause 0.3
        report minimised.json
        restore
        size 760 206
        wait complete
        key m
        wait complete
        report half.json
        key m m m
        size 640 606
        wait complete
        # the camera
        key c
        wait complete
        key f
        drag 100 60 120 65
        report flies.json
        key f Home
        wait complete
        key bracketright
        click exposure auto
        wait complete
        # the animation
        click Play
        wait control Rest
        pause 0.4
        key space
        wait complete
        report moved.json
        number time 0.5
        wait complete
        picture moved.png
        key p
        wait complete
        click Rest
        wait complete
        picture rest.png
        # A and B
        key b
        wait complete
        click tab Settings
        choose effects none
        number skip-below 0.5
        wait complete
        click Measure
        report compare.json
        click show A
        picture a.png
        click show B
        picture b.png
        click show difference
        number gain 16
        picture difference.png
        click show A|B
        move 10 10
        picture wipe.png
        drag 100 60 40 60
        picture wiped.png
        click edit A
        click Compare
        # strategies by their keys
        key 3
        wait complete
        report third.json
        # files
        drop other/scene.gltf
        wait complete
        report dropped.json
        drop missing.gltf
        wait failed
        report missing.json
        drop script
        wait failed
        report refused.json
        key ctrl+q
    )");
    const Json pick = report("pick.json").at("pick").at("fields");
    EXPECT_EQ(pick.at("material"), "0: Floor");
    EXPECT_EQ(pick.at("primitive"), "/meshes/0/primitives/0");
    EXPECT_TRUE(has(pick.at("bucket"), "hits of case")) << pick;
    EXPECT_TRUE(pick.contains("why") && pick.contains("key") && pick.contains("cost by the model")) << pick;
    EXPECT_TRUE(pick.contains("rays of reflection")) << pick;
    const Json passes = report("passes.json").at("passes");
    for (const char* const pass : {"gbuffer", "first count", "compose"}) {
        EXPECT_TRUE(passes.contains(pass)) << passes;
    }
    EXPECT_TRUE(report("help.json").at("help"));
    EXPECT_EQ(report("wide.json").at("width"), kWidth + 440);
    EXPECT_EQ(report("large.json").at("width"), 260);
    EXPECT_EQ(report("large.json").at("height"), 374);
    EXPECT_EQ(report("half.json").at("width"), kWidth / 2);
    EXPECT_TRUE(report("flies.json").at("flies"));
    EXPECT_GT(report("moved.json").at("time"), 0.0);
    EXPECT_EQ(report("moved.json").at("samples"), 2);
    // A picture that is higher than wide, for room in the panel.
    constexpr std::uint32_t kNarrow = 200;
    constexpr std::uint32_t kHigh = 580;
    EXPECT_GT(shareDiffering(image("moved.png"), image("rest.png"), 0, kNarrow, kHigh), 0.02);

    // The command beside a screenshot makes the moment of the animation again.
    const std::string search = fs::path(commandPath()).parent_path().string() + ":" + std::getenv("PATH");
    fs::rename(path("scene-001.png"), path("shot.png"));
    const Outcome again = runProgram({"sh", "scene-001.sh"}, {{"PATH", search}});
    ASSERT_EQ(again.exit, 0) << readText(path("scene-001.sh")) << again.err;
    EXPECT_EQ(shareDiffering(image("shot.png"), image("scene-001.png")), 0.0);

    EXPECT_TRUE(has(report("compare.json").at("difference"), "FLIP")) << report("compare.json");
    const LinearImage a = image("a.png");
    const LinearImage b = image("b.png");
    // The floor, which is a mirror in A alone, is small from the camera that frames everything.
    EXPECT_GT(shareDiffering(a, b, 0, kNarrow, kHigh), 0.03);
    // Labels and the border are over the picture.
    const LinearImage wipe = image("wipe.png");
    EXPECT_LT(shareDiffering(wipe, a, 0, kNarrow / 2 - 24, kHigh), 0.02);
    EXPECT_LT(shareDiffering(wipe, b, kNarrow / 2 + 24, kNarrow, kHigh), 0.02);
    EXPECT_LT(shareDiffering(image("wiped.png"), b, 70, kNarrow, kHigh), 0.02);
    EXPECT_GT(shareDiffering(image("difference.png"), a, 0, kNarrow, kHigh), 0.5);

    EXPECT_EQ(report("third.json").at("strategy"), "sorted-uber");
    EXPECT_FALSE(report("third.json").at("compares"));
    EXPECT_EQ(report("dropped.json").at("scene"), "other/scene.gltf");
    EXPECT_TRUE(report("dropped.json").at("error").is_null());
    EXPECT_TRUE(has(report("missing.json").at("error").get<std::string>(), "missing.gltf"));
    EXPECT_EQ(report("missing.json").at("scene"), "other/scene.gltf");
    EXPECT_TRUE(has(report("refused.json").at("error").get<std::string>(), "window-drop"));
}

// Views and layers are shown in place of the picture: those of `glint render`, to the pixel. The packages
// lack their layers until they are chosen.
TEST_F(WindowTest, ShowsViewsAndLayers) {
    writeTinyScene(path(""));
    view(R"(
        wait complete
        picture before.png
        key l
        click view material
        wait complete
        picture material.png
        report material.json
        key p
        wait complete
        click view reflection.hit-distance
        wait complete
        report distance.json
        click layer depth
        wait complete
        picture depth.png
        report depth.json
        key p
        wait complete
        # moves under the camera
        drag 100 60 130 70
        wait complete
        picture moved.png
        key l
        wait complete
        report after.json
        quit
    )",
         {"--size", "160x400"});
    const std::string search = fs::path(commandPath()).parent_path().string() + ":" + std::getenv("PATH");
    constexpr std::uint32_t kSide = 160;
    constexpr std::uint32_t kHigh = 400;
    const Json material = report("material.json");
    EXPECT_EQ(material.at("look"), "material");
    EXPECT_EQ(material.at("settings").at("layers"), "material");
    EXPECT_EQ(material.at("view").at("categories").size(), 3U) << material.at("view");
    // The view is below its label, and the file of the screenshot has its legend below it.
    fs::rename(path("scene-001.png"), path("shot.png"));
    const Outcome again = runProgram({"sh", "scene-001.sh"}, {{"PATH", search}});
    ASSERT_EQ(again.exit, 0) << readText(path("scene-001.sh")) << again.err;
    const LinearImage rendered = image("scene-001.png");
    EXPECT_GT(rendered.height, kHigh);
    EXPECT_EQ(shareDiffering(image("shot.png"), rendered), 0.0);
    EXPECT_LT(shareDiffering(image("material.png"), rendered, 0, kSide, kHigh), 0.04);
    EXPECT_GT(shareDiffering(image("material.png"), image("before.png"), 0, kSide, kHigh), 0.5);

    EXPECT_EQ(report("distance.json").at("lookNote"), "");
    EXPECT_GT(report("distance.json").at("view").at("numbers"), 0);
    const Json depth = report("depth.json");
    EXPECT_EQ(depth.at("look"), "depth");
    EXPECT_NEAR(depth.at("view").at("greatest").get<double>(), 6.0, 0.01);  // the wall
    EXPECT_GT(shareDiffering(image("depth.png"), image("moved.png"), 0, kSide, kHigh), 0.1);
    // The layer is in an OpenEXR file.
    EXPECT_TRUE(has(readText(path("scene-002.sh")), "--layers depth")) << readText(path("scene-002.sh"));
    fs::rename(path("scene-002.exr"), path("shot.exr"));
    must(runProgram({"sh", "scene-002.sh"}, {{"PATH", search}}));
    EXPECT_TRUE(has(readText(path("shot.exr")), "depth.Z"));
    EXPECT_EQ(readText(path("shot.exr")), readText(path("scene-002.exr")));
    EXPECT_EQ(report("after.json").at("look"), "");
    EXPECT_TRUE(report("after.json").at("error").is_null());
}

// Each view and layer of the list is shown, from a package that has all layers.
TEST_F(WindowTest, ShowsEveryViewAndLayer) {
    writeTinyScene(path(""));
    view("wait complete\nreport list.json\nquit\n", {"--size", "100x400"});
    std::string script = "wait complete\nkey l\n";
    std::string layers;
    const std::vector<std::string> looks = report("list.json").at("looks");
    for (std::size_t i = 0; i < looks.size(); ++i) {
        script += "click " + looks[i] + "\nwait complete\nreport " + std::to_string(i) + ".json\n";
        if (looks[i].starts_with("layer ")) {
            layers += (layers.empty() ? "" : ",") + looks[i].substr(looks[i].find(' ') + 1);
        }
    }
    view(script + "quit\n", {"--size", "100x400", "--layers", layers});
    EXPECT_GT(looks.size(), 40U);
    for (std::size_t i = 0; i < looks.size(); ++i) {
        const Json shown = report(std::to_string(i) + ".json");
        EXPECT_EQ(shown.at("look"), looks[i].substr(looks[i].find(' ') + 1));
        EXPECT_EQ(shown.at("lookNote"), "") << looks[i];
        EXPECT_FALSE(shown.at("view").is_null()) << looks[i];
        EXPECT_TRUE(shown.at("error").is_null()) << shown.at("error");
    }
}

// A scene and a pack change under the window. What does not compile leaves the picture as it was.
TEST_F(WindowTest, FollowsFilesThatChange) {
    const fs::path scene = writeTinyScene(path(""));
    addMud(scene, 0.8);
    writeMudPack(path("pack"), 0.5);
    writeText(path("good.glsl"), readText(path("pack/mud.glsl")));
    writeText(path("bad.glsl"),
              "void mudSurface(Hit hit, Features features, inout SurfaceValues values) {\n    oops();\n}\n");
    writeMudPack(path("dark"), 0.1);
    fs::create_directories(path("later"));
    fs::copy_file(scene, path("later/scene.gltf"));
    addMud(path("later/scene.gltf"), 0.2);
    view(R"(
        wait complete
        picture first.png
        copy dark/mud.glsl pack/mud.glsl
        pause 0.5
        wait complete
        picture dark.png
        report dark.json
        copy bad.glsl pack/mud.glsl
        wait failed
        picture bad.png
        report bad.json
        copy good.glsl pack/mud.glsl
        pause 0.5
        wait complete
        picture good.png
        report good.json
        copy later/scene.gltf scene.gltf
        pause 0.5
        wait complete
        picture later.png
        quit
    )",
         {"--materials", "pack"});
    const LinearImage first = image("first.png");
    EXPECT_GT(shareDiffering(first, image("dark.png"), 0, kWidth, kHeight), 0.05);
    EXPECT_TRUE(has(report("dark.json").at("lastChange"), "package replaced")) << report("dark.json");
    const std::string error = report("bad.json").at("error").get<std::string>();
    EXPECT_TRUE(has(error, "mud.glsl:2")) << error;
    EXPECT_EQ(shareDiffering(image("bad.png"), image("dark.png"), 0, kWidth, kHeight), 0.0);
    EXPECT_TRUE(report("good.json").at("error").is_null());
    EXPECT_LT(shareDiffering(first, image("good.png"), 0, kWidth, kHeight), 0.01);
    EXPECT_GT(shareDiffering(first, image("later.png"), 0, kWidth, kHeight), 0.05);
}

// The first frames have the coarse levels of a texture. Those that follow make the picture of `glint render`,
// but for the rounding of levels that the device makes there.
TEST_F(WindowTest, FinerLevelsOfTexturesFollow) {
    const fs::path scene = writeTinyScene(path(""));
    constexpr std::uint32_t kTexels = 256;
    image::DisplayImage noise{kTexels, kTexels, {}};
    for (std::uint32_t i = 0; i < kTexels * kTexels; ++i) {
        const auto value = static_cast<std::uint8_t>(i * 2654435761U >> 24U);
        noise.pixels.push_back({value, static_cast<std::uint8_t>(255 - value), 90});
    }
    ASSERT_TRUE(image::writeImage(path("noise.png"), noise));
    Json gltf = Json::parse(readText(scene));
    // Texture coordinates of the wall are X and Y of its positions.
    Json positions = gltf["bufferViews"][3];
    positions["byteStride"] = 12;
    gltf["bufferViews"].push_back(positions);
    gltf["accessors"].push_back({{"bufferView", gltf["bufferViews"].size() - 1},
                                 {"componentType", 5126},
                                 {"count", 4},
                                 {"type", "VEC2"}});
    gltf["meshes"][1]["primitives"][0]["attributes"]["TEXCOORD_0"] = gltf["accessors"].size() - 1;
    gltf["images"] = {{{"uri", "noise.png"}}};
    gltf["textures"] = {{{"source", 0}}};
    gltf["materials"][1]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    writeText(scene, gltf.dump());
    const Outcome outcome = view(R"(
        wait complete
        report done.json
        key p
        wait complete
        quit
    )",
                                 {"--verbose"});
    EXPECT_TRUE(has(outcome.out + outcome.err, "all levels of the textures")) << outcome.err;
    EXPECT_EQ(report("done.json").at("missingLevels"), 0);
    const std::string search = fs::path(commandPath()).parent_path().string() + ":" + std::getenv("PATH");
    fs::rename(path("scene-001.png"), path("shot.png"));
    must(runProgram({"sh", "scene-001.sh"}, {{"PATH", search}}));
    EXPECT_LT(shareDiffering(image("shot.png"), image("scene-001.png")), 0.02);
}

// Nodes are edited while an animation plays. The command beside a screenshot makes the same edits with
// `glint render --edits`, and the same picture. The window fits the screen, which is 1280 x 1000.
TEST_F(WindowTest, EditsNodesWhileAnAnimationPlays) {
    const fs::path scene = writeTinyScene(path(""), {.animated = true});
    fs::create_directories(path("other"));
    writeTinyScene(path("other"), {.camera = false});
    Json gltf = Json::parse(readText(scene));
    gltf["nodes"][0]["name"] = "Ground";
    gltf["nodes"][1]["name"] = "Screen";
    writeText(scene, gltf.dump());
    view(R"(
        wait complete
        report size.json
        size 800 640
        key m m m
        click Play
        click tab Nodes
        click node Screen
        click Duplicate
        click node Screen copy
        number node.place.x 0.5
        number node.scale.y 0.5
        wait control node Screen
        click node Screen
        click Hide
        wait control Show
        click node Ground
        choose node.material Wall
        pause 0.5
        drop other/scene.gltf
        wait control node scene
        click node scene
        number node.place.y 1
        number node.scale.x 0.25
        wait frames 4
        key space
        wait complete
        number time 0.5
        wait complete
        report edited.json
        picture window.png
        key p
        wait complete
        click node scene
        click Delete
        wait complete
        report deleted.json
        picture deleted.png
        quit
    )",
         {"--size", "1500x700", "--sky", "1"});
    EXPECT_EQ(report("size.json").at("width"), 1280 - 440);
    EXPECT_TRUE(report("edited.json").at("error").is_null()) << report("edited.json").at("error");
    EXPECT_TRUE(report("deleted.json").at("error").is_null()) << report("deleted.json").at("error");
    const std::string search = fs::path(commandPath()).parent_path().string() + ":" + std::getenv("PATH");
    fs::rename(path("scene-001.png"), path("shot.png"));
    const Outcome again = runProgram({"sh", "scene-001.sh"}, {{"PATH", search}});
    ASSERT_EQ(again.exit, 0) << readText(path("scene-001.sh")) << again.err;
    EXPECT_EQ(shareDiffering(image("shot.png"), image("scene-001.png")), 0.0)
        << readText(path("scene-001.edits.json"));
    EXPECT_GT(shareDiffering(image("window.png"), image("deleted.png"), 0, 300, 600), 0.002);
}

TEST_F(WindowTest, RefusesWhatItCantDo) {
    writeTinyScene(path(""));
    writeText(path("script"), "wait complete\nfly to the moon\n");
    const std::vector<std::pair<std::string, std::string>> variables{{"DISPLAY", screen().display()}};
    const Outcome script =
        runProgram({GLINT_VIEW_SCRIPT, "script", "view", "scene.gltf", "--size", "32x18"}, variables);
    EXPECT_EQ(script.exit, 1);
    EXPECT_TRUE(has(script.err, "script:2: error: is no step of a script: fly")) << script.err;
    const Outcome missing = run({"view", "none.gltf"}, variables);
    EXPECT_EQ(missing.exit, 1);
    EXPECT_TRUE(has(missing.err, "none.gltf")) << missing.err;
    const Outcome blind = run({"view", "scene.gltf"}, {{"DISPLAY", ":no"}});
    EXPECT_EQ(blind.exit, 1);
    EXPECT_TRUE(has(blind.err, "[window-open]")) << blind.err;
    EXPECT_EQ(run({"view", "scene.gltf", "--spp", "0"}, variables).exit, 2);
}

}  // namespace
}  // namespace glint::testing
