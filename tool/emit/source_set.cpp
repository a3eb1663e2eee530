#include "emit/source_set.h"

#include <utility>

namespace glint::compiler {

void SourceSet::add(std::string name, std::string text) {
    files_.insert_or_assign(std::move(name), std::move(text));
}

std::optional<std::string_view> SourceSet::find(std::string_view name) const {
    const auto place = files_.find(name);
    return place == files_.end() ? std::nullopt : std::optional<std::string_view>(place->second);
}

SourceLookup SourceSet::lookup() const {
    return [this](std::string_view name) { return find(name); };
}

}  // namespace glint::compiler
