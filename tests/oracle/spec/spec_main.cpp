// glint_spec_oracle: writes the table that compares Glint's materials with the glTF specification.
#include "base/files.h"
#include "oracle/spec/bounds.h"
#include "oracle/spec/comparison.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <map>
#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::spec;

struct Settings {
    std::string json;
    std::string markdown;
    std::string only;
    std::string lighting = "lights,traced,untraced";
    std::string maps = "smooth,spot,white";
    std::string compensation = "off,on";
    ComparisonOptions options;
};

bool names(const std::string& list, const char* name) {
    return ("," + list + ",").find(std::string(",") + name + ",") != std::string::npos;
}

bool wanted(const Row& row, const std::string& pattern) {
    return pattern.empty() || (row.group + ": " + row.name).find(pattern) != std::string::npos;
}

// Keeps the rows that are wanted, so that the scene has no others.
Rows choose(Rows all, const std::string& pattern) {
    std::erase_if(all.rows, [&](const Row& row) { return !wanted(row, pattern); });
    return all;
}

void compareRow(Comparer& comparer, std::size_t row, bool sphere, const Settings& settings,
                std::vector<Comparison>& table) {
    if (names(settings.lighting, "lights")) {
        table.push_back(comparer.underLights(row));
    }
    for (const Transport transport : {Transport::Traced, Transport::Untraced}) {
        if (!names(settings.lighting, transport == Transport::Traced ? "traced" : "untraced")) {
            continue;
        }
        if (sphere && settings.options.device.compensation && names(settings.maps, "white")) {
            table.push_back(comparer.inFurnaceOnSphere(row, transport));
        }
        for (const MapKind map : {MapKind::Smooth, MapKind::Spot, MapKind::White}) {
            if (names(settings.maps, kMapNames[static_cast<std::size_t>(map)])) {
                table.push_back(comparer.underMap(row, map, transport));
            }
        }
    }
}

// Returns the number of comparisons outside of their bounds.
int compareAll(const Rows& rows, Settings settings, std::vector<Comparison>& table) {
    int failures = 0;
    for (const bool compensation : {false, true}) {
        if (!names(settings.compensation, compensation ? "on" : "off")) {
            continue;
        }
        settings.options.device.compensation = compensation;
        Comparer comparer(rows, settings.options);
        for (std::size_t row = 0; row < rows.rows.size(); ++row) {
            const std::size_t first = table.size();
            compareRow(comparer, row, rows.rows[row].sphere, settings, table);
            for (std::size_t i = first; i < table.size(); ++i) {
                const std::string objection = objectionTo(table[i]);
                if (!objection.empty()) {
                    ++failures;
                    std::printf("%s: %s, compensation %s: %s\n", table[i].group.c_str(),
                                table[i].name.c_str(), compensation ? "on" : "off", objection.c_str());
                }
            }
        }
    }
    return failures;
}

Status write(const std::string& path, const std::string& text) {
    return path.empty() ? okStatus() : base::writeFile(path, text);
}

int parseAndRun(int argc, char** argv) {
    CLI::App app{
        "Compares Glint's materials with an oracle that is written from the texts of glTF 2.0 and of its "
        "material extensions. Exits with 1 if a comparison is outside of its bound."};
    Settings settings;
    app.add_option("--json", settings.json, "write all comparisons");
    app.add_option("--markdown", settings.markdown, "write the table");
    app.add_option("--only", settings.only, "compare materials whose \"group: name\" contains this text");
    app.add_option("--light", settings.lighting, "lights, traced, untraced, or several of them")
        ->capture_default_str();
    app.add_option("--map", settings.maps, "smooth, spot, white, or several of them")->capture_default_str();
    app.add_option("--compensation", settings.compensation, "off, on, or both")->capture_default_str();
    app.add_option("--masking", settings.options.masking,
                   "of the specification: correlated, or separable as appendix B.3.2 writes it")
        ->transform(CLI::CheckedTransformer(std::map<std::string, Masking>{
            {"correlated", Masking::HeightCorrelated}, {"separable", Masking::Separable}}))
        ->default_str("correlated");
    app.add_option("--size", settings.options.device.size, "pixels of a picture's side")
        ->check(CLI::Range(1U, 1024U))
        ->capture_default_str();
    app.add_option("--samples", settings.options.device.samples, "samples a pixel where rays are traced")
        ->check(CLI::Range(1U, 65536U))
        ->capture_default_str();
    app.add_flag("--many-views", settings.options.manyViews, "two views a zone of n·v instead of one");
    app.add_option("--points", settings.options.quality, "points of a quadrature along its shorter side")
        ->check(CLI::Range(8, 2048))
        ->capture_default_str();
    app.add_option("--map-width", settings.options.mapWidth, "texels in a row of the maps: 256 to 2048")
        ->check(CLI::Range(256U, 2048U))
        ->capture_default_str();
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    const Rows rows = choose(allRows(), settings.only);
    if (rows.rows.empty()) {
        std::fprintf(stderr, "glint_spec_oracle: no material contains \"%s\"\n", settings.only.c_str());
        return 2;
    }
    std::vector<Comparison> table;
    const int failures = compareAll(rows, settings, table);
    for (const auto& [path, text] :
         {std::pair(settings.json, toJson(table)), std::pair(settings.markdown, toMarkdown(table))}) {
        if (const Status written = write(path, text); !written) {
            std::fprintf(stderr, "%s\n", toString(written.error()).c_str());
            return 1;
        }
    }
    std::printf("%zu comparisons, %d outside of their bounds\n", table.size(), failures);
    return failures == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return parseAndRun(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "glint_spec_oracle: %s\n", error.what());
        return 1;
    }
}
