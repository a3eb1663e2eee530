#include "materials/feature_code.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <string_view>

namespace glint::materials {

namespace {

// A model stands in place of the base that it replaces, in the keys of its own feature.
void checkModel(const Members& declaration, const Members& glsl) {
    if (declaration.text("stage") != "base") {
        failAt(glsl.at("model"), "needs a declaration whose \"stage\" is \"base\"");
    }
    if (!declaration.has("extension") || !declaration.has("replaces")) {
        failAt(glsl.at("model"), "a model is the base of materials that name it",
               "give the declaration \"extension\", and \"replaces\" with the object of the base");
    }
}

}  // namespace

DeclaredCode readFeatureCode(const Members& declaration, std::string_view file, int feature) {
    const Members members(declaration["glsl"], declaration.at("glsl"), Place::Glsl);
    DeclaredCode declared;
    declared.where = members.where();
    FeatureCode& code = declared.code;
    code.name = declaration.text("name");
    code.declaration = file;
    code.feature = feature;
    const std::string_view folder = file.substr(0, file.rfind('/') + 1);
    struct {
        std::string_view member;
        std::string& file;
    } const stages[] = {{"surface", code.surface},   {"bsdf", code.bsdf},
                        {"layer", code.layer},       {"model", code.model},
                        {"emission", code.emission}, {"coordinates", code.coordinates},
                        {"opacity", code.opacity},   {"diffuse", code.diffuse}};
    for (const auto& [member, place] : stages) {
        if (members.has(member)) {
            const std::string name = members.text(member);
            if (!isDeclaredFile(name, ".glsl")) {
                failAt(members.at(member),
                       fmt::format("\"{}\" must be the name of a .glsl file beside the declaration", name));
            }
            place = std::string(folder) + name;
        }
    }
    if (std::ranges::all_of(stages, [](const auto& stage) { return stage.file.empty(); })) {
        failAt(members.where(), "names no file");
    }
    declared.after = members.texts("after");
    code.coversEmission = members.flag("coversEmission", false);
    code.isTraced = members.flag("traced", false);
    code.isReciprocal = members.flag("reciprocal", false);
    code.isSampled = members.flag("sampled", false);
    code.shadesAll = members.flag("shadesAll", false);
    code.gains = members.text("gainsEnergy", "");
    if (!code.model.empty()) {
        checkModel(declaration, members);
    }
    if (!code.layer.empty() || !code.model.empty() || !code.diffuse.empty()) {
        refuseWordOfGlsl(declaration, code.name);  // The BSDF has a member of the name.
    }
    // The code of coordinates and opacity also runs in traversal, for keys that no case of the module has.
    for (const std::string_view stage : {"layer", "coordinates", "opacity", "diffuse"}) {
        if (members.has(stage) && feature < 0) {
            failAt(members.at(stage), "needs a feature of its own: give the declaration \"neutral\"");
        }
    }
    if (!code.layer.empty() && declaration.text("stage") != "layer") {
        // Only features that are lobes can be enabled as layers.
        failAt(members.at("layer"), "needs a declaration whose \"stage\" is \"layer\"");
    }
    return declared;
}

std::vector<FeatureCode> orderCode(std::vector<DeclaredCode> code) {
    std::ranges::sort(code, {}, [](const DeclaredCode& declared) { return declared.code.name; });
    std::vector<std::string> names;
    std::map<std::string_view, std::size_t> places;
    for (const DeclaredCode& declared : code) {
        places.emplace(declared.code.name, names.size());
        names.push_back(declared.code.name);
    }
    // How many each waits for, and which wait for each.
    std::vector<std::size_t> needs(code.size());
    std::vector<std::vector<std::size_t>> waiting(code.size());
    std::set<std::size_t> ready;
    for (std::size_t i = 0; i < code.size(); ++i) {
        for (const std::string& name : code[i].after) {
            const auto place = places.find(name);
            if (place == places.end()) {
                failAt(code[i].where + "/after", fmt::format("no declaration with GLSL is called \"{}\"{}",
                                                             name, base::suggestion(name, names)));
            }
            waiting[place->second].push_back(i);
        }
        needs[i] = code[i].after.size();
        if (needs[i] == 0) {
            ready.insert(i);
        }
    }
    std::vector<FeatureCode> ordered;
    while (!ready.empty()) {
        const std::size_t next = *ready.begin();
        ready.erase(ready.begin());
        ordered.push_back(code[next].code);
        for (const std::size_t other : waiting[next]) {
            if (--needs[other] == 0) {
                ready.insert(other);
            }
        }
    }
    if (ordered.size() < code.size()) {
        const auto left = std::ranges::find_if(needs, [](std::size_t count) { return count > 0; });
        failAt(code[static_cast<std::size_t>(left - needs.begin())].where + "/after",
               "waits for itself by what it names");
    }
    return ordered;
}

}  // namespace glint::materials
