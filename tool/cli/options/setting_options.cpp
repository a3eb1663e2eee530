#include "cli/options/setting_options.h"

#include "base/lists.h"
#include "base/text.h"
#include "cli/options/options.h"
#include "cli/table.h"

#include <glint/measure/settings.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <string_view>

namespace glint::cli {

namespace {

std::vector<std::string> namesOf(const std::vector<compiler::SettingWord>& words) {
    return base::mapped<std::string>(words, &compiler::SettingWord::name);
}

std::string typeOf(const compiler::Descriptor& row) {
    if (!row.values.type.empty()) {
        return std::string(row.values.type);
    }
    switch (row.values.form) {
        case compiler::ValueForm::Whole:
            return "N";
        case compiler::ValueForm::Real:
            return "X";
        default:
            return fmt::format("{}", fmt::join(namesOf(wordsOf(row)), "|"));
    }
}

// Returns what the option does, what its words mean, its range and its default.
std::string helpOf(const compiler::Descriptor& row, const compiler::Settings& settings) {
    const compiler::SettingValues& values = row.values;
    std::string text(row.what);
    std::vector<std::string> others;
    for (const compiler::SettingWord& word : wordsOf(row)) {
        if (!word.what.empty()) {
            const std::string name = isSwitch(row) ? optionWords(row, word.name).front() : word.name;
            text += fmt::format("; {}: {}", name, word.what);
        } else if (values.form == compiler::ValueForm::List) {
            others.push_back(word.name);
        }
    }
    if (!others.empty()) {
        text += fmt::format("; others: {}", fmt::join(others, ", "));
    }
    const std::string usual = values.text(settings);
    if (values.form == compiler::ValueForm::Whole || values.form == compiler::ValueForm::Real) {
        return helpText(text, fmt::format("({} to {}, default: {})", compiler::boundText(values.min),
                                          compiler::boundText(values.max), usual));
    }
    return helpText(text, isSwitch(row) && usual == "off" ? "" : fmt::format("(default: {})", usual));
}

void addSetting(CLI::App& command, const compiler::Descriptor& row, compiler::Settings& settings) {
    const std::string flags = "--" + std::string(row.name);
    const std::string help = helpOf(row, settings);
    const auto set = [&row, &settings, usual = row.values.text(settings)](const CLI::results_t& words) {
        row.values.set(settings, fmt::format("{}", fmt::join(words, ",")));
        std::erase(settings.given, row.name);
        if (row.values.text(settings) != usual) {
            settings.given.emplace_back(row.name);
        }
        return true;
    };
    CLI::Option* option = nullptr;
    if (isSwitch(row)) {
        const auto value = std::make_shared<std::string>();
        option = command.add_flag(switchFlags(flags, "on", "off"), *value, help);
        option->each([value, set](const std::string& word) { set({word}); });
    } else {
        option = command.add_option(flags, set, help)->type_name(typeOf(row));
    }
    option->group(std::string(row.group));
    if (row.values.form == compiler::ValueForm::List) {
        option->expected(1, CLI::detail::expected_max_vector_size)->delimiter(',')->allow_extra_args(false);
    }
    if (!isSwitch(row)) {
        keepChoices(*option, namesOf(wordsOf(row)));
    }
    option->check(CLI::Validator([&row](const std::string& text) { return complaintAbout(row, text); }, ""));
}

// Returns the settings that decide whether those of `which` change anything. A package for several strategies
// counts as one of a strategy that sorts hits, if it has such a one.
compiler::Settings decisive(const compiler::Build& build) {
    compiler::Settings settings = build.asked;
    settings.strategy = build.settings.strategy;
    if (!build.draws) {
        const std::uint32_t all = build.settings.compile.strategies;
        const std::uint32_t ordered = all & package::orderedStrategies();
        for (const package::Strategy strategy : package::strategies()) {
            if (((ordered != 0 ? ordered : all) & strategy) != 0) {
                settings.strategy = strategy;
            }
        }
    }
    return settings;
}

// Returns null for a command without that option.
const CLI::Option* givenOption(const CLI::App& command, const std::string& name) {
    const CLI::Option* const option = command.get_option_no_throw(name);
    return option != nullptr && option->count() > 0 ? option : nullptr;
}

// Refuses names that only a pack could give.
void refuseNames(std::string_view setting, const std::vector<std::string>& names) {
    if (!names.empty()) {
        compiler::Descriptor row = *compiler::sweptSetting(setting);
        row.values.accepts = nullptr;
        row.values.further = {};
        throw CLI::ValidationError("--" + std::string(setting), complaintAbout(row, names.front()));
    }
}

// Packages for scenes that are edited, and for hosts that bring textures of their own, trust no textures.
void checkTrust(const CLI::App& command, const compiler::Settings& settings) {
    if (settings.compile.trustTextures && !trustsTextures(settings) &&
        givenOption(command, "--trust-textures") != nullptr) {
        throw CLI::ValidationError(
            "--trust-textures",
            fmt::format("can't be combined with {}, with which textures may hold anything at run time; "
                        "leave out one of them",
                        settings.compile.plan.fallback ? "--fallback" : "--host"));
    }
}

}  // namespace

void addSettings(CLI::App& command, compiler::SettingCommand which, compiler::Settings& settings) {
    for (const compiler::Descriptor& row : compiler::settingsTable()) {
        if ((row.commands & which) != 0) {
            addSetting(command, row, settings);
        }
    }
}

void checkSettings(const CLI::App& command, const compiler::Settings& settings) {
    checkTrust(command, settings);
    if (const CLI::Option* const effects = givenOption(command, "--effects")) {
        for (const std::string alone : {"none", "all"}) {
            const bool named = std::ranges::find(effects->results(), alone) != effects->results().end();
            if (named && effects->results().size() > 1) {
                throw CLI::ValidationError(
                    "--effects",
                    alone + " can't be combined with other effects; leave out one or the others");
            }
        }
    }
    if (settings.materials.empty()) {
        refuseNames("hit-lobes", settings.packLobes);
        refuseNames("effects", settings.compile.effects.ofPacks);
    }
    if (settings.frame.occlusionFalloff &&
        settings.frame.occlusionRadius == std::numeric_limits<float>::infinity()) {
        throw CLI::ValidationError("--ao-falloff", "linear needs a radius; give one with --ao-radius");
    }
    if (settings.strategy && (*settings.strategy & package::pipelineStrategies()) != 0 &&
        settings.renderer.tracer == package::kTracerRayQuery) {
        throw CLI::ValidationError(
            "--tracer",
            fmt::format("ray-query can't run --strategy {}, which is a ray tracing pipeline; "
                        "leave out --tracer, or use --strategy {}",
                        package::nameOf(*settings.strategy), package::strategyTable().front().name));
    }
}

void checkProfile(const CLI::App& command, const compiler::Settings& settings) {
    const CLI::Option* const merge = givenOption(command, "--merge");
    const bool isNamed = merge != nullptr && !compiler::parseMerge(merge->results().front())->file.empty();
    const compiler::MergePolicy policy = settings.compile.plan.merge;
    if (isNamed && givenOption(command, "--profile") != nullptr) {
        throw CLI::ValidationError("--merge",
                                   "names a profile, and so does --profile; give only one of them");
    }
    if (policy == compiler::MergePolicy::Profile && settings.profile.empty()) {
        throw CLI::ValidationError(
            "--merge",
            "profile needs the hits that `glint render --profile FILE` counted; give profile:FILE");
    }
    if (!takesHits(policy) && !settings.profile.empty()) {
        throw CLI::ValidationError(
            "--profile",
            fmt::format("is for --merge profile and auto, not for --merge {}; leave out one of them",
                        nameOf(policy)));
    }
}

void addProfileInput(CLI::App& command, compiler::Settings& settings) {
    addText(
        command, "--profile", settings.profile, "FILE",
        "hits that `glint render --profile FILE` counted, for --merge profile; --merge auto uses them too")
        .group("Shaders");
}

void addCalibration(CLI::App& command, compiler::Settings& settings) {
    const OptionGroup group(command, "Shaders");
    addText(command, "--calibration", settings.calibration, "FILE.json",
            "device.json of `glint bench --calibrate`: what strategies cost on a device (default: constants "
            "that are built in)");
    addText(command, "--gpu", settings.gpu, "NAME|FILE",
            "what the compiler of a GPU makes of the shaders, for --strategy auto and --merge auto: a name "
            "such as navi31, or a table; device: this one, with --package (default: nothing)");
}

void addReadingOptions(CLI::App& command, compiler::Settings& settings) {
    addText(command, "--scene", settings.sceneInFile, "NAME|INDEX",
            "draw this one of the file's scenes; numbers count from 0 (default: the file's own choice, or "
            "else the first)");
    addText(command, "--variant", settings.variant, "NAME",
            "use the materials of this variant of the scene (KHR_materials_variants; default: none)");
    addFlag(command, "--strict-paths", settings.strictPaths,
            "refuse symbolic links that lead out of the scene's folder: for scenes that strangers made");
    addTexts(command, "--materials", settings.materials, "DIR",
             "add the material features and effects that this folder declares (docs/material_features.md, "
             "docs/effects.md); may be repeated")
        .allow_extra_args(false);
}

void addHostOption(CLI::App& command, compiler::Settings& settings) {
    addText(command, "--host", settings.compile.host, "DIR",
            "read geometry, materials, textures, lights and sky by the functions in this folder's GLSL "
            "(docs/host.md)")
        .group("Shaders");
}

void addLockOptions(CLI::App& command, compiler::LockRequest& request, bool isWritten) {
    const OptionGroup group(command, "Shaders");
    request.isWritten = isWritten;
    CLI::Option& lock =
        addText(command, "--lock", request.file, "FILE",
                isWritten ? "keep shader IDs from build to build in this file, which is created, and "
                            "extended by new keys; commit it"
                          : "take shader IDs from this file, which glint compile --lock keeps");
    if (!isWritten) {
        return;
    }
    CLI::Option& frozen = addFlag(command, "--locked", request.frozen,
                                  "fail, and write nothing, if the lock file would change (needs --lock)");
    CLI::Option& prune = addFlag(command, "--lock-prune", request.prune,
                                 "remove keys that no scene has from the lock file, which frees their IDs "
                                 "(needs --lock, excludes --locked)");
    frozen.needs(&lock);
    prune.needs(&lock)->excludes(&frozen);
}

Diagnostic idleWarning(const std::string& where, const std::string& words, const std::string& reason) {
    return makeWarning("setting-idle", where, fmt::format("{} changes nothing: {}", words, reason),
                       "leave it out");
}

std::vector<Diagnostic> idleSettings(const compiler::Build& build) {
    std::vector<Diagnostic> warnings;
    const compiler::Settings& given = build.asked;
    const std::string where = build.scenes->scenes().front().path;
    if (!given.calibration.empty() && !build.settings.compile.strategyChoice) {
        warnings.push_back(idleWarning(where, "--calibration", "only --strategy auto reads it"));
    }
    if (given.precisionError > 0.0 && !given.choosesPrecision) {
        warnings.push_back(idleWarning(where, fmt::format("--precision-error {}", given.precisionError),
                                       "only --precision auto reads it"));
    }
    if (given.given.empty()) {
        return warnings;
    }
    const compiler::SettingCommand which = build.draws ? compiler::kOfRender : compiler::kOfCompile;
    const compiler::Configuration base = configurationOf(decisive(build));
    std::vector<compiler::BenchFacts> facts;
    for (std::size_t i = 0; i < build.scenes->scenes().size(); ++i) {
        facts.push_back(measure::factsOf(build, i));
    }
    for (const compiler::Descriptor& row : compiler::settingsTable()) {
        if ((row.commands & which) == 0 || std::ranges::find(given.given, row.name) == given.given.end()) {
            continue;
        }
        std::string reason;
        for (const compiler::BenchFacts& scene : facts) {
            reason = idleReason(row, scene, base);
            if (reason.empty()) {
                break;
            }
        }
        if (!reason.empty()) {
            warnings.push_back(idleWarning(
                where, fmt::format("{}", fmt::join(optionWords(row, row.values.text(given)), " ")), reason));
        }
    }
    return warnings;
}

namespace {

constexpr const char* kOption = "--settings";

// Returns the value of an option, joined to it or as the next word; nothing if the option is not given.
std::optional<std::string> given(std::span<const char* const> arguments, std::string_view option) {
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const std::string_view word = arguments[i];
        if (word == "--") {
            break;
        }
        if (word == option) {
            return i + 1 < arguments.size() ? arguments[i + 1] : "";
        }
        if (word.starts_with(option) && word.size() > option.size() && word[option.size()] == '=') {
            return std::string(word.substr(option.size() + 1));
        }
    }
    return std::nullopt;
}

// Takes "--sun off" for "--sun=off": boolean options have no value of their own, but people give one.
std::vector<std::string> joinSwitches(const CLI::App& command, const std::vector<std::string>& words) {
    std::vector<std::string> joined;
    for (const std::string& word : words) {
        const CLI::Option* const option =
            joined.empty() ? nullptr : command.get_option_no_throw(joined.back());
        const bool isValue = word == "on" || word == "off" || word == "auto";
        if (isValue && option != nullptr && option->get_expected_max() == 0) {
            joined.back() += "=" + word;
        } else {
            joined.push_back(word);
        }
    }
    return joined;
}

}  // namespace

void addSettingsFile(CLI::App& command, std::string& file) {
    addText(command, kOption, file, "FILE.json",
            "read options from this file, such as `glint bench` writes; options on the command line win")
        .group("Settings");
}

Result<CompletedLine> completeLine(const CLI::App& app, std::span<const char* const> arguments) {
    CompletedLine line;
    line.words.assign(arguments.begin(), arguments.end());
    const CLI::App* const command = arguments.empty() ? nullptr : findCommand(app, arguments.front());
    if (command != nullptr) {
        line.words = joinSwitches(*command, line.words);
    }
    const bool takes = command != nullptr && command->get_option_no_throw(kOption) != nullptr;
    const std::optional<std::string> file = takes ? given(arguments, kOption) : std::nullopt;
    if (!file || file->empty()) {
        return line;
    }
    GLINT_TRY(const auto settings, measure::readSettings(*file));
    line.file = *file;
    const bool isPackaged = given(arguments, "--package").has_value();
    compiler::Configuration taken;
    for (const auto& [name, value] : settings) {
        const std::string option = "--" + name;
        const bool isDecided =
            isPackaged && compiler::sweptSetting(name)->stage == compiler::SettingStage::Package;
        if (command->get_option_no_throw(option) != nullptr && !given(arguments, option) && !isDecided) {
            taken.emplace(name, value);
            line.options.push_back(option);
        }
    }
    const std::vector<std::string> words = compiler::wordsOf(taken);
    line.words.insert(line.words.begin() + 1, words.begin(), words.end());
    return line;
}

std::optional<Diagnostic> blameFile(const CompletedLine& line, const std::string& complaint) {
    for (const std::string& option : line.options) {
        if (complaint.starts_with(option + ":")) {
            const std::string name = option.substr(2);
            return measure::settingsError(
                line.file, "/settings/" + name, complaint.substr(option.size() + 2),
                fmt::format("correct it there, or give {} on the command line", option));
        }
    }
    return std::nullopt;
}

}  // namespace glint::cli
