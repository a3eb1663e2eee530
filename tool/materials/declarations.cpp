#include "materials/declarations.h"

#include "base/json.h"
#include "materials/declaration_json.h"
#include "materials/feature_code.h"
#include "materials/material_model.h"
#include "materials/model_builder.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <span>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace glint::materials {

// The members that a declaration may have.
std::vector<std::string_view> effectMembers();
// Reads the declaration in `file`. Throws DeclarationFault.
EffectDeclaration readEffect(const Members& members, std::string_view file, bool isOfPack);
// Orders the effects: their place is the number of their bit. Throws DeclarationFault.
void numberEffects(std::vector<EffectDeclaration>& effects);

namespace {

using package::EffectInfo;

constexpr std::string_view kMembers[] = {"$schema", "name",         "about",   "kind",     "order",
                                         "glsl",    "calledFor",    "refines", "settings", "coherence",
                                         "absent",  "sharesLights", "albedo",  "shows"};

constexpr struct {
    std::string_view name;
    EffectInfo::Kind kind;
} kKinds[] = {{"light", EffectInfo::Kind::Light},
              {"surface", EffectInfo::Kind::Surface},
              {"rays", EffectInfo::Kind::Rays}};

constexpr struct {
    std::string_view name;
    bool all;
    Behaviour behaviour;
} kCalls[] = {{"lit", true, {}},
              {"reflects", false, Behaviour::Reflects},
              {"transmits", false, Behaviour::Transmits},
              {"scatters", false, Behaviour::Scatters},
              {"emits", false, Behaviour::Emits}};

constexpr std::string_view kAlbedos[] = {"diffuse", "specular", "transmission"};
constexpr std::string_view kShown[] = {"mirrored", "refracted"};

// Reads a member that only effects with rays have, and whose value is one of the words.
std::string readWord(const Members& members, std::string_view name, std::span<const std::string_view> words,
                     EffectInfo::Kind kind) {
    if (!members.has(name)) {
        return {};
    }
    std::string word = members.text(name);
    if (kind != EffectInfo::Kind::Rays) {
        failAt(members.at(name), "only an effect of the kind rays can have it");
    }
    if (std::ranges::find(words, word) == words.end()) {
        failAt(members.at(name), fmt::format("\"{}\" is none of {}", word, fmt::join(words, ", ")));
    }
    return word;
}

// The files of GLSL, and the kind of effect that has each.
constexpr struct {
    std::string_view name;
    std::string EffectDeclaration::*file;
    EffectInfo::Kind kind;
    bool isNeeded;
    std::string_view extension;
} kFiles[] = {
    {"light", &EffectDeclaration::light, EffectInfo::Kind::Light, true, ".glsl"},
    {"apply", &EffectDeclaration::apply, EffectInfo::Kind::Surface, true, ".glsl"},
    {"sample", &EffectDeclaration::sample, EffectInfo::Kind::Rays, true, ".glsl"},
    {"compose", &EffectDeclaration::compose, EffectInfo::Kind::Rays, false, ".glsl"},
    {"start", &EffectDeclaration::start, EffectInfo::Kind::Rays, false, ".glsl"},
    {"walk", &EffectDeclaration::walk, EffectInfo::Kind::Rays, false, ".comp"},
    {"hit", &EffectDeclaration::hit, EffectInfo::Kind::Rays, false, ".glsl"},
};

void readFiles(const Members& declaration, std::string_view file, EffectDeclaration& effect) {
    std::vector<std::string_view> known;
    for (const auto& row : kFiles) {
        if (row.kind == effect.kind) {
            known.push_back(row.name);
        }
    }
    const Members members(declaration["glsl"], declaration.at("glsl"), known);
    const std::string_view folder = file.substr(0, file.rfind('/') + 1);
    for (const auto& row : kFiles) {
        if (row.kind != effect.kind || (!row.isNeeded && !members.has(row.name))) {
            continue;
        }
        const std::string name = members.text(row.name);
        if (!isDeclaredFile(name, row.extension)) {
            failAt(members.at(row.name),
                   fmt::format("\"{}\" must be the name of a {} file beside the declaration", name,
                               row.extension));
        }
        effect.*row.file = std::string(folder) + name;
    }
}

EffectCall readCall(const Members& members) {
    EffectCall call;
    const auto& row = choose(kCalls, members, "by", members.text("by"));
    call.byAll = row.all;
    call.behaviour = row.behaviour;
    call.lights = members.flag("lights", false);
    call.because = members.text("because", "");
    call.otherwise = members.text("otherwise", "");
    if (call.byAll == call.because.empty() || call.byAll != call.otherwise.empty()) {
        failAt(members.where(),
               "\"because\" stands where \"by\" is \"lit\", and there alone; \"otherwise\" stands elsewhere");
    }
    return call;
}

EffectCoherence readCoherence(const Members& declaration) {
    EffectCoherence coherence;
    if (declaration.has("coherence") && declaration["coherence"].is_object()) {
        const Members members(declaration["coherence"], declaration.at("coherence"), {"mirror", "glossy"});
        coherence.mirror = Members::toNumber(members["mirror"], members.at("mirror"));
        coherence.glossy = Members::toNumber(members["glossy"], members.at("glossy"));
    } else {
        coherence.mirror = declaration.number("coherence", coherence.mirror);
        coherence.glossy = coherence.mirror;
    }
    for (const double value : {coherence.mirror, coherence.glossy}) {
        if (!(value >= 0.0 && value <= 1.0)) {
            failAt(declaration.at("coherence"), "must be from 0 to 1");
        }
    }
    return coherence;
}

}  // namespace

std::vector<std::string_view> effectMembers() {
    return {std::begin(kMembers), std::end(kMembers)};
}

EffectDeclaration readEffect(const Members& members, std::string_view file, bool isOfPack) {
    EffectDeclaration effect;
    effect.name = members.text("name");
    if (!isEffectName(effect.name)) {
        failAt(
            members.at("name"),
            fmt::format("\"{}\" must be words of small letters and digits, joined by hyphens", effect.name));
    }
    effect.declaration = file;
    effect.about = members.text("about");
    if (!effect.about.ends_with('.')) {
        failAt(members.at("about"), "must be a sentence, with its full stop");
    }
    effect.kind = choose(kKinds, members, "kind", members.text("kind")).kind;
    effect.order = members.number("order", kUnlimited);
    effect.isOfPack = isOfPack;
    effect.call = readCall(
        Members(members["calledFor"], members.at("calledFor"), {"by", "lights", "because", "otherwise"}));
    effect.refines = members.text("refines", "");
    effect.coherence = readCoherence(members);
    effect.settings = members.texts("settings");
    effect.absent = members.text("absent", "");
    if (effect.settings.empty() != effect.absent.empty()) {
        failAt(members.where(), "\"absent\" stands where \"settings\" are, and there alone");
    }
    effect.sharesLights = members.flag("sharesLights", false);
    if (effect.sharesLights && effect.kind != EffectInfo::Kind::Rays) {
        failAt(members.at("sharesLights"), "only an effect of the kind rays can share light");
    }
    effect.albedo = readWord(members, "albedo", kAlbedos, effect.kind);
    effect.shows = readWord(members, "shows", kShown, effect.kind);
    readFiles(members, file, effect);
    return effect;
}

void numberEffects(std::vector<EffectDeclaration>& effects) {
    std::ranges::sort(effects, {}, [](const EffectDeclaration& effect) {
        return std::tuple(effect.isOfPack, effect.order, effect.name);
    });
    bool hasLight = false;
    for (std::size_t i = 0; i < effects.size(); ++i) {
        const EffectDeclaration& effect = effects[i];
        const std::string where = effect.declaration + "#/name";
        for (std::size_t other = 0; other < i; ++other) {
            if (effects[other].name == effect.name) {
                failAt(where, fmt::format("\"{}\" is declared twice; {} declares it, too", effect.name,
                                          effects[other].declaration));
            }
        }
        if (effect.name == "auto" || effect.name == "all" || effect.name == "none") {
            failAt(where, fmt::format("--effects has another meaning for \"{}\"", effect.name));
        }
        // The passes that light surfaces have room for one such effect.
        if (effect.kind == EffectInfo::Kind::Light && std::exchange(hasLight, true)) {
            failAt(effect.declaration + "#/kind",
                   "there can be one effect of the kind light; Glint has shadow");
        }
        if (i >= package::kMostEffects) {
            failAt(where, fmt::format("there are more than {} effects", package::kMostEffects));
        }
    }
}

namespace {

bool isIdentifier(std::string_view name) {
    return !name.empty() && std::islower(static_cast<unsigned char>(name.front())) != 0 &&
           std::ranges::all_of(name, [](unsigned char c) { return std::isalnum(c) != 0; });
}

}  // namespace

ParsedDeclaration::ParsedDeclaration(const DeclarationFile& file)
    : name(file.name), text(file.text), isOfPack(file.isOfPack) {
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(file.text.data());
    if (base::nestsTooDeep({bytes, file.text.size()})) {
        failAt(name, "nests too deep");
    }
    json = DeclarationJson::parse(file.text, nullptr, false);
    if (json.is_discarded()) {
        failAt(name, "is no JSON", "look for a missing comma or bracket");
    }
    // Declarations of effects have a kind; those of features have none.
    if (json.is_object() && json.contains("kind")) {
        effect = readEffect({json, name + "#", effectMembers()}, name, isOfPack);
        return;
    }
    members.emplace(json, name + "#", Place::File);
    const auto readList = [this](std::string_view member, Place place, std::vector<Members>& list) {
        for (const auto& [element, where] : members->list(member)) {
            list.emplace_back(*element, where, place);
        }
    };
    readList("parameters", Place::Parameter, parameters);
    readList("textures", Place::Texture, textures);
    readList("attributes", Place::Attribute, attributes);
    readList("features", Place::Feature, features);
}

ModelBuilder::ModelBuilder(ParsedDeclarations files) {
    addObject("", false);
    std::ranges::sort(files, {}, [](const auto& file) { return std::string_view(file->name); });
    for (std::shared_ptr<const ParsedDeclaration>& file : files) {
        if (file->effect) {
            model_.effects.push_back(*file->effect);
        } else {
            files_.push_back({std::move(file)});
        }
    }
    numberEffects(model_.effects);
    // The core comes before the extensions. This is not std::ranges, whose subrange Clang 14 can't read
    // in libstdc++ 12.
    std::stable_partition(files_.begin(), files_.end(),
                          [](const File& file) { return !file->members->has("extension"); });
}

MaterialModel ModelBuilder::build() {
    findRoles();
    for (File& file : files_) {
        collect(file);
    }
    for (const File& file : files_) {
        collectAliases(file);
    }
    assignBits();
    model_.indexAllNames();
    for (const File& file : files_) {
        link(file);
    }
    for (const File& file : files_) {
        linkAliases(file);
    }
    for (Parameter& parameter : model_.parameters) {
        if (parameter.aliasOf >= 0) {
            const Parameter& own = model_.parameters[static_cast<std::size_t>(parameter.aliasOf)];
            parameter.scaledBy = own.scaledBy;
            parameter.scaledByChannels = own.scaledByChannels;
        }
    }
    model_.indexBehaviours();
    std::vector<DeclaredCode> code;
    std::map<int, FeatureMask> replacedBy = replacing();
    for (const File& file : files_) {
        if (file->members->has("glsl")) {
            code.push_back(readFeatureCode(*file->members, file->name, file.mainFeature));
            code.back().code.unless = replacedBy[file.object];
            code.back().code.isOfPack = file->isOfPack;
        }
    }
    model_.code = orderCode(std::move(code));
    for (const FeatureCode& row : model_.code) {
        model_.opacity |= row.opacity.empty() || row.feature < 0 ? 0 : featureAt(row.feature).mask();
    }
    excludeFromModels();
    keepPlacesOfUnlit();
    orderByDependence();
    indexModel();
    return std::move(model_);
}

std::map<int, FeatureMask> ModelBuilder::replacing() const {
    std::map<int, FeatureMask> masks;
    for (const File& file : files_) {
        const int replaced = model_.objects[static_cast<std::size_t>(file.object)].replaces;
        if (replaced > 0 && file.mainFeature >= 0) {
            masks[replaced] |= model_.features[static_cast<std::size_t>(file.mainFeature)].mask();
        }
    }
    return masks;
}

int ModelBuilder::addObject(const std::string& name, bool isExtension) {
    const int known = model_.findObject(name);
    if (known >= 0) {
        return known;
    }
    model_.objects.push_back({name, isExtension});
    return static_cast<int>(model_.objects.size()) - 1;
}

std::string ModelBuilder::newName(const Members& members) {
    const std::string declared = members.text("name");
    checkName(declared, members.at("name"));
    std::string name = fullName(scope_, declared);
    claimName(name, members.at("name"));
    return name;
}

void ModelBuilder::checkName(const std::string& name, const std::string& where) {
    if (!isIdentifier(name)) {
        failAt(where, fmt::format("\"{}\" must be letters and digits that begin with a small letter", name));
    }
}

void ModelBuilder::claimName(const std::string& name, const std::string& where) {
    const auto [place, isNew] = named_.try_emplace(name, where);
    if (!isNew) {
        failAt(where, fmt::format("\"{}\" is declared twice; {} declares it, too", name, place->second));
    }
}

int ModelBuilder::named(int (MaterialModel::*find)(std::string_view) const, std::string_view name) const {
    const int own = (model_.*find)(fullName(scope_, name));
    return own >= 0 ? own : (model_.*find)(name);
}

std::string ModelBuilder::gltfPlace(int object, std::string_view member) const {
    const MaterialObject& owner = model_.objects[static_cast<std::size_t>(object)];
    std::string place = "materials[]";
    place += owner.isExtension ? ".extensions" : "";
    place += owner.name.empty() ? "" : "." + owner.name;
    return member.empty() ? place : fmt::format("{}.{}", place, member);
}

Feature& ModelBuilder::featureAt(int index) {
    return model_.features[static_cast<std::size_t>(index)];
}

int ModelBuilder::featureNamed(const std::string& name, const std::string& where) const {
    const int found = named(&MaterialModel::findFeature, name);
    if (found < 0) {
        failAt(where, fmt::format("there is no feature \"{}\"", name));
    }
    return found;
}

namespace {

// Returns what `make` does, or the fault that it throws.
template <typename Make>
auto caught(const Make& make) -> Result<decltype(make())> {
    try {
        return make();
    } catch (const DeclarationFault& fault) {
        return fault.diagnostic;
    } catch (const DeclarationJson::exception& error) {
        return makeError("declaration", "", error.what());
    }
}

}  // namespace

Result<ParsedDeclarations> parseDeclarations(std::span<const DeclarationFile> files,
                                             const ParsedDeclarations& known) {
    std::vector<DeclarationFile> sorted(files.begin(), files.end());
    std::ranges::sort(sorted, {}, &DeclarationFile::name);
    return caught([&] {
        ParsedDeclarations parsed;
        auto earlier = known.begin();
        for (const DeclarationFile& file : sorted) {
            while (earlier != known.end() && (*earlier)->name < file.name) {
                ++earlier;
            }
            const bool isKnown = earlier != known.end() && (*earlier)->name == file.name &&
                                 (*earlier)->text == file.text && (*earlier)->isOfPack == file.isOfPack;
            parsed.push_back(isKnown ? *earlier : std::make_shared<const ParsedDeclaration>(file));
        }
        return parsed;
    });
}

Result<MaterialModel> readDeclarations(ParsedDeclarations files) {
    return caught([&] { return ModelBuilder(std::move(files)).build(); });
}

Result<MaterialModel> readDeclarations(std::span<const DeclarationFile> files) {
    GLINT_TRY(auto parsed, parseDeclarations(files));
    return readDeclarations(std::move(parsed));
}

}  // namespace glint::materials
