#include "materials/declarations.h"

#include "base/json.h"
#include "materials/effect_reader.h"
#include "materials/feature_code.h"
#include "materials/model_builder.h"

#include <algorithm>
#include <cctype>
#include <utility>

namespace glint::materials {

namespace {

bool isIdentifier(std::string_view name) {
    return !name.empty() && std::islower(static_cast<unsigned char>(name.front())) != 0 &&
           std::ranges::all_of(name, [](unsigned char c) { return std::isalnum(c) != 0; });
}

}  // namespace

ModelBuilder::ModelBuilder(std::span<const DeclarationFile> files) {
    addObject("", false);
    std::vector<DeclarationFile> sorted(files.begin(), files.end());
    std::ranges::sort(sorted, {}, &DeclarationFile::name);
    for (const DeclarationFile& file : sorted) {
        parse(file);
    }
    readEffects();
    // The core comes before the extensions. This is not std::ranges, whose subrange Clang 14 can't read
    // in libstdc++ 12.
    std::stable_partition(files_.begin(), files_.end(),
                          [](const File& file) { return !file.json.contains("extension"); });
}

MaterialModel ModelBuilder::build() {
    for (File& file : files_) {
        collect(file);
    }
    for (const File& file : files_) {
        collectAliases(file);
    }
    assignBits();
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
    keepPlacesOfUnlit();
    std::vector<DeclaredCode> code;
    for (const File& file : files_) {
        const Members members = membersOf(file);
        if (members.has("glsl")) {
            code.push_back(readFeatureCode(members, file.name, file.mainFeature));
            code.back().code.unless = replacing(file.object);
            code.back().code.isOfPack = file.isOfPack;
        }
    }
    model_.code = orderCode(std::move(code));
    orderByDependence();
    return std::move(model_);
}

int ModelBuilder::replacing(int object) const {
    for (const File& file : files_) {
        const int replaced = model_.objects[static_cast<std::size_t>(file.object)].replaces;
        if (object > 0 && replaced == object) {
            return file.mainFeature;
        }
    }
    return -1;
}

void ModelBuilder::parse(const DeclarationFile& file) {
    File parsed{std::string(file.name), {}, 0, -1, file.isOfPack};
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(file.text.data());
    if (base::nestsTooDeep({bytes, file.text.size()})) {
        failAt(parsed.name, "nests too deep");
    }
    parsed.json = DeclarationJson::parse(file.text, nullptr, false);
    if (parsed.json.is_discarded()) {
        failAt(parsed.name, "is no JSON", "look for a missing comma or bracket");
    }
    files_.push_back(std::move(parsed));
}

void ModelBuilder::readEffects() {
    const auto isEffect = [](const File& file) {
        return file.json.is_object() && file.json.contains("kind");
    };
    for (const File& file : files_) {
        if (isEffect(file)) {
            model_.effects.push_back(
                readEffect({file.json, file.name + "#", effectMembers()}, file.name, file.isOfPack));
        }
    }
    std::erase_if(files_, isEffect);
    numberEffects(model_.effects);
}

Members ModelBuilder::membersOf(const File& file) const {
    return {file.json, file.name + "#", kFileMembers};
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
    std::string name = members.text("name");
    if (!isIdentifier(name)) {
        failAt(members.at("name"),
               fmt::format("\"{}\" must be letters and digits that begin with a small letter", name));
    }
    const auto [place, isNew] = named_.try_emplace(name, members.at("name"));
    if (!isNew) {
        failAt(members.at("name"),
               fmt::format("\"{}\" is declared twice; {} declares it, too", name, place->second));
    }
    return name;
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
    const int found = model_.findFeature(name);
    if (found < 0) {
        failAt(where, fmt::format("there is no feature \"{}\"", name));
    }
    return found;
}

Result<MaterialModel> readDeclarations(std::span<const DeclarationFile> files) {
    try {
        return ModelBuilder(files).build();
    } catch (const DeclarationFault& fault) {
        return fault.diagnostic;
    } catch (const DeclarationJson::exception& error) {
        return makeError("declaration", "", error.what());
    }
}

}  // namespace glint::materials
