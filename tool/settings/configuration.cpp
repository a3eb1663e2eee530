#include "settings/configuration.h"

#include "settings/table.h"

#include <algorithm>
#include <iterator>

namespace glint::compiler {

std::vector<std::string> settingNames() {
    std::vector<std::string> names;
    for (const Descriptor& row : settingsTable()) {
        if (row.bench.use == BenchUse::Swept) {
            names.emplace_back(row.name);
        }
    }
    return names;
}

Configuration configurationOf(const Settings& settings) {
    Configuration configuration;
    for (const Descriptor& row : settingsTable()) {
        if (row.bench.use == BenchUse::Swept) {
            configuration.emplace(row.name, row.values.text(settings));
        }
    }
    return configuration;
}

Settings withSettings(Settings settings, const Configuration& configuration) {
    for (const Descriptor& row : settingsTable()) {
        const auto value = configuration.find(row.name);
        if (row.bench.use == BenchUse::Swept && value != configuration.end()) {
            row.values.set(settings, value->second);
        }
    }
    return settings;
}

std::vector<std::string> wordsOf(const Configuration& configuration) {
    std::vector<std::string> words;
    for (const std::string& name : settingNames()) {
        const auto value = configuration.find(name);
        if (value != configuration.end()) {
            std::ranges::move(optionWords(*sweptSetting(name), value->second), std::back_inserter(words));
        }
    }
    return words;
}

}  // namespace glint::compiler
