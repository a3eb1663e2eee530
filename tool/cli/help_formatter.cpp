#include "cli/help_formatter.h"

namespace glint {

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
    std::string text;
    if (option->get_type_size() != 0) {
        text += option->get_type_name().empty() ? "" : " " + option->get_type_name();
        const bool many = option->get_expected_max() >= CLI::detail::expected_max_vector_size;
        text += many && option->get_positional() ? "..." : "";
        text += option->get_required() ? " " + get_label("REQUIRED") : "";
    }
    return text;
}

}  // namespace glint
