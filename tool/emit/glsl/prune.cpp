#include "emit/glsl/prune.h"

#include "emit/glsl/glsl_items.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <unordered_map>
#include <utility>
#include <vector>

namespace glint {

namespace {

using Items = std::vector<GlslItem>;

// Returns whether ## can form the item's name from one of `fragments`.
bool mayBePasted(const GlslItem& item, const std::vector<std::string_view>& fragments) {
    return std::ranges::any_of(fragments, [&](std::string_view fragment) {
        return item.name.starts_with(fragment) || item.name.ends_with(fragment);
    });
}

// Marks the items that are reached from those that must stay.
std::vector<bool> findReached(const Items& items) {
    std::unordered_multimap<std::string_view, std::size_t> byName;
    std::vector<std::string_view> fragments;
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (!items[i].name.empty()) {
            byName.emplace(items[i].name, i);
        }
        fragments.insert(fragments.end(), items[i].pasted.begin(), items[i].pasted.end());
    }
    std::vector<bool> reached(items.size());
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (items[i].name.empty() || mayBePasted(items[i], fragments)) {
            reached[i] = true;
            open.push_back(i);
        }
    }
    while (!open.empty()) {
        const GlslItem& item = items[open.back()];
        open.pop_back();
        for (const std::string_view word : item.words) {
            const auto [begin, end] = byName.equal_range(word);
            for (auto entry = begin; entry != end; ++entry) {
                if (!reached[entry->second]) {
                    reached[entry->second] = true;
                    open.push_back(entry->second);
                }
            }
        }
    }
    return reached;
}

// A comment is dropped together with what stands right below it, which may be a list of macros.
void dropComments(const Items& items, std::vector<bool>& kept) {
    // Says whether anything is kept of what stands below, up to the end of the list.
    bool keptBelow = true;
    for (std::size_t i = items.size(); i-- > 0;) {
        const GlslItemKind kind = items[i].kind;
        if (kind == GlslItemKind::Comment) {
            kept[i] = keptBelow;
        } else if (kind == GlslItemKind::Macro && i + 1 < items.size() &&
                   items[i + 1].kind == GlslItemKind::Macro) {
            keptBelow = keptBelow || kept[i];
        } else {
            keptBelow = kept[i];
        }
    }
}

// Joins items. Wherever an item's lines don't follow those of the last one, a directive gives their place.
class Writer {
public:
    void add(const GlslItem& item) {
        const bool blank = item.kind == GlslItemKind::Blank;
        if (blank && afterBlank_) {
            return;
        }
        afterBlank_ = blank;
        const bool inPlace = item.file == file_ && item.line == line_;
        if (!blank && !inPlace && !item.file.empty()) {
            text_ += fmt::format("#line {} \"{}\"\n", item.line, item.file);
        }
        text_ += item.text;
        // After a moved blank line, the place of the next line is unknown.
        file_ = blank && !inPlace ? std::string_view() : item.endFile;
        line_ = item.endLine;
    }
    std::string take() {
        return std::move(text_);
    }

private:
    std::string text_;
    std::string_view file_;
    int line_ = 0;
    bool afterBlank_ = true;
};

}  // namespace

std::string dropUnused(std::string_view glsl) {
    const Items items = splitGlsl(glsl);
    std::vector<bool> kept = findReached(items);
    dropComments(items, kept);
    Writer writer;
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (kept[i]) {
            writer.add(items[i]);
        }
    }
    return writer.take();
}

std::string essentialText(std::string_view glsl) {
    std::string text;
    text.reserve(glsl.size());
    std::string line;
    // GLSL has no literals that contain blanks, so one blank can replace several.
    const auto addBlank = [&] {
        if (!line.empty() && line.back() != ' ') {
            line += ' ';
        }
    };
    const auto endLine = [&] {
        while (!line.empty() && (line.back() == ' ' || line.back() == '\r')) {
            line.pop_back();
        }
        if (!line.empty() && !line.starts_with("#line ")) {
            text += line;
            text += '\n';
        }
        line.clear();
    };
    for (std::size_t i = 0; i < glsl.size();) {
        const std::string_view rest = glsl.substr(i);
        if (rest.starts_with("//")) {
            i += std::min(rest.find('\n'), rest.size());
        } else if (rest.starts_with("/*")) {
            const std::size_t end = rest.find("*/", 2);
            i += end == std::string_view::npos ? rest.size() : end + 2;
            addBlank();
        } else if (rest.front() == '\n') {
            endLine();
            ++i;
        } else {
            if (rest.front() == ' ' || rest.front() == '\t') {
                addBlank();
            } else {
                line += rest.front();
            }
            ++i;
        }
    }
    endLine();
    return text;
}

}  // namespace glint
