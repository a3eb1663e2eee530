#include "program.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <type_traits>

namespace glint::benchmarks {

namespace {

void addOption(CLI::App& app, const Option& option) {
    CLI::Option* const added = std::visit(
        [&](auto* value) {
            if constexpr (std::is_same_v<decltype(value), bool*>) {
                return app.add_flag(option.name, *value, option.help);
            } else {
                return app.add_option(option.name, *value, option.help)->capture_default_str();
            }
        },
        option.value);
    added->required(option.demand.present);
    if (option.demand.least < option.demand.most) {
        added->check(CLI::Range(option.demand.least, option.demand.most));
    }
}

}  // namespace

Option widthOption(Size& size) {
    return {"--width", &size.width, "pixels"};
}

Option heightOption(Size& size) {
    return {"--height", &size.height, "pixels"};
}

Option roundsOption(int& rounds, const char* help) {
    return {"--rounds", &rounds, help, {false, 1, 10'000}};
}

int runProgram(const char* purpose, const std::vector<Option>& options, int count, char** words,
               const std::function<Status()>& run) {
    CLI::App app{purpose};
    for (const Option& option : options) {
        addOption(app, option);
    }
    CLI11_PARSE(app, count, words);
    try {
        const Status status = run();
        if (status) {
            return 0;
        }
        fmt::print(stderr, "{}\n", toString(status.error()));
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}: {}\n", std::filesystem::path(words[0]).filename().string(), error.what());
    }
    return 1;
}

}  // namespace glint::benchmarks
