#include "base/files.h"
#include "base/json.h"
#include "cache/store.h"
#include "cli/compile/compile.h"
#include "cli/table.h"

#include <fmt/format.h>

namespace glint::cli {

namespace {

std::string describe(const ModuleCounts& modules) {
    std::string text = fmt::format("{} compiled, {} taken from the cache", modules.compiled, modules.cached);
    if (modules.partsCompiled + modules.partsCached > 0) {
        text += fmt::format("; parts: {} compiled, {} taken from the cache", modules.partsCompiled,
                            modules.partsCached);
    }
    return text;
}

}  // namespace

ModuleCounts countModules(const compiler::CompiledPackage& package) {
    ModuleCounts counts;
    for (const compiler::CompiledModule& module : package.modules) {
        ++(module.compiled ? counts.compiled : counts.cached);
        counts.partsCompiled += module.partsCompiled;
        counts.partsCached += module.partsCached;
    }
    return counts;
}

void tell(const Console& console, CompileSummary summary, const std::optional<ModuleCounts>& modules,
          bool upToDate, double milliseconds) {
    if (console.isJson()) {
        summary.json["milliseconds"] = milliseconds;
        summary.json["modules"] =
            modules ? base::Json{{"compiled", modules->compiled},
                                 {"cached", modules->cached},
                                 {"parts",
                                  {{"compiled", modules->partsCompiled}, {"cached", modules->partsCached}}}}
                    : base::Json(nullptr);
        summary.json["upToDate"] = upToDate;
        console.result(summary.json);
        return;
    }
    const auto add = [&](const char* name, std::string value) {
        summary.fields.insert(summary.fields.end() - 1, {name, std::move(value)});
    };
    if (modules) {
        add("modules", upToDate ? "up to date, none compiled" : describe(*modules));
    }
    add("time", fmt::format("{:.0f} ms", milliseconds));
    console.print(formatFields(summary.fields) + summary.dropped);
}

std::string pack(const CompileSummary& summary) {
    compiler::Packer packer;
    packer.add(summary.fields.size());
    for (const std::vector<std::string>& field : summary.fields) {
        packer.add(std::string_view(field[0])).add(std::string_view(field[1]));
    }
    packer.add(std::string_view(summary.dropped)).add(static_cast<std::uint64_t>(summary.modules));
    const std::string json = summary.json.dump(-1, ' ', false, base::Json::error_handler_t::replace);
    return packer.add(std::string_view(json)).take();
}

std::optional<CompileSummary> unpackSummary(std::string_view bytes, bool withJson) {
    compiler::Unpacker unpacker(bytes);
    CompileSummary summary;
    // A field is two texts, each with its length.
    summary.fields.resize(unpacker.count(2 * sizeof(std::uint64_t)).value_or(0));
    for (std::vector<std::string>& field : summary.fields) {
        field = {std::string(unpacker.text().value_or("")), std::string(unpacker.text().value_or(""))};
    }
    summary.dropped = unpacker.text().value_or("");
    summary.modules = static_cast<int>(unpacker.number().value_or(0));
    const std::optional<std::string_view> json = unpacker.text();
    if (!json || !unpacker.atEnd() || summary.fields.empty()) {
        return std::nullopt;
    }
    if (!withJson) {
        return summary;
    }
    if (base::nestsTooDeep(base::asBytes(*json))) {
        return std::nullopt;
    }
    summary.json = base::Json::parse(*json, nullptr, false);
    return summary.json.is_object() ? std::optional(std::move(summary)) : std::nullopt;
}

}  // namespace glint::cli
