#include "emit/glsl/macros.h"
#include "emit/glsl/passes.h"
#include "emit/glsl/text.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace glint::compiler {

namespace {

constexpr std::string_view kOwnPrefix = "GLINT_";
constexpr std::size_t kNone = GlslToken::kNone;

// Returns whether a condition holds. Returns nothing if the text alone does not decide it.
std::optional<bool> evaluate(const Macros& macros, std::string_view condition) {
    const std::optional<std::uint32_t> value = macros.evaluate(condition);
    return value ? std::optional(*value != 0) : std::nullopt;
}

// --- Conditionals of the preprocessor ---

struct Conditional {
    bool decided = false;  // its directives are dropped
    bool taken = true;     // this branch stays
    bool done = false;     // an earlier branch has stayed
};

class Conditionals {
public:
    explicit Conditionals(Macros& macros) : macros_(macros) {}

    enum class Fate { Goes, Stays, BeginsWithIf };  // BeginsWithIf: an #elif, before which nothing stays

    // Takes a line, with those that continue it.
    Fate take(std::string_view line) {
        const Directive directive = parseDirective(line);
        const std::string_view word = directive.word;
        if (word == "if" || word == "ifdef" || word == "ifndef") {
            return begin(directive) ? Fate::Stays : Fate::Goes;
        }
        if (!open_.empty() && (word == "else" || word == "elif")) {
            return next(directive);
        }
        if (!open_.empty() && word == "endif") {
            const bool decided = open_.back().decided;
            open_.pop_back();
            return !decided && isActive() ? Fate::Stays : Fate::Goes;
        }
        if (!isActive()) {
            return Fate::Goes;
        }
        if (word == "define" || word == "undef") {
            takeMacro(directive);
        }
        return Fate::Stays;
    }
    // Takes a line that declares a constant of the whole text.
    void takeConstant(std::string_view line) {
        constexpr std::string_view kConstant = "const uint ";
        if (!line.starts_with("GLINT_CONSTANT(") && !line.starts_with(kConstant)) {
            return;
        }
        const std::string text = macros_.expand(line);
        const std::size_t equals = text.find('=');
        const std::size_t end = text.find(';');
        if (!text.starts_with(kConstant) || equals == std::string::npos || end == std::string::npos) {
            return;
        }
        const std::string_view name =
            trim(std::string_view(text).substr(kConstant.size(), equals - kConstant.size()));
        const std::optional<std::uint32_t> value =
            macros_.evaluate(std::string_view(text).substr(equals + 1, end - equals - 1));
        if (value) {
            macros_.setConstant(name, *value);
        }
    }
    // Forgets the macros that do not mean the same in the whole text.
    void forgetChanged() {
        for (const std::string& name : changed_) {
            macros_.undefine(name);
        }
    }

private:
    void takeMacro(const Directive& directive) {
        const std::string name(nameIn(directive.argument));
        const bool isCertain = std::ranges::all_of(open_, &Conditional::decided);
        if (macros_.has(name) || !isCertain) {
            changed_.insert(name);
        }
        if (isCertain) {
            doubtful_.erase(name);
        } else {
            doubtful_.insert(name);
        }
        if (isCertain && directive.word == "define") {
            macros_.define(directive.argument);
        } else {
            macros_.undefine(name);
        }
    }
    std::optional<bool> isDefined(std::string_view name) const {
        const bool isKnown = name.starts_with(kOwnPrefix) && !doubtful_.contains(name);
        return isKnown ? std::optional(macros_.has(name)) : std::nullopt;
    }
    std::optional<bool> holds(const Directive& directive) const {
        if (directive.word == "if" || directive.word == "elif") {
            return evaluate(macros_, directive.argument);
        }
        const std::optional<bool> defined = isDefined(nameIn(directive.argument));
        return defined ? std::optional(*defined == (directive.word == "ifdef")) : std::nullopt;
    }
    bool isActive() const {
        return std::ranges::all_of(open_, &Conditional::taken);
    }
    bool begin(const Directive& directive) {
        const bool active = isActive();
        const std::optional<bool> value = active ? holds(directive) : std::optional(false);
        open_.push_back({value.has_value(), value.value_or(true), value.value_or(false)});
        return active && !value;
    }
    Fate next(const Directive& directive) {
        Conditional& current = open_.back();
        if (!current.decided) {
            return isActive() ? Fate::Stays : Fate::Goes;
        }
        current.taken = true;
        const std::optional<bool> value = current.done || !isActive() ? std::optional(false)
                                          : directive.word == "else"  ? std::optional(true)
                                                                      : holds(directive);
        if (!value) {
            current.decided = false;
            return Fate::BeginsWithIf;
        }
        current.taken = *value;
        current.done = current.done || current.taken;
        return Fate::Goes;
    }

    Macros& macros_;
    std::vector<Conditional> open_;
    std::set<std::string, std::less<>> changed_;
    std::set<std::string, std::less<>> doubtful_;  // perhaps defined, perhaps not
};

// --- Statements ---

// A range of a text that goes, and what stands in its place.
struct Cut {
    std::string_view text;
    std::string_view replacement;
};

// Finds the statements of a text that conditions decide against.
class Statements {
public:
    Statements(std::string_view text, const Macros& macros)
        : macros_(macros), tokens_(splitTokens(text)), skip_(tokens_.size() + 1) {}
    // Returns ranges that do not overlap, in order.
    std::vector<Cut> findCuts() {
        std::vector<std::size_t> blocks;  // the closing brackets of those that are open
        for (std::size_t at = 0; at < tokens_.size();) {
            if (skip_[at] > at) {
                cut(at, skip_[at]);
                std::string_view& text = cuts_.back().text;
                const char* const before = endOfToken(at - 1);
                text = trim({before, text.data()}).empty()
                           ? std::string_view(before, text.data() + text.size())
                           : text;
                at = skip_[at];
                continue;
            }
            if (is(at, "{")) {
                blocks.push_back(tokens_[at].match);
            } else if (is(at, "}") && !blocks.empty()) {
                blocks.pop_back();
            }
            if (is(at, "if") && is(at + 1, "(")) {
                at = takeIf(at, blocks.empty() ? kNone : blocks.back());
            } else {
                at = is(at, "?") ? takeChoice(at) : at + 1;
            }
        }
        // A choice may lie in the condition of another one.
        std::ranges::stable_sort(cuts_, {}, [](const Cut& cut) { return cut.text.data(); });
        const char* end = nullptr;
        std::erase_if(cuts_, [&](const Cut& cut) {
            const bool isWithin = end != nullptr && cut.text.data() < end;
            end = isWithin ? end : cut.text.data() + cut.text.size();
            return isWithin;
        });
        return std::move(cuts_);
    }

private:
    bool is(std::size_t at, std::string_view text) const {
        return at < tokens_.size() && tokens_[at].text == text && !tokens_[at].isDirective;
    }
    // Returns the token behind the statement at `at`, or kNone if it is not clear.
    std::size_t endOf(std::size_t at) const {
        if (is(at, "{")) {
            return tokens_[at].match == kNone ? kNone : tokens_[at].match + 1;
        }
        if (is(at, "if") || is(at, "for") || is(at, "while") || is(at, "switch")) {
            const std::size_t close = is(at + 1, "(") ? tokens_[at + 1].match : kNone;
            const std::size_t end = close == kNone ? kNone : endOf(close + 1);
            return end != kNone && is(at, "if") && is(end, "else") ? endOf(end + 1) : end;
        }
        while (at < tokens_.size() && !is(at, ";") && !is(at, "}") && !is(at, "do")) {
            const std::size_t match = tokens_[at].match;
            at = match != kNone && match > at ? match + 1 : at + 1;
        }
        return is(at, ";") ? at + 1 : kNone;
    }
    bool hasDirective(std::size_t begin, std::size_t end) const {
        return std::ranges::any_of(std::span(tokens_).subspan(begin, end - begin), &GlslToken::isDirective);
    }
    const char* endOfToken(std::size_t at) const {
        return tokens_[at].text.data() + tokens_[at].text.size();
    }
    std::string_view textOf(std::size_t begin, std::size_t end) const {
        return {tokens_[begin].text.data(), endOfToken(end - 1)};
    }
    void cut(std::size_t begin, std::size_t end, std::string_view replacement = "") {
        cuts_.push_back({textOf(begin, end), replacement});
    }
    // Cuts up to the token at `end`, with the blanks before it on its line.
    void cutUpTo(std::size_t begin, std::size_t end) {
        cut(begin, end);
        std::string_view& text = cuts_.back().text;
        const std::string_view gap{text.data() + text.size(), tokens_[end].text.data()};
        text = {text.data(), text.size() + (trim(gap).empty() ? gap.size() : 0)};
    }
    // Returns whether the last statement of the one from `begin` to `end` is a return.
    bool returns(std::size_t begin, std::size_t end) const {
        if (!is(begin, "{")) {
            return is(begin, "return");
        }
        std::size_t last = begin;
        for (std::size_t at = begin + 1; at != kNone && at + 1 < end; at = endOf(at)) {
            last = at;
        }
        return is(last, "return");
    }
    std::optional<bool> decide(std::string_view condition) {
        const auto [known, isNew] = decided_.emplace(condition, std::nullopt);
        if (isNew) {
            known->second = evaluate(macros_, condition);
        }
        return known->second;
    }
    // Takes the `if` at `at` in the block that ends at `blockEnd`. Returns the token to go on with.
    std::size_t takeIf(std::size_t at, std::size_t blockEnd) {
        const std::size_t close = tokens_[at + 1].match;
        const std::size_t yes = close == kNone ? kNone : close + 1;
        const std::size_t yesEnd = yes == kNone ? kNone : endOf(yes);
        const bool hasElse = is(yesEnd, "else");
        const std::size_t end = hasElse ? endOf(yesEnd + 1) : yesEnd;
        const std::optional<bool> value =
            end == kNone || close == at + 2 ? std::nullopt : decide(textOf(at + 2, close));
        if (!value) {
            return at + 1;
        }
        // The body of another statement can't go without leaving one.
        const bool isBody = at > 0 && (is(at - 1, ")") || is(at - 1, "else"));
        if (!*value) {
            const std::size_t no = hasElse ? yesEnd + 1 : yesEnd;
            if (hasDirective(at, no)) {
                return at + 1;
            }
            if (hasElse) {
                cutUpTo(at, no);
            } else {
                cut(at, no, isBody ? "{}" : "");
            }
            return no;
        }
        if (hasDirective(at, yes) || hasDirective(yesEnd, end)) {
            return at + 1;
        }
        cutUpTo(at, yes);
        // Nothing runs after a return.
        const bool endsBlock =
            blockEnd != kNone && !isBody && returns(yes, yesEnd) && !hasDirective(end, blockEnd);
        skip_[yesEnd] = std::max(skip_[yesEnd], endsBlock ? blockEnd : end);
        return yes;
    }

    // Returns whether the token at `at` stands outside of the condition or the last part of a choice.
    bool bounds(std::size_t at) const {
        if (is(at, "=")) {
            const auto touches = [&](std::size_t first) {
                return first + 1 < tokens_.size() &&
                       tokens_[first].text.data() + 1 == tokens_[first + 1].text.data();
            };
            const bool endsComparison =
                at > 0 && touches(at - 1) &&
                (is(at - 1, "=") || is(at - 1, "!") || is(at - 1, "<") || is(at - 1, ">"));
            return !endsComparison && !(touches(at) && is(at + 1, "="));
        }
        constexpr std::string_view kBounds = ";,?:{}()[]";
        return kBounds.find(tokens_[at].text) != std::string_view::npos || is(at, "return");
    }
    // Takes the choice whose "?" is at `at`. Returns the token to go on with.
    std::size_t takeChoice(std::size_t at) {
        std::size_t begin = at;
        while (begin > 0) {
            const std::size_t match = tokens_[begin - 1].match;
            if (match >= begin - 1 && bounds(begin - 1)) {
                break;
            }
            begin = match < begin - 1 ? match : begin - 1;
        }
        // Returns the bound behind an expression, in which choices may nest.
        const auto endFrom = [&](std::size_t from) {
            for (int depth = 0; from < tokens_.size(); ++from) {
                const std::size_t match = tokens_[from].match;
                if (match != kNone && match > from) {
                    from = match;
                } else if (is(from, "?")) {
                    ++depth;
                } else if (bounds(from) && (!is(from, ":") || depth-- == 0)) {
                    break;
                }
            }
            return from;
        };
        const std::size_t no = endFrom(at + 1);
        const std::size_t end = is(no, ":") ? endFrom(no + 1) : tokens_.size();
        const std::optional<bool> value = begin == at || end == tokens_.size() || hasDirective(begin, end)
                                              ? std::nullopt
                                              : decide(textOf(begin, at));
        if (!value) {
            return at + 1;
        }
        cutUpTo(begin, *value ? at + 1 : no + 1);
        skip_[no] = *value ? std::max(skip_[no], end) : skip_[no];
        return *value ? at + 1 : no + 1;
    }

    const Macros& macros_;
    std::vector<GlslToken> tokens_;
    std::vector<std::size_t> skip_;  // by token, where one is that goes: the end of the range
    std::unordered_map<std::string_view, std::optional<bool>> decided_;
    std::vector<Cut> cuts_;
};

// Lines of a unit that stay.
struct KeptLines {
    std::string text;                 // with line breaks
    std::vector<std::size_t> places;  // of each line in the unit
};

// Returns the lines that no decided conditional drops, without the directives of these. `macros` then has
// what the text defines, without what it defines in several ways.
KeptLines keepLines(const GlslUnit& unit, Macros& macros) {
    Conditionals conditionals(macros);
    KeptLines kept;
    for (std::size_t first = 0; first < unit.size();) {
        std::size_t end = first + 1;
        std::string joined;
        std::string_view line = unit.line(first);
        for (; line.ends_with('\\') && end < unit.size(); ++end) {
            joined += joined.empty() ? line.substr(0, line.size() - 1) : "";
            const std::string_view next = unit.line(end);
            joined += next.substr(0, next.size() - (next.ends_with('\\') ? 1 : 0));
            line = next.ends_with('\\') ? next : std::string_view();
        }
        line = joined.empty() ? unit.line(first) : joined;
        const Conditionals::Fate fate = conditionals.take(line);
        if (fate != Conditionals::Fate::Goes) {
            conditionals.takeConstant(line);
            for (std::size_t i = first; i < end; ++i) {
                std::string_view whole = unit.line(i);
                if (i == first && fate == Conditionals::Fate::BeginsWithIf) {
                    kept.text += "#";
                    whole.remove_prefix(whole.find("elif") + 2);
                }
                kept.text += whole;
                kept.text += '\n';
                kept.places.push_back(i);
            }
        }
        first = end;
    }
    conditionals.forgetChanged();
    return kept;
}

}  // namespace

GlslUnit cutDecided(const GlslUnit& unit) {
    Macros macros;
    const KeptLines kept = keepLines(unit, macros);
    const std::vector<Cut> cuts = Statements(kept.text, macros).findCuts();
    GlslUnit result;
    std::string line;
    bool isCut = false;  // some of `line`, which has what stays of it
    auto cut = cuts.begin();
    std::string_view rest = kept.text;
    for (const std::size_t place : kept.places) {
        const std::string_view whole = rest.substr(0, rest.find('\n') + 1);
        rest.remove_prefix(whole.size());
        const char* at = whole.data();
        const char* const end = at + whole.size() - 1;
        for (; cut != cuts.end() && cut->text.data() < end; ++cut) {
            const char* const begin = cut->text.data();
            const char* const behind = begin + cut->text.size();
            if (begin >= at) {
                line.append(at, begin);
                line += cut->replacement;
            }
            isCut = true;
            at = std::min(behind, end);
            if (behind > end) {
                break;
            }
        }
        line.append(at, end);
        // The rest of a line behind a cut stands where the cut began.
        if (!isCut || !trim(line).empty()) {
            result.add(line, unit.file(place), unit.number(place));
            line.clear();
        }
        const bool goesOn = cut != cuts.end() && cut->text.data() < end;
        if (!goesOn) {
            line.clear();
            isCut = false;
        }
    }
    return result;
}

}  // namespace glint::compiler
