#include "page/sample_settings.h"

#include <string>

namespace glint::testing {

using Json = nlohmann::ordered_json;

const std::vector<Setting>& sampleSettings() {
    static const std::vector<Setting> kSettings{
        {"spp",
         "render",
         true,
         "samples per pixel",
         2,
         {{"1", 0.26, 4.1},
          {"2", 0.51, 2.0},
          {"4", 1, 1},
          {"8", 2.0, 0.5},
          {"16", 4.0, 0.26},
          {"32", 8.1, 0.14}}},
        {"texture-lod",
         "compile",
         true,
         "levels of textures of hits",
         0,
         {{"cones", 1, 1}, {"mip0", 1.12, 0.97}}},
        {"hit-record", "compile", true, "bytes of a hit", 0, {{"full", 1, 1}, {"packed", 0.985, 1.001}}},
        {"ssr",
         "render",
         true,
         "steps of screen-space reflections",
         0,
         {{"off", 1, 1}, {"8", 0.83, 1.7}, {"16", 0.88, 1.45}, {"32", 0.97, 1.3}}},
        {"shadow-samples",
         "render",
         true,
         "shadow rays of a light",
         0,
         {{"1", 1, 1}, {"2", 1.3, 0.83}, {"4", 1.85, 0.74}}},
        {"alpha", "compile", true, "whether hits test alpha", 1, {{"opaque", 0.93, 2.4}, {"tested", 1, 1}}},
        {"hit-lobes", "compile", true, "lobes that hits keep", 0, {{"all", 1, 1}, {"base", 0.86, 1.9}}},
        {"multi-scatter", "compile", true, "energy compensation", 0, {{"on", 1, 1}, {"off", 0.97, 1.35}}},
        {"precision",
         "compile",
         true,
         "bits of shading",
         0,
         {{"32", 1, 1}, {"16", 1, 1, "the device has no 16-bit arithmetic"}}},
        {"merge",
         "compile",
         false,
         "which materials share a case",
         3,
         {{"none", 1.02, 1}, {"family", 0.99, 1}, {"all", 1.21, 1}, {"auto", 1, 1}}},
        {"strategy",
         "compile",
         false,
         "how hits are shaded",
         1,
         {{"uber", 1.18, 1},
          {"visibility", 1, 1},
          {"sorted-uber", 1.09, 1},
          {"hit-shaders", 1, 1, "the device has no ray tracing pipelines"}}},
        {"ordering",
         "render",
         false,
         "how hits are ordered",
         0,
         {{"atomics", 1, 1},
          {"wave-loop", 1.01, 1},
          {"wave-ballot", 0.996, 1},
          {"local-histogram", 0.99, 1}}},
        {"binning",
         "render",
         false,
         "order of rays by direction",
         0,
         {{"none", 1, 1}, {"sign", 1.05, 1}, {"octahedral", 1.08, 1}}},
        {"max-roughness",
         "render",
         true,
         "roughest surface that reflects",
         1,
         {{"0.2", 0.71, 3.0}, {"0.4", 1, 1}, {"0.7", 1.24, 0.8}, {"1", 1.36, 0.71}}},
        {"bounces",
         "compile",
         true,
         "the most bounces of a path",
         0,
         {{"1", 1, 1}, {"2", 1.3, 0.8}, {"4", 1.6, 0.7}, {"unlimited", 1.9, 0.66}}},
        {"lights",
         "compile",
         true,
         "lights that a surface chooses",
         0,
         {{"all", 1, 1}, {"1", 0.4, 5.0}, {"4", 0.6, 2.2}, {"16", 0.9, 1.3}}},
        {"skip-below",
         "render",
         true,
         "samples too faint for a ray",
         0,
         {{"0", 1, 1}, {"0.01", 0.94, 1.02}, {"0.1", 0.81, 1.6}}},
    };
    return kSettings;
}

Json sampleSettingsJson() {
    Json list = Json::array();
    for (const Setting& setting : sampleSettings()) {
        Json values = Json::array();
        Json skipped = Json::array();
        for (const Value& value : setting.values) {
            if (value.skipped == nullptr) {
                values.push_back(value.name);
            } else {
                skipped.push_back({{"value", value.name}, {"reason", value.skipped}});
            }
        }
        list.push_back({{"name", setting.name},
                        {"option", std::string("--") + setting.name},
                        {"stage", setting.stage},
                        {"approximates", setting.approximates},
                        {"what", setting.what},
                        {"default", setting.values[setting.defaultValue].name},
                        {"values", values},
                        {"skipped", skipped}});
    }
    list.push_back({{"name", "max-interfaces"},
                    {"option", "--max-interfaces"},
                    {"stage", "render"},
                    {"approximates", true},
                    {"what", "the most surfaces that a refracted ray meets"},
                    {"default", "8"},
                    {"values", {"8"}},
                    {"skipped",
                     {{{"value", "2"}, {"reason", "nothing refracts"}},
                      {{"value", "16"}, {"reason", "nothing refracts"}}}}});
    return list;
}

}  // namespace glint::testing
