#include "materials/model_builder.h"
#include "materials/value_json.h"

#include <algorithm>
#include <array>
#include <interop/models.h>
#include <tuple>
#include <utility>

namespace glint::materials {

void ModelBuilder::assignBits() {
    std::vector<int> sorted(pending_.size());
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        sorted[i] = static_cast<int>(i);
    }
    std::ranges::sort(sorted, {}, [this](int i) {
        const Pending& row = pending_[static_cast<std::size_t>(i)];
        const Pending* const base = row.base < 0 ? nullptr : &pending_[static_cast<std::size_t>(row.base)];
        // The bits of Glint's own features are the same with packs as without. Those of a model follow its
        // base.
        return std::tuple(row.isOfPack, base != nullptr, base != nullptr ? base->order : 0.0,
                          base != nullptr ? std::string_view(base->feature.name) : std::string_view(),
                          i != row.base, !isLobe(row.feature), row.order, std::string_view(row.feature.name));
    });
    std::vector<int> indexOf(pending_.size());
    int lobe = 0;
    int input = kFirstInput;
    int further = kFirstInput;  // inputs that find no place in their word go down from here
    int own = kFirstOfModels;
    for (const int i : sorted) {
        Pending& row = pending_[static_cast<std::size_t>(i)];
        const int index = static_cast<int>(model_.features.size());
        row.feature.isLobe = isLobe(row.feature);
        if (row.base >= 0) {
            row.feature.bit = own++;
            if (row.base == i) {
                model_.models.push_back({row.feature.name, index, own});
            } else if (++model_.models.back().bits > kOwnFeatures) {
                failAt(row.where, fmt::format("{} has more than {} features of its own",
                                              model_.models.back().name, kOwnFeatures));
            }
            row.feature.model = static_cast<int>(model_.models.size()) - 1;
        } else {
            row.feature.bit = row.feature.isLobe ? lobe++ : input < kFirstOfModels ? input++ : --further;
        }
        if (lobe > further) {
            failAt(row.where, fmt::format("there are more features than the {} bits that all models share",
                                          kFirstOfModels));
        }
        model_.lobes |= row.feature.isLobe ? row.feature.mask() : 0;
        model_.bases |= row.feature.stage == Stage::Base ? row.feature.mask() : 0;
        indexOf[static_cast<std::size_t>(i)] = index;
        model_.unlit |= row.light == Light::None ? row.feature.mask() : 0;
        model_.bothSides |= row.light == Light::Both ? row.feature.mask() : 0;
        model_.features.push_back(std::move(row.feature));
    }
    for (MaterialTexture& texture : model_.textures) {
        texture.feature = indexOf[static_cast<std::size_t>(texture.feature)];
    }
    for (File& file : files_) {
        file.mainFeature = file.mainFeature < 0 ? -1 : indexOf[static_cast<std::size_t>(file.mainFeature)];
    }
    for (VertexAttribute& attribute : model_.attributes) {
        attribute.feature = indexOf[static_cast<std::size_t>(attribute.feature)];
    }
    model_.indexBits();
    // Slots have the order of their bits.
    std::ranges::sort(model_.textures, {}, &MaterialTexture::feature);
    for (std::size_t i = 0; i < model_.textures.size(); ++i) {
        featureAt(model_.textures[i].feature).texture = static_cast<int>(i);
    }
}

bool ModelBuilder::isLobe(const Feature& feature) {
    return feature.texture < 0 && (feature.stage == Stage::Base || feature.stage == Stage::Layer);
}

void ModelBuilder::orderByDependence() {
    const std::size_t count = model_.features.size();
    std::vector<std::vector<int>> needs(count);
    const auto isLate = [&](const Feature& feature) {
        return feature.stage == Stage::Attributes || feature.stage == Stage::Coordinates;
    };
    for (const Exclusion& exclusion : model_.exclusions) {
        for (const int excluded : model_.indicesOf(exclusion.excluded)) {
            needs[static_cast<std::size_t>(excluded)].push_back(exclusion.by);
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        const Feature& feature = model_.features[i];
        for (const NeutralReason& reason : feature.neutral) {
            addNeeds(reason.when, needs[i]);
        }
        if (feature.given) {
            addNeeds(*feature.given, needs[i]);
        }
        if (feature.lobe >= 0) {
            needs[i].push_back(feature.lobe);
        }
        if (feature.model >= 0 && model_.baseOf(feature) != static_cast<int>(i)) {
            needs[i].push_back(model_.baseOf(feature));
        }
        if (asksFor(feature, Fact::ModelOfPack)) {
            for (const BaseModel& model : model_.models) {
                needs[i].push_back(model.feature);
            }
        }
        if (asksFor(feature, Fact::ChangesOpacity)) {
            for (const FeatureCode& code : model_.code) {
                if (!code.opacity.empty() && code.feature != static_cast<int>(i)) {
                    needs[i].push_back(code.feature);
                }
            }
        }
        for (std::size_t other = 0; isLate(feature) && other < count; ++other) {
            if (!isLate(model_.features[other])) {
                needs[i].push_back(static_cast<int>(other));
            }
        }
    }
    // How many each waits for, and which wait for each.
    std::vector<std::size_t> open(count);
    std::vector<std::vector<int>> waiting(count);
    std::set<int> ready;
    for (std::size_t i = 0; i < count; ++i) {
        open[i] = needs[i].size();
        for (const int need : needs[i]) {
            waiting[static_cast<std::size_t>(need)].push_back(static_cast<int>(i));
        }
        if (open[i] == 0) {
            ready.insert(static_cast<int>(i));
        }
    }
    while (model_.order.size() < count) {
        if (ready.empty()) {
            // The last one, as features of packs come last.
            const auto left = std::find_if(open.rbegin(), open.rend(), [](std::size_t n) { return n > 0; });
            const Feature& feature = model_.features[static_cast<std::size_t>(open.rend() - left) - 1];
            failAt(named_[feature.name],
                   fmt::format("the conditions of \"{}\" lead back to it", feature.name));
        }
        const int next = *ready.begin();
        ready.erase(ready.begin());
        for (const int other : waiting[static_cast<std::size_t>(next)]) {
            if (--open[static_cast<std::size_t>(other)] == 0) {
                ready.insert(other);
            }
        }
        const Feature& feature = model_.features[static_cast<std::size_t>(next)];
        const int base = feature.model < 0 ? -1 : model_.baseOf(feature);
        // What is asked for by value is decided for every material.
        const bool byObject = base >= 0 && !featureAt(base).given && featureAt(base).object >= 0 &&
                              featureAt(base).neutral.empty();
        std::vector<int>& steps = byObject
                                      ? model_.objects[static_cast<std::size_t>(featureAt(base).object)].steps
                                      : model_.commonSteps;
        steps.push_back(static_cast<int>(model_.order.size()));
        model_.order.push_back({next, base < 0 || base == next ? -1 : featureAt(base).bit});
    }
}

void ModelBuilder::excludeFromModels() {
    // What changes the replaced BSDF: its lobes but for layers, what features of packs make of its values,
    // and what the declaration of the replaced object itself adds.
    FeatureMask ofBase = 0;
    for (const Feature& feature : model_.features) {
        ofBase |= feature.stage == Stage::Layer && feature.texture < 0 ? feature.mask() : 0;
    }
    for (const FeatureCode& code : model_.code) {
        const FeatureMask own = code.feature < 0 ? 0 : featureAt(code.feature).mask();
        ofBase = code.layer.empty() ? ofBase | (code.bsdf.empty() ? 0 : own) : ofBase & ~own;
    }
    const FeatureMask models = model_.bases & ~model_.unlit;
    FeatureMask later = models;
    for (std::size_t i = 0; i < model_.features.size(); ++i) {
        const Feature& feature = model_.features[i];
        if (!models.has(feature.bit)) {
            continue;
        }
        later &= ~feature.mask();
        if (later != 0) {
            model_.exclusions.push_back(
                {static_cast<int>(i), later, fmt::format("{} is the material's model", feature.name)});
        }
    }
    std::map<int, FeatureMask> furtherOf;  // by object
    for (const File& file : files_) {
        for (const Members& further : file->features) {
            furtherOf[file.object] |= model_.mask(fullName(file.scope, further.text("name")));
        }
    }
    const FeatureMask changing = ofBase & ~models;
    for (const FeatureCode& code : model_.code) {
        if (code.model.empty()) {
            continue;
        }
        const Feature& feature = featureAt(code.feature);
        model_.ownModels |= feature.mask();
        const int replaced = model_.objects[static_cast<std::size_t>(feature.object)].replaces;
        const auto further = furtherOf.find(replaced);
        const FeatureMask excluded = further == furtherOf.end() ? changing : changing | further->second;
        model_.exclusions.push_back(
            {code.feature, excluded, fmt::format("{} is the material's model", code.name)});
    }
}

void ModelBuilder::indexModel() {
    for (std::size_t i = 0; i < model_.exclusions.size(); ++i) {
        featureAt(model_.exclusions[i].by).exclusions.push_back(static_cast<int>(i));
    }
    for (std::size_t i = 0; i < model_.features.size(); ++i) {
        const Feature& feature = model_.features[i];
        if (feature.object < 0) {
            continue;
        }
        MaterialObject& object = model_.objects[static_cast<std::size_t>(feature.object)];
        const auto index = static_cast<int>(i);
        object.feature = object.feature < 0 ? index : object.feature;
        object.base = object.base < 0 && feature.stage == Stage::Base ? index : object.base;
        object.isUnlit = object.isUnlit || model_.unlit.has(feature.bit);
        object.asksFor.push_back(index);
    }
    for (std::size_t i = 0; i < model_.parameters.size(); ++i) {
        const Parameter& parameter = model_.parameters[i];
        MaterialObject& object = model_.objects[static_cast<std::size_t>(parameter.object)];
        object.parameters.push_back(static_cast<int>(i));
        if (parameter.aliasOf >= 0) {
            object.fills.insert(std::ranges::upper_bound(object.fills, parameter.aliasOf), parameter.aliasOf);
        }
    }
    for (std::size_t i = 0; i < model_.textures.size(); ++i) {
        for (const MaterialTexture::Place& place : model_.textures[i].places) {
            std::vector<int>& textures = model_.objects[static_cast<std::size_t>(place.object)].textures;
            if (textures.empty() || textures.back() != static_cast<int>(i)) {
                textures.push_back(static_cast<int>(i));
            }
        }
    }
    const int color = model_.parameterOf(package::Role::BaseColor);
    for (std::size_t i = 0; i < model_.models.size(); ++i) {
        BaseModel& model = model_.models[i];
        const int base = featureAt(model.feature).bit;
        model.word = static_cast<std::uint32_t>(i) + 1;
        model.word |= model_.unlit.has(base) ? gpu::kModelUnlit : 0U;
        model.word |= model_.bothSides.has(base) ? gpu::kModelBothSides : 0U;
        model.word |= model_.ownModels.has(base) ? gpu::kModelOwnCode : 0U;
        const bool hasColor = color >= 0 && model_.hasParameter(static_cast<int>(i), color);
        model.word |= hasColor ? gpu::kModelBaseColor : 0U;
    }
    for (const FeatureCode& code : model_.code) {
        const int owner = code.feature < 0 ? -1 : featureAt(code.feature).model;
        if (owner >= 0) {
            std::uint32_t& word = model_.models[static_cast<std::size_t>(owner)].word;
            word |= code.isSampled ? gpu::kModelSampled : 0U;
            word |= code.coordinates.empty() && code.opacity.empty() ? 0U : gpu::kModelChangesAlpha;
        }
    }
}

void ModelBuilder::keepPlacesOfUnlit() {
    FeatureMask kept = 0;
    for (const Feature& feature : model_.features) {
        const Feature& owner = feature.lobe < 0 ? feature : featureAt(feature.lobe);
        const bool isPlace = owner.stage == Stage::Coordinates || owner.stage == Stage::Opacity;
        kept |= isPlace ? feature.mask() : 0;
    }
    for (Exclusion& exclusion : model_.exclusions) {
        if ((featureAt(exclusion.by).mask() & model_.unlit) != 0) {
            exclusion.excluded &= ~kept;
        }
    }
}

bool ModelBuilder::asksFor(const Feature& feature, Fact fact) const {
    return std::ranges::any_of(feature.neutral, [&](const NeutralReason& reason) {
        const auto& symbols = reason.when.symbols();
        return std::ranges::find(symbols, model_.symbolOf(fact)) != symbols.end();
    });
}

void ModelBuilder::addNeeds(const Expression& expression, std::vector<int>& needs) const {
    const int first = model_.symbolOfFeature(0);
    for (const int symbol : expression.symbols()) {
        if (symbol >= first && symbol < first + static_cast<int>(model_.features.size())) {
            needs.push_back(symbol - first);
        }
    }
}

// --- Reads the expressions of declarations, and links the names in them ---

namespace {

constexpr struct {
    std::string_view function;
    std::string_view name;
    Fact fact;
    bool isNumber;
} kFacts[] = {
    {"", "NORMAL", Fact::Normal, false},
    {"", "TANGENT", Fact::Tangent, false},
    {"", "TEXCOORD_0", Fact::TexCoord0, false},
    {"", "TEXCOORD_1", Fact::TexCoord1, false},
    {"", "COLOR_0", Fact::Color, true},
    {"", "givesColors", Fact::GivesColors, false},
    {"", "doubleSided", Fact::DoubleSided, false},
    {"", "MASK", Fact::Mask, false},
    {"", "BLEND", Fact::Blend, false},
    {"", "raysTestAlpha", Fact::RaysTestAlpha, false},
    {"", "raysBlend", Fact::RaysBlend, false},
    {"reads", "TEXCOORD_0", Fact::ReadsTexCoord0, false},
    {"reads", "TEXCOORD_1", Fact::ReadsTexCoord1, false},
    {"", "movesTextures", Fact::MovesTextures, false},
    {"", "givesTransforms", Fact::GivesTransforms, false},
    {"needed", "tangents", Fact::NeedsTangents, false},
    {"derived", "tangents", Fact::DerivesTangents, false},
    {"turned", "tangents", Fact::TurnsTangents, false},
    {"", "changesOpacity", Fact::ChangesOpacity, false},
    {"", "modelOfPack", Fact::ModelOfPack, false},
};

}  // namespace

namespace {

Symbol symbolOf(const Parameter& parameter, int index) {
    Symbol symbol{index, false, parameter.type->channels};
    if (!parameter.isNamedByConditions()) {
        symbol.refusal = fmt::format("\"{}\" is {}, which conditions can't name", parameter.declared,
                                     parameter.isArray()           ? "an array"
                                     : parameter.type->isAddress() ? "an address"
                                                                   : "a matrix");
    } else if (parameter.type->kind == NumberKind::Name) {
        symbol.names = parameter.names;
    } else if (parameter.type->kind == NumberKind::Truth) {
        symbol.names = {"false", "true"};
        symbol.isTruth = true;
    }
    return symbol;
}

}  // namespace

std::optional<Symbol> ModelBuilder::resolve(std::string_view function,
                                            const std::vector<std::string_view>& names) {
    for (const auto& row : kFacts) {
        if (row.function == function && names.size() == 1 && row.name == names[0]) {
            return Symbol{model_.symbolOf(row.fact), !row.isNumber, 1};
        }
    }
    const auto condition = [](int index, int symbol) {
        return index < 0 ? std::nullopt : std::optional(Symbol{symbol, true, 1});
    };
    if (function.empty()) {
        const int index = named(&MaterialModel::findParameter, names[0]);
        return index < 0 ? std::nullopt
                         : std::optional(symbolOf(model_.parameters[static_cast<std::size_t>(index)], index));
    }
    if (function == "has" && names.size() == 1) {
        const int index = named(&MaterialModel::findFeature, names[0]);
        return condition(index, model_.symbolOfFeature(index));
    }
    if (function == "readable" && names.size() == 1) {
        const int index = named(&MaterialModel::findTexture, names[0]);
        return condition(index, model_.symbolOfTexture(index));
    }
    if (function == "texel" && names.size() == 1) {
        const int index = named(&MaterialModel::findTexture, names[0]);
        return index < 0 ? std::nullopt : std::optional(Symbol{model_.symbolOfTexel(index), false, 4});
    }
    if (function == "attribute" && names.size() == 1) {
        const int index = named(&MaterialModel::findAttribute, names[0]);
        return condition(index, model_.symbolOfAttribute(index));
    }
    if (function == "same" && names.size() == 2) {
        const std::array<int, 2> pair{named(&MaterialModel::findTexture, names[0]),
                                      named(&MaterialModel::findTexture, names[1])};
        if (pair[0] < 0 || pair[1] < 0) {
            return std::nullopt;
        }
        model_.pairs.push_back(pair);
        return Symbol{model_.symbolOfPair(static_cast<int>(model_.pairs.size()) - 1), true, 1};
    }
    return std::nullopt;
}

Expression ModelBuilder::expression(const DeclarationJson& json, const std::string& where, bool isCondition) {
    if (!json.is_string()) {
        failAt(where, "must be an expression, as a text");
    }
    ExpressionError error;
    const auto& text = json.get_ref<const std::string&>();
    std::optional<Expression> parsed = Expression::parse(
        text, [this](auto function, const auto& names) { return resolve(function, names); }, error);
    if (!parsed) {
        failAt(where, fmt::format("{}, at character {} of \"{}\"", error.message, error.offset + 1, text));
    }
    if (parsed->isCondition() != isCondition) {
        failAt(where, isCondition ? "must be a condition" : "must be a number");
    }
    return std::move(*parsed);
}

void ModelBuilder::linkFeature(const Members& members, int index, const FeatureMask& onlyWith) {
    if (members.has("given")) {
        featureAt(index).given = expression(members["given"], members.at("given"), true);
    }
    for (const auto& [json, where] : members.list("neutral")) {
        const Members reason(*json, where, Place::Reason);
        NeutralReason neutral{expression(reason["when"], reason.at("when"), true), reason.text("because")};
        neutral.onlyWith = onlyWith;
        featureAt(index).neutral.push_back(std::move(neutral));
    }
}

void ModelBuilder::link(const File& file) {
    scope_ = file.scope;
    const Members& members = *file->members;
    if (file.mainFeature >= 0) {
        linkFeature(members, file.mainFeature, 0);
    }
    for (const Members& further : file->features) {
        linkFeature(further, named(&MaterialModel::findFeature, further.text("name")), 0);
    }
    for (const Members& texture : file->textures) {
        if (!fills(texture, Place::Texture)) {
            linkTexture(file, texture);
        }
    }
    linkParameters(file);
    for (const auto& [json, where] : members.list("derived")) {
        linkDerived(file, Members(*json, where, Place::Derived));
    }
    linkBase(file, members);
    for (const auto& [json, where] : members.list("effects")) {
        linkBehaviour(file, Members(*json, where, Place::Effect));
    }
}

void ModelBuilder::linkTexture(const File& file, const Members& members) {
    const int slot = named(&MaterialModel::findTexture, members.text("name"));
    const int feature = model_.textures[static_cast<std::size_t>(slot)].feature;
    linkFeature(members, feature, 0);
    const bool ofLayer = file.mainFeature >= 0 && featureAt(file.mainFeature).isLobe;
    featureAt(feature).lobe = members.has("of") ? featureNamed(members.text("of"), members.at("of"))
                              : ofLayer         ? file.mainFeature
                                                : -1;
    linkScales(members, slot);
}

void ModelBuilder::linkAliases(const File& file) {
    scope_ = file.scope;
    for (const Members& texture : file->textures) {
        if (!fills(texture, Place::Texture)) {
            continue;
        }
        const int slot = filledTexture(texture);
        const int feature = model_.textures[static_cast<std::size_t>(slot)].feature;
        const FeatureMask own = file.mainFeature < 0 ? 0 : featureAt(file.mainFeature).mask();
        for (NeutralReason& reason : featureAt(feature).neutral) {
            reason.onlyWithout |= texture.has("neutral") ? own : 0;
        }
        linkFeature(texture, feature, own);
        linkScales(texture, slot);
    }
}

void ModelBuilder::linkScales(const Members& members, int slot) {
    std::set<std::string> scales;
    for (const std::string& scaled : members.texts("scales")) {
        const std::string name = scaled.substr(0, scaled.find('.'));
        int index = named(&MaterialModel::findParameter, name);
        if (index < 0) {
            failAt(members.at("scales"), fmt::format("there is no parameter \"{}\"", name));
        }
        if (!scales.insert(name).second) {
            failAt(members.at("scales"), fmt::format("\"{}\" is scaled twice", name));
        }
        // The numbers of an alias are those of the parameter that it fills.
        const int filled = model_.parameters[static_cast<std::size_t>(index)].aliasOf;
        index = filled < 0 ? index : filled;
        Parameter& parameter = model_.parameters[static_cast<std::size_t>(index)];
        if (!parameter.isVector()) {
            failAt(members.at("scales"), fmt::format("\"{}\" has the type {}; a texture scales floats and "
                                                     "vectors of them",
                                                     name, parameter.typeText()));
        }
        if (parameter.scaledBy >= 0 && parameter.scaledBy != slot) {
            failAt(members.at("scales"),
                   fmt::format("{} scales \"{}\", too; one texture can",
                               model_.textures[static_cast<std::size_t>(parameter.scaledBy)].name, name));
        }
        parameter.scaledBy = slot;
        const std::string_view channels = std::string_view(scaled).substr(name.size());
        if (channels.empty()) {
            continue;
        }
        if (channels.size() != static_cast<std::size_t>(parameter.numbers) + 1) {
            failAt(members.at("scales"),
                   fmt::format("\"{}\" must name {} of the texture's channels", scaled, parameter.numbers));
        }
        for (int i = 0; i < parameter.numbers; ++i) {
            const std::size_t channel =
                std::string_view("rgba").find(channels[static_cast<std::size_t>(i) + 1]);
            if (channel == std::string_view::npos) {
                failAt(members.at("scales"),
                       fmt::format("\"{}\" names a channel that is not r, g, b or a", scaled));
            }
            parameter.scaledByChannels[static_cast<std::size_t>(i)] = static_cast<int>(channel);
        }
    }
}

void ModelBuilder::linkParameters(const File& file) {
    for (const Members& row : file->parameters) {
        Parameter& parameter =
            model_
                .parameters[static_cast<std::size_t>(named(&MaterialModel::findParameter, row.text("name")))];
        parameter.feature = row.has("of") ? featureNamed(row.text("of"), row.at("of")) : file.mainFeature;
    }
}

void ModelBuilder::linkDerived(const File& file, const Members& members) {
    DerivedField field;
    field.name = newName(members);
    refuseWordOfGlsl(members, field.name);
    field.type = &vectorType(members);
    const auto count = static_cast<std::size_t>(field.type->channels);
    field.unit = members.text("unit", "");
    field.about = members.text("about", "");
    field.feature = members.has("of") ? featureNamed(members.text("of"), members.at("of")) : file.mainFeature;
    if (members["value"].is_array()) {
        for (const auto& [json, where] : members.list("value")) {
            field.channels.push_back(expression(*json, where, false));
        }
    } else {
        field.channels.push_back(expression(members["value"], members.at("value"), false));
    }
    const bool fits = field.channels.size() == 1 ? field.channels[0].channels() == field.type->channels ||
                                                       field.channels[0].channels() == 1
                                                 : field.channels.size() == count;
    if (!fits) {
        failAt(members.at("value"), fmt::format("must give {} channels", count));
    }
    model_.derived.push_back(std::move(field));
}

void ModelBuilder::linkBase(const File& file, const Members& members) {
    if (members.has("replaces")) {
        const Members replaces(members["replaces"], members.at("replaces"), Place::Replaces);
        const int object = model_.findObject(replaces.text("object"));
        if (object < 0) {
            failAt(replaces.at("object"), "no declaration has this object");
        }
        const auto other = std::ranges::find(model_.objects, object, &MaterialObject::replaces);
        const bool isModel = file.mainFeature >= 0 && featureAt(file.mainFeature).stage == Stage::Base;
        if (other != model_.objects.end() && !isModel) {
            failAt(members.at("replaces"), fmt::format("{} replaces it, too", other->name),
                   "base models alone can replace the same object");
        }
        MaterialObject& owner = model_.objects[static_cast<std::size_t>(file.object)];
        if (object == file.object || (owner.replaces >= 0 && owner.replaces != object)) {
            failAt(replaces.at("object"), object == file.object ? "is the declaration's own object"
                                                                : "its object replaces another one, too");
        }
        owner.replaces = object;
        if (replaces.has("sets")) {
            for (const auto& [name, value] : replaces["sets"].items()) {
                const int parameter = named(&MaterialModel::findParameter, name);
                if (parameter < 0) {
                    failAt(replaces.at("sets"), fmt::format("there is no parameter \"{}\"", name));
                }
                const std::string place = replaces.at("sets") + "/" + name;
                const Parameter& row = model_.parameters[static_cast<std::size_t>(parameter)];
                MaterialObject::Setting setting{parameter};
                if (const auto fault = readValue(row, value, setting.numbers)) {
                    failAt(place + fault->place, fault->message);
                }
                for (double& number : setting.numbers) {
                    if (!row.isValid(number)) {
                        failAt(place, "is outside of the parameter's range");
                    }
                    number = row.hold(number);
                }
                owner.settings.push_back(std::move(setting));
            }
        }
    }
    if (members.has("excludes")) {
        const Members excludes(members["excludes"], members.at("excludes"), Place::Excludes);
        Exclusion exclusion{file.mainFeature, 0, excludes.text("because")};
        std::set<int> kept{file.mainFeature};
        for (const std::string& name : excludes.texts("but")) {
            kept.insert(featureNamed(name, excludes.at("but")));
        }
        for (std::size_t i = 0; i < model_.features.size(); ++i) {
            const Feature& feature = model_.features[i];
            const bool isOfStage =
                !excludes.has("stage") ||
                (feature.texture < 0 &&
                 feature.stage == choose(kStages, excludes, "stage", excludes.text("stage")).stage);
            exclusion.excluded |= isOfStage && !kept.contains(static_cast<int>(i)) ? feature.mask() : 0;
        }
        model_.exclusions.push_back(std::move(exclusion));
    }
}

void ModelBuilder::linkBehaviour(const File& file, const Members& members) {
    const NamedBehaviour& behaviour = choose(kBehaviours, members, "does", members.text("does"));
    BehaviourRule rule{behaviour.behaviour, file.object,
                       expression(members["when"], members.at("when"), true)};
    const FeatureMask own = file.mainFeature < 0 ? 0 : featureAt(file.mainFeature).mask();
    if (rule.does == Behaviour::Transmits && (own & model_.bothSides) == 0) {
        failAt(members.at("does"), "light comes to such a surface from the viewer's side alone",
               "give the declaration \"light\": \"both\", and a feature of its own");
    }
    if (members.has("roughness")) {
        rule.roughness = expression(members["roughness"], members.at("roughness"), false);
        if (rule.roughness->channels() != 1) {
            failAt(members.at("roughness"),
                   fmt::format("has {} channels; name the one that holds the roughness",
                               rule.roughness->channels()));
        }
    }
    if (members.has("value")) {
        rule.value = expression(members["value"], members.at("value"), false);
    }
    if ((rule.does == Behaviour::Reflects) != rule.roughness.has_value()) {
        failAt(members.where(), "\"roughness\" stands where \"does\" is \"reflects\", and there alone");
    }
    // A surface that has no words for what it does would count as one that does not do it.
    rule.text = members.text("text", std::string(behaviour.text));
    if (rule.value && rule.text.find("{}") == std::string::npos) {
        failAt(members.at("value"), "there is no {} in \"text\" where it could stand");
    }
    rule.textureText = members.text("textureText", "");
    // The base speaks before the layers.
    const bool isLayer = file.mainFeature >= 0 && featureAt(file.mainFeature).stage == Stage::Layer;
    const auto place = isLayer ? model_.behaviours.end() : model_.behaviours.begin() + baseBehaviours_++;
    model_.behaviours.insert(place, std::move(rule));
}

}  // namespace glint::materials
