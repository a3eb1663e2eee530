// The directional albedo of GGX microfacets from a table that another program has computed, beside the
// models.
#pragma once

#include "support/models.h"

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace glint::numerics {

struct GgxAlbedoEntry {
    double alpha = 0.0;
    double cosine = 0.0;  // of the view
    double albedo = 0.0;  // of white facets that reflect once
};

inline std::filesystem::path ggxTablePath() {
    return test::modelsFolder().parent_path() / "reference/ggx_directional_albedo.csv";
}

// Returns nothing if there is no table.
inline std::vector<GgxAlbedoEntry> readGgxTable() {
    std::ifstream table(ggxTablePath());
    // The columns are roughness, alpha, then E_mu<cosine> each, then the mean.
    std::string line;
    std::getline(table, line);
    std::vector<double> cosines;
    std::istringstream names(line);
    for (std::string name; std::getline(names, name, ',');) {
        if (name.starts_with("E_mu")) {
            cosines.push_back(std::stod(name.substr(4)));
        }
    }
    std::vector<GgxAlbedoEntry> entries;
    while (std::getline(table, line)) {
        std::istringstream cells(line);
        double roughness = 0.0;
        double alpha = 0.0;
        double albedo = 0.0;
        char comma = 0;
        cells >> roughness >> comma >> alpha;
        for (const double cosine : cosines) {
            cells >> comma >> albedo;
            entries.push_back({alpha, cosine, albedo});
        }
    }
    return entries;
}

}  // namespace glint::numerics
