// The layout of --help.
#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace glint {

// The formatter of CLI11, without details that the texts of options already give: which options they need and
// exclude, and that lists may be repeated.
class HelpFormatter : public CLI::Formatter {
public:
    std::string make_option_opts(const CLI::Option* option) const override;
};

}  // namespace glint
