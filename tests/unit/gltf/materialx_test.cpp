// MaterialX files, which become lists of materials.
#include "gltf/import.h"
#include "materials/declarations.h"
#include "support/must.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

namespace {

using namespace glint;

class MaterialX : public ::testing::Test {
protected:
    static const materials::MaterialModel* pack() {
        static const Result<const materials::MaterialModel*> model = materials::loadMaterialModel(
            std::vector<std::string>{GLINT_SOURCE_DIR "/examples/materials/openpbr"});
        return model ? *model : nullptr;
    }
    Result<gltf::Scene> read(const std::string& document, bool withPack = true) {
        std::ofstream(folder_.path() / "surface.mtlx") << "<?xml version=\"1.0\"?>" + document;
        gltf::ImportOptions options;
        options.materialModel = withPack ? pack() : options.materialModel;
        return gltf::importScene(folder_.path() / "surface.mtlx", options);
    }
    // A document with one surface of OpenPBR, and what stands beside it.
    Result<gltf::Scene> readOpenPbr(const std::string& inputs, const std::string& beside = "") {
        return read("<materialx version=\"1.39\">" + beside + "<open_pbr_surface name=\"s\">" + inputs +
                    "</open_pbr_surface></materialx>");
    }
    // Returns the place below the file and the message of the error.
    std::string refusal(const Result<gltf::Scene>& scene) {
        if (scene) {
            return "accepted";
        }
        EXPECT_EQ(scene.error().id, "materialx");
        const std::size_t place = scene.error().where.find('#');
        return (place == std::string::npos ? "" : scene.error().where.substr(place + 1)) + ": " +
               scene.error().message;
    }
    static void expectNear(const materials::Material& material, const char* name,
                           std::vector<double> expected) {
        for (std::size_t i = 0; i < expected.size(); ++i) {
            EXPECT_NEAR(material[name][i], expected[i], 1e-5) << name << " " << i;
        }
    }

    test::TemporaryFolder folder_;
};

TEST_F(MaterialX, OpenPbrHasItsConstants) {
    const gltf::Scene scene = must(readOpenPbr(
        R"(<input name="base_color" type="color3" value="0.2, 0.4,0.6"/>
           <input name="coat_weight" type="float" value="0.5"/>
           <input name="geometry_opacity" type="float" value="0.25"/>
           <input name="geometry_thin_walled" type="boolean" value="true"/>
           <input name="transmission_color" type="color3" nodegraph="g" output="o"/>
           <input name="specular_color" type="color3" value="0.5, 0.5, 0.5" colorspace="srgb_texture"/>)",
        R"(<surfacematerial name="Paint" type="material"/>
           <nodegraph name="g"><constant name="c" type="color3">
             <input name="value" type="color3" value="1, 0.5, 0.25"/></constant>
             <output name="o" type="color3" nodename="c"/></nodegraph>)"));
    EXPECT_TRUE(scene.warnings.empty()) << toString(scene.warnings.front());
    ASSERT_EQ(scene.materials.size(), 1U);
    const materials::Material& material = scene.materials[0];
    EXPECT_EQ(material.name, "Paint");
    EXPECT_TRUE(material.gives("EXAMPLE_materials_openpbr"));
    expectNear(material, "baseColorFactor", {0.2, 0.4, 0.6, 1.0});
    expectNear(material, "coatWeight", {0.5});
    expectNear(material, "transmissionColor", {1.0, 0.5, 0.25});
    expectNear(material, "specularColor", {0.21404, 0.21404, 0.21404});
    expectNear(material, "geometryThinWalled", {1.0});
    EXPECT_TRUE(material.doubleSided);
    EXPECT_EQ(material.alphaMode, materials::AlphaMode::Blend);
    // Other parameters have the specification's defaults.
    expectNear(material, "roughnessFactor", {0.3});
    expectNear(material, "metallicFactor", {0.0});
    expectNear(material, "emissiveStrength", {0.0});
}

// White has the same numbers in both spaces, and red of ACEScg is beyond that of Rec. 709.
TEST_F(MaterialX, ColoursAreInRec709) {
    const gltf::Scene scene = must(read(R"(<materialx colorspace="acescg"><open_pbr_surface name="s">
               <input name="base_color" type="color3" value="0.5, 0.5, 0.5"/>
               <input name="coat_color" type="color3" value="0.2, 0.1, 0.1"/></open_pbr_surface></materialx>)"));
    expectNear(scene.materials[0], "baseColorFactor", {0.5, 0.5, 0.5});
    expectNear(scene.materials[0], "coatColor", {0.270505, 0.086973, 0.0976});
}

// The published translation, with numbers worked out by hand.
TEST_F(MaterialX, StandardSurfaceIsTranslated) {
    const gltf::Scene scene = must(read(
        R"(<materialx><standard_surface name="s">
           <input name="base" type="float" value="0.5"/>
           <input name="base_color" type="color3" value="0.8, 0.6, 0.4"/>
           <input name="coat" type="float" value="0.5"/>
           <input name="coat_color" type="color3" value="0.5, 1, 1"/>
           <input name="sheen_roughness" type="float" value="0.5"/>
           <input name="thin_film_thickness" type="float" value="400"/>
           <input name="emission" type="float" value="2"/>
           <input name="opacity" type="color3" value="1, 1, 1"/></standard_surface></materialx>)"));
    const materials::Material& material = scene.materials[0];
    expectNear(material, "baseWeight", {0.5});
    expectNear(material, "baseColorFactor", {0.6, 0.6, 0.4, 1.0});
    expectNear(material, "coatWeight", {0.5});
    expectNear(material, "coatDarkening", {0.0});
    expectNear(material, "coatRoughness", {0.1});
    expectNear(material, "roughnessFactor", {0.2});
    expectNear(material, "fuzzRoughness", {std::pow(0.5, 0.4)});
    expectNear(material, "thinFilmWeight", {1.0});
    expectNear(material, "thinFilmThickness", {0.4});
    expectNear(material, "emissiveStrength", {2.0});
    EXPECT_EQ(material.alphaMode, materials::AlphaMode::Opaque);
    EXPECT_FALSE(material.doubleSided);
}

TEST_F(MaterialX, ImagesFillTheTexturesOfThePack) {
    const gltf::Scene scene = must(readOpenPbr(
        R"(<input name="base_color" type="color3" nodename="wood"/>
           <input name="specular_roughness" type="float" nodename="rough"/>)",
        R"(<tiledimage name="wood" type="color3" fileprefix="maps/">
             <input name="file" type="filename" value="wood.png" colorspace="srgb_texture"/>
             <input name="uvtiling" type="vector2" value="2, 4"/></tiledimage>
           <image name="rough" type="float"><input name="file" type="filename" value="rough.png"/></image>)"));
    const materials::Material& material = scene.materials[0];
    EXPECT_GE(material.texture("baseColorTexture").texture, 0);
    EXPECT_GE(material.texture("metallicRoughnessTexture").texture, 0);
    expectNear(material, "baseColorFactor", {1.0, 1.0, 1.0, 1.0});
    expectNear(material, "roughnessFactor", {1.0});
    EXPECT_EQ(material.texture("baseColorTexture").transform.scale[1], 4.0F);
    EXPECT_EQ(material.texture("baseColorTexture").transform.offset[1], -3.0F);
}

TEST_F(MaterialX, OtherFilesAreRefusedByName) {
    EXPECT_EQ(refusal(read("<materialx><standard_surface/><open_pbr_surface/></materialx>")),
              ": has 2 surfaces; one open_pbr_surface or standard_surface is read");
    EXPECT_NE(refusal(read("<materialx><standard_surface>")).find("is no XML"), std::string::npos);
    EXPECT_EQ(refusal(read("<materialx><open_pbr_surface/></materialx>", false)),
              ": needs the model openPbr, which no pack declares");
    EXPECT_EQ(
        refusal(readOpenPbr(R"(<input name="coat_wight" type="float" value="1"/>)")),
        "s/coat_wight: no input of the model openPbr is called \"coat_wight\"; did you mean coat_weight?");
    EXPECT_EQ(refusal(readOpenPbr(R"(<input name="coat_weight" type="color3" value="1, 1, 1"/>)")),
              "s/coat_weight: has 3 numbers; the input needs 1");
    EXPECT_EQ(refusal(readOpenPbr(R"(<input name="coat_weight" type="float" value="much"/>)")),
              "s/coat_weight: \"much\" is no value of the type float");
    EXPECT_EQ(
        refusal(readOpenPbr(R"(<input name="coat_weight" type="float" nodename="n"/>)",
                            R"(<noise2d name="n" type="float"/>)")),
        "s/coat_weight: comes from n, a node of the kind noise2d; constant, image and tiledimage are read");
    EXPECT_EQ(refusal(readOpenPbr(R"(<input name="coat_weight" type="float" nodename="n"/>)")),
              "s/coat_weight: is connected to a node that is not there");
    const std::string image =
        R"(<image name="n" type="float"><input name="file" type="filename" value="a.png"/></image>)";
    EXPECT_NE(refusal(readOpenPbr(R"(<input name="coat_weight" type="float" nodename="n"/>)", image))
                  .find("s/coat_weight: has an image"),
              std::string::npos);
    EXPECT_NE(refusal(readOpenPbr(R"(<input name="specular_roughness" type="float" nodename="n"/>
                                     <input name="base_metalness" type="float" value="1"/>)",
                                  image))
                  .find("where base_metalness is 0"),
              std::string::npos);
    EXPECT_NE(refusal(readOpenPbr(R"(<input name="base_color" type="color3" nodename="n"/>)", image))
                  .find("is not in srgb_texture"),
              std::string::npos);
    EXPECT_NE(
        refusal(readOpenPbr(R"(<input name="base_color" type="color3" value="1,1,1" colorspace="p3"/>)"))
            .find("colour space p3"),
        std::string::npos);
}

}  // namespace
