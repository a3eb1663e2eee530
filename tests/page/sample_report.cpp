#include "page/sample_report.h"

#include "image/png.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace glint::testing {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kWidth = 96;
constexpr std::uint32_t kHeight = 54;

// What a value of a setting does to time and to error, as factors.
struct Value {
    const char* name;
    double time;
    double error;
    const char* skipped = nullptr;
};
struct Setting {
    const char* name;
    const char* stage;
    bool approximates;
    const char* what;
    std::size_t defaultValue;
    std::vector<Value> values;
};

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
        {"skip-below",
         "render",
         true,
         "samples too faint for a ray",
         0,
         {{"0", 1, 1}, {"0.01", 0.94, 1.02}, {"0.1", 0.81, 1.6}}},
    };
    return kSettings;
}

using Chosen = std::map<std::string, std::string>;

class Maker {
public:
    SamplePage make();

private:
    double jitter(double spread) {
        return 1.0 + spread * (static_cast<double>(random_() >> 8U) / 8388608.0 - 1.0);
    }
    Json interval(double value, double spread) {
        const double median = value * jitter(spread * 0.5);
        return {{"median", median},
                {"low", median * (1.0 - spread)},
                {"high", median * (1.0 + spread)},
                {"q1", median * (1.0 - spread / 2.0)},
                {"q3", median * (1.0 + spread / 2.0)}};
    }
    void addPoint(const std::string& kind, const Chosen& chosen);
    void addErrors(Json& point, double factor);
    void addPasses(Json& point, double time) const;
    void addImages(Json& point);
    void addSingles();
    void addCombinations();
    void markFront();

    std::minstd_rand random_{11};
    SamplePage page_;
};

Bytes samplePng(double error, bool map) {
    DisplayImage image{kWidth, kHeight, {}};
    std::minstd_rand random(5);
    for (std::uint32_t y = 0; y < kHeight; ++y) {
        for (std::uint32_t x = 0; x < kWidth; ++x) {
            const double noise =
                (static_cast<double>(random() >> 8U) / 4194304.0 - 1.0) * std::min(0.5, error);
            const bool ball = std::hypot(x - 40.0, y - 30.0) < 16.0;
            const double shade =
                map ? std::abs(noise) * 2.0 : 0.35 + 0.4 * y / kHeight + (ball ? 0.2 : 0.0) + noise;
            const auto level = static_cast<std::uint8_t>(std::clamp(shade, 0.0, 1.0) * 255.0);
            image.pixels.push_back({level, static_cast<std::uint8_t>(map ? level / 3 : level),
                                    static_cast<std::uint8_t>(ball && !map ? level / 2 : level)});
        }
    }
    return *encodePng(image, "sample.png");
}

void Maker::addErrors(Json& point, double factor) {
    const double relMse = 0.0042 * factor;
    const double rmse = std::sqrt(relMse) * 0.61;
    Json bias{{"mean", 0.004 * (factor - 1.0)},
              {"low", 0.004 * (factor - 1.0) - 0.002},
              {"high", 0.004 * (factor - 1.0) + 0.002}};
    Json psnr = interval(-20.0 * std::log10(rmse), 0.01);
    // A picture that happens to be exact in one measure.
    if (point.at("id") == 7) {
        psnr = nullptr;
    }
    point["error"] = {{"relMse", interval(relMse, 0.06)},
                      {"rmse", interval(rmse, 0.03)},
                      {"psnr", psnr},
                      {"p999", interval(std::sqrt(relMse) * 9.0, 0.1)},
                      {"flip", interval(std::sqrt(relMse) * 0.9, 0.04)},
                      {"bias", bias}};
    if (factor == 1.0 && point.at("id") != 0) {
        point["error"] = page_.report["points"][0]["error"];
    }
    point["errorTie"] = std::abs(factor - 1.0) < 0.06;
    point["sameImage"] = factor == 1.0;
}

void Maker::addPasses(Json& point, double time) const {
    const std::pair<const char*, double> shares[] = {
        {"gbuffer", 0.08}, {"lighting", 0.22},   {"reflection rays", 0.05},
        {"trace", 0.31},   {"count", 0.015},     {"offset", 0.005},
        {"copy", 0.02},    {"shade miss", 0.01}, {"shade 0", 0.12},
        {"shade 1", 0.07}, {"shade 2", 0.04},    {"compose", 0.06}};
    point["passes"] = Json::array();
    for (const auto& [name, share] : shares) {
        const double median = time * share;
        point["passes"].push_back(
            {{"name", name}, {"median", median}, {"q1", median * 0.98}, {"q3", median * 1.03}});
    }
}

void Maker::addImages(Json& point) {
    const double error = std::sqrt(point.at("error").at("relMse").at("median").get<double>()) * 2.0;
    const std::string number = std::to_string(1000 + point.at("id").get<int>()).substr(1);
    for (const bool map : {false, true}) {
        std::string name = "images/" + number + (map ? "_error.png" : ".png");
        point[map ? "errorImage" : "image"] = name;
        page_.images.push_back({std::move(name), samplePng(error, map)});
    }
}

void Maker::addPoint(const std::string& kind, const Chosen& chosen) {
    double time = 21.0;
    double error = 1.0;
    std::string name;
    std::string options;
    for (const auto& [setting, value] : chosen) {
        for (const Setting& candidate : sampleSettings()) {
            for (const Value& entry : candidate.values) {
                if (candidate.name == setting && entry.name == value) {
                    time *= entry.time;
                    error *= entry.error;
                }
            }
        }
        name += name.empty() ? "" : ", ";
        name += setting;
        name += ' ' + value;
        options += " --" + setting;
        options += ' ' + value;
    }
    Json& points = page_.report["points"];
    Json point{{"id", points.size()},
               {"name", chosen.empty() ? "default" : name},
               {"kind", kind},
               {"settings", Json(chosen)}};
    if (chosen.empty()) {
        point["settings"] = Json::object();
    }
    point["command"] = "glint render gallery.gltf -o picture.exr" + options;
    point["time"] = interval(time, 0.012);
    point["time"]["values"] = {time, time * 1.01, time * 0.99};
    point["ratio"] = interval(time / 21.0, 0.008);
    point["timeTie"] = std::abs(time / 21.0 - 1.0) < 0.012;
    addPasses(point, time * 0.98);
    addErrors(point, error);
    point["front"] = false;
    point.update(Json{{"rays", 41234}, {"cases", 34}, {"pipelines", 40}, {"bytes", 1234567}});
    addImages(point);
    points.push_back(std::move(point));
}

void Maker::addSingles() {
    for (const Setting& setting : sampleSettings()) {
        for (std::size_t i = 0; i < setting.values.size(); ++i) {
            if (i != setting.defaultValue && setting.values[i].skipped == nullptr) {
                addPoint(setting.stage == std::string("compile") ? "package" : "single",
                         {{setting.name, setting.values[i].name}});
            }
        }
    }
}

void Maker::addCombinations() {
    for (const char* samples : {"1", "2", "8", "16"}) {
        for (const char* steps : {"8", "16", "32"}) {
            addPoint("pair", {{"spp", samples}, {"ssr", steps}});
        }
        addPoint("pair", {{"spp", samples}, {"max-roughness", "0.2"}});
        addPoint("pair", {{"spp", samples}, {"max-roughness", "0.7"}});
    }
    addPoint("search", {{"spp", "2"}, {"max-roughness", "0.7"}, {"skip-below", "0.01"}});
    addPoint("search",
             {{"spp", "16"}, {"max-roughness", "1"}, {"shadow-samples", "2"}, {"texture-lod", "mip0"}});
    addPoint("search", {{"spp", "8"}, {"skip-below", "0.01"}, {"hit-record", "packed"}});
    addPoint("search", {{"spp", "1"}, {"skip-below", "0.01"}, {"merge", "family"}});
    addPoint("search",
             {{"spp", "32"}, {"max-roughness", "1"}, {"shadow-samples", "4"}, {"texture-lod", "mip0"}});
}

// Those that no other beats in time and relMSE, by their medians.
void Maker::markFront() {
    Json& points = page_.report["points"];
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < points.size(); ++i) {
        order.push_back(i);
    }
    const auto time = [&](std::size_t i) { return points[i]["time"]["median"].get<double>(); };
    const auto error = [&](std::size_t i) { return points[i]["error"]["relMse"]["median"].get<double>(); };
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return time(a) < time(b); });
    double best = 1e30;
    page_.report["front"] = Json::array();
    for (const std::size_t i : order) {
        if (error(i) < best) {
            best = error(i);
            points[i]["front"] = true;
            page_.report["front"].push_back(i);
        }
    }
}

Json settingsJson() {
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
                    {"what", "surfaces that a refracted ray meets at most"},
                    {"default", "8"},
                    {"values", {"8"}},
                    {"skipped",
                     {{{"value", "2"}, {"reason", "nothing refracts"}},
                      {{"value", "16"}, {"reason", "nothing refracts"}}}}});
    return list;
}

Json strategyRow(const char* strategy, double time, double shade, double order) {
    const Json interval{{"median", time},
                        {"low", time * 0.99},
                        {"high", time * 1.01},
                        {"q1", time * 0.995},
                        {"q3", time * 1.005}};
    const Json ratio{{"median", time / 21.0},
                     {"low", time / 21.2},
                     {"high", time / 20.8},
                     {"q1", time / 21.1},
                     {"q3", time / 20.9}};
    return {{"strategy", strategy}, {"point", 0},           {"time", interval}, {"ratio", ratio},
            {"shadeMs", shade},     {"orderMs", order},     {"launches", 38},   {"rays", 41234},
            {"buckets", 29},        {"divergence", nullptr}};
}

SamplePage Maker::make() {
    Json& report = page_.report;
    report = {{"format", "glint-bench"},
              {"version", 1},
              {"tool", "0.1.0"},
              {"commit", "abc1234"},
              {"date", "2026-11-21T22:00:00Z"},
              {"command", "glint bench gallery.gltf -o out/bench --quick --budget-ms 20"}};
    report["scene"] = {{"file", "gallery.gltf"}, {"name", "gallery"}, {"triangles", 123456},
                       {"materials", 40},        {"instances", 50},   {"lights", 2},
                       {"camera", "auto"},       {"width", kWidth},   {"height", kHeight},
                       {"environment", nullptr}};
    report["machine"] = {{"device", "llvmpipe (LLVM 15.0.6, 256 bits)"},
                         {"driver", "llvmpipe Mesa 25.0.7"},
                         {"deviceType", "cpu"},
                         {"tracers", {"ray-query", "ray-pipeline"}},
                         {"cpu", "A CPU at 2.0 GHz"},
                         {"cores", 2},
                         {"os", "Linux 6.1"}};
    report["method"] = {{"rounds", 7}, {"seed", 1},   {"confidence", 0.95}, {"quick", true},
                        {"warmup", 1}, {"batch", 12}, {"seconds", 93.1},    {"metric", "relMse"}};
    report["reference"] = {{"image", "images/reference.png"},
                           {"samples", 4096},
                           {"relativeError", 0.0061},
                           {"target", 0.005},
                           {"reached", false},
                           {"noise", {{"relMse", 0.00008}, {"rmse", 0.0005}}},
                           {"cached", false},
                           {"seconds", 31.0},
                           {"settings", {{"texture-lod", "mip0"}, {"max-roughness", "1"}}},
                           {"exposure", -0.3}};
    page_.images.push_back({"images/reference.png", samplePng(0.0, false)});
    report["settings"] = settingsJson();
    report["points"] = Json::array();
    addPoint("default", {});
    addSingles();
    addCombinations();
    markFront();
    std::size_t advised = 0;
    for (const Json& id : report["front"]) {
        advised =
            report["points"][id.get<std::size_t>()]["time"]["high"] < 20.0 ? id.get<std::size_t>() : advised;
    }
    report["advice"] = {
        {"budgetMs", 20.0},
        {"maxError", nullptr},
        {"metric", "relMse"},
        {"point", advised},
        {"file", "settings.json"},
        {"compile", Json::object()},
        {"render", {{"spp", "2"}}},
        {"why", "It has the least error of the points whose whole interval of time is within the budget."}};
    report["strategies"] = {{"fastest", {"visibility"}},
                            {"tracer", "ray-query"},
                            {"rows",
                             {strategyRow("visibility", 21.0, 9.1, 0.8), strategyRow("uber", 24.8, 14.2, 0.0),
                              strategyRow("sorted-uber", 22.9, 10.4, 1.1)}},
                            {"why",
                             {"Ordering the hits costs 0.8 ms and saves 5.1 ms of shading.",
                              "29 of 35 buckets are filled, the largest with 31 % of the rays."}}};
    report["diagnostics"] = Json::array();
    return std::move(page_);
}

}  // namespace

SamplePage samplePage() {
    return Maker().make();
}

SamplePage hostilePage() {
    SamplePage page = samplePage();
    const std::string name =
        "</script><script>window.broken = 1</script><!-- <img src=x onerror=\"window.broken = 2\"> "
        "{{{css}}} {{report}} ]]> & \xe2\x80\xa8 \xff";
    page.report["scene"]["name"] = name;
    page.report["scene"]["file"] = name + ".gltf";
    page.report["command"] = "glint bench '" + name + "'";
    page.report["points"][1]["name"] = name;
    page.report["strategies"]["why"].push_back(name);
    page.report["settings"][0]["what"] = name;
    return page;
}

SamplePage sparsePage() {
    SamplePage page = samplePage();
    Json& report = page.report;
    page.images.clear();
    report["points"].erase(report["points"].begin() + 1, report["points"].end());
    Json& point = report["points"][0];
    for (const char* name : {"image", "errorImage", "rays", "cases", "pipelines", "bytes"}) {
        point[name] = nullptr;
    }
    point["passes"] = Json::array();
    for (Json& error : point["error"]) {
        error = nullptr;
    }
    point["error"]["relMse"] = {{"median", 0.0}, {"low", 0.0}, {"high", 0.0}, {"q1", 0.0}, {"q3", 0.0}};
    report["front"] = {0};
    report["advice"] = nullptr;
    report["strategies"] = nullptr;
    report["commit"] = "unknown";
    report["reference"]["image"] = nullptr;
    return page;
}

}  // namespace glint::testing
