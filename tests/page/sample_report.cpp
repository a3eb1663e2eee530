#include "page/sample_report.h"

#include "image/png.h"
#include "page/sample_settings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>

namespace glint::testing {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kWidth = 96;
constexpr std::uint32_t kHeight = 54;

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
    void addErrorParts();
    void markFront();

    std::minstd_rand random_{11};
    SamplePage page_;
};

base::Bytes samplePng(double error, bool map) {
    image::DisplayImage image{kWidth, kHeight, {}};
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
    // This picture happens to be exact in one measure.
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
        {"gbuffer", 0.08}, {"first cases", 0.22}, {"reflection rays", 0.05},
        {"trace", 0.31},   {"count", 0.015},      {"offset", 0.005},
        {"copy", 0.02},    {"shade miss", 0.01},  {"shade 0", 0.12},
        {"shade 1", 0.07}, {"shade 2", 0.04},     {"compose", 0.06}};
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
    for (const char* bounces : {"2", "4", "unlimited"}) {
        addPoint("pair", {{"bounces", bounces}, {"max-roughness", "1"}});
    }
    addPoint("search", {{"spp", "2"}, {"max-roughness", "0.7"}, {"skip-below", "0.01"}});
    addPoint("search",
             {{"spp", "16"}, {"max-roughness", "1"}, {"shadow-samples", "2"}, {"texture-lod", "mip0"}});
    addPoint("search", {{"spp", "8"}, {"skip-below", "0.01"}, {"hit-record", "packed"}});
    addPoint("search", {{"spp", "1"}, {"skip-below", "0.01"}, {"merge", "family"}});
    addPoint("search",
             {{"spp", "32"}, {"max-roughness", "1"}, {"shadow-samples", "4"}, {"texture-lod", "mip0"}});
}

// Marks the points that no other beats in time and relMSE, by their medians.
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

void Maker::addErrorParts() {
    Json& points = page_.report["points"];
    Json parts = Json::array();
    const std::array<const char*, 3> exact[] = {
        {"bounces", "1", "unlimited"}, {"max-roughness", "0.4", "1"}, {"texture-lod", "cones", "mip0"}};
    for (const auto& [setting, from, to] : exact) {
        const std::string name = std::string(setting) + ' ' + to;
        const auto point = std::ranges::find_if(points, [&](const Json& one) { return one["name"] == name; });
        const double share = 1.0 - (*point)["error"]["relMse"]["median"].get<double>() /
                                       points[0]["error"]["relMse"]["median"].get<double>();
        parts.push_back({{"setting", setting},
                         {"from", from},
                         {"to", to},
                         {"point", (*point)["id"]},
                         {"removed", interval(share, 0.1)},
                         {"bias", 1.2 * share},
                         {"noise", -0.2 * share}});
    }
    addPoint("exact", {{"bounces", "unlimited"}, {"max-roughness", "1"}, {"texture-lod", "mip0"}});
    page_.report["errorParts"] = {{"parts", std::move(parts)},
                                  {"exact",
                                   {{"point", points.back()["id"]},
                                    {"removed", interval(0.55, 0.05)},
                                    {"bias", 0.7},
                                    {"noise", -0.15}}},
                                  {"noise", 0.31},
                                  {"rest", -0.04}};
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
    return {{"strategy", strategy}, {"point", 0},       {"time", interval}, {"ratio", ratio},
            {"shadeMs", shade},     {"orderMs", order}, {"rays", 41234}};
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
    report["method"] = {{"rounds", 7}, {"seed", 1},       {"confidence", 0.95}, {"quick", true},
                        {"batch", 12}, {"seconds", 93.1}, {"metric", "relMse"}};
    report["reference"] = {{"image", "images/reference.png"},
                           {"transport", "full"},
                           {"what", "all of light transport (--bounces unlimited), with every light"},
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
    report["settings"] = sampleSettingsJson();
    report["points"] = Json::array();
    addPoint("default", {});
    addSingles();
    addCombinations();
    addErrorParts();
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
                            {"rows",
                             {strategyRow("visibility", 21.0, 9.1, 0.8), strategyRow("uber", 24.8, 14.2, 0.0),
                              strategyRow("sorted-uber", 22.9, 10.4, 1.1)}},
                            {"why",
                             {"Ordering the hits costs 0.8 ms and saves 5.1 ms of shading.",
                              "29 of 35 buckets are filled, the largest with 31 % of the rays."}}};
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
    report["errorParts"] = {{"parts", Json::array()}, {"exact", nullptr}, {"noise", 0.0}, {"rest", 1.0}};
    report["commit"] = "unknown";
    report["reference"]["image"] = nullptr;
    return page;
}

}  // namespace glint::testing
