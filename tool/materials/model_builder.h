// Builds a material model from declarations. The parts of the work are in files of their own.
#pragma once

#include "materials/declaration_json.h"
#include "materials/material_model.h"

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glint::materials {

inline constexpr double kNoOrder = 1e6;

// Builds the model in two passes over the files: the first collects the names, the second reads the
// expressions, which may use any of the names.
class ModelBuilder {
public:
    explicit ModelBuilder(ParsedDeclarations files);
    MaterialModel build();

private:
    struct File {
        std::shared_ptr<const ParsedDeclaration> parsed;
        int object = 0;
        int mainFeature = -1;  // index into pending_, until bits are assigned
        std::string scope{};   // the name of the model of a pack that it declares

        const ParsedDeclaration* operator->() const {
            return parsed.get();
        }
    };
    // A feature before bits are assigned.
    struct Pending {
        Feature feature;
        double order = kNoOrder;
        std::string where;
        Light light = Light::Front;
        bool isOfPack = false;
        int base = -1;  // the model whose feature it is, as an index into pending_; -1: all models share it
    };

    // declarations.cpp

    // Returns, by object, the features whose objects a material may have in place of it.
    std::map<int, FeatureMask> replacing() const;
    int addObject(const std::string& name, bool isExtension);
    // Returns the full name of what the object declares, which must be new: every full name stands for one
    // thing.
    std::string newName(const Members& members);
    void claimName(const std::string& name, const std::string& where);
    static void checkName(const std::string& name, const std::string& where);
    // Finds what the file that is read means by a name: a thing of its own model, or one that models share.
    // `find` is a function of MaterialModel. Returns the index, or -1.
    int named(int (MaterialModel::*find)(std::string_view) const, std::string_view name) const;
    std::string gltfPlace(int object, std::string_view member) const;
    Feature& featureAt(int index);
    int featureNamed(const std::string& name, const std::string& where) const;

    // collect_declarations.cpp: the first pass

    // Finds what has each role: Glint's own declarations come before those of packs. Later parameters and
    // textures of the role fill the first one.
    void findRoles();
    void findRole(const Members& members, Place place);
    static package::Role roleOf(const Members& members);
    // Returns whether a parameter or a texture fills another one, by its name or by its role.
    bool fills(const Members& members, Place place) const;
    int addFeature(const Members& members, Feature feature, Light light);
    static void readNeeds(const Members& members, Feature& feature);
    // Refuses a feature that every material would have, and what is for lobes where it is none.
    static void checkOwn(const Members& members, const Feature& feature);
    void collect(File& file);
    Parameter makeParameter(const File& file, const Members& members, const std::string& name);
    static void readType(const Members& members, Parameter& parameter);
    static void readRange(const Members& members, Parameter& parameter);
    static void readDefault(const Members& members, Parameter& parameter);
    static const ValueType& vectorType(const Members& members);
    void addParameter(const File& file, const Members& members);
    void addAttribute(const File& file, const Members& members);
    void addTexture(const File& file, const Members& members);
    static void readDimension(const Members& members, MaterialTexture& texture, Feature& feature);
    static TextureReads readsOfTexture(const Members& members);
    static void readRoughness(const Members& members, TextureReads& reads);
    // Parameters and textures that fill those of another base model.
    void collectAliases(const File& file);
    // Returns the texture that one fills.
    int filledTexture(const Members& members) const;

    // link_declarations.cpp: the bits, between the passes

    // Lobes and inputs have words of their own. In each, bits follow the declared order, then the names.
    void assignBits();
    static bool isLobe(const Feature& feature);
    // A feature is evaluated after those that its conditions need. Vertex attributes come last, because all
    // textures and lobes may need them.
    void orderByDependence();
    // Fills MaterialObject::feature, base and isUnlit, and Feature::exclusions.
    void indexModel();
    // The features of a model's keys that are of the base which it replaces, and other models, are left out.
    void excludeFromModels();
    // Unlit surfaces read a texture and have an opacity, so packs may change both.
    void keepPlacesOfUnlit();
    // Whether a reason that leaves the feature out reads the fact.
    bool asksFor(const Feature& feature, Fact fact) const;
    void addNeeds(const Expression& expression, std::vector<int>& needs) const;

    // link_declarations.cpp: the second pass

    std::optional<Symbol> resolve(std::string_view function, const std::vector<std::string_view>& names);
    Expression expression(const DeclarationJson& json, const std::string& where, bool isCondition);
    void linkFeature(const Members& members, int index, const FeatureMask& onlyWith);
    void link(const File& file);
    void linkTexture(const File& file, const Members& members);
    // In keys of another base model, the texture's reasons are those that this model gives, if it gives any.
    void linkAliases(const File& file);
    void linkScales(const Members& members, int slot);
    void linkParameters(const File& file);
    void linkDerived(const File& file, const Members& members);
    void linkBase(const File& file, const Members& members);
    void linkBehaviour(const File& file, const Members& members);

    MaterialModel model_;
    bool isOfPack_ = false;  // of the file that collect() reads
    int base_ = -1;          // the model that it declares: Pending::base of its features
    std::string scope_;      // File::scope of the file that is read
    std::vector<File> files_;
    std::vector<Pending> pending_;
    std::map<std::string, std::string> named_;                      // where each name is declared
    std::map<std::pair<package::Role, Place>, std::string> roles_;  // where what has each role is declared
    std::ptrdiff_t baseBehaviours_ = 0;
};

}  // namespace glint::materials
